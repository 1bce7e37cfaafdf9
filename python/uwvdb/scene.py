"""Scenes as objects."""

from __future__ import annotations

import operator
import os
from collections.abc import Mapping
from typing import Any, Union

from . import _uwvdb
from ._native import Native
from .camera import Camera
from .errors import UsageError
from .sections import Geometry, Volumes
from .water import Water

__all__ = ["Scene"]

Path = Union[str, "os.PathLike[str]"]


class Scene(Native[_uwvdb.Scene]):
    """A camera, water, volumes, surfaces and lamps, as a scene file has them (docs/scene-file.md).

    `Scene.load(file)` reads a scene file, `Scene.parse(text)` its text, and
    `Scene(camera={...}, lamps=[...])` takes its sections as dicts and lists. Lengths are metres,
    angles degrees, wavelengths nm, coefficients 1/m, concentrations ppm by volume.

    `scene[path]` reads a value as it is written, and `scene[path] = value` sets it: the paths are
    those of `uwvdb render --set`, such as "lamps.left.intensity" or "camera.pose.position". A scene
    is valid at all times: a value that no scene file could have raises InputError and changes
    nothing. `scene.update({...})` sets several together, where one alone would not be valid.

    Scenes can be pickled and copied, with the arrays they have. One scene may be read and rendered
    in several threads.
    """

    def __init__(self, *, folder: Path = ".", **sections: Any) -> None:
        """A scene of its sections: camera or cameras and rig, water, volumes, geometry, lamps,
        render, variations. `uwvdb=2` is the version of scene files in which all light is the
        default; without it, it is 1, and light is scattered once. `folder`: what names of files in
        the sections are relative to. Raises InputError."""
        self._native = _uwvdb.Scene.of_sections({"uwvdb": 1, **sections},
                                               os.path.join(os.fspath(folder), "scene"))

    @classmethod
    def load(cls, file: Path) -> Scene:
        """The scene of a file. Raises InputError for what is wrong in it, and IoError."""
        return cls._of(_uwvdb.Scene.load(os.fspath(file)))

    @classmethod
    def parse(cls, text: str, *, file: Path = "scene.yaml") -> Scene:
        """The scene of a scene file's text. `file` is where it would lie: it is what messages name,
        and names of files are relative to its folder; it is not read. Raises InputError."""
        return cls._of(_uwvdb.Scene.parse(text, os.fspath(file)))

    def __getitem__(self, path: str) -> Any:
        """The value at `path` as it is written: numbers, text, bool, lists and dicts. What is
        left to its default is not there: KeyError."""
        return self._native.get(path)

    def __setitem__(self, path: str, value: Any) -> None:
        self._native.set({path: value})

    def __delitem__(self, path: str) -> None:
        """Removes a key, or an entry of a list; then its default holds."""
        if not self._native.remove(path):
            raise KeyError(f"{path}: is not in the scene")

    def __contains__(self, path: str) -> bool:
        return self._native.has(path)

    def get(self, path: str, default: Any = None) -> Any:
        """The value at `path`, or `default`."""
        return self._native.get(path) if path in self else default

    def update(self, values: Mapping[str, Any]) -> None:
        """Sets values by their paths, all or, if they are not valid together, none."""
        self._native.set(dict(values))

    def to_dict(self) -> dict[str, Any]:
        """All of the scene as it is written."""
        result: dict[str, Any] = self._native.get("")
        return result

    def copy(self) -> Scene:
        """A scene of its own that shares the arrays, which never change."""
        return self._of(self._native.copy())

    __copy__ = copy

    def __deepcopy__(self, memo: Any) -> Scene:
        return self.copy()

    def variation(self, number: int) -> Scene:
        """The scene with the values that its section `variations` draws for this number, from 0:
        that of `uwvdb render --variation`. Raises UsageError if it has no such section, and
        InputError where it is no valid scene with these values."""
        return self._of(self._native.variation(operator.index(number)))

    def variation_values(self, number: int) -> dict[str, Any]:
        """What variation(number) sets: values by their paths. Raises UsageError."""
        return self._native.variation_values(operator.index(number))

    @property
    def volumes(self) -> Volumes:
        """Its volumes, to add arrays to."""
        return Volumes(self._native)

    @property
    def geometry(self) -> Geometry:
        """Its surfaces, to add meshes to."""
        return Geometry(self._native)

    @property
    def water(self) -> Water:
        """Its water, with what its volumes hold as constituents."""
        return Water._of(_uwvdb.Water.of_scene(self._native))

    @property
    def camera(self) -> Camera:
        """Its camera, of a rig the first: the geometry of rays, through lens and port."""
        return self.camera_at()

    def camera_at(self, camera: str | int | None = None, frame: int | None = None, *,
                  wavelength: float | None = None) -> Camera:
        """The camera of that name or index of a rig, at a frame of what moves, as light of that
        wavelength [nm] is refracted by its port: where its indices depend on it, by default that of
        the band nearest to 550, as in ground truth."""
        if wavelength is not None and not 300 <= wavelength <= 1100:
            raise UsageError(f"camera_at: wavelength: {wavelength} is not from 300 to 1100 nm")
        return Camera._of(_uwvdb.Camera(self._native, self._camera_index(camera), frame, wavelength))

    def _camera_index(self, camera: str | int | None) -> int:
        names = self.cameras
        if camera is None:
            return 0
        if isinstance(camera, str):
            if camera not in names:
                there = ", ".join(names) or "one camera, which has no name"
                raise UsageError(f"camera: the scene has no camera '{camera}'; it has {there}")
            return names.index(camera)
        camera = operator.index(camera)
        if not 0 <= camera < max(1, len(names)):
            raise UsageError(f"camera: there is no camera {camera}; count from 0 "
                             f"to {max(1, len(names)) - 1}")
        return camera

    @property
    def cameras(self) -> list[str]:
        """The names of a rig's cameras; empty: the scene has one, without a name."""
        return self._native.cameras

    @property
    def lamps(self) -> list[str]:
        """The names of its lamps, without those of its glTF files."""
        return self._native.lamps

    @property
    def bands(self) -> list[float]:
        """Its wavelengths [nm]."""
        return self._native.bands

    @property
    def frames(self) -> range | None:
        """The frames in which all that moves has a pose; None: nothing moves."""
        found = self._native.frames
        return None if found is None else range(found[0], found[1] + 1)

    @property
    def file(self) -> str:
        """Where it was read from, or belongs."""
        return os.fspath(self._native.file)

    @property
    def hash(self) -> str:
        """A hash of what is written in it, as image headers have it; arrays do not count."""
        return self._native.hash

    @property
    def warnings(self) -> list[str]:
        """What was noticed when it was read, one line each; rendering warns of it."""
        return self._native.warnings

    def __getstate__(self) -> _uwvdb.Scene:
        return self._native

    def __setstate__(self, state: _uwvdb.Scene) -> None:
        self._native = state

    def __repr__(self) -> str:
        return f"<uwvdb.Scene {self.file}: lamps {', '.join(self.lamps) or 'none'}>"
