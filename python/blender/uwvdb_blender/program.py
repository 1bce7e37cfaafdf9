"""Runs the program uwvdb: its place, progress, messages and end."""

import json
import os
import select
import shutil
import signal
import subprocess
import threading

from .notes import Refusal

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

    is_by_program = True


def run(arguments, folder, is_cancelled, on_progress):
    """Runs the program in a folder and returns its messages. is_cancelled() is asked several times a
    second; on_progress(stage, fraction, seconds left or None) is told as often."""
    try:
        process = subprocess.Popen([*arguments, "--progress", "json"], cwd=folder, bufsize=0,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE)
    except OSError as error:
        raise Refusal(f"{arguments[0]}: {error.strerror}") from error
    lines, rest, is_open = [], b"", True
    try:
        while is_open:
            if is_cancelled():
                raise Stopped()
            if not select.select([process.stderr], [], [], 0.1)[0]:
                continue
            data = process.stderr.read(65536)
            is_open = bool(data)
            *whole, rest = (rest + data).split(b"\n")
            for line in whole:
                _take(line.decode(errors="replace").strip(), lines, on_progress)
        code = process.wait()
    finally:
        _stop(process)
        process.stderr.close()
    if code != 0:
        errors = [line for line in lines if not line.startswith(("warning:", "note:"))]
        raise Failed(errors[-1] if errors else f"uwvdb ended with code {code}")
    return lines


def _take(line, lines, on_progress):
    if line.startswith("{"):
        progress = json.loads(line)
        on_progress(progress["stage"], progress["fraction"], progress.get("seconds_left"))
    elif line:
        lines.append(line)


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
