"""Rendering."""

from __future__ import annotations

import operator
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any, NamedTuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arrays, _uwvdb
from .errors import SceneWarning, UsageError
from .image import Image
from .scene import Scene

__all__ = ["LightMatrix", "Renderer"]

Progress = Callable[[str, float], Any]
Layers = Union[str, Sequence[str]]


class LightMatrix(NamedTuple):
    """The light of a scene's image by the lamp that it comes from. An image is linear in the
    brightness of its lamps: what they are mixed to here is what rendering would give."""

    lamps: list[str]
    images: NDArray[np.float32]  # (lamps, height, width, bands): of the lamps as they are
    rest: NDArray[np.float32]  # (height, width, bands): of what glows by itself

    def mix(self, factors: ArrayLike) -> NDArray[np.float64]:
        """The image (height, width, bands) with each lamp's brightness times its factor: (lamps,),
        or (lamps, bands) for its colours."""
        given = _arrays.numbers("mix", factors, np.float64)
        bands = self.images.shape[-1]
        if given.shape not in ((len(self.lamps),), (len(self.lamps), bands)):
            raise UsageError(f"mix: expected factors of shape ({len(self.lamps)},) or "
                             f"({len(self.lamps)}, {bands}), found {given.shape}")
        by_band = np.broadcast_to(given.reshape(len(self.lamps), -1), (len(self.lamps), bands))
        mixed: NDArray[np.float64] = np.einsum("lb,lyxb->yxb", by_band, self.images) + self.rest
        return mixed


class Renderer:
    """Renders images of scenes, and keeps light, water, volumes and surfaces from one image to the
    next as far as they are the same. Every image is the same to the bit as from a new Renderer,
    from `uwvdb render`, and by any number of threads.

    Other Python threads run while it works. It renders one image at a time: for several at once
    make several. It can be interrupted by Ctrl-C, and used again after that.
    """

    def __init__(self, threads: int = 0) -> None:
        """`threads`: how many it uses at most; 0: as many as there are processors."""
        threads = operator.index(threads)
        if threads < 0:
            raise UsageError(f"Renderer: threads: expected 0 or more, found {threads}")
        self._renderer = _uwvdb.Renderer(threads)

    def render(self, scene: Scene, layers: Layers | None = None, quality: str | None = None,
               progress: Progress | None = None, *, size: tuple[int, int] | None = None,
               crop: tuple[int, int, int, int] | None = None, samples: int | None = None,
               integrator: str | None = None, error: float | None = None, orders: int = 0,
               frame: int | None = None, camera: str | int | None = None,
               derivatives: str | Sequence[str] = ()) -> Image:
        """The image of a scene. What is not given is as the scene says.

        layers      names of layers (docs/command-line.md), or one text with commas: "total",
                    "depth", "direct", "backscatter", "clean", "lamps", "all" ...; left out: total
                    and depth
        quality     "draft", "final" or "exact"
        progress    called as progress(stage, fraction), in this thread, at most every 20 ms; if it
                    returns False, Interrupted is raised, and what it raises ends the work
        size        (width, height) [pixels]: the same view at another resolution
        crop        (x0, y0, x1, y1): only these pixels
        samples     per pixel
        integrator  "volume", "planes", "reference" or "path"
        error       of integrator path, instead of samples: the standard error to reach
        orders      of integrator path: layers of light by how often it was scattered, up to this
        frame       of what moves, and of files with a number; needed by the layers "flow"
        camera      of a rig: name or index; left out: its only one
        derivatives  of the image, for Image.derivative(): "water.absorption", "water.scattering",
                    "water.particles.small", "water.particles.large" or "concentration.NAME"; each
                    takes one or two times as long as the image

        Raises InputError, IoError, UsageError, Interrupted and KeyboardInterrupt; the Renderer
        stays usable. Warns with SceneWarning.
        """
        if not isinstance(scene, Scene):
            raise UsageError(f"render: expected a Scene, found {type(scene).__name__}; "
                             "Scene.load(file) reads one")
        if camera is None and len(scene.cameras) > 1:
            raise UsageError(f"camera: the scene has several; choose one of "
                             f"{', '.join(scene.cameras)}")
        settings: dict[str, Any] = {
            "layers": layers or "", "quality": quality, "size": size, "crop": crop,
            "samples": samples, "integrator": integrator, "error": error, "orders": orders,
            "frame": frame, "camera": scene._camera_index(camera),
            "derivatives": [derivatives] if isinstance(derivatives, str) else list(derivatives)}
        if layers is not None and not isinstance(layers, str):
            settings["layers"] = ",".join(layers)
        settings = {key: value for key, value in settings.items() if value is not None}
        image = Image(self._renderer.render(scene._native, settings, progress))
        for line in image.warnings:
            warnings.warn(line, SceneWarning, stacklevel=2)
        return image

    def sequence(self, scene: Scene, frames: Iterable[int] | None = None,
                 layers: Layers | None = None, quality: str | None = None,
                 progress: Progress | None = None, **settings: Any) -> Iterator[Image]:
        """The images of `frames`, one after the other; None: all that the scene has. The rest is
        as for render(). An image is rendered when it is asked for."""
        if frames is None:
            frames = scene.frames
            if frames is None:
                raise UsageError("sequence: nothing in the scene has a trajectory or is animated; "
                                 "list the frames, such as range(48)")
        for frame in frames:
            yield self.render(scene, layers, quality, progress, frame=frame, **settings)

    def light_matrix(self, scene: Scene, **settings: Any) -> LightMatrix:
        """The light of each lamp by itself, from one rendering. `settings`: as for render()."""
        image = self.render(scene, ["total", "lamps"], **settings)
        names = [layer for layer in image if layer.startswith("lamp.")]
        images = np.stack([image[name] for name in names]) if names else np.zeros(
            (0, *image["total"].shape), np.float32)
        return LightMatrix([name.removeprefix("lamp.") for name in names], images,
                           image["total"] - images.sum(axis=0, dtype=np.float32))

    def clear(self) -> None:
        """Frees what is kept for the next image, and reads files anew."""
        self._renderer.clear()
