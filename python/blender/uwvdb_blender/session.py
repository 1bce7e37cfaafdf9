"""One `uwvdb edit` that stays, and the pictures that it renders of a scene which is written anew again and
again, by the interface of edit/server/edit_server.h. Nothing here waits on Blender's main thread, and
nothing here needs Blender."""

import atexit
import contextlib
import http.client
import json
import os
import shutil
import subprocess
import tempfile
import threading
import urllib.parse
import weakref

import numpy

from .scene import SCENE_FILE
from .words import Words

TOTAL = ("direct", "forward", "backscatter", "multiple", "snow")
SECONDS_TO_ANSWER = 60
SECONDS_TO_STOP = 2


_open = weakref.WeakSet()


@atexit.register
def _close_all():
    """Blender frees its views after Python has ended."""
    sessions = list(_open)
    for session in sessions:
        session.close()
    for session in sessions:
        session.wait_until_closed()


class Picture:
    """Linear light as rows from the bottom, (height, width, 4); the step it is of, and how far that is."""

    def __init__(self, rows, quality):
        self.rows, self.quality = rows, quality


class Session:
    """Renders the scene that was shown last. All its work is done on threads of its own; `version` grows
    with each picture and message."""

    def __init__(self, program_path):
        self.folder = tempfile.mkdtemp(prefix="uwvdb-viewport-")
        self.version, self.picture, self.message = 0, None, ""
        self.not_shown, self.is_final = [], False
        self._program, self._changed = program_path, threading.Condition()
        self._wanted, self._is_closed, self._words = None, False, Words()
        self._process = self._address = None
        self._state, self._sent = None, None  # of the server: the scene, and the picture's planes
        self._mixing = threading.Lock()
        self._thread = threading.Thread(target=self._work, daemon=True)
        self._thread.start()
        _open.add(self)

    def show(self, content, words, meshes=None):
        """Shows a scene from now on, of which messages speak in `words`. `meshes` is (name of its file, gltf.Glb),
        written unless it is there."""
        with self._changed:
            self.is_final = False
            self._wanted = (content, words, meshes)
            self._changed.notify()

    def close(self):
        """Ends the process; returns at once."""
        with self._changed:
            self._is_closed = True
            self._changed.notify()

    def wait_until_closed(self):
        self._thread.join()

    def _tell(self, message):
        self.message = self._words.of(message)
        self.version += 1

    def _work(self):
        try:
            while True:
                with self._changed:
                    self._changed.wait_for(lambda: self._wanted or self._is_closed)
                    if self._is_closed:
                        return
                    wanted, self._wanted = self._wanted, None
                try:
                    self._take(*wanted)
                except (OSError, http.client.HTTPException, ValueError) as error:
                    if not self._is_closed:
                        self._tell(f"the viewport's picture cannot be rendered: {error}")
        finally:
            self._end()

    def _take(self, content, words, meshes):
        self._words = words
        if meshes is not None:
            self._write_meshes(*meshes)
        path = os.path.join(self.folder, SCENE_FILE)
        with open(path + ".new", "w", encoding="utf-8") as file:
            json.dump(content, file)
        os.replace(path + ".new", path)
        if self._process is None or self._process.poll() is not None:
            self._start(path)
            self._hear(json.loads(self._ask("GET", "api/state")))
        else:
            self._hear(json.loads(self._ask("POST", "api/reload", b"{}")))

    def _write_meshes(self, name, glb):
        path = os.path.join(self.folder, name)
        if os.path.exists(path):
            return
        glb.write(path + ".new")
        os.replace(path + ".new", path)
        for other in os.listdir(self.folder):
            if other.endswith(".glb") and other != name:
                os.remove(os.path.join(self.folder, other))

    def _start(self, path):
        command = [self._program, "edit", path, "--no-browser"]
        if shutil.which("setpriv"):  # if Blender dies, so does it
            command = ["setpriv", "--pdeathsig", "TERM", *command]
        self._process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                         stderr=subprocess.PIPE, text=True)
        address = self._process.stdout.readline().strip()
        if not address:
            raise OSError(self._process.stderr.read().strip() or "uwvdb edit ended")
        # What it may say later has somewhere to go.
        threading.Thread(target=self._process.stderr.read, daemon=True).start()
        with self._mixing:  # what another process has sent counts its revisions for itself
            self._state = self._sent = None
        self._address = urllib.parse.urlsplit(address)
        threading.Thread(target=self._follow, args=(self._address,), daemon=True).start()

    def _connect(self, address, method, path, body=None, timeout=SECONDS_TO_ANSWER):
        connection = http.client.HTTPConnection(address.hostname, address.port, timeout=timeout)
        connection.request(method, address.path + path, body, {"Content-Type": "application/json"})
        return connection.getresponse()

    def _ask(self, method, path, body=None):
        response = self._connect(self._address, method, path, body)
        data = response.read()
        if response.status >= 400:
            raise OSError(json.loads(data)["error"])
        return data

    def _follow(self, address):
        """Follows the server's events until it ends."""
        with contextlib.suppress(OSError, http.client.HTTPException):
            response = self._connect(address, "GET", "api/events", timeout=None)
            for line in response:
                if line.startswith(b"event: "):
                    kind = line[7:].strip()
                    if kind in (b"hello", b"image"):
                        self._fetch()
                    elif kind == b"error":
                        self._hear(json.loads(self._ask("GET", "api/state")))
        if not self._is_closed:
            self._tell("the program uwvdb has ended; with the next change it is started again")

    def _hear(self, state):
        """Takes the state of the server; a change of brightness alone mixes the picture anew."""
        with self._mixing:
            self._state = state
            self.not_shown = state.get("not_shown", [])
            error = state.get("error")
            if error:
                self._tell(error["message"])
            elif self.message:
                self._tell("")
            self._mix()

    def _fetch(self):
        data = self._ask("GET", "api/image?type=f16")
        if not data:
            return
        length = int.from_bytes(data[:4], "little")
        header, at = json.loads(data[4:4 + length]), 4 + length
        size, planes = (header["height"], header["width"]), []
        for plane in header["planes"]:
            count = size[0] * size[1] * plane["channels"]
            if plane["layer"] in TOTAL:
                values = numpy.frombuffer(data, "<f2", count, at).reshape(*size, 3)
                planes.append((plane["lamp"], plane["factor"], values))
            at += 2 * count
        with self._mixing:
            self._sent = (header, planes)
            self._mix()

    def _mix(self):
        """Makes the picture of the planes that were sent: the lamps as bright as they are now."""
        if self._sent is None or self._state is None:
            return
        header, planes = self._sent
        rendered = dict(zip(header["lamps"], header["lamp_brightness"]))
        now = {lamp["name"]: lamp["rgb_scale"] for lamp in self._state.get("lamps", ())}
        rows = numpy.zeros((header["height"], header["width"], 4), numpy.float32)
        rows[..., 3] = 1
        for lamp, factor, values in planes:
            gain = numpy.full(3, factor, numpy.float32)
            if lamp is not None:
                was, is_now = rendered[lamp], now.get(lamp, (0, 0, 0))
                gain *= [n / w if w > 0 else 0 for n, w in zip(is_now, was)]
            rows[..., :3] += values.astype(numpy.float32) * gain
        self.picture = Picture(numpy.ascontiguousarray(rows[::-1]), header["quality"])
        self.is_final = (header["quality"] == "final"
                         and header["revision"] >= self._state["revision"])
        self.version += 1

    def _end(self):
        process = self._process
        if process is not None and process.poll() is None:
            process.terminate()
            try:
                process.wait(SECONDS_TO_STOP)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)
