"""Blender's images as PNG or JPEG files in memory."""

import os
import struct
import zlib

import bpy
import numpy

SIGNATURES = {b"\x89PNG\r\n\x1a\n": "image/png", b"\xff\xd8\xff": "image/jpeg"}


def pixels(image):
    """Values as Blender stores them, 0 to 1, as rows from the top: (height, width, 4)."""
    width, height = image.size
    values = numpy.empty(width * height * 4, numpy.float32)
    image.pixels.foreach_get(values)
    return values.reshape(height, width, 4)[::-1]


def is_srgb(image):
    """Whether the values that pixels() returns are encoded as sRGB."""
    return not image.is_float and image.colorspace_settings.name == "sRGB"


def srgb_from_linear(values):
    values = numpy.clip(values, 0, 1)
    return numpy.where(values <= 0.0031308, 12.92 * values, 1.055 * values ** (1 / 2.4) - 0.055)


def linear_from_srgb(values):
    return numpy.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)


def colour_file(image):
    """(data, MIME type) of an image of colours, encoded as sRGB."""
    own = _own_file(image) if image.colorspace_settings.name == "sRGB" else None
    if own is not None:
        return own
    values = pixels(image).copy()
    if not is_srgb(image):
        values[..., :3] = srgb_from_linear(values[..., :3])
    return png(values), "image/png"


def data_file(image):
    """(data, MIME type) of an image of numbers that are no colours."""
    own = _own_file(image) if image.colorspace_settings.name in ("Non-Color", "Raw") else None
    return own if own is not None else (png(data_pixels(image)), "image/png")


def data_pixels(image):
    """The numbers that Blender's nodes see."""
    values = pixels(image)
    if is_srgb(image):
        values = values.copy()
        values[..., :3] = linear_from_srgb(values[..., :3])
    return values


def _own_file(image):
    """The image's own file if nothing was painted on it since and glTF may hold such files."""
    if image.is_dirty or image.source != "FILE":
        return None
    if image.packed_file:
        data = image.packed_file.data
    else:
        path = bpy.path.abspath(image.filepath, library=image.library)
        if not os.path.isfile(path):
            return None
        with open(path, "rb") as file:
            data = file.read()
    kind = next((kind for start, kind in SIGNATURES.items() if data.startswith(start)), None)
    return (data, kind) if kind else None


def png(values, bits=8):
    """A PNG of 8 or 16 bits of values 0 to 1, (height, width, 3 or 4)."""
    height, width, channels = values.shape
    levels = numpy.rint(numpy.clip(values, 0, 1) * (2**bits - 1)).astype(">u2" if bits == 16 else numpy.uint8)
    levels = levels.reshape(height, -1).view(numpy.uint8)
    rows = numpy.zeros((height, 1 + levels.shape[1]), numpy.uint8)  # begin with 0: no filter
    rows[:, 1:] = levels

    def chunk(kind, data):
        check = zlib.crc32(kind + data)
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", check)

    header = struct.pack(">2I5B", width, height, bits, 2 if channels == 3 else 6, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header)
            + chunk(b"IDAT", zlib.compress(rows.tobytes(), 1)) + chunk(b"IEND", b""))
