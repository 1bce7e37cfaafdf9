"""Reads the OpenEXR files that uwvdb writes with --compression none: one part of scanlines. Blender's
Python has no reader of its own, and its images lose the names of layers."""

import struct

import numpy

TYPES = {1: numpy.dtype("<f2"), 2: numpy.dtype("<f4")}


class Image:
    """Channels by name, each an array of rows from the top; the window's place in the whole image; the
    header's texts by name."""

    def __init__(self, channels, x, y, texts):
        self.channels, self.x, self.y, self.texts = channels, x, y, texts

    def get(self, layer, components):
        """A layer's components as one array (rows, columns, components); None if one is missing."""
        names = [f"{layer}.{c}" if layer else c for c in components]
        if any(name not in self.channels for name in names):
            return None
        return numpy.stack([self.channels[name] for name in names], axis=-1)


def read(path):
    with open(path, "rb") as file:
        data = file.read()
    if data[:4] != b"\x76\x2f\x31\x01":
        raise ValueError(f"{path}: no OpenEXR file")
    attributes, texts, at = _header(data)
    if attributes["compression"] != b"\0":
        raise ValueError(f"{path}: is compressed")
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    line = numpy.dtype([("y", "<i4"), ("size", "<i4")] + [
        (name, kind, (width,)) for name, kind in _channels(attributes["channels"])])
    # The table of offsets comes first; the lines follow each other in the order of y.
    lines = numpy.frombuffer(data, line, count=height, offset=at + 8 * height)
    order = numpy.argsort(lines["y"], kind="stable")
    return Image({name: lines[name][order].astype(numpy.float32)
                  for name in line.names[2:]}, x0, y0, texts)


def _header(data):
    attributes, texts, at = {}, {}, 8
    while data[at] != 0:
        name, at = _text(data, at)
        kind, at = _text(data, at)
        size, = struct.unpack_from("<i", data, at)
        attributes[name] = data[at + 4:at + 4 + size]
        if kind == "string":
            texts[name] = attributes[name].decode(errors="replace")
        at += 4 + size
    return attributes, texts, at + 1


def _channels(data):
    at = 0
    while data[at] != 0:
        name, at = _text(data, at)
        kind, = struct.unpack_from("<i", data, at)
        at += 16
        yield name, TYPES[kind]


def _text(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1
