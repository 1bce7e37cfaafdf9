"""Camera calibrations: OpenCV, ROS, Kalibr, Calibmar, COLMAP."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any

from . import _uwvdb
from .camera import Camera

__all__ = ["Calibration", "load"]


@dataclass(frozen=True)
class Calibration:
    """What a file says about one camera."""

    camera: Camera  # at the world's origin
    section: dict[str, Any]  # a scene's `camera`: Scene(camera={**section, "pose": {...}})
    format: str
    name: str  # of the camera in the file; "" if it has none
    names: list[str]  # of all cameras in the file
    model: str  # in the file's own words
    warnings: list[str]


def load(file: str | os.PathLike[str], camera: str = "") -> Calibration:
    """Reads a calibration (docs/calibration.md); its format is found out. `camera`: which of
    several in the file. Raises InputError and IoError."""
    found = _uwvdb.load_calibration(os.fspath(file), camera)
    return Calibration(Camera._of(found["camera"]), found["section"], found["format"],
                       found["name"], found["names"], found["model"], found["warnings"])
