"""Arrays as they come, made into what the renderer takes."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _uwvdb
from .errors import UsageError

# Smaller copies are made without asking whether there is memory for them.
_SMALL_BYTES = 1 << 24


def shape_text(shape: tuple[int, ...]) -> str:
    return "(" + ", ".join(map(str, shape)) + ("," if len(shape) == 1 else "") + ")"


def unmasked(what: str, array: ArrayLike) -> NDArray[Any]:
    """`array` as an array. UsageError, which begins with `what`, if some of its values are masked:
    what they stand for is for the caller to say."""
    if isinstance(array, np.ma.MaskedArray) and np.any(array.mask):
        raise UsageError(f"{what}: some values of the array are masked; say what they are, such as "
                         "array.filled(0)")
    return np.asarray(array)


def _repeats(array: NDArray[Any]) -> bool:
    """Whether it has more values than there are in memory, as those of np.broadcast_to have."""
    steps = zip(array.shape, array.strides)
    extent = array.itemsize + sum((size - 1) * abs(stride) for size, stride in steps)
    return array.nbytes > extent


def numbers(what: str, array: ArrayLike, dtype: type, made: float = 0) -> NDArray[np.generic]:
    """`array` as an array of real numbers. UsageError, which begins with `what`, for others and for
    masked ones; InputError for what does not fit into memory: a copy, where one is needed, and
    `made` bytes per value, of what is made of it."""
    return _converted(what, unmasked(what, array), dtype, made, "biuf", "real numbers")


def whole_numbers(what: str, array: ArrayLike, made: float = 0) -> NDArray[np.int64]:
    """The same of whole numbers."""
    found = _converted(what, unmasked(what, array), np.int64, made, "iu", "whole numbers")
    return np.asarray(found, dtype=np.int64)


def _converted(what: str, found: NDArray[Any], dtype: type, made: float, kinds: str,
               expected: str) -> NDArray[np.generic]:
    if found.dtype.kind not in kinds:
        raise UsageError(f"{what}: expected {expected}, found {found.dtype}; convert the array")
    is_copied = found.dtype != dtype or _repeats(found) or (
        made > 0 and not found.flags.c_contiguous)
    needed = found.size * (made + (np.dtype(dtype).itemsize if is_copied else 0))
    if needed > _SMALL_BYTES:
        _uwvdb.require_memory(needed, f"{what}: an array of shape {shape_text(found.shape)} takes",
                              "give fewer values")
    with np.errstate(over="ignore"):  # what is infinite then is warned of as such
        return found.astype(dtype, copy=False)


def rows(what: str, array: ArrayLike, width: int, made: float) -> NDArray[np.float64]:
    """`array` of shape (..., width) as (N, width); `made` as of numbers()."""
    found = numbers(what, array, np.float64, made)
    if found.ndim == 0 or found.shape[-1] != width:
        raise UsageError(f"{what}: expected an array of shape (..., {width}), "
                         f"found {shape_text(found.shape)}")
    return np.ascontiguousarray(found.reshape(-1, width), dtype=np.float64)


def vector(what: str, value: ArrayLike) -> NDArray[np.float64]:
    """One finite number for all of three, or three."""
    found = numbers(what, value, np.float64)
    if found.shape not in ((), (3,)):
        raise UsageError(f"{what}: expected a number or three, found {shape_text(found.shape)}")
    if not np.isfinite(found).all():
        raise UsageError(f"{what}: expected finite numbers, found {value!r}")
    return np.array(np.broadcast_to(found, 3), dtype=np.float64)


def matrix(what: str, value: ArrayLike) -> NDArray[np.float64]:
    """An affine map that can be inverted, as a matrix of 4 x 4 numbers."""
    found = np.asarray(numbers(what, value, np.float64), dtype=np.float64)
    if found.shape != (4, 4) or not np.array_equal(found[3], [0, 0, 0, 1]):
        raise UsageError(f"{what}: expected a (4, 4) matrix whose last row is 0, 0, 0, 1, "
                         f"found {shape_text(found.shape)}")
    if not np.isfinite(found).all() or np.linalg.matrix_rank(found[:3, :3]) < 3:
        raise UsageError(f"{what}: expected finite numbers, and axes that span a volume")
    return found.copy()
