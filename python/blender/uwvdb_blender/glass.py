"""Materials that light goes through: glass, and what is left out because nothing happens to light there."""

import numpy

from .nodes import output_of, source_of
from .shaders import WATER_INDEX

SMOOTH = 0.1  # what is less rough is hardly seen to be


def is_clear(material):
    """Whether light goes through most of a surface; opaque, it would be black."""
    if material is None or not material.use_nodes or material.node_tree is None:
        return False
    output = output_of(material)
    found = source_of(output.inputs["Surface"]) if output is not None else None
    return found is not None and _is_clear(found[0])


def _is_clear(node):
    if node.type in ("BSDF_TRANSPARENT", "BSDF_GLASS", "BSDF_REFRACTION"):
        return True
    if node.type == "BSDF_PRINCIPLED":
        return _is_clear_principled(node.inputs)
    if node.type not in ("MIX_SHADER", "ADD_SHADER"):
        return False
    sources = [source_of(socket) for socket in node.inputs if socket.type == "SHADER"]
    clear = [source is not None and _is_clear(source[0]) for source in sources]
    if node.type == "ADD_SHADER" or all(clear):
        return all(clear)
    factor = source_of(node.inputs[0])
    if factor is not None:  # a coat, which reflects little but at grazing angles
        return any(clear) and factor[0].type in ("FRESNEL", "LAYER_WEIGHT")
    second = node.inputs[0].default_value
    return clear[0] and second < 0.5 or clear[1] and second > 0.5


def _is_clear_principled(inputs):
    def value(*names):
        socket = next((inputs[name] for name in names if name in inputs), None)
        return None if socket is None or socket.is_linked else socket.default_value

    emission = value("Emission Color", "Emission")
    if value("Emission Strength") != 0 and (emission is None or max(emission[:3]) > 0):
        return False
    transmission, metallic = value("Transmission", "Transmission Weight"), value("Metallic")
    return value("Alpha") == 0 or (transmission is not None and transmission > 0.5
                                   and metallic is not None and metallic < 0.5)


def is_exactly_clear(material):
    """Whether nothing happens to light at a surface that is clear."""
    node = source_of(output_of(material).inputs["Surface"])[0]
    if node.type == "BSDF_PRINCIPLED":
        return not node.inputs["Alpha"].is_linked and node.inputs["Alpha"].default_value == 0
    colour = node.inputs["Color"] if node.type == "BSDF_TRANSPARENT" else None
    return colour is not None and not colour.is_linked and min(colour.default_value[:3]) == 1


class Glass:
    """What refracts in a clear material. `is_pane` is that of what has no inside, whatever its shape; `faults` what is
    left out."""

    def __init__(self, ior, colour, roughness=0.0, is_pane=False, faults=()):
        self.ior, self.colour, self.is_pane, self.faults = ior, colour, is_pane, list(faults)
        if roughness > SMOOTH:
            self.faults.append("rough glass is shown as smooth")

    def content(self, name, is_closed, chord):
        """glTF's material. `chord` is how far light goes through the shape, in the mean [m]: Blender's colour is that of
        each surface, of which light crosses two."""
        is_solid = is_closed and not self.is_pane
        colour = [min(max(part, 0.0), 1.0) for part in self.colour]
        extensions = {"KHR_materials_transmission": {"transmissionFactor": 1.0},
                      "KHR_materials_ior": {"ior": self.ior}}
        if is_solid:
            volume = extensions["KHR_materials_volume"] = {"thicknessFactor": 1.0}
            if min(colour) < 1 and chord > 0:
                volume.update(attenuationColor=[part ** 2 for part in colour], attenuationDistance=chord)
        return {"name": name, "extensions": extensions, "pbrMetallicRoughness": {
            "baseColorFactor": [1.0, 1.0, 1.0, 1.0] if is_solid else colour + [1.0],
            "metallicFactor": 0.0, "roughnessFactor": 0.0}}


def glass_of(material):
    """The Glass of a material that is clear; None if it has none."""
    return _glass_of(source_of(output_of(material).inputs["Surface"])[0])


def _glass_of(node):
    if node.type in ("BSDF_GLASS", "BSDF_REFRACTION"):
        return Glass(*_values(node, "IOR", "Color", "Roughness"), faults=_linked(node, "IOR", "Color", "Roughness"))
    if node.type == "BSDF_PRINCIPLED":
        if _number(node.inputs["Alpha"]) == 0:
            return None
        return Glass(*_values(node, "IOR", "Base Color", "Roughness"),
                     faults=_linked(node, "IOR", "Base Color", "Roughness"))
    if node.type == "BSDF_TRANSPARENT":
        (colour,) = _values(node, "Color")
        if min(colour) == 1 and not _linked(node, "Color"):
            return None
        return Glass(WATER_INDEX, colour, is_pane=True, faults=_linked(node, "Color"))
    sources = [source_of(socket) for socket in node.inputs if socket.type == "SHADER"]
    nodes = [source[0] for source in sources if source is not None and _is_clear(source[0])]
    found = [glass for glass in map(_glass_of, nodes) if glass is not None]
    if found:
        return found[0]
    factor = source_of(node.inputs[0]) if node.type == "MIX_SHADER" else None
    if factor is not None and factor[0].type == "FRESNEL":  # a reflecting coat on nothing
        return Glass(_number(factor[0].inputs["IOR"]) or 1.45, [1.0, 1.0, 1.0], is_pane=True)
    return None


def _number(socket):
    return None if socket.is_linked else socket.default_value


def _values(node, *names):
    """The inputs' own values, colours without alpha."""
    result = []
    for name in names:
        value = node.inputs[name].default_value
        result.append(float(value) if isinstance(value, (int, float)) else [float(part) for part in value[:3]])
    return result


def _linked(node, *names):
    return [f"the nodes behind '{name}' of glass are left out; its own value is taken" for name in names
            if source_of(node.inputs[name]) is not None]


def mean_chord(positions, corners, starts, scale):
    """How far straight lines go through a closed shape, in the mean: 4 V/S of a convex one. Faces are fans."""
    ends = numpy.append(starts[1:], len(corners))
    volume = area = 0.0
    for k in range(1, int((ends - starts).max()) - 1):
        faces = numpy.flatnonzero(ends - starts > k + 1)
        a, b, c = (positions[corners[starts[faces] + i]].astype(float) for i in (0, k, k + 1))
        across = numpy.cross(b - a, c - a)
        volume += float((a * across).sum()) / 6
        area += float(numpy.linalg.norm(across, axis=1).sum()) / 2
    return 4 * abs(volume) / area * scale if area > 0 else 0.0


def is_closed(corners, starts):
    """Whether each edge belongs to two faces."""
    following = numpy.arange(1, len(corners) + 1)
    following[numpy.append(starts[1:], len(corners)) - 1] = starts
    edges = numpy.sort(numpy.stack((corners, corners[following]), 1), axis=1)
    _, counts = numpy.unique(edges, axis=0, return_counts=True)
    return bool((counts == 2).all())
