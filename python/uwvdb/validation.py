"""Every way of computing an image of a scene, compared with the others."""

from __future__ import annotations

from dataclasses import dataclass

from . import _uwvdb
from .scene import Scene

__all__ = ["Check", "Validation", "validate"]


@dataclass(frozen=True)
class Check:
    """How two methods differ in one component of the light and one band."""

    left: str
    right: str
    component: str
    band: float  # [nm]
    largest: float  # difference, relative
    rms: float  # of all pixels, relative to the image's mean
    tolerance: float  # of `largest`
    passed: bool


@dataclass(frozen=True)
class Validation:
    """The result of validate(): true if all checks passed."""

    checks: list[Check]

    @property
    def passed(self) -> bool:
        return all(check.passed for check in self.checks)

    def __bool__(self) -> bool:
        return self.passed


def validate(scene: Scene, *, tolerance: float = 1e-3, camera: str | int | None = None,
             frame: int | None = None) -> Validation:
    """Compares the ways of computing single scattering of `scene`, as `uwvdb validate` does: sums
    over planes, quadrature, the reference integrator and a grid of constant value against what
    renders. Takes seconds to minutes. `tolerance`: of relative differences. Raises InputError."""
    checks = _uwvdb.validate(scene._native, tolerance, scene._camera_index(camera), frame)
    return Validation([Check(**check) for check in checks])
