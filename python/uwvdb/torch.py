"""Images as functions that PyTorch differentiates. Needs PyTorch, which uwvdb itself does not."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import torch

from . import _changes
from .errors import UsageError
from .render import Renderer
from .scene import Scene

__all__ = ["render"]


class _Render(torch.autograd.Function):
    @staticmethod
    def forward(ctx: Any, *given: Any, **_: Any) -> torch.Tensor:
        renderer, scene, paths, settings, *values = given
        changed = with_values(scene, dict(zip(paths, values)))
        ctx.rendered = renderer, changed, paths, dict(settings)
        layer = settings.get("layer", "total")
        settings = {key: value for key, value in settings.items() if key not in ("seed", "layer")}
        ctx.kinds = [(value.dtype, value.device) for value in values]
        image = renderer.render(changed, ["total"], **settings)
        found = image.mean_numbers() if layer == "sensor" else image["total"]
        return torch.as_tensor(np.array(found), dtype=values[0].dtype, device=values[0].device)

    @staticmethod
    def backward(ctx: Any, *gradients: torch.Tensor) -> tuple[torch.Tensor | None, ...]:
        renderer, scene, paths, settings = ctx.rendered
        wanted = [path for path, needs in zip(paths, ctx.needs_input_grad[4:]) if needs]
        found = renderer.backward(scene, gradients[0].detach().cpu().numpy(), wanted, **settings)
        return (None, None, None, None, *(
            torch.as_tensor(found[path], dtype=dtype, device=device) if path in found else None
            for path, (dtype, device) in zip(paths, ctx.kinds)))


def with_values(scene: Scene, values: Mapping[str, torch.Tensor]) -> Scene:
    """The scene with these values, by their paths; "volumes[0].array" stands for an array that was
    added to the volumes, "geometry[0].texture" for the texture of a mesh."""
    changed = scene.copy()
    written: dict[str, Any] = {}
    for path, value in values.items():
        numbers = value.detach().cpu().numpy()
        array = _changes.array_of(path)
        if array is None:
            written[path] = numbers.tolist()
        elif array[0] == "volumes":
            changed.volumes.set_values(changed[path], numbers)
        else:
            changed.geometry.set_texture(changed[f"geometry[{array[1]}].mesh"], numbers)
    if written:
        changed.update(written)
    return changed


def render(renderer: Renderer, scene: Scene, values: Mapping[str, torch.Tensor],
           **settings: Any) -> torch.Tensor:
    """"total" (height, width, bands) of the scene with these values, by their paths: a tensor that
    can be differentiated by them, by Renderer.backward().

        b = torch.tensor([0.2, 0.2, 0.2], requires_grad=True)
        image = uwvdb.torch.render(renderer, scene, {"water.scattering.b": b})
        ((image - seen) ** 2).mean().backward()

    `settings`: as for Renderer.render(), and the `seed` of its gradient; layer="sensor" for
    Image.mean_numbers() in place of "total". By light paths, both share
    their random numbers with seed 0: take others for an unbiased gradient of a square. Raises
    UsageError, and as Renderer.render().
    """
    if not values:
        raise UsageError("torch.render: expected values by the paths of the scene, found none")
    image: torch.Tensor = _Render.apply(renderer, scene, list(values), settings, *values.values())
    return image
