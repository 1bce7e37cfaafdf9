"""What goes wrong, as exceptions; what is merely odd, as warnings."""

from __future__ import annotations

import re

__all__ = ["Error", "InputError", "IoError", "UsageError", "Interrupted", "SceneWarning"]

_PLACE = re.compile(r"(?P<file>[^\n]+?):(?P<line>\d+):(?P<column>\d+): ")
_KEY = re.compile(r": (?P<key>(?:camera|cameras|rig|water|volumes|geometry|lamps|render|variations)"
                  r"\b[^\s:]*): ")


class Error(Exception):
    """The base of all of them. Its text is one line."""


class InputError(Error, ValueError):
    """A scene, or a file that it names, is wrong.

    The text says where, what, and how to mend it; so do the attributes, as far as the fault has
    them, else None:

    file     the scene file
    line, column  in it, from 1
    key      path of the value, such as "lamps[0].intensity"
    mend     what to write instead
    """

    file: str | None = None
    line: int | None = None
    column: int | None = None
    key: str | None = None
    mend: str | None = None

    def __init__(self, message: str = "") -> None:
        super().__init__(message)
        if place := _PLACE.match(message):
            self.file = place["file"]
            self.line, self.column = int(place["line"]), int(place["column"])
        what = message
        if key := _KEY.search(message):
            self.key, what = key["key"], message[key.end():]
        if "; " in what:
            self.mend = what.partition("; ")[2]


class IoError(Error, OSError):
    """A file cannot be read or written."""


class UsageError(Error, ValueError):
    """A function was called with what it cannot take: an array of another shape, a layer that does
    not exist, a Renderer that is at work."""

    def __init__(self, message: str = "") -> None:
        # The renderer names its options as the command line does.
        super().__init__(re.sub(r"--(?=[a-z])", "", message))


class Interrupted(Error):
    """A progress callback returned False."""


class SceneWarning(UserWarning):
    """Something about a scene that may not be what its author meant. One line."""
