"""`uwvdb edit` as a process, and its page as a user meets it."""

import base64
import os
import pathlib
import re
import signal
import subprocess
import tempfile

from png import Picture

# A wall four metres ahead, lit by a spot inside the picture and by a wide lamp beside the camera.
SCENE = """\
# The wall of a basin, and two lamps.
uwvdb: 1
camera:
  resolution: [320, 180]        # small, for it is rendered often
  intrinsics: {fov_x: 60}
  port: {type: flat, distance: 0.02, thickness: 0.01}
water:
  bands: [620, 540, 450]
  particles: {small: 0.02, large: 0.05}
geometry:
  - {type: plane, point: [0, 0, 4], normal: [0, 0, -1], reflectance: [0.5, 0.5, 0.5]}
  - {type: box, min: [-0.4, 0.7, 3.4], max: [0.4, 1.2, 3.9], reflectance: [0.05, 0.05, 0.05]}
lamps:
  - name: spot   # seen in the picture
    position: [0.6, 0, 2.5]
    direction: [0, 0, 1]
    profile: {type: spot, beam: 40, edge: 10}
    intensity: [10, 10, 10]
    frame: camera
  - {name: flood, position: [-0.8, -0.3, 0], intensity: [4, 4, 4]}
render:
  samples: 4
"""


class Editor:
    """The server, with a scene in a folder of its own, or with a file where it is."""

    def __init__(self, program, scene=SCENE, file=None):
        self._folder = tempfile.TemporaryDirectory(prefix="uwvdb-edit-")
        self.folder = pathlib.Path(self._folder.name)
        self.program = program
        self.scene = file or self.folder / "wall.yaml"
        if file is None:
            self.scene.write_text(scene)
        self._process = None
        self.address = None
        self.start()

    def start(self, port=0):
        self._process = subprocess.Popen(
            [self.program, "edit", self.scene, "--no-browser", "--port", str(port)],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        printed = ""
        while (line := self._process.stdout.readline()):
            printed += line
            if (found := re.search(r"http://127\.0\.0\.1:(\d+)/\S+/", line)):
                self.address = found.group(0)
                self.port = int(found.group(1))
                return
        raise AssertionError(f"uwvdb edit printed no address: {printed}")

    def stop(self):
        """Ctrl-C; returns the exit code."""
        self._process.send_signal(signal.SIGINT)
        try:
            code = self._process.wait(10)
        finally:
            self._process.kill()
            self._process.stdout.close()
        return code

    @property
    def cpu_seconds(self):
        fields = pathlib.Path(f"/proc/{self._process.pid}/stat").read_text().rpartition(")")[2]
        user, system = fields.split()[11:13]
        return (int(user) + int(system)) / os.sysconf("SC_CLK_TCK")

    @property
    def resident_bytes(self):
        pages = pathlib.Path(f"/proc/{self._process.pid}/statm").read_text().split()[1]
        return int(pages) * os.sysconf("SC_PAGE_SIZE")

    def render(self, name, *options):
        """Renders the scene as it is on disk; the preview."""
        out = self.folder / name
        subprocess.run([self.program, "render", self.scene, "-o", out, "--quiet", *options],
                       check=True, capture_output=True)
        return out.with_suffix(".png").read_bytes()

    def close(self):
        if self._process.poll() is None:
            self.stop()
        self._folder.cleanup()


class EditorPage:
    """The page of an editor, in terms of what is on it."""

    # What was drawn last: the page marks it for measurements.
    DRAWN = "performance.getEntriesByName('picture').at(-1)?.detail"

    # As if SwiftShader were a graphics card.
    ANY_WEBGL = """
        const { getParameter } = WebGL2RenderingContext.prototype;
        WebGL2RenderingContext.prototype.getParameter = function (name) {
            const value = getParameter.call(this, name);
            return typeof value === 'string' ? 'a graphics card' : value;
        };
    """

    def __init__(self, browser, editor, width=1024, height=700, by_webgl=False):
        self.page = browser.new_page(width, height)
        self.editor = editor
        if by_webgl:
            self.page.command("Page.addScriptToEvaluateOnNewDocument", source=self.ANY_WEBGL)
        self.open()

    def open(self):
        self.page.evaluate("window.isLeft = true")
        self.page.open(self.editor.address)
        self.page.wait("!window.isLeft && document.querySelector('.lamp-list li') !== null")

    def wait_final(self):
        """Until the picture at hand is the final one of the scene as it is."""
        self.settle()
        self.page.wait(f"{self.DRAWN}?.quality === 'final' && "
                       f"{self.DRAWN}.revision === {self.state('revision')}", 30)

    def state(self, key):
        return self.page.evaluate(f"fetch('api/state').then(r => r.json()).then(s => s.{key})")

    def lamp(self, name):
        return next(lamp for lamp in self.state("lamps") if lamp["name"] == name)

    def canvas(self):
        """The picture on the canvas, without handles."""
        width, height, data = self.page.evaluate("""(() => {
            const { width, height } = document.querySelector('.picture-box canvas');
            const copy = new OffscreenCanvas(width, height).getContext('2d');
            copy.drawImage(document.querySelector('.picture-box canvas'), 0, 0);
            const { data } = copy.getImageData(0, 0, width, height);
            let text = '';
            for (let at = 0; at < data.length; at += 30000) {
                text += String.fromCharCode(...data.subarray(at, at + 30000));
            }
            return [width, height, btoa(text)];
        })()""")
        return Picture(width, height, 4, base64.b64decode(data))

    @property
    def scale(self):
        """CSS pixels per pixel of the image."""
        return self.page.box(".picture-box canvas")[2] / self.state("image.width")

    def handle(self, name, kind="lamp"):
        """Where a lamp's handle is on the screen."""
        label = f"Lamp {name}" if kind == "lamp" else f"Axis of lamp {name}"
        return self.page.centre(f'.picture-box .{kind}-handle[aria-label^="{label}"]')

    def drag(self, name, dx, dy, kind="lamp", **options):
        start = self.handle(name, kind)
        self.page.drag(start, (start[0] + dx, start[1] + dy), **options)

    def text(self, selector):
        return self.page.evaluate(f"document.querySelector({selector!r}).textContent")

    def settle(self):
        """Lets what the user did arrive at the server, and its answers here."""
        self.page.pump(0.15)
        self.page.wait("document.body.dataset.edits !== 'sent'")
