"""Rendering."""

from __future__ import annotations

import operator
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arrays, _changes, _uwvdb
from ._sensor import Sensor
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
    rest: NDArray[np.float32]  # (height, width, bands): of what emits light itself

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


def _settings(what: str, scene: Scene, given: Mapping[str, Any]) -> dict[str, Any]:
    """Keyword arguments as the renderer takes them."""
    if not isinstance(scene, Scene):
        raise UsageError(f"{what}: expected a Scene, found {type(scene).__name__}; "
                         "Scene.load(file) reads one")
    camera = given.get("camera")
    if camera is None and len(scene.cameras) > 1:
        raise UsageError(f"camera: the scene has several; choose one of "
                         f"{', '.join(scene.cameras)}")
    settings = {key: value for key, value in given.items() if value is not None}
    settings["camera"] = scene._camera_index(camera)
    layers = settings.get("layers", "")
    settings["layers"] = layers if isinstance(layers, str) else ",".join(layers)
    return settings


class _Origin(NamedTuple):
    """What an image was rendered by, from and with."""

    renderer: Renderer
    scene: Scene
    settings: dict[str, Any]


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
        options = _settings("render", scene, {
            "layers": layers or "", "quality": quality, "size": size, "crop": crop,
            "samples": samples, "integrator": integrator, "error": error, "orders": orders,
            "frame": frame, "camera": camera,
            "derivatives": [derivatives] if isinstance(derivatives, str) else list(derivatives)})
        native = self._renderer.render(scene._native, options, progress)
        image = Image(native, _Origin(self, scene.copy(), options))
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

    def jvp(self, scene: Scene, directions: Mapping[str, ArrayLike], *, layer: str = "total",
            seed: int = 0, progress: Progress | None = None,
            **settings: Any) -> NDArray[np.float32]:
        """The derivative of "total" (height, width, bands) as the numbers at some paths of the
        scene move along `directions` (a Jacobian times a vector): {"lamps[0].position": [1, 0, 0]}
        for a lamp that moves along x [radiance per m]. One number stands for all of a list.

        The numbers are those of the water and its species, of the volumes, of the lamps, and of
        what surfaces reflect. `settings`: as for render(). Where the image is of light scattered
        once, it is exact: the image's own sums, differentiated term by term. With
        render.scattering multiple, and by integrator "path", it is the mean over `samples` random
        paths per pixel, without bias and with noise: other ones for another `seed`. Not in it is
        what a number moves in the image: the edges of shadows, and of beams that end at once.

        layer "sensor": of Image.mean_numbers() in place of "total", by the sensor's own numbers as
        well ("camera.sensor.gain").

        Raises UsageError for what has no such derivatives, and as render().
        """
        options = _settings("jvp", scene, {**settings, "seed": seed})
        of_light = {path: along for path, along in directions.items()
                    if not (layer == "sensor" and _changes.is_of_sensor(path))}
        light: NDArray[np.float32] | None = None
        if of_light or layer != "sensor":
            light = self._renderer.derivatives(
                scene._native, [_changes.change(scene, of_light)], options, progress)[0]
        if layer == "total" and light is not None:
            return light
        sensor = self._sensor(scene, layer, settings)
        moved = np.zeros(sensor.shape)
        if light is not None:
            moved += sensor.of_light(light)
        of_sensor = {path: directions[path] for path in directions if path not in of_light}
        if of_sensor:
            moved += sensor.by_number(_changes.change(scene, of_sensor))
        return moved.astype(np.float32)

    def backward(self, scene: Scene, gradient: ArrayLike, of: str | Sequence[str], *,
                 layer: str = "total", seed: int = 0, progress: Progress | None = None,
                 **settings: Any) -> dict[str, NDArray[np.float64]]:
        """The derivatives of a number by those at the paths `of` (a vector times a Jacobian), each
        of the shape that the scene has there; `gradient` (height, width, bands) is the number's
        derivative by "total": 2 (total - seen) where it is the sum of squares of what an image is
        off. "volumes[0].array" stands for all values of an array that was added to the volumes,
        "geometry[0].texture" for all of a texture that was added with a mesh.

        Like jvp() otherwise, and so is `layer`. All take one pass over the image together. Unless
        the quality is "exact", a few places on each ray stand for all, without bias: descend with
        another `seed` in each step."""
        options = _settings("backward", scene, {**settings, "seed": seed})
        paths = [of] if isinstance(of, str) else list(of)
        sensor = self._sensor(scene, layer, settings) if layer != "total" else None
        weights = _changes.checked_gradient(
            gradient, sensor.shape if sensor else _changes.light_shape(scene, settings), layer)
        changes: list[_changes.Change] = []
        shapes: dict[str, tuple[int, ...]] = {}
        arrays: dict[str, dict[str, int]] = {"volumes": {}, "geometry": {}}
        result: dict[str, NDArray[np.float64]] = {}
        for path in dict.fromkeys(paths):
            array = _changes.array_of(path)
            if array is not None:
                arrays[array[0]][path] = array[1]
            elif sensor is not None and _changes.is_of_sensor(path):
                shape, of_sensor = _changes.changes_of(scene, path)
                result[path] = np.array([(weights * sensor.by_number(change)).sum()
                                         for change in of_sensor]).reshape(shape)
            else:
                shapes[path], more = _changes.changes_of(scene, path)
                changes += more
        if len(result) == len(set(paths)):
            return result
        volumes, textures = arrays["volumes"], arrays["geometry"]
        numbers, by_voxel, by_texel = self._renderer.gradient(
            scene._native, changes, list(volumes.values()), list(textures.values()),
            weights if sensor is None else sensor.to_light(weights), options, progress)
        for path, values in zip([*volumes, *textures], by_voxel + by_texel):
            result[path] = values.astype(np.float64)
        ends = np.cumsum([np.prod(shape, dtype=int) for shape in shapes.values()])
        for (path, shape), of_path in zip(shapes.items(), np.split(np.array(numbers), ends[:-1])):
            result[path] = of_path.reshape(shape)
        return {path: result[path] for path in paths}

    def _sensor(self, scene: Scene, layer: str, settings: Mapping[str, Any]) -> Sensor:
        if layer != "sensor":
            raise UsageError(f"layer: expected \"total\" or \"sensor\", found {layer!r}")
        options = _settings("sensor", scene, settings)
        total = self.render(scene, ["total"], **settings)["total"]
        return Sensor(scene._native, options, total)

    def clear(self) -> None:
        """Frees what is kept for the next image, and reads files anew."""
        self._renderer.clear()
