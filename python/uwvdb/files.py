"""Volumes in files."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arrays, _uwvdb
from .errors import UsageError

__all__ = ["Grid", "read_vdb", "write_vdb", "inspect"]

_MOST_VALUES = 1 << 30  # along an axis: voxels are counted in 32 bits


class Grid(NamedTuple):
    """A grid of a VDB file."""

    name: str
    values: NDArray[np.float32]  # (nx, ny, nz): the box of its active voxels, 0 where it has none
    world_from_index: NDArray[np.float64]  # (4, 4) [m]: values[i, j, k] lies at (i, j, k, 1)

    @property
    def voxel_size(self) -> NDArray[np.float64]:
        """(3,) [m]"""
        size: NDArray[np.float64] = np.linalg.norm(self.world_from_index[:3, :3], axis=0)
        return size

    @property
    def origin(self) -> NDArray[np.float64]:
        """Where values[0, 0, 0] lies (3,) [m]."""
        return self.world_from_index[:3, 3]


def read_vdb(file: str | os.PathLike[str], grid: str = "") -> Grid:
    """The values of a grid of a .vdb or .nvdb file as they are stored. `grid` may be left out if
    there is only one. Its world is a scene's, y up, as for a volume without transform, and so
    scene.volumes.add(grid.values, world_from_index=grid.world_from_index, ...) is the same volume
    as the file. For a grid that is no field of numbers (level sets, vectors) InputError, and
    for a file that cannot be read IoError."""
    return Grid(*_uwvdb.read_vdb(os.fspath(file), grid))


def _grid_values(what: str, array: ArrayLike) -> NDArray[np.float32]:
    values = np.ascontiguousarray(_arrays.numbers(what, array, np.float32), dtype=np.float32)
    if values.ndim != 3 or 0 in values.shape or max(values.shape) > _MOST_VALUES:
        raise UsageError(f"{what}: expected an array of three axes, with values, "
                         f"found {_arrays.shape_text(values.shape)}")
    wrong = np.argwhere(~np.isfinite(values))
    if len(wrong):
        place = ", ".join(map(str, wrong[0]))
        raise UsageError(f"{what}: not a finite number at [{place}]; replace it, such as by "
                         "np.nan_to_num(array)")
    return values


def write_vdb(file: str | os.PathLike[str], array: ArrayLike | Mapping[str, ArrayLike],
              voxel_size: float, origin: ArrayLike = (0, 0, 0), name: str = "density") -> None:
    """Writes an array, or several by the names of their grids, as a .vdb file of fog volumes, of
    32-bit floats. `array[i, j, k]` lies at `origin + voxel_size * (i, j, k)` [m]. Values of 0 are
    inactive: they take no room. A scene takes the file as it is (y up, values at nodes), and
    read_vdb gives back the box of the values that are not 0. Raises UsageError for an array that
    has not three axes or is not finite and for a name without .vdb, and IoError."""
    if not os.fsdecode(file).endswith(".vdb"):
        raise UsageError(f"write_vdb: {os.fspath(file)!r}: expected a name that ends in .vdb")
    arrays = dict(array) if isinstance(array, Mapping) else {name: array}
    if not arrays:
        raise UsageError("write_vdb: there is no array; give one")
    size = np.asarray(_arrays.numbers("write_vdb: voxel_size", voxel_size, np.float64))
    if size.shape != () or not 0 < float(size) < np.inf:
        raise UsageError(f"write_vdb: voxel_size: expected a number above 0, found {voxel_size!r}")
    first = _arrays.vector("write_vdb: origin", origin)
    grids = [(grid, _grid_values(f"write_vdb: {grid}", values)) for grid, values in arrays.items()]
    _uwvdb.write_vdb(os.fspath(file), grids, float(size), first.tolist())


def inspect(file: str | os.PathLike[str]) -> _uwvdb.Inspection:
    """What is in a .vdb or .nvdb file: a dict with "creator", "centering" and "up" as scenes would
    take them, and "grids", a list of dicts with name, type, class, transform, voxel_size [m],
    bounds ((x, y, z), (x, y, z)) [m] or None, active_voxels, min, mean and max, and why a grid is
    "unusable" or "unread", if it is. Raises InputError and IoError."""
    return _uwvdb.inspect(os.fspath(file))
