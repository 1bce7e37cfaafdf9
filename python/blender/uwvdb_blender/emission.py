"""The light of Principled Volume shaders, as what grids of their object's file give off."""

import math

import numpy
from mathutils import Vector

from . import bands as colours
from .nodes import output_of, source_of

# Blender makes a domain's temperature of its flame, above this.
LEAST_FLAME, FULL_FLAME = 0.01, 2.0
# Cycles' blackbody: a millionth of the radiance by the law of Stefan and Boltzmann, per unit of length.
CYCLES_SIGMA = 5.670373e-8 * 1e-6 / math.pi
COLDEST, HOTTEST = 100, 20000  # K
ROWS = 128  # of a table of T^4, linear between them: 2e-3 off


class Reading:
    """An attribute of an object's volume: its value is scale * that of a grid + offset, where the grid's is
    `least` or more."""

    def __init__(self, grid, scale=1.0, offset=0.0, least=0.0):
        self.grid, self.scale, self.offset, self.least = grid, scale, offset, least

    def of(self, values):
        return (self.scale * values + self.offset) * (values >= self.least)


class Light:
    """What a shader gives off by the values of a grid, (n,) -> (n, 3), and the values between which that is
    linear; none if it is in proportion to them."""

    def __init__(self, grid, of, steps=None):
        self.grid, self.of, self.steps = grid, of, steps


def emits(shown):
    """Whether an object's volume may give off light, for those who then have to read its file."""
    node = _principled(shown)
    return node is not None and any(
        node.inputs[name].is_linked or node.inputs[name].default_value > 0
        for name in ("Emission Strength", "Blackbody Intensity"))


def of_object(shown, domain, grids, bands, metres_per_unit, notes):
    """{grid: its entry in `emission`} of an object whose volume's file has these grids; `domain` are the
    settings of a fluid domain, or None."""
    node = _principled(shown)
    if node is None:
        return {}
    # Cycles counts by Blender's units, and makes a Volume object brighter that is scaled down.
    factor = _object_density(shown) / metres_per_unit
    shader = _Shader(shown, domain, grids, notes)
    by_grid = {}
    for light in shader.strength(node, factor) + shader.blackbody(node, factor):
        by_grid.setdefault(light.grid, []).append(light)
    return {grid: _entry(lights, bands) for grid, lights in by_grid.items()}


def _principled(shown):
    material = next((slot.material for slot in shown.material_slots if slot.material is not None), None)
    if material is None or not material.use_nodes or material.node_tree is None:
        return None
    output = output_of(material)
    found = source_of(output.inputs["Volume"]) if output is not None else None
    return found[0] if found is not None and found[0].type == "PRINCIPLED_VOLUME" else None


def _object_density(shown):
    if shown.type != "VOLUME" or shown.data.render.space != "OBJECT":
        return 1.0
    length = (shown.matrix_world.to_3x3() @ Vector((1, 1, 1)).normalized()).length
    return 1 / length if length > 0 else 1.0


class _Shader:
    def __init__(self, shown, domain, grids, notes):
        self._shown, self._domain, self._grids, self._notes = shown, domain, grids, notes

    def _note(self, text):
        self._notes.add(f"volume '{self._shown.name}': {text}")

    def _own_value(self, socket):
        if source_of(socket) is not None:
            self._note(f"the nodes behind '{socket.name}' are left out; its own value is taken")
        return socket.default_value

    def _colour(self, socket):
        return numpy.array(self._own_value(socket)[:3], float)

    def _reading(self, attribute):
        """The Reading of an attribute, or None if the file has no such grid."""
        reading = Reading(attribute)
        if self._domain is not None and attribute == "temperature":
            low, high = self._domain.flame_ignition, self._domain.flame_max_temp
            reading = Reading("flame", high - low, low, LEAST_FLAME)
        return reading if reading.grid in self._grids else None

    def _product(self, socket):
        """(Reading or None, number) whose product a socket of a number gets, or None for anything else."""
        found = source_of(socket)
        if found is None:
            return None, float(socket.default_value)
        node, output = found
        if node.type == "VALUE":
            return None, float(output.default_value)
        if node.type in ("ATTRIBUTE", "VOLUME_INFO"):
            name = node.attribute_name if node.type == "ATTRIBUTE" else output.name.lower()
            reading = self._reading(name)
            return reading, 1.0 if reading is not None else 0.0
        if node.type == "MATH" and node.operation == "MULTIPLY" and not node.use_clamp:
            parts = [self._product(node.inputs[i]) for i in (0, 1)]
            if None not in parts and None in (parts[0][0], parts[1][0]):
                return parts[0][0] or parts[1][0], parts[0][1] * parts[1][1]
        return None

    def strength(self, node, factor):
        """What Emission Strength gives off, as a list of one Light or none."""
        found = self._product(node.inputs["Emission Strength"])
        if found is None:
            self._note("its emission strength has to be an attribute, such as flame, times numbers; this "
                       "light is left out")
            return []
        reading, number = found
        if number < 0:
            self._note("its negative emission strength is left out")
        if number <= 0:
            return []
        if reading is None:
            self._note("its emission strength is the same everywhere, so this light is left out: multiply it by "
                       "an attribute such as flame")
            return []
        colour = factor * number * self._colour(node.inputs["Emission Color"])
        steps = None
        if reading.least > 0:
            steps = numpy.array([reading.least, FULL_FLAME])
        return [Light(reading.grid, lambda values: reading.of(values)[:, None] * colour, steps)]

    def blackbody(self, node, factor):
        """What Blackbody Intensity gives off, likewise."""
        intensity = float(self._own_value(node.inputs["Blackbody Intensity"]))
        if intensity <= 0:
            return []
        attribute = node.inputs["Temperature Attribute"].default_value
        reading = self._reading(attribute)
        if reading is None:
            if self._domain is None:  # a domain without fire is cold
                self._note(f"its file has no grid '{attribute}' of temperatures; this light is left out")
            return []
        kelvin = float(self._own_value(node.inputs["Temperature"]))
        if kelvin <= 0:
            return []
        tint = factor * self._colour(node.inputs["Blackbody Tint"])

        def light(values):
            temperature = numpy.maximum(kelvin * reading.of(values), 0)
            watts = CYCLES_SIGMA * numpy.maximum(1 + intensity * (temperature**4 - 1), 0)
            return numpy.where(temperature > 0, watts, 0)[:, None] * blackbody_colour(temperature) * tint

        if reading.least > 0:
            steps = numpy.linspace(reading.least, FULL_FLAME, ROWS)
        else:
            steps = numpy.geomspace(COLDEST / kelvin, HOTTEST / kelvin, ROWS)
        return [Light(reading.grid, light, steps)]


def _entry(lights, bands):
    if all(light.steps is None for light in lights):
        unit = sum(light.of(numpy.ones(1)) for light in lights)[0]
        return {"per_unit": colours.from_rgb(unit, bands)}
    values = numpy.unique(numpy.concatenate([light.steps for light in lights if light.steps is not None]))
    rows = sum(light.of(values) for light in lights)
    return {"table": [[float(value), colours.from_rgb(row, bands)] for value, row in zip(values, rows)]}


def blackbody_colour(kelvin):
    """(n, 3) linear Rec. 709 of Planck's law, of luminance 1, without the negative parts of its reds; below 800 K
    and over 12 000 K that at these, as in Cycles."""
    nm = numpy.arange(380.0, 781.0, 5.0)
    x = numpy.clip(numpy.asarray(kelvin, float), 800, 12000)[:, None]
    # From the peak, so that nothing overflows; a common factor does not matter.
    exponent = 1.438777e7 / (nm[None, :] * x)
    log = -5 * numpy.log(nm)[None, :] - exponent - numpy.log1p(-numpy.exp(-exponent))
    radiance = numpy.exp(log - log.max(axis=1, keepdims=True))
    xyz = radiance @ _matching(nm)
    rgb = xyz @ numpy.array([[3.2404542, -0.9692660, 0.0556434], [-1.5371385, 1.8760108, -0.2040259],
                             [-0.4985314, 0.0415560, 1.0572252]])
    return numpy.maximum(rgb / xyz[:, 1:2], 0)


def _matching(nm):
    """(n, 3) CIE 1931, by the fits of Wyman, Sloan and Shirley (2013)."""
    def lobe(peak, below, above):
        return numpy.exp(-0.5 * ((nm - peak) * numpy.where(nm < peak, below, above))**2)
    x = 0.362 * lobe(442.0, 0.0624, 0.0374) + 1.056 * lobe(599.8, 0.0264, 0.0323) - \
        0.065 * lobe(501.1, 0.0490, 0.0382)
    y = 0.821 * lobe(568.8, 0.0213, 0.0247) + 0.286 * lobe(530.9, 0.0613, 0.0322)
    z = 1.217 * lobe(437.0, 0.0845, 0.0278) + 0.681 * lobe(459.0, 0.0385, 0.0725)
    return numpy.stack([x, y, z], axis=1)
