"""A sensor's mean numbers, and their derivatives."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _uwvdb


class Sensor:
    """The sensor of a scene's camera, in an image of this light."""

    def __init__(self, scene: _uwvdb.Scene, settings: dict[str, Any],
                 total: NDArray[np.float32]) -> None:
        self._scene = scene
        self._settings = settings
        self._total = total
        self._slopes: NDArray[np.float64] | None = None

    def _means(self, scene: _uwvdb.Scene) -> NDArray[np.float64]:
        found = _uwvdb.mean_numbers(scene, self._settings, self._total)
        return found[..., 0] if found.shape[2] == 1 else found

    @property
    def numbers(self) -> NDArray[np.float64]:
        """What they are, (height, width) or (height, width, 3)."""
        return self._means(self._scene)

    @property
    def shape(self) -> tuple[int, ...]:
        return self.numbers.shape

    def _by_light(self) -> NDArray[np.float64]:
        if self._slopes is None:
            self._slopes = _uwvdb.number_slopes(self._scene, self._settings, self._total)
        return self._slopes

    def of_light(self, light: NDArray[np.float32]) -> NDArray[np.float64]:
        """What their derivative is where that of the light (height, width, bands) is this."""
        moved: NDArray[np.float64] = np.einsum("yxkb,yxb->yxk", self._by_light(), light)
        return moved[..., 0] if moved.shape[2] == 1 else moved

    def to_light(self, weights: NDArray[np.float64]) -> NDArray[np.float64]:
        """The derivatives of a number by the light, from those by them."""
        slopes = self._by_light()
        by_light: NDArray[np.float64] = np.einsum(
            "yxkb,yxk->yxb", slopes, weights.reshape(slopes.shape[:3]))
        return np.ascontiguousarray(by_light)

    def by_number(self, change: tuple[str, _uwvdb.Scene, _uwvdb.Scene, float]
                  ) -> NDArray[np.float64]:
        """Their derivative by a number of the sensor: the light stays as it is."""
        _, less, more, step = change
        derivative: NDArray[np.float64] = (self._means(more) - self._means(less)) / step
        return derivative
