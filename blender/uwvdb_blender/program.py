"""Runs the program uwvdb: its place, progress, messages and end."""

import fcntl
import json
import os
import pty
import re
import select
import shutil
import signal
import struct
import subprocess
import termios
import threading

from .notes import Refusal

PROGRESS = re.compile(r"^(?P<what>.*?) (?:\[.*\] )?\s*(?P<percent>\d+) %  (?:.*  )?(?P<left>\S.*) left\s*$")
SECONDS_TO_STOP = 0.8


def find(chosen):
    """The program's path: that of the preferences, or the one on PATH."""
    path = shutil.which(os.path.expanduser(chosen) if chosen else "uwvdb")
    if path:
        return path
    if chosen:
        raise Refusal(f"'{chosen}' is no program: choose uwvdb in Preferences > Add-ons > uwvdb")
    raise Refusal("the program uwvdb is not on PATH: install it, or choose it in "
                  "Preferences > Add-ons > uwvdb")


class Stopped(Exception):
    """The user ended the render."""


class Failed(Refusal):
    """The program ended with an error; the text is its own line."""


def run(arguments, folder, is_cancelled, on_progress):
    """Runs the program in a folder and returns its lines. is_cancelled() is asked, and
    on_progress(what, fraction, time left) is told, several times a second. The program shows its
    progress as often as that on a terminal only, so it gets one."""
    reading, writing = pty.openpty()
    fcntl.ioctl(writing, termios.TIOCSWINSZ, struct.pack("4H", 24, 1000, 0, 0))
    try:
        process = subprocess.Popen(arguments, cwd=folder, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.DEVNULL, stderr=writing)
    except OSError as error:
        os.close(reading)
        raise Refusal(f"{arguments[0]}: {error.strerror}") from error
    finally:
        os.close(writing)
    lines, rest, is_open = [], "", True
    try:
        while is_open:
            if is_cancelled():
                raise Stopped()
            if not select.select([reading], [], [], 0.1)[0]:
                continue
            try:
                data = os.read(reading, 65536)
            except OSError:  # how Linux says that nobody writes to a terminal any more
                data = b""
            is_open = bool(data)
            *whole, rest = re.split(r"[\r\n]+", rest + data.decode(errors="replace"))
            for line in whole:
                _take(line, lines, on_progress)
            _show_progress(rest, on_progress)  # the bar has no end of line until it is drawn anew
        code = process.wait()
    finally:
        os.close(reading)
        _stop(process)
    if code != 0:
        errors = [line for line in lines if not line.startswith(("warning:", "note:"))]
        raise Failed(errors[-1] if errors else f"uwvdb ended with code {code}")
    return lines


def _show_progress(line, on_progress):
    found = PROGRESS.match(line)
    if found:
        on_progress(found["what"].strip(), int(found["percent"]) / 100, found["left"])
    return found is not None


def _take(line, lines, on_progress):
    is_message = line.startswith(("warning: ", "note: ", "uwvdb: ")) or " % " not in line
    if not _show_progress(line, on_progress) and line.strip() and is_message:
        lines.append(line.strip())


def _stop(process):
    if process.poll() is not None:
        return
    process.send_signal(signal.SIGTERM)
    try:
        process.wait(SECONDS_TO_STOP)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


_info_of = {}


def info(program, pattern, path, is_cancelled):
    """`uwvdb info --json` of a volume, kept while the file of this frame does not change."""
    stamp = (program, os.stat(path).st_mtime_ns if pattern == path else 0)
    kept = _info_of.get(pattern)
    if kept is None or kept[0] != stamp or isinstance(kept[1], Failed):
        process = subprocess.Popen([program, "info", pattern, "--json"], text=True,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE)
        while True:
            try:
                out, errors = process.communicate(timeout=0.2)
                break
            except subprocess.TimeoutExpired:
                if is_cancelled():
                    _stop(process)
                    raise Stopped() from None
        if process.returncode != 0:
            raise Failed((errors.strip().splitlines() or ["uwvdb info failed"])[-1])
        kept = _info_of[pattern] = (stamp, json.loads(out))
    return kept[1]


class NotYet(Refusal):
    """What was asked for is being looked up."""


_asked = set()


def info_soon(program, pattern, path):
    """The same without waiting: NotYet until it is known; then is_asking() becomes false."""
    stamp = (program, os.stat(path).st_mtime_ns if pattern == path else 0)
    kept = _info_of.get(pattern)
    if kept is not None and kept[0] == stamp:
        if isinstance(kept[1], Failed):
            raise kept[1]
        return kept[1]

    def ask():
        try:
            info(program, pattern, path, lambda: False)
        except Failed as failed:
            _info_of[pattern] = (stamp, failed)
        finally:
            _asked.discard(pattern)

    if pattern not in _asked:
        _asked.add(pattern)
        threading.Thread(target=ask, daemon=True).start()
    raise NotYet("its grids are being looked at")


def is_asking():
    return bool(_asked)
