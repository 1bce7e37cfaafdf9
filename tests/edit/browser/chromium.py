"""Drives Debian's Chromium through a pipe, by the DevTools protocol: no other package is needed."""

import base64
import json
import os
import select
import shutil
import subprocess
import tempfile
import time

PROGRAMS = ["chromium", "chromium-browser", "google-chrome"]

OPTIONS = [
    "--headless", "--no-first-run", "--no-default-browser-check", "--disable-extensions",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
    "--disable-dev-shm-usage", "--mute-audio", "--hide-scrollbars",
    "--force-color-profile=srgb", "--force-device-scale-factor=1", "--remote-debugging-pipe",
]

# Pages are put together by WebGL that SwiftShader computes, in place of a graphics card, or
# without any, as a browser on a machine without one does.
WITH_WEBGL = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
WITHOUT_GRAPHICS = ["--disable-gpu"]


class ProtocolError(Exception):
    """Chromium refuses a command, or JavaScript threw."""


class Chromium:
    """One browser; `with Chromium() as browser` ends it and removes its profile."""

    def __init__(self, width=1280, height=800, graphics=WITH_WEBGL):
        program = next(filter(None, map(shutil.which, PROGRAMS)), None)
        if program is None:
            raise FileNotFoundError("chromium is missing: scripts/install-packages --tests")
        self._profile = tempfile.mkdtemp(prefix="uwvdb-chromium-")
        to_read, self._to = os.pipe()
        self._from, to_write = os.pipe()
        # Chromium's sandbox needs a user that is not root.
        sandbox = ["--no-sandbox"] if os.geteuid() == 0 else []
        # It reads file descriptor 3 and writes 4.
        self._process = subprocess.Popen(
            ["bash", "-c", f'exec "$@" 3<&{to_read} 4>&{to_write}', "bash", program, *OPTIONS,
             *graphics,
             *sandbox, f"--user-data-dir={self._profile}", f"--window-size={width},{height}",
             "about:blank"],
            pass_fds=(to_read, to_write), stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL)
        os.close(to_read)
        os.close(to_write)
        self._buffer = b""
        self._last_id = 0
        self._answers = {}
        self._handlers = {}

    def __enter__(self):
        return self

    def __exit__(self, *_):
        try:
            self.command("Browser.close")
        except (ProtocolError, OSError):
            self._process.kill()
        try:
            self._process.wait(10)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        os.close(self._to)
        os.close(self._from)
        shutil.rmtree(self._profile, ignore_errors=True)

    def on(self, method, handler):
        """Calls handler(params, session) for each event of that name."""
        self._handlers.setdefault(method, []).append(handler)

    def send(self, method, session=None, **params):
        """Without waiting for the answer, as handlers of events have to; returns its number."""
        self._last_id += 1
        message = {"id": self._last_id, "method": method, "params": params}
        if session:
            message["sessionId"] = session
        os.write(self._to, json.dumps(message).encode() + b"\0")
        return self._last_id

    def command(self, method, session=None, timeout=300, **params):
        number = self.send(method, session, **params)
        deadline = time.monotonic() + timeout
        while number not in self._answers:
            self._receive(deadline, method)
        answer = self._answers.pop(number)
        if "error" in answer:
            raise ProtocolError(f"{method}: {answer['error']['message']}")
        return answer["result"]

    def pump(self, seconds):
        """Handles events for a while."""
        deadline = time.monotonic() + seconds
        while (left := deadline - time.monotonic()) > 0:
            if select.select([self._from], [], [], left)[0]:
                self._receive(time.monotonic() + 1, "events")

    def _receive(self, deadline, what):
        left = deadline - time.monotonic()
        if left <= 0 or not select.select([self._from], [], [], left)[0]:
            raise ProtocolError(f"{what}: Chromium does not answer")
        data = os.read(self._from, 1 << 20)
        if not data:
            raise ProtocolError("Chromium has ended")
        self._buffer += data
        *messages, self._buffer = self._buffer.split(b"\0")
        for text in messages:
            message = json.loads(text)
            if "id" in message:
                self._answers[message["id"]] = message
            for handler in self._handlers.get(message.get("method"), []):
                handler(message["params"], message.get("sessionId"))

    def new_page(self, width=1280, height=800):
        target = self.command("Target.createTarget", url="about:blank")["targetId"]
        session = self.command("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        return Page(self, session, target, width, height)


class Page:
    """One window of the browser, used as a hand and an eye would."""

    def __init__(self, browser, session, target, width, height):
        self._browser = browser
        self._session = session
        self._target = target
        self.requests = []  # (method, address) of all that the page has asked for
        self.complaints = []  # what the console says went wrong
        self.questions = []  # kinds of the browser's own dialogues, which are all agreed to
        for domain in ("Page", "Runtime", "Network", "Log"):
            self.command(f"{domain}.enable")
        self._on("Network.requestWillBeSent", lambda p: self.requests.append(
            (p["request"]["method"], p["request"]["url"])))
        self._on("Runtime.exceptionThrown", lambda p: self.complaints.append(
            p["exceptionDetails"].get("exception", {}).get("description",
                                                           p["exceptionDetails"]["text"])))
        self._on("Runtime.consoleAPICalled", lambda p: p["type"] in ("error", "assert") and
                 self.complaints.append(str([a.get("value") for a in p["args"]])))
        self._on("Log.entryAdded", lambda p: p["entry"]["level"] == "error" and
                 self.complaints.append(f"{p['entry']['text']} {p['entry'].get('url', '')}"))
        self._on("Page.javascriptDialogOpening", self._agree)
        self.resize(width, height)

    def _agree(self, params):
        self.questions.append(params["type"])
        self._browser.send("Page.handleJavaScriptDialog", self._session, accept=True)

    def _on(self, method, handler):
        self._browser.on(method, lambda params, session:
                         handler(params) if session == self._session else None)

    def command(self, method, **params):
        return self._browser.command(method, self._session, **params)

    def close(self):
        self._browser.command("Target.closeTarget", targetId=self._target)

    def pump(self, seconds):
        self._browser.pump(seconds)

    def resize(self, width, height, mobile=False):
        """A mobile screen shows a page that is wider than itself smaller, as telephones do."""
        self.command("Emulation.setDeviceMetricsOverride", width=width, height=height,
                     deviceScaleFactor=1, mobile=mobile)

    def prefer(self, scheme):
        """dark or light."""
        self.command("Emulation.setEmulatedMedia",
                     features=[{"name": "prefers-color-scheme", "value": scheme}])

    def open(self, address):
        self.command("Page.navigate", url=address)

    def evaluate(self, expression):
        """The value of a JavaScript expression; promises are awaited."""
        answer = self.command("Runtime.evaluate", expression=expression, returnByValue=True,
                              awaitPromise=True)
        if "exceptionDetails" in answer:
            raise ProtocolError(f"{expression}: "
                                f"{answer['exceptionDetails']['exception'].get('description')}")
        return answer["result"].get("value")

    def wait(self, expression, seconds=300):
        """Until a JavaScript expression is true."""
        deadline = time.monotonic() + seconds
        while True:
            if self.evaluate(f"Boolean({expression})"):
                return
            if time.monotonic() > deadline:
                raise AssertionError(f"not within {seconds} s: {expression}")
            self.pump(0.03)

    def screenshot(self, path=None, clip=None):
        """A PNG as bytes, of the page or of clip = (x, y, width, height)."""
        options = {"format": "png"}
        if clip:
            options["clip"] = dict(zip(("x", "y", "width", "height"), clip), scale=1)
        png = base64.b64decode(self.command("Page.captureScreenshot", **options)["data"])
        if path:
            with open(path, "wb") as file:
                file.write(png)
        return png

    def box(self, selector):
        """(x, y, width, height) of the first element of that CSS selector, in the window."""
        found = self.evaluate(f"(e => e && (r => [r.x, r.y, r.width, r.height])"
                              f"(e.getBoundingClientRect()))(document.querySelector({json.dumps(selector)}))")
        if not found:
            raise AssertionError(f"there is no {selector}")
        return found

    def centre(self, selector):
        x, y, width, height = self.box(selector)
        return x + width / 2, y + height / 2

    def mouse(self, kind, x, y, buttons=0, modifiers=0):
        """kind: mousePressed, mouseMoved or mouseReleased."""
        self.command("Input.dispatchMouseEvent", type=kind, x=x, y=y, modifiers=modifiers,
                     button="left" if buttons or kind != "mouseMoved" else "none",
                     buttons=buttons, clickCount=1 if kind != "mouseMoved" else 0)

    def click(self, selector):
        x, y = self.centre(selector)
        self.mouse("mouseMoved", x, y)
        self.mouse("mousePressed", x, y, buttons=1)
        self.mouse("mouseReleased", x, y)

    def drag(self, start, end, steps=8, modifiers=0, release=True):
        self.mouse("mouseMoved", *start, modifiers=modifiers)
        self.mouse("mousePressed", *start, buttons=1, modifiers=modifiers)
        for step in range(1, steps + 1):
            at = [a + (b - a) * step / steps for a, b in zip(start, end)]
            self.mouse("mouseMoved", *at, buttons=1, modifiers=modifiers)
        if release:
            self.mouse("mouseReleased", *end, modifiers=modifiers)

    def key(self, key, modifiers=0):
        """A key by its DOM name; modifiers: 1 Alt, 2 Ctrl, 8 Shift."""
        codes = {"Enter": 13, "Escape": 27, "Tab": 9, "Delete": 46, "PageUp": 33, "PageDown": 34,
                 "Home": 36, "ArrowLeft": 37, "ArrowUp": 38, "ArrowRight": 39, "ArrowDown": 40}
        code = codes.get(key, ord(key[0].upper()))
        text = {"Enter": "\r"}.get(key, key if len(key) == 1 and not modifiers & 3 else "")
        common = {"key": key, "windowsVirtualKeyCode": code, "modifiers": modifiers}
        self.command("Input.dispatchKeyEvent", type="keyDown", **common,
                     **({"text": text} if text else {}))
        self.command("Input.dispatchKeyEvent", type="keyUp", **common)

    def type_into(self, selector, text):
        """Replaces what a field holds, and ends with Enter."""
        self.click(selector)
        self.evaluate(f"document.querySelector({json.dumps(selector)}).select()")
        self.command("Input.insertText", text=text)
        self.key("Enter")
