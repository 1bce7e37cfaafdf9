"""The geometry of cameras: pixels, rays and points, through lens and port."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arrays, _uwvdb
from ._native import Native

__all__ = ["Camera", "Rays"]


class Rays(NamedTuple):
    """Rays in the water, in the world. NaN where a pixel has none."""

    origin: NDArray[np.float64]  # (..., 3) [m]: where they enter the water, on the outer glass
    direction: NDArray[np.float64]  # (..., 3), of length 1, away from the camera


class Camera(Native[_uwvdb.Camera]):
    """A camera as its scene or calibration describes it, at one moment. It never changes.

    Positions in the image are pixels: the image's corner is (0, 0), x to the right and y down, the
    first pixel's centre (0.5, 0.5), so that OpenCV's positions are these less 0.5.
    """

    def rays(self, pixels: ArrayLike) -> Rays:
        """The rays in the water that `pixels` (..., 2) see: origins and directions (..., 3). NaN
        outside the image and where no ray enters the water. Uses all processors."""
        flat = _arrays.rows("rays", pixels, 2, made=24)  # six numbers for two
        shape = (*np.shape(pixels)[:-1], 3)
        origin, direction = self._native.rays(flat)
        return Rays(origin.reshape(shape), direction.reshape(shape))

    def project(self, points: ArrayLike, *, beyond: bool = False) -> NDArray[np.float64]:
        """Where the camera sees `points` (..., 3) [m, world]: pixels (..., 2), to 1e-6. NaN where
        no ray leads to a point and outside the image; with `beyond`, positions outside it as well.
        Surfaces in between are ignored. Uses all processors."""
        flat = _arrays.rows("project", points, 3, made=6)  # two numbers for three
        return self._native.project(flat, beyond).reshape((*np.shape(points)[:-1], 2))

    def pixel_centres(self) -> NDArray[np.float64]:
        """The centre of every pixel: (height, width, 2)."""
        x, y = np.meshgrid(np.arange(self.width) + 0.5, np.arange(self.height) + 0.5)
        return np.stack([x, y], axis=-1)

    @property
    def width(self) -> int:
        """[pixels]"""
        return self._native.width

    @property
    def height(self) -> int:
        """[pixels]"""
        return self._native.height

    @property
    def wavelength(self) -> float:
        """The light [nm] whose rays these are. All light has the same where the indices of the port
        are numbers, and without a port."""
        return self._native.wavelength

    @property
    def matrix(self) -> NDArray[np.float64]:
        """The camera matrix (3, 3) [pixels]: fx, fy, cx, cy from the image's corner."""
        return self._native.matrix

    @property
    def distortion(self) -> tuple[str, NDArray[np.float64]]:
        """The lens's model and its coefficients in OpenCV's order: "brown-conrady" with k1, k2, p1,
        p2, k3 to k6, or "fisheye" with k1 to k4."""
        model, coefficients = self._native.distortion
        return model, np.array(coefficients)

    @property
    def world_from_camera(self) -> NDArray[np.float64]:
        """Its pose (4, 4): camera axes are x right, y down, z forward."""
        return self._native.world_from_camera

    def __repr__(self) -> str:
        return f"<uwvdb.Camera {self.width} x {self.height}>"
