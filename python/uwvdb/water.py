"""The optical properties of water."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arrays, _uwvdb
from ._native import Native
from .errors import UsageError

__all__ = ["Water"]


class Water(Native[_uwvdb.Water]):
    """Homogeneous water: absorption, scattering and phase function by wavelength."""

    def __init__(self, preset: str | None = None, *,
                 bands: Iterable[float] | None = None, **keys: Any) -> None:
        """Water of a Jerlov type ("jerlov-IB" to "jerlov-5C"), or pure, with any key of a scene's
        `water`: salinity, temperature, particles={"small": 0.03}, absorption, scattering and so on.

        bands  wavelengths [nm]; left out: 620, 540, 450

        Raises InputError.
        """
        section = dict(keys)
        if preset is not None:
            section["preset"] = preset
        if bands is not None:
            section["bands"] = list(bands)
        self._native = _uwvdb.Water.of_section(section)

    @property
    def bands(self) -> NDArray[np.float64]:
        """Its wavelengths (bands,) [nm]."""
        return np.array(self._native.bands)

    @property
    def absorption(self) -> NDArray[np.float64]:
        """a (bands,) [1/m]."""
        return self._native.absorption

    @property
    def scattering(self) -> NDArray[np.float64]:
        """b (bands,) [1/m]."""
        return self._native.scattering

    @property
    def attenuation(self) -> NDArray[np.float64]:
        """c = a + b (bands,) [1/m]."""
        return self.absorption + self.scattering

    def scattering_function(self, angles: ArrayLike) -> NDArray[np.float64]:
        """The volume scattering function (bands, *angles.shape) [1/(m sr)] at angles of scattering
        [degrees, 0 forward to 180]. Raises UsageError for others."""
        flat = _arrays.numbers("scattering_function", angles, np.float64,
                               made=8 * (4 + len(self.bands)))
        if not ((flat >= 0) & (flat <= 180)).all():
            raise UsageError("scattering_function: expected angles from 0 to 180 degrees, found "
                             f"{flat[~((flat >= 0) & (flat <= 180))].flat[0]}")
        values = self._native.scattering_function(np.ascontiguousarray(flat.ravel()))
        return values.reshape((len(values), *flat.shape))

    def phase(self, angles: ArrayLike) -> NDArray[np.float64]:
        """The phase function (bands, *angles.shape) [1/sr], whose integral over the sphere is 1, at
        angles of scattering [degrees, 0 forward to 180]. NaN in water that does not scatter."""
        values = self.scattering_function(angles)
        b = self.scattering.reshape((-1,) + (1,) * (values.ndim - 1))
        with np.errstate(invalid="ignore", divide="ignore"):
            phase: NDArray[np.float64] = values / b
        return phase

    @property
    def phase_functions(self) -> list[str]:
        """What it scatters by, in words."""
        return self._native.phase_functions

    @property
    def constituents(self) -> list[_uwvdb.Constituent]:
        """What volumes add to a scene's water: name, unit, and absorption and scattering (bands,)
        [1/m] per unit."""
        return self._native.constituents

    @property
    def warnings(self) -> list[str]:
        """One line each."""
        return self._native.warnings
