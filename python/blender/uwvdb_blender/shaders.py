"""What shaders reflect, let through and give off, as inputs of one Principled shader, and what of mixtures of them."""

import math

# A dielectric of the index of water does not shine in it: what has no gloss gets this one.
WATER_INDEX = 1.334
# What has no gloss has no part in a mixture's roughness, unless nothing else has.
FAINT_GLOSS = 1e-3
LEAST_GLOSS = 0.04  # a dielectric's in air
LUMINANCE = (0.2126, 0.7152, 0.0722)  # linear Rec. 709


class Shader:
    """Names of inputs, the first of which a node has, or numbers. `metallic` is the part of the colour that is a
    mirror's; `opacity` the factors of what is not let through, `clear` those of what is, of a dielectric."""

    def __init__(self, colour=None, roughness=1.0, metallic=0.0, emission=None, strength=1.0, opacity=1.0, clear=0.0):
        self.colour, self.roughness, self.metallic = colour, roughness, metallic
        self.emission, self.strength, self.opacity, self.clear = emission, strength, opacity, clear

    @property
    def has_gloss(self):
        return self.roughness != 1.0


_MATT = Shader(("Color", "Base Color"))
_MIRROR = Shader(("Color", "Base Color"), ("Roughness",), 1.0)
_CLEAR = Shader(opacity=0.0)
SHADERS = {
    "BSDF_PRINCIPLED": Shader(("Base Color",), ("Roughness",), ("Metallic",), ("Emission Color", "Emission"),
                              ("Emission Strength",), ("Alpha",), ("Transmission", "Transmission Weight")),
    "EEVEE_SPECULAR": Shader(("Base Color",), ("Roughness",), 0.0, ("Emissive Color",)),
    "BSDF_DIFFUSE": _MATT, "BSDF_VELVET": _MATT, "BSDF_SHEEN": _MATT, "BSDF_TOON": _MATT, "BSDF_TRANSLUCENT": _MATT,
    "SUBSURFACE_SCATTERING": _MATT, "BSDF_HAIR": _MATT, "BSDF_HAIR_PRINCIPLED": _MATT,
    "BSDF_GLOSSY": _MIRROR, "BSDF_ANISOTROPIC": _MIRROR, "BSDF_METALLIC": _MIRROR,
    "EMISSION": Shader(emission=("Color",), strength=("Strength",)),
    "BACKGROUND": Shader(emission=("Color",), strength=("Strength",)),
    "BSDF_TRANSPARENT": _CLEAR, "BSDF_GLASS": _CLEAR, "BSDF_REFRACTION": _CLEAR, "HOLDOUT": Shader(),
}
MIXTURES = ("MIX_SHADER", "ADD_SHADER")


def parts_of(node):
    """[(weight, nodes.Node)] of the shaders whose sum one is; None if the weights are not the same everywhere."""
    if node.type not in MIXTURES:
        return [(1.0, node)]
    sockets = [socket for socket in node.inputs if socket.type == "SHADER"]
    weights = (1.0, 1.0)
    if node.type == "MIX_SHADER":
        if node.inputs[0].source is not None:
            return None
        factor = min(max(node.inputs[0].default_value, 0.0), 1.0)
        weights = (1.0 - factor, factor)
    result = []
    for weight, socket in zip(weights, sockets):
        if weight == 0 or socket.source is None:
            continue
        inner = parts_of(socket.source[0])
        if inner is None:
            return None
        result += [(weight * part, found) for part, found in inner]
    return result


class Surface:
    """Inputs of a Principled shader, linear."""

    def __init__(self, colour, roughness, metallic, emission, alpha):
        self.colour, self.roughness, self.metallic = colour, roughness, metallic
        self.emission, self.alpha = emission, alpha


def merged(parts):
    """The Surface of shaders all of whose inputs are constant; None if one is not, or is none of these."""
    colour, emission, clear = [0.0] * 3, [0.0] * 3, 0.0
    roughness = gloss = metal = 0.0
    for weight, node in parts:
        shader = SHADERS.get(node.type)
        if shader is None:
            return None
        normal = node.inputs.get("Normal")
        values = [_value(node, names) for names in (shader.colour, shader.roughness, shader.metallic, shader.emission,
                                                    shader.strength, shader.opacity, shader.clear)]
        if any(value is None for value in values) or normal is not None and normal.source is not None:
            return None
        own, rough, metallic, light, strength, opacity, through = values
        clear += weight * (1 - opacity * (1 - through * (1 - metallic)))
        opaque = weight * opacity * (1 - through * (1 - metallic))
        for at in range(3):
            colour[at] += opaque * own[at]
            emission[at] += weight * opacity * strength * light[at]
        metal += opaque * metallic * _luminance(own)
        shine = opaque * _gloss(shader, metallic) if shader.colour is not None else 0.0
        gloss += shine
        roughness += shine * rough
    alpha = min(max(1 - clear, 0.0), 1.0)
    bright = _luminance(colour)
    return Surface([part / alpha if alpha > 0 else 0.0 for part in colour], roughness / gloss if gloss > 0 else 1.0,
                   metal / bright if bright > 0 else 0.0, emission, alpha)


def _gloss(shader, metallic):
    return LEAST_GLOSS + (1 - LEAST_GLOSS) * metallic if shader.has_gloss else FAINT_GLOSS


def _luminance(colour):
    return sum(part * weight for part, weight in zip(colour, LUMINANCE))


def _value(node, names):
    """A number or colour; None if it is not constant. No name is no colour."""
    if isinstance(names, float):
        return names
    if names is None:
        return (0.0, 0.0, 0.0)
    socket = next((node.inputs[name] for name in names if name in node.inputs), None)
    if socket is None:
        return 0.0
    if socket.source is not None:
        return None
    value = socket.default_value
    return float(value) if isinstance(value, (int, float)) else tuple(float(part) for part in value[:3])


def index_of(nodes):
    """The refractive index of shaders: that of the first with gloss, or water's."""
    for node in nodes:
        if node.type == "BSDF_PRINCIPLED":
            return _principled_index(node.inputs)
        if node.type in SHADERS and SHADERS[node.type].has_gloss:
            return 1.5
    return WATER_INDEX


def _principled_index(inputs):
    """Specular 0.5 means 4 % in air, Fresnel's for the index 1.5; Blender 4 scales that of IOR."""
    specular = inputs.get("Specular IOR Level") or inputs["Specular"]
    f0 = 0.08 * float(specular.default_value)
    if "Specular IOR Level" in inputs:
        ior = float(inputs["IOR"].default_value)
        f0 = ((ior - 1) / (ior + 1)) ** 2 * 2 * float(specular.default_value)
    root = math.sqrt(min(max(f0, 0), 0.9))
    return max((1 + root) / (1 - root), 1) if f0 > 0 else WATER_INDEX
