"""The values of nodes all of whose inputs are constant, as Cycles computes them."""

import colorsys
import math

LUMINANCE = (0.2126, 0.7152, 0.0722)  # linear Rec. 709


def constant(node, output):
    """The value of a nodes.Node's output, a float or a tuple; None if it is not constant, or its node is none of
    these."""
    function = NODES.get(node.type)
    if function is None:
        return None
    values = []
    for socket in node.values:
        if socket.source is not None or not hasattr(socket.socket, "default_value"):
            return None
        values.append(plain(socket.default_value))
    try:
        return function(node.bpy_node, output, values)
    except (ValueError, OverflowError, ZeroDivisionError):
        return None


def plain(value):
    """A socket's value as a float or a tuple of floats; None for what is neither."""
    if isinstance(value, (bool, int, float)):
        return float(value)
    try:
        return tuple(float(part) for part in value)
    except (TypeError, ValueError):
        return None


def converted(value, kind, wanted):
    """A value of one kind of socket as another takes it; None if it cannot."""
    if wanted in ("VALUE", "INT", "BOOLEAN"):
        if isinstance(value, float):
            return value
        return _luminance(value) if kind == "RGBA" else sum(value[:3]) / 3
    if wanted not in ("RGBA", "VECTOR"):
        return None
    value = (value,) * 3 if isinstance(value, float) else value[:3]
    return (*value, 1.0) if wanted == "RGBA" else value


def _luminance(colour):
    return sum(part * weight for part, weight in zip(colour, LUMINANCE))


def _clamped(value, low=0.0, high=1.0):
    if isinstance(value, tuple):
        return tuple(_clamped(part, low, high) for part in value)
    return min(max(value, low), high)


def _lerp(first, second, factor):
    return tuple(a + (b - a) * factor for a, b in zip(first, second))


def _divided(a, b):
    return a / b if b != 0 else 0.0


def _power(a, b):
    if b == 0:
        return 1.0
    if a == 0 or a < 0 and b != int(b):
        return 0.0
    return float(a ** b)


def _wrapped(value, top, bottom):
    width = top - bottom
    return value - width * math.floor((value - bottom) / width) if width != 0 else bottom


def _smooth_least(a, b, c):
    if c == 0:
        return min(a, b)
    h = max(c - abs(a - b), 0) / c
    return min(a, b) - h**3 * c / 6


def _logarithm(a, b):
    return math.log(a) / math.log(b) if a > 0 and b > 0 and b != 1 else 0.0


def _rounded(value):
    return math.floor(value + 0.5)


MATH = {
    "ADD": lambda a, b, c: a + b, "SUBTRACT": lambda a, b, c: a - b, "MULTIPLY": lambda a, b, c: a * b,
    "DIVIDE": lambda a, b, c: _divided(a, b), "MULTIPLY_ADD": lambda a, b, c: a * b + c,
    "POWER": lambda a, b, c: _power(a, b), "LOGARITHM": lambda a, b, c: _logarithm(a, b),
    "SQRT": lambda a, b, c: math.sqrt(max(a, 0)), "INVERSE_SQRT": lambda a, b, c: 1 / math.sqrt(a) if a > 0 else 0.0,
    "ABSOLUTE": lambda a, b, c: abs(a), "EXPONENT": lambda a, b, c: math.exp(a),
    "MINIMUM": lambda a, b, c: min(a, b), "MAXIMUM": lambda a, b, c: max(a, b),
    "LESS_THAN": lambda a, b, c: float(a < b), "GREATER_THAN": lambda a, b, c: float(a > b),
    "SIGN": lambda a, b, c: float((a > 0) - (a < 0)),
    "COMPARE": lambda a, b, c: float(a == b or abs(a - b) <= max(c, 1e-5)),
    "SMOOTH_MIN": _smooth_least, "SMOOTH_MAX": lambda a, b, c: -_smooth_least(-a, -b, c),
    "ROUND": lambda a, b, c: _rounded(a), "FLOOR": lambda a, b, c: math.floor(a),
    "CEIL": lambda a, b, c: math.ceil(a), "TRUNC": lambda a, b, c: math.trunc(a),
    "FRACT": lambda a, b, c: a - math.floor(a), "MODULO": lambda a, b, c: math.fmod(a, b) if b != 0 else 0.0,
    "WRAP": _wrapped, "SNAP": lambda a, b, c: math.floor(_divided(a, b)) * b,
    "PINGPONG": lambda a, b, c: abs(math.fmod(a - b - 2 * b * math.floor((a - b) / (2 * b)), 2 * b) - b) if b else 0.0,
    "SINE": lambda a, b, c: math.sin(a), "COSINE": lambda a, b, c: math.cos(a), "TANGENT": lambda a, b, c: math.tan(a),
    "ARCSINE": lambda a, b, c: math.asin(_clamped(a, -1, 1)),
    "ARCCOSINE": lambda a, b, c: math.acos(_clamped(a, -1, 1)),
    "ARCTANGENT": lambda a, b, c: math.atan(a), "ARCTAN2": lambda a, b, c: math.atan2(a, b),
    "SINH": lambda a, b, c: math.sinh(a), "COSH": lambda a, b, c: math.cosh(a), "TANH": lambda a, b, c: math.tanh(a),
    "RADIANS": lambda a, b, c: math.radians(a), "DEGREES": lambda a, b, c: math.degrees(a),
}


def _math(node, output, values):
    function = MATH.get(node.operation)
    if function is None:
        return None
    value = float(function(*(values + [0.0] * 3)[:3]))
    return _clamped(value) if node.use_clamp else value


def _dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def _length(a):
    return math.sqrt(_dot(a, a))


def _cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


BY_PARTS = ("ADD", "SUBTRACT", "MULTIPLY", "DIVIDE", "MULTIPLY_ADD", "ABSOLUTE", "MINIMUM", "MAXIMUM", "FLOOR",
            "CEIL", "SNAP", "MODULO", "WRAP", "SINE", "COSINE", "TANGENT")


def _vector_math(node, output, values):
    operation = node.operation
    vectors = [value for value in values if isinstance(value, tuple)]
    if operation in BY_PARTS:
        parts = (vectors + [(0.0,) * 3] * 3)[:3]
        return tuple(float(MATH[operation](*part)) for part in zip(*parts))
    first, second = (vectors + [(0.0,) * 3])[:2]
    if operation == "FRACTION":
        return tuple(part - math.floor(part) for part in first)
    if operation == "SCALE":
        number = next(value for value in values if isinstance(value, float))
        return tuple(part * number for part in first)
    if operation == "CROSS_PRODUCT":
        return _cross(first, second)
    if operation == "NORMALIZE":
        length = _length(first)
        return tuple(part / length for part in first) if length > 0 else first
    if operation == "DOT_PRODUCT":
        return float(_dot(first, second))
    if operation == "LENGTH":
        return _length(first)
    if operation == "DISTANCE":
        return _length([a - b for a, b in zip(first, second)])
    return None


def _overlaid(a, b, t):
    return a * (1 - t + 2 * t * b) if a < 0.5 else 1 - (1 - t + 2 * t * (1 - b)) * (1 - a)


def _dodged(a, b, t):
    if a == 0:
        return a
    rest = 1 - t * b
    return 1.0 if rest <= 0 or a / rest > 1 else a / rest


def _burnt(a, b, t):
    under = 1 - t + t * b
    return 0.0 if under <= 0 else _clamped(1 - (1 - a) / under)


def _softened(a, b, t):
    screen = 1 - (1 - b) * (1 - a)
    return (1 - t) * a + t * ((1 - a) * b * a + a * screen)


BLENDS = {
    "MIX": lambda a, b, t: a + (b - a) * t, "ADD": lambda a, b, t: a + t * b,
    "MULTIPLY": lambda a, b, t: a * (1 - t + t * b), "SUBTRACT": lambda a, b, t: a - t * b,
    "SCREEN": lambda a, b, t: 1 - (1 - t + t * (1 - b)) * (1 - a), "OVERLAY": _overlaid,
    "DIVIDE": lambda a, b, t: (1 - t) * a + t * a / b if b != 0 else 0.0,
    "DIFFERENCE": lambda a, b, t: a + (abs(a - b) - a) * t,
    "EXCLUSION": lambda a, b, t: max(a + (a + b - 2 * a * b - a) * t, 0),
    "DARKEN": lambda a, b, t: a + (min(a, b) - a) * t, "LIGHTEN": lambda a, b, t: a + (max(a, b) - a) * t,
    "DODGE": _dodged, "BURN": _burnt, "SOFT_LIGHT": _softened,
    "LINEAR_LIGHT": lambda a, b, t: a + t * (2 * b - 1),
}


def _hsv(colour):
    high, low = max(colour), min(colour)
    if high <= 0 or low < 0 or high > 1:  # colorsys takes 0 to 1; scaling changes the value alone
        if low < 0 or high <= 0:
            raise ValueError
        hue, saturation, _ = colorsys.rgb_to_hsv(*(part / high for part in colour))
        return hue, saturation, high
    return colorsys.rgb_to_hsv(*colour)


def _blended_hue(kind, first, second, factor):
    if max(first) <= 0 or max(second) <= 0:
        raise ValueError
    one, two = _hsv(first), _hsv(second)
    if kind == "SATURATION":
        return colorsys.hsv_to_rgb(one[0], one[1] + (two[1] - one[1]) * factor, one[2]) if one[1] != 0 else first
    if kind == "VALUE":
        return colorsys.hsv_to_rgb(one[0], one[1], one[2] + (two[2] - one[2]) * factor)
    if two[1] == 0:
        return first
    saturation = one[1] if kind == "HUE" else two[1]
    return _lerp(first, colorsys.hsv_to_rgb(two[0], saturation, one[2]), factor)


def mixed(kind, first, second, factor):
    first, second = first[:3], second[:3]
    if kind in BLENDS:
        return tuple(BLENDS[kind](a, b, factor) for a, b in zip(first, second))
    return _blended_hue(kind, first, second, factor)


def _mix_rgb(node, output, values):
    result = mixed(node.blend_type, values[1], values[2], _clamped(values[0]))
    return (*(_clamped(result) if node.use_clamp else result), 1.0)


def _mix(node, output, values):
    factor, first, second = values
    if node.clamp_factor:
        factor = _clamped(factor)
    if node.data_type == "RGBA":
        result = mixed(node.blend_type, first, second, factor)
        return (*(_clamped(result) if node.clamp_result else result), 1.0)
    if node.data_type == "FLOAT":
        return first + (second - first) * factor
    if node.data_type != "VECTOR":
        return None
    factors = factor if isinstance(factor, tuple) else (factor,) * 3
    return tuple(a + (b - a) * t for a, b, t in zip(first, second, factors))


def _ramp(node, output, values):
    colour = tuple(node.color_ramp.evaluate(values[0]))
    return float(colour[3]) if output.name == "Alpha" else colour


def _hue_saturation(node, output, values):
    named = dict(zip((s.name for s in node.inputs), values))
    colour = named["Color"][:3]
    if max(colour) <= 0:
        return (*colour, 1.0)
    hue, saturation, value = _hsv(colour)
    turned = colorsys.hsv_to_rgb((hue + named["Hue"] + 0.5) % 1, _clamped(saturation * named["Saturation"]),
                                 value * named["Value"])
    factor = named.get("Fac", named.get("Factor"))
    return (*(max(part, 0) for part in _lerp(colour, turned, factor)), 1.0)


def _bright_contrast(node, output, values):
    colour, bright, contrast = values
    offset = bright - contrast * 0.5
    return (*(max((1 + contrast) * part + offset, 0) for part in colour[:3]), 1.0)


def _gamma(node, output, values):
    colour, gamma = values
    return (*(part ** gamma if part > 0 else part for part in colour[:3]), 1.0)


def _invert(node, output, values):
    factor, colour = values
    return (*_lerp(colour[:3], [1 - part for part in colour[:3]], factor), 1.0)


def _rgb_curves(node, output, values):
    factor, colour = values
    mapping = node.mapping
    mapping.initialize()
    whole, curves = mapping.curves[3], mapping.curves
    bent = [mapping.evaluate(curves[at], mapping.evaluate(whole, part)) for at, part in enumerate(colour[:3])]
    return (*_lerp(colour[:3], bent, factor), 1.0)


def _float_curve(node, output, values):
    factor, value = values
    mapping = node.mapping
    mapping.initialize()
    return value + (mapping.evaluate(mapping.curves[0], value) - value) * factor


def _map_range(node, output, values):
    if node.data_type != "FLOAT" or node.interpolation_type not in ("LINEAR", "SMOOTHSTEP", "SMOOTHERSTEP"):
        return None
    value, low, high, to_low, to_high = values[:5]
    if high == low:
        return 0.0
    part = (value - low) / (high - low)
    if node.interpolation_type == "LINEAR":
        result = to_low + part * (to_high - to_low)
        return _clamped(result, min(to_low, to_high), max(to_low, to_high)) if node.clamp else result
    part = _clamped(part)
    smooth = part**2 * (3 - 2 * part) if node.interpolation_type == "SMOOTHSTEP" \
        else part**3 * (part * (6 * part - 15) + 10)
    return to_low + smooth * (to_high - to_low)


def _clamp(node, output, values):
    value, low, high = values
    if node.clamp_type == "RANGE" and low > high:
        low, high = high, low
    return min(max(value, low), high)


def _mode_of(node):
    """RGB, HSV, HSL or XYZ, of the nodes that take colours apart and put them together."""
    return {"RGB": "RGB", "HSV": "HSV", "XYZ": "XYZ"}.get(node.type[-3:]) or node.mode


def _separated(node, output, values):
    mode, parts = _mode_of(node), values[0][:3]
    if mode == "HSV":
        parts = _hsv(parts)
    elif mode == "HSL":
        hue, lightness, saturation = colorsys.rgb_to_hls(*parts)
        parts = hue, saturation, lightness
    return float(parts[list(node.outputs).index(output)])


def _combined(node, output, values):
    mode, parts = _mode_of(node), tuple(values[:3])
    if mode == "HSV":
        parts = colorsys.hsv_to_rgb(*parts)
    elif mode == "HSL":
        parts = colorsys.hls_to_rgb(parts[0], parts[2], parts[1])
    return parts if mode == "XYZ" else (*parts, 1.0)


def _blackbody(node, output, values):
    from .emission import blackbody_colour  # which reads nodes, too
    return (*map(float, blackbody_colour([values[0]])[0]), 1.0)


def _own(node, output, values):
    return plain(output.default_value)


def _for_camera(node, output, values):
    """Light paths as the rays of a camera have them."""
    return float(output.name == "Is Camera Ray")


NODES = {
    "VALUE": _own, "RGB": _own, "MATH": _math, "VECT_MATH": _vector_math, "MIX_RGB": _mix_rgb, "MIX": _mix,
    "VALTORGB": _ramp, "HUE_SAT": _hue_saturation, "BRIGHTCONTRAST": _bright_contrast, "GAMMA": _gamma,
    "INVERT": _invert, "CURVE_RGB": _rgb_curves, "CURVE_FLOAT": _float_curve, "MAP_RANGE": _map_range,
    "CLAMP": _clamp, "RGBTOBW": lambda node, output, values: _luminance(values[0]), "SEPRGB": _separated,
    "SEPHSV": _separated, "SEPXYZ": _separated, "SEPARATE_COLOR": _separated, "COMBRGB": _combined,
    "COMBHSV": _combined, "COMBXYZ": _combined, "COMBINE_COLOR": _combined, "BLACKBODY": _blackbody,
    "LIGHT_PATH": _for_camera,
}
