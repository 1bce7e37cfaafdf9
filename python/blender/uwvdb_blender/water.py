"""The section `water` of a scene, from World > Water and Render > Forward Scatter; and World > Water from the volume
shader of a world."""

import math

from . import bands as colours
from .nodes import output_of, source_of
from .notes import Refusal

DEFAULT_PRESET = "jerlov-II"


def describe(scene, bands, to_metres):
    world = scene.world
    water = {"bands": bands}
    if world is None:
        water["preset"] = DEFAULT_PRESET
        return water
    settings = world.uwvdb
    if settings.kind == "NONE":
        water.update(_explicit([0.0] * 3, [0.0] * 3, 0.0, bands))
    elif settings.kind == "COEFFICIENTS":
        water.update(_explicit(settings.absorption, settings.scattering, settings.hg_g, bands))
        water.update(salinity=settings.salinity, temperature=settings.temperature)
    else:
        if settings.kind == "CONSTITUENTS":
            water.update(cdom=settings.cdom, chlorophyll=settings.chlorophyll)
        else:
            water["preset"] = settings.preset
        water.update(salinity=settings.salinity, temperature=settings.temperature)
        if settings.kind == "CONSTITUENTS" or settings.use_particles:
            water["particles"] = {"small": settings.small, "large": settings.large}
    if settings.use_surface:
        water["surface"] = {"point": [0, 0, settings.surface_height * to_metres.median_scale],
                            "normal": [0, 0, 1]}
    if settings.use_snow:
        water["snow"] = {"number": settings.snow_number,
                         "diameter": [f"{settings.snow_least} mm", f"{settings.snow_greatest} mm"],
                         "exponent": settings.snow_exponent, "reflectance": settings.snow_reflectance,
                         "drift": [speed * to_metres.median_scale for speed in settings.snow_drift],
                         "seed": settings.snow_seed,
                         "mean": settings.snow_mean.lower()}
    render = scene.uwvdb
    if render.use_forward_scatter:
        water["forward_scatter"] = {"K": render.forward_strength, "G": render.forward_g,
                                    "B": render.forward_b, "shape": render.forward_shape.lower()}
    return water


def _explicit(absorption, scattering, g, bands):
    return {"absorption": colours.from_rgb(absorption, bands),
            "scattering": {"b": colours.from_rgb(scattering, bands), "phase": {"type": "hg", "g": g}}}


class Coefficients:
    """Of a world's volume shader, 1/m at red, green and blue, and the mean of its scattering's cosines."""

    def __init__(self, absorption, scattering, g):
        self.absorption, self.scattering, self.g = absorption, scattering, g

    def are_of(self, settings):
        """Whether World > Water has them."""
        return settings.kind == "COEFFICIENTS" and math.isclose(self.g, settings.hg_g, abs_tol=1e-3) and all(
            math.isclose(mine, its, rel_tol=1e-3, abs_tol=1e-6)
            for mine, its in zip((*self.absorption, *self.scattering), (*settings.absorption, *settings.scattering)))


def has_volume(world):
    if world is None or not world.use_nodes or world.node_tree is None:
        return False
    output = output_of(world)
    return output is not None and source_of(output.inputs["Volume"]) is not None


def of_volume(world, metres_per_unit):
    """The Coefficients of a world's volume shader, which Cycles has per unit of length. Raises Refusal if they are not
    the same everywhere."""
    absorption, scattering, forward = [0.0] * 3, [0.0] * 3, 0.0
    for weight, node in _volumes(source_of(output_of(world).inputs["Volume"])[0], 1.0):
        density = weight * max(_value(node, "Density"), 0.0) / metres_per_unit
        colour = [max(part, 0.0) for part in _value(node, "Color")[:3]]
        for at in range(3):
            if node.type != "VOLUME_ABSORPTION":
                scattering[at] += colour[at] * density
                forward += colour[at] * density * _value(node, "Anisotropy")
            if node.type != "VOLUME_SCATTER":
                absorption[at] += max(1 - colour[at], 0.0) * density * _kept_by_tint(node, at)
    total = sum(scattering)
    return Coefficients(absorption, scattering, min(max(forward / total if total > 0 else 0.0, -0.99), 0.99))


def _kept_by_tint(node, at):
    """Principled Volume's Absorption Color reduces what is absorbed."""
    if node.type != "PRINCIPLED_VOLUME":
        return 1.0
    return max(1 - math.sqrt(max(_value(node, "Absorption Color")[at], 0.0)), 0.0)


def _volumes(node, weight):
    """(weight, Node) of all volume shaders that are added or mixed."""
    if node.type in ("ADD_SHADER", "MIX_SHADER"):
        weights = (weight, weight)
        if node.type == "MIX_SHADER":
            factor = min(max(_value(node, node.inputs[0].name), 0.0), 1.0)
            weights = ((1 - factor) * weight, factor * weight)
        for part, socket in zip(weights, [socket for socket in node.inputs if socket.type == "SHADER"]):
            if socket.source is not None:
                yield from _volumes(socket.source[0], part)
    elif node.type in ("VOLUME_SCATTER", "VOLUME_ABSORPTION", "PRINCIPLED_VOLUME"):
        yield weight, node
    else:
        raise Refusal(f"the world's volume has a {node.bl_label} node: water is read from Volume Scatter, Volume "
                      "Absorption and Principled Volume")


def _value(node, name):
    if node.inputs[name].source is not None:
        raise Refusal(f"the world's volume shader differs from place to place: {node.bl_label} > {name} has to be a "
                      "number or colour")
    return node.inputs[name].default_value
