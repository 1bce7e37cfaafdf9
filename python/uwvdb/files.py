"""Volumes in files."""

from __future__ import annotations

import os
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import _uwvdb

__all__ = ["Grid", "read_vdb", "inspect"]


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


def inspect(file: str | os.PathLike[str]) -> _uwvdb.Inspection:
    """What is in a .vdb or .nvdb file: a dict with "creator", "centering" and "up" as scenes would
    take them, and "grids", a list of dicts with name, type, class, transform, voxel_size [m],
    bounds ((x, y, z), (x, y, z)) [m] or None, active_voxels, min, mean and max, and why a grid is
    "unusable" or "unread", if it is. Raises InputError and IoError."""
    return _uwvdb.inspect(os.fspath(file))
