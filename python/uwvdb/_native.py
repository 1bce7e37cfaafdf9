"""What users' classes have in common that stand for an object of the compiled module."""

from __future__ import annotations

from typing import Generic, Self, TypeVar

T = TypeVar("T")


class Native(Generic[T]):
    """Has an object of the compiled module, and can be made of one."""

    _native: T

    @classmethod
    def _of(cls, native: T) -> Self:
        made = cls.__new__(cls)
        made._native = native
        return made
