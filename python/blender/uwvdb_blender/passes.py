"""Which layers of uwvdb a view layer asks for, and how they become passes of Blender."""

import json

import numpy

FAR = 1e10  # Cycles' depth of what is not hit

# Property of the view layer -> layer; light in bands, or one number.
LIGHT = {"use_direct": "direct", "use_backscatter": "backscatter", "use_forward": "forward",
         "use_multiple": "multiple", "use_clean": "clean", "use_transmittance": "transmittance",
         "use_irradiance": "irradiance", "use_error": "error", "use_albedo": "albedo"}
NUMBERS = {"use_range": "range", "use_path": "path", "use_lit": "lit"}
# Property of the view layer -> layer, and what its channels and Blender's passes begin with.
MATTES = {"use_pass_cryptomatte_object": ("crypto_object", "CryptoObject"),
          "use_pass_cryptomatte_material": ("crypto_material", "CryptoMaterial")}
MATTE_PASSES = 3  # of two ranks each
HOLES = ("crypto_object", "transmittance")  # of which holes' alpha is made


class Pass:
    """A pass's name in Blender, its channels, and what makes it of an image."""

    def __init__(self, name, channel_ids, kind, make):
        self.name, self.channel_ids, self.kind, self._make = name, channel_ids, kind, make

    def make(self, image):
        """Rows from the top, (height, width, channels); None if the image does not have it."""
        return self._make(image)


def layers_of(view_layer, scene, held_out=()):
    """uwvdb's layers for the passes of a view layer; `held_out` are the names of what is a hole in the picture."""
    settings = view_layer.uwvdb
    layers = ["total"] + [layer for key, layer in {**LIGHT, **NUMBERS}.items()
                          if getattr(settings, key) and _exists(layer, scene)]
    if view_layer.use_pass_z:
        layers.append("depth")
    if view_layer.use_pass_normal:
        layers.append("normal")
    if view_layer.use_pass_position:
        layers.append("position")
    if view_layer.use_pass_object_index:
        layers.append("id")
    if view_layer.use_pass_material_index:
        layers.append("material")
    layers += [layer for key, (layer, _) in MATTES.items()
               if getattr(view_layer, key) or held_out and layer == HOLES[0]]
    if held_out and HOLES[1] not in layers:
        layers.append(HOLES[1])
    if needs_flow(view_layer):
        layers += ["flow", "flow_back"]
    if settings.use_lamps:
        layers.append("lamps")
    if _sensor(scene) is not None:
        layers.append("sensor")
    return layers


def _sensor(scene):
    """Settings of the camera's sensor if it has one."""
    settings = scene.camera.data.uwvdb if scene.camera is not None else None
    return settings if settings is not None and settings.use_sensor else None


def needs_flow(view_layer):
    return view_layer.use_pass_vector


def _exists(layer, scene):
    settings = scene.uwvdb
    multiple = settings.integrator == "PATH" or (settings.integrator == "VOLUME"
                                                 and settings.scattering == "MULTIPLE")
    return {"multiple": multiple, "error": settings.integrator == "PATH"}.get(layer, True)


def passes_of(view_layer, scene, bands, lamp_names=(), written=None):
    """The passes in Blender's order. Without `written` only their names and channels are of use."""
    yield Pass("Combined", "RGBA", "COLOR", lambda image: _with_holes(image, bands, written.held_out))
    unit = written.metres_per_unit if written else 1
    if view_layer.use_pass_z:
        yield Pass("Depth", "Z", "VALUE", lambda image: _far(_scaled(image.get("depth", "Z"), unit)))
    if view_layer.use_pass_position:
        yield Pass("Position", "XYZ", "VECTOR", lambda image: _scaled(image.get("position", "XYZ"), unit))
    if view_layer.use_pass_normal:
        yield Pass("Normal", "XYZ", "VECTOR", lambda image: image.get("normal", "XYZ"))
    if needs_flow(view_layer):
        yield Pass("Vector", "XYZW", "VECTOR", _vector)
    if view_layer.use_pass_object_index:
        yield Pass("IndexOB", "X", "VALUE",
                   lambda image: _looked_up(image.get("id", "V"), written.pass_indices))
    if view_layer.use_pass_material_index:
        yield Pass("IndexMA", "X", "VALUE",
                   lambda image: _looked_up(image.get("material", "V"), written.material_indices))
    for key, (_, prefix) in MATTES.items():
        for number in range(MATTE_PASSES if getattr(view_layer, key) else 0):
            name = f"{prefix}{number:02}"
            yield Pass(name, "RGBA", "COLOR", lambda image, name=name: image.get(name, "RGBA"))
    settings = view_layer.uwvdb
    for key, layer in LIGHT.items():
        if getattr(settings, key) and _exists(layer, scene):
            yield from _in_bands(layer, bands)
    for key, layer in NUMBERS.items():
        if getattr(settings, key):
            yield Pass(layer, "X", "VALUE", lambda image, layer=layer: image.get(layer, "V"))
    if settings.use_lamps:
        for name in lamp_names:
            yield from _in_bands(f"lamp.{name}", bands)
    if len(bands) != 3:
        yield from _in_bands("total", bands)
    sensor = _sensor(scene)
    if sensor is not None and sensor.mosaic == "THREE":
        yield Pass("sensor", "RGB", "COLOR", lambda image: image.get("sensor", "RGB"))
    elif sensor is not None:
        yield Pass("sensor", "X", "VALUE", lambda image: image.get("sensor", "V"))


def _with_holes(image, bands, held_out):
    """The picture; what is held out has the alpha of the water before it, which is what Cycles has there."""
    result = image.get("", "RGBA")
    if not held_out:
        return result
    field = next(name for name, text in image.texts.items()
                 if name.startswith("cryptomatte/") and name.endswith("/name") and text == "CryptoObject")
    hashes = json.loads(image.texts[field.removesuffix("name") + "manifest"])
    ids = numpy.array([int(hashes[name], 16) for name in held_out if name in hashes], numpy.uint32)
    coverage = numpy.zeros(result.shape[:2], numpy.float32)
    for number in range(MATTE_PASSES):
        ranks = image.get(f"CryptoObject{number:02}", "RGBA")
        for at in (0, 2):
            known = numpy.ascontiguousarray(ranks[..., at]).view(numpy.uint32)
            coverage += numpy.where(numpy.isin(known, ids), ranks[..., at + 1], 0)
    names = "RGB" if len(bands) == 3 else [_band_name(band) for band in bands]
    clear = image.get("transmittance", names).mean(axis=-1)
    result = result.copy()
    result[..., 3] *= 1 - numpy.clip(coverage, 0, 1) * clear
    return result


def matte_texts(view_layer, image):
    """What Blender stores with the image, so that mattes are found by names: Cryptomatte's fields, under
    the name that a view layer's passes have in files."""
    for key, (_, prefix) in MATTES.items():
        if not getattr(view_layer, key):
            continue
        found = next(name for name, text in image.texts.items()
                     if name.startswith("cryptomatte/") and name.endswith("/name") and text == prefix)
        name = f"{view_layer.name}.{prefix}"
        target = f"cryptomatte/{_murmur_hash_3(name.encode()):08x}"[:-1]
        yield f"{target}/name", name
        for field in ("hash", "conversion", "manifest"):
            yield f"{target}/{field}", image.texts[found.removesuffix("name") + field]


def _murmur_hash_3(data):
    """MurmurHash3_x86_32 with seed 0, by which Cryptomatte names its fields."""
    def mixed(block):
        block = block * 0xcc9e2d51 & 0xffffffff
        return (block << 15 | block >> 17) * 0x1b873593 & 0xffffffff

    result, whole = 0, len(data) & ~3
    for at in range(0, whole, 4):
        result ^= mixed(int.from_bytes(data[at:at + 4], "little"))
        result = ((result << 13 | result >> 19) * 5 + 0xe6546b64) & 0xffffffff
    result ^= mixed(int.from_bytes(data[whole:], "little")) ^ len(data)
    for shift, factor in ((16, 0x85ebca6b), (13, 0xc2b2ae35), (16, 1)):
        result = (result ^ result >> shift) * factor & 0xffffffff
    return result


def _in_bands(layer, bands):
    if len(bands) == 3:
        yield Pass(layer, "RGB", "COLOR", lambda image: image.get(layer, "RGB"))
        return
    for band in bands:
        name = _band_name(band)
        yield Pass(f"{layer}.{name}", "X", "VALUE", lambda image, name=name: image.get(layer, [name]))


def _band_name(band):
    return f"{band:g}nm".replace(".", "_")


def _scaled(values, metres_per_unit):
    return None if values is None else values / numpy.float32(metres_per_unit)


def _far(depth):
    return None if depth is None else numpy.where(depth == 0, numpy.float32(FAR), depth)


def _vector(image):
    """Blender's pass has the way from here to the frame before, and that from the next to here, with y
    upwards; uwvdb's flow leads from here to both, with y downwards."""
    back, on = image.get("flow_back", "XY"), image.get("flow", "XY")
    if back is None or on is None:
        return None
    result = numpy.stack([back[..., 0], -back[..., 1], -on[..., 0], on[..., 1]], axis=-1)
    return numpy.nan_to_num(result, nan=0.0)


def _looked_up(numbers, table):
    """uwvdb counts from 1; 0 is nothing."""
    if numbers is None:
        return None
    known = numpy.array([0, *table], numpy.float32)
    return known[numbers.astype(numpy.int64)]
