"""Volumes and surfaces of a scene, made of arrays."""

from __future__ import annotations

import copy
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arrays, _uwvdb
from .errors import UsageError

__all__ = ["Geometry", "Volumes"]

_FARTHEST_UV = 1e7  # as in files


class Section:
    """A list of the scene's, with entries from files and from memory."""

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


class Volumes(Section):
    """The volumes of a scene: `len`, iteration and `del` work as on a list of their entries."""

    _name, _kind = "volumes", "array"

    def add(self, array: ArrayLike, *, voxel_size: ArrayLike | None = None,
            origin: ArrayLike = (0, 0, 0), world_from_index: ArrayLike | None = None,
            concentration: Mapping[str, float] | None = None,
            absorption: ArrayLike | None = None, scattering: ArrayLike | None = None,
            phase: Mapping[str, Any] | None = None,
            emission: Mapping[str, Any] | ArrayLike | None = None, name: str | None = None,
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
        emission       the light that it gives off, beside one of these or alone: W/(sr m3) per unit
                       of value, one per band or one for all; or, as scene files have it,
                       {"blackbody": 0.5, "kelvin": 1000}, {"table": ...}, {"per_unit": ...}
        transform      of a scene file's volume: scale, rotate, translate, applied last

        The entry can then be changed as any other: `scene["volumes[0].grids.array1.small"] = 2`.
        Raises UsageError for an array of another shape or with masked values, InputError for
        meanings that no scene file could have and for more values than there is memory for.
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
        if concentration is not None and not isinstance(concentration, Mapping):
            raise UsageError(f"{where}: concentration: expected ppm per unit of value, such as "
                             f"{{'small': 0.1, 'large': 1}}, found {concentration!r}")
        meaning: dict[str, Any] = dict(concentration or {})
        for key, value in (("absorption", absorption), ("scattering", scattering),
                           ("phase", phase)):
            if value is not None:
                meaning[key] = value
        if not meaning and emission is None:
            raise UsageError(f"{where}: does not say what the values mean; give concentration in "
                             "ppm per unit, absorption and scattering in 1/m, or emission")
        name = self._new_name(name)
        entry: dict[str, Any] = {"array": name}
        if meaning:
            entry["grids"] = {name: meaning}
        if emission is not None:
            entry["emission"] = {name: dict(emission) if isinstance(emission, Mapping)
                                 else {"per_unit": emission}}
        if transform is not None:
            entry["transform"] = dict(transform)
        self._scene.add_volume(name, values, place, entry, where)
        return name


    def set_values(self, name: str, array: ArrayLike) -> None:
        """Puts other values in the place of the array that was added as `name`, of the same shape.
        Raises UsageError."""
        where = "volumes.set_values"
        values = _arrays.numbers(where, array, np.float32)
        if values.ndim != 3:
            raise UsageError(f"{where}: expected an array of shape (nx, ny, nz), "
                             f"found {_arrays.shape_text(values.shape)}")
        self._scene.set_array(name, values, where)


def _placed(where: str, voxel_size: ArrayLike, origin: ArrayLike) -> NDArray[np.float64]:
    edges = _arrays.vector(f"{where}: voxel_size", voxel_size)
    if not (edges > 0).all():
        raise UsageError(f"{where}: voxel_size: expected lengths above 0 m, found {voxel_size!r}")
    place = np.diag([*edges, 1.0])
    place[:3, 3] = _arrays.vector(f"{where}: origin", origin)
    return place


class Geometry(Section):
    """The surfaces of a scene: `len`, iteration and `del` work as on a list of their entries."""

    _name, _kind = "geometry", "mesh"

    def add(self, vertices: ArrayLike, faces: ArrayLike, *,
            reflectance: ArrayLike | None = None, uvs: ArrayLike | None = None,
            texture: ArrayLike | None = None, name: str | None = None,
            transform: Mapping[str, Any] | None = None,
            trajectory: Mapping[str, Any] | None = None) -> str:
        """Adds a mesh of diffuse triangles, opaque from both sides. Returns its name.

        vertices     (V, 3) positions [m, world]
        faces        (F, 3) whole numbers: the vertices of each triangle, counted from 0
        reflectance  0 to 1, one per band or one for all; 0.5 if left out
        texture      instead of it: (height, width, 3) reflectances, linear red, green and blue,
                     which become bands as those of files do
        uvs          (V, 2) where in the texture each vertex lies: (0, 0) is its top left corner,
                     (1, 1) the bottom right one, as in glTF
        transform, trajectory  as scene files have them

        Raises UsageError for arrays of another shape or with masked values, and InputError.
        """
        where = "geometry.add"
        points = _arrays.numbers(f"{where}: vertices", vertices, np.float64, made=4)
        corners = _arrays.whole_numbers(f"{where}: faces", faces, made=8)
        for what, found in (("vertices", points), ("faces", corners)):
            if found.ndim != 2 or found.shape[1] != 3 or len(found) == 0:
                raise UsageError(f"{where}: {what}: expected an array of shape "
                                 f"({what[0].upper()}, 3), found {_arrays.shape_text(found.shape)}")
        if (uvs is None) != (texture is None):
            raise UsageError(f"{where}: give uvs and a texture, or neither")
        if texture is not None and reflectance is not None:
            raise UsageError(f"{where}: give either a reflectance or a texture")
        coordinates = texels = None
        if uvs is not None and texture is not None:
            coordinates = _arrays.numbers(f"{where}: uvs", uvs, np.float64, made=13)
            if coordinates.shape != (len(points), 2):
                raise UsageError(f"{where}: uvs: expected an array of shape ({len(points)}, 2), "
                                 f"found {_arrays.shape_text(coordinates.shape)}")
            if not (np.abs(coordinates) <= _FARTHEST_UV).all():
                raise UsageError(f"{where}: uvs: expected numbers of at most {_FARTHEST_UV:g}; "
                                 "0 to 1 lies in the texture")
            texels = _texture(f"{where}: texture", texture)
        name = self._new_name(name)
        entry: dict[str, Any] = {"mesh": name}
        for key, value in (("reflectance", reflectance), ("transform", transform),
                           ("trajectory", trajectory)):
            if value is not None:
                entry[key] = copy.copy(value)
        self._scene.add_mesh(name, points, corners, coordinates, texels,
                             entry, where)
        return name

    def set_texture(self, name: str, texture: ArrayLike) -> None:
        """Puts another texture in the place of that of the mesh that was added as `name`, of any
        size. Raises UsageError."""
        where = "geometry.set_texture"
        self._scene.set_texture(name, _texture(where, texture), where)


def _texture(where: str, texture: ArrayLike) -> NDArray[np.float32]:
    # Compared with 0 and 1; as pixels; as a texture with its smaller images.
    texels = np.asarray(_arrays.numbers(where, texture, np.float32, made=13), dtype=np.float32)
    if texels.ndim != 3 or texels.shape[2] != 3 or 0 in texels.shape:
        raise UsageError(f"{where}: expected an array of shape (height, width, 3), found "
                         f"{_arrays.shape_text(texels.shape)}")
    if not ((texels >= 0) & (texels <= 1)).all():
        raise UsageError(f"{where}: expected reflectances from 0 to 1, linear; pixels of an 8-bit "
                         "image are (pixels / 255) ** 2.2, roughly")
    return texels
