"""Scenes with some of their numbers a little less and a little more, for derivatives."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arrays, _uwvdb
from .errors import InputError, UsageError
from .scene import Scene

# By how much numbers are changed to each side, relative to the greatest beside them: differences
# of products in double precision are good to 1e-8 then, and so is leaving out third derivatives.
_STEP = 1e-4

Change = tuple[str, "_uwvdb.Scene", "_uwvdb.Scene", float]


def numbers_at(scene: Scene, path: str) -> NDArray[np.float64]:
    """The numbers that are written at `path`, of any shape. Raises UsageError."""
    if path not in scene:
        raise UsageError(f"derivatives: {path}: is not written in the scene; give it a value from "
                         "where to change it")
    try:
        values = np.array(scene[path], dtype=np.float64)
    except (TypeError, ValueError):
        raise UsageError(f"derivatives: {path}: expected a number or a list of numbers, found "
                         f"{scene[path]!r}") from None
    return values


def change(scene: Scene, directions: Mapping[str, ArrayLike]) -> Change:
    """`scene` moved by a small step back and ahead along `directions`, which are those of the
    numbers at the paths."""
    values = {path: numbers_at(scene, path) for path in directions}
    along: dict[str, NDArray[np.float64]] = {}
    reach = np.inf
    for path, given in directions.items():
        direction = np.asarray(_arrays.numbers(f"derivatives: {path}", given, np.float64))
        if direction.shape not in ((), values[path].shape):
            raise UsageError(f"derivatives: {path}: expected a direction of shape "
                             f"{_arrays.shape_text(values[path].shape)}, found "
                             f"{_arrays.shape_text(direction.shape)}")
        along[path] = np.broadcast_to(direction, values[path].shape)
        longest = float(np.abs(direction).max(initial=0))
        if not np.isfinite(longest):
            raise UsageError(f"derivatives: {path}: expected finite numbers")
        if longest > 0:
            scale = float(np.abs(values[path]).max(initial=0)) or 1.0
            reach = min(reach, _STEP * scale / longest)
    if not np.isfinite(reach):
        raise UsageError("derivatives: the directions are all 0")

    def moved(step: float) -> Scene:
        other = scene.copy()
        other.update({path: (values[path] + step * along[path]).tolist() for path in along})
        return other

    name = ", ".join(directions)
    ahead = behind = reach
    try:
        more = moved(ahead)
    except InputError:  # such as a reflectance of 1
        more, ahead = scene, 0.0
    try:
        less = moved(-behind)
    except InputError:  # such as a concentration of 0
        if ahead == 0:
            raise
        less, behind = scene, 0.0
    return name, less._native, more._native, ahead + behind


def changes_of(scene: Scene, path: str) -> tuple[tuple[int, ...], list[Change]]:
    """The shape of the numbers at `path`, and a change of each."""
    shape = numbers_at(scene, path).shape
    result = []
    for index in np.ndindex(*shape):
        direction = np.zeros(shape)
        direction[index] = 1
        result.append(change(scene, {path: direction}))
    return shape, result


def is_of_sensor(path: str) -> bool:
    """Whether `path` is a number of the sensor, which light does not depend on."""
    return path.startswith("camera.sensor.")


def array_of(path: str) -> tuple[str, int] | None:
    """Which entry `path` names the array of, ("volumes", 0) or ("geometry", 0), by that section's
    arrays: voxels or texels. None: it is another path."""
    found = (re.fullmatch(r"(volumes)\[(\d+)\]\.array", path)
             or re.fullmatch(r"(geometry)\[(\d+)\]\.texture", path))
    return (found[1], int(found[2])) if found else None


def light_shape(scene: Scene, settings: Mapping[str, Any]) -> tuple[int, ...]:
    """The shape of an image's "total"."""
    camera = scene.camera_at(settings.get("camera"))
    width, height = settings.get("size") or (camera.width, camera.height)
    if settings.get("crop"):
        x0, y0, x1, y1 = settings["crop"]
        width, height = x1 - x0, y1 - y0
    return height, width, len(scene.bands)


def checked_gradient(gradient: Any, shape: tuple[int, ...], layer: str) -> NDArray[np.float64]:
    """The derivative of some number by an image's layer of that shape. Raises UsageError."""
    found = np.asarray(_arrays.numbers("backward: gradient", gradient, np.float64))
    if found.shape != shape:
        raise UsageError(f"backward: gradient: expected the shape of the image's {layer}, "
                         f"{_arrays.shape_text(shape)}, found {_arrays.shape_text(found.shape)}")
    return np.ascontiguousarray(found)
