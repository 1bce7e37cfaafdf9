"""Scenes as objects."""

from __future__ import annotations

import copy
import os
from collections.abc import Iterator, Mapping
from typing import Any, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arrays, _uwvdb
from .camera import Camera
from .errors import UsageError
from .water import Water

__all__ = ["Scene", "Volumes", "Geometry"]

Path = Union[str, "os.PathLike[str]"]


class Scene:
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
        render, variations. `folder`: what names of files in them are relative to. Raises
        InputError."""
        self._scene = _uwvdb.Scene.of_sections({"uwvdb": 1, **sections},
                                               os.path.join(os.fspath(folder), "scene"))

    @classmethod
    def _of(cls, scene: _uwvdb.Scene) -> Scene:
        made = cls.__new__(cls)
        made._scene = scene
        return made

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
        return self._scene.get(path)

    def __setitem__(self, path: str, value: Any) -> None:
        self._scene.set({path: value})

    def __delitem__(self, path: str) -> None:
        """Removes a key, or an entry of a list; then its default holds."""
        if not self._scene.remove(path):
            raise KeyError(f"{path}: is not in the scene")

    def __contains__(self, path: str) -> bool:
        return self._scene.has(path)

    def get(self, path: str, default: Any = None) -> Any:
        """The value at `path`, or `default`."""
        return self._scene.get(path) if path in self else default

    def update(self, values: Mapping[str, Any]) -> None:
        """Sets values by their paths, all or, if they are not valid together, none."""
        self._scene.set(dict(values))

    def to_dict(self) -> dict[str, Any]:
        """All of the scene as it is written."""
        result: dict[str, Any] = self._scene.get("")
        return result

    def copy(self) -> Scene:
        """A scene of its own that shares the arrays, which never change."""
        return self._of(self._scene.copy())

    __copy__ = copy

    def __deepcopy__(self, memo: Any) -> Scene:
        return self.copy()

    @property
    def volumes(self) -> Volumes:
        """Its volumes, to add arrays to."""
        return Volumes(self._scene)

    @property
    def geometry(self) -> Geometry:
        """Its surfaces, to add meshes to."""
        return Geometry(self._scene)

    @property
    def water(self) -> Water:
        """Its water, with what its volumes hold as constituents."""
        return Water._of(_uwvdb.Water.of_scene(self._scene))

    @property
    def camera(self) -> Camera:
        """Its camera, of a rig the first: the geometry of rays, through lens and port."""
        return self.camera_at()

    def camera_at(self, camera: str | int | None = None, frame: int | None = None) -> Camera:
        """The camera of that name or index of a rig, at a frame of what moves."""
        return Camera._of(_uwvdb.Camera(self._scene, self._camera_index(camera), frame))

    def _camera_index(self, camera: str | int | None) -> int:
        names = self.cameras
        if camera is None:
            return 0
        if isinstance(camera, str):
            if camera not in names:
                there = ", ".join(names) or "one camera, which has no name"
                raise UsageError(f"camera: the scene has no camera '{camera}'; it has {there}")
            return names.index(camera)
        if not 0 <= camera < max(1, len(names)):
            raise UsageError(f"camera: there is no camera {camera}; count from 0 "
                             f"to {max(1, len(names)) - 1}")
        return camera

    @property
    def cameras(self) -> list[str]:
        """The names of a rig's cameras; empty: the scene has one, without a name."""
        return self._scene.cameras

    @property
    def lamps(self) -> list[str]:
        """The names of its lamps, without those of its glTF files."""
        return self._scene.lamps

    @property
    def bands(self) -> list[float]:
        """Its wavelengths [nm]."""
        return self._scene.bands

    @property
    def frames(self) -> range | None:
        """The frames in which all that moves has a pose; None: nothing moves."""
        found = self._scene.frames
        return None if found is None else range(found[0], found[1] + 1)

    @property
    def file(self) -> str:
        """Where it was read from, or belongs."""
        return os.fspath(self._scene.file)

    @property
    def hash(self) -> str:
        """A hash of what is written in it, as image headers have it; arrays do not count."""
        return self._scene.hash

    @property
    def warnings(self) -> list[str]:
        """What was noticed when it was read, one line each; rendering warns of it."""
        return self._scene.warnings

    def __getstate__(self) -> _uwvdb.Scene:
        return self._scene

    def __setstate__(self, state: _uwvdb.Scene) -> None:
        self._scene = state

    def __repr__(self) -> str:
        return f"<uwvdb.Scene {self.file}: lamps {', '.join(self.lamps) or 'none'}>"


class _Section:
    _name: str
    _kind: str

    def __init__(self, scene: _uwvdb.Scene) -> None:
        self._scene = scene

    def _entries(self) -> list[dict[str, Any]]:
        entries: list[dict[str, Any]] = (
            self._scene.get(self._name) if self._scene.has(self._name) else [])
        return entries

    def __len__(self) -> int:
        return len(self._entries())

    def __getitem__(self, index: int) -> dict[str, Any]:
        """An entry as it is written."""
        return self._entries()[index]

    def __iter__(self) -> Iterator[dict[str, Any]]:
        return iter(self._entries())

    def __delitem__(self, index: int) -> None:
        self._entries()[index]  # IndexError
        self._scene.remove(f"{self._name}[{index % len(self)}]")

    def _new_name(self, name: str | None) -> str:
        taken = set(self._scene.arrays)
        if name is None:
            number = 1
            while f"{self._kind}{number}" in taken:
                number += 1
            return f"{self._kind}{number}"
        if name in taken:
            raise UsageError(f"{self._name}.add: there is a '{name}' already; give another name")
        return name


class Volumes(_Section):
    """The volumes of a scene: `len`, iteration and `del` work as on a list of their entries."""

    _name, _kind = "volumes", "array"

    def add(self, array: ArrayLike, *, voxel_size: ArrayLike | None = None,
            origin: ArrayLike = (0, 0, 0), world_from_index: ArrayLike | None = None,
            concentration: Mapping[str, float] | None = None,
            absorption: ArrayLike | None = None, scattering: ArrayLike | None = None,
            phase: Mapping[str, Any] | None = None, name: str | None = None,
            transform: Mapping[str, Any] | None = None) -> str:
        """Adds a grid of values, without a file. Returns its name.

        array          (nx, ny, nz) real numbers of any type and memory order; array[i, j, k] lies
                       at origin + voxel_size * (i, j, k) in the world, and between the values they
                       are interpolated; outside, and where they are negative or not finite, there
                       is nothing. The values are copied, quantised to 16 bits per block of 8^3.
        voxel_size     [m], or three along x, y, z
        origin         where array[0, 0, 0] lies [m, world]
        world_from_index  (4, 4) instead of these two: takes (i, j, k, 1) to the world [m]
        concentration  {"small": s, "large": l}: ppm of particles per unit of value
        absorption, scattering, phase  instead of it: coefficients [1/m] per unit of value, one per
                       band or one for all, and a phase function as scene files have it
        transform      of a scene file's volume: scale, rotate, translate, applied last

        The entry can then be changed as any other: `scene["volumes[0].grids.array1.small"] = 2`.
        Raises UsageError for an array of another shape, InputError for meanings that no scene file
        could have.
        """
        where = "volumes.add"
        values = _arrays.numbers(where, array, np.float32)
        if values.ndim != 3 or 0 in values.shape:
            raise UsageError(f"{where}: expected an array of shape (nx, ny, nz), "
                             f"found {_arrays.shape_text(values.shape)}")
        if voxel_size is not None and world_from_index is None:
            place = _placed(where, voxel_size, origin)
        elif world_from_index is not None and voxel_size is None:
            place = _arrays.matrix(f"{where}: world_from_index", world_from_index)
        else:
            raise UsageError(f"{where}: give either voxel_size, with origin, or world_from_index")
        meaning: dict[str, Any] = dict(concentration or {})
        for key, value in (("absorption", absorption), ("scattering", scattering),
                           ("phase", phase)):
            if value is not None:
                meaning[key] = value
        if not meaning:
            raise UsageError(f"{where}: does not say what the values mean; give concentration in "
                             "ppm per unit, or absorption and scattering in 1/m")
        name = self._new_name(name)
        entry: dict[str, Any] = {"array": name, "grids": {name: meaning}}
        if transform is not None:
            entry["transform"] = dict(transform)
        self._scene.add_volume(name, values, place, entry, where)
        return name


def _placed(where: str, voxel_size: ArrayLike, origin: ArrayLike) -> NDArray[np.float64]:
    edges = _arrays.vector(f"{where}: voxel_size", voxel_size)
    if not (np.isfinite(edges).all() and (edges > 0).all()):
        raise UsageError(f"{where}: voxel_size: expected lengths above 0 m, found {voxel_size!r}")
    place = np.diag([*edges, 1.0])
    place[:3, 3] = _arrays.vector(f"{where}: origin", origin)
    return place


class Geometry(_Section):
    """The surfaces of a scene: `len`, iteration and `del` work as on a list of their entries."""

    _name, _kind = "geometry", "mesh"

    def add(self, vertices: ArrayLike, faces: ArrayLike, *,
            reflectance: ArrayLike | None = None, name: str | None = None,
            transform: Mapping[str, Any] | None = None,
            trajectory: Mapping[str, Any] | None = None) -> str:
        """Adds a mesh of diffuse triangles, opaque from both sides. Returns its name.

        vertices     (V, 3) positions [m, world]
        faces        (F, 3) whole numbers: the vertices of each triangle, counted from 0
        reflectance  0 to 1, one per band or one for all; 0.5 if left out
        transform, trajectory  as scene files have them

        Raises UsageError for arrays of another shape, and InputError.
        """
        where = "geometry.add"
        points = _arrays.numbers(f"{where}: vertices", vertices, np.float64)
        corners = np.asarray(faces)
        for what, found in (("vertices", points), ("faces", corners)):
            if found.ndim != 2 or found.shape[1] != 3 or len(found) == 0:
                raise UsageError(f"{where}: {what}: expected an array of shape "
                                 f"({what[0].upper()}, 3), found {_arrays.shape_text(found.shape)}")
        if corners.dtype.kind not in "iu":
            raise UsageError(f"{where}: faces: expected whole numbers, found {corners.dtype}")
        name = self._new_name(name)
        entry: dict[str, Any] = {"mesh": name}
        for key, value in (("reflectance", reflectance), ("transform", transform),
                           ("trajectory", trajectory)):
            if value is not None:
                entry[key] = copy.copy(value)
        self._scene.add_mesh(name, points, corners.astype(np.int64, copy=False), entry, where)
        return name
