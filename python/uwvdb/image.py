"""Images as arrays."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _uwvdb
from ._sensor import Sensor
from .errors import UsageError

__all__ = ["Image"]

# The endings of layers of one number; a band's are others.
_LETTERS = {"V", "Z"}


class Image(Mapping[str, "NDArray[np.float32]"]):
    """A rendered image: a mapping from the names of its layers to arrays.

    `image["depth"]` is float32 of shape (height, width), and so is every layer of one number;
    `image["total"]`, and every layer of light, is (height, width, bands); `normal` and `position`
    are (height, width, 3), `flow` is (height, width, 2). Beside what was requested there are "rgb"
    and "alpha". Radiance is in W m^-2 sr^-1 per band, lengths are metres, positions and normals are
    in the world (docs/command-line.md).

    The arrays are views of the image's memory: nothing is copied, and they stay valid when the
    image is gone. What is written to them is in the image.
    """

    def __init__(self, image: _uwvdb.Image, origin: Any = None) -> None:
        self._image = image
        self._origin = origin  # its renderer, scene and settings; None: it was unpickled
        self._layers = _layers_of(image.channels, len(image.bands))

    def __getitem__(self, layer: str) -> NDArray[np.float32]:
        try:
            channels, is_single = self._layers[layer]
        except KeyError:
            raise KeyError(f"{layer}: the image has {', '.join(self._layers)}; request others by "
                           "layers=[...]") from None
        pixels = self._image.pixels
        return pixels[..., channels.start] if is_single else pixels[..., channels]

    def __iter__(self) -> Iterator[str]:
        return iter(self._layers)

    def __len__(self) -> int:
        return len(self._layers)

    @property
    def layers(self) -> list[str]:
        """The names of its layers."""
        return list(self._layers)

    @property
    def pixels(self) -> NDArray[np.float32]:
        """All channels (height, width, channels), a view."""
        return self._image.pixels

    @property
    def channels(self) -> list[str]:
        """Their names, as an EXR has them."""
        return self._image.channels

    @property
    def bands(self) -> list[float]:
        """The wavelengths of layers of light [nm]."""
        return self._image.bands

    @property
    def window(self) -> tuple[int, int, int, int]:
        """The pixels that it has of the whole image: x0, y0, x1, y1."""
        return self._image.window

    @property
    def metadata(self) -> dict[str, str | float]:
        """The header of its EXR."""
        return self._image.metadata

    @property
    def report(self) -> dict[str, Any]:
        """What it was made of: pixels, rays, voxels, triangles; of light paths the samples and the
        stated error."""
        return self._image.report

    @property
    def warnings(self) -> list[str]:
        """What was warned of, one line each."""
        return self._image.warnings

    @property
    def objects(self) -> dict[int, str]:
        """Names by the numbers of the layer "id", if it was requested."""
        return self._image.objects

    @property
    def materials(self) -> dict[int, str]:
        """Names by the numbers of the layer "material", if it was requested."""
        return self._image.materials

    def derivative(self, name: str) -> NDArray[np.float32]:
        """The derivative of "total" (height, width, bands) that was requested by
        render(derivatives=[name]), a view:

        "water.absorption", "water.scattering"  by the uniform water's coefficient in the same
                              band [radiance per 1/m]; the phase function stays as it is
        "water.particles.small", "water.particles.large"  by the concentration of the water's own
                              particles [radiance per ppm]
        "concentration.NAME"  by a factor on the concentrations of a constituent of the volumes
                              (scene.water.constituents), at 1 [radiance]

        Light scattered once; exact: the same sums as the image's, differentiated term by term.
        """
        return self._image.derivative(name)

    def mean_numbers(self) -> NDArray[np.float64]:
        """The sensor's numbers in the mean, (height, width), or (height, width, 3) with mosaic
        "three": what noise scatters the layer "sensor" about. They are limited by full wells, but
        neither rounded nor limited to what the converter holds. From "total", which the image must
        have."""
        _, scene, settings = self._rendered_by("mean_numbers")
        return Sensor(scene._native, self._origin.settings, self["total"]).numbers

    def jvp(self, directions: Mapping[str, ArrayLike], **settings: Any) -> NDArray[np.float32]:
        """The derivative of "total" as numbers of its scene move: Renderer.jvp() of the scene as it
        was rendered. `settings` that differ, such as samples=64."""
        renderer, scene, given = self._rendered_by("jvp")
        derivative: NDArray[np.float32] = renderer.jvp(scene, directions, **{**given, **settings})
        return derivative

    def backward(self, gradient: ArrayLike, of: str | Sequence[str],
                 **settings: Any) -> dict[str, NDArray[np.float64]]:
        """The derivatives of a number by those at paths of its scene, from that by its "total":
        Renderer.backward() of the scene as it was rendered."""
        renderer, scene, given = self._rendered_by("backward")
        found: dict[str, NDArray[np.float64]] = renderer.backward(scene, gradient, of,
                                                                  **{**given, **settings})
        return found

    def _rendered_by(self, what: str) -> tuple[Any, Any, dict[str, Any]]:
        if self._origin is None:
            raise UsageError(f"{what}: an image that was pickled has lost its scene; use "
                             f"Renderer.{what}")
        renderer, scene, settings = self._origin
        return renderer, scene, {key: value for key, value in settings.items()
                                 if key not in ("layers", "derivatives", "orders")}

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_origin": None}

    @property
    def automatic_exposure(self) -> float | None:
        """The factor by which srgb() multiplies on its own; None for a black image."""
        return self._image.automatic_exposure()

    def srgb(self, exposure: float | None = None) -> NDArray[np.uint8]:
        """The picture (height, width, 3), uint8: "rgb" times `exposure` (None: the automatic one)
        as sRGB. Black where no ray enters the water."""
        return self._image.srgb(exposure)

    def save(self, file: str | os.PathLike[str], *, exposure: float | None = None,
             precision: str = "auto") -> None:
        """Writes the OpenEXR that `uwvdb render` writes, or, to a name that ends in .png, .jpg,
        .tif, .dpx, .tga, .bmp or .webp, the picture; .hdr, and .tif with precision="float", hold
        the light's R, G and B. `precision` of an EXR's light: auto, half or float. Raises IoError
        and UsageError; the file is whole or not there, also after Ctrl-C, which ends it at
        once."""
        self._image.save(os.fspath(file), exposure, precision)

    def __repr__(self) -> str:
        height, width, _ = self.pixels.shape
        return f"<uwvdb.Image {width} x {height}: {', '.join(self._layers)}>"


def _layers_of(channels: list[str], bands: int) -> dict[str, tuple[slice, bool]]:
    """Each layer's channels, and whether it is one number."""
    layers = {"rgb": (slice(0, 3), False), "alpha": (slice(3, 4), True)}
    if bands == 3:  # which are R, G and B
        layers["total"] = layers["rgb"]
    for index, channel in enumerate(channels[4:], 4):
        layer, _, suffix = channel.rpartition(".")
        first = layers[layer][0].start if layer in layers else index
        layers[layer] = (slice(first, index + 1), first == index and suffix in _LETTERS)
    return layers
