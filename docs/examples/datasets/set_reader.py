"""Reads the files of `uwvdb dataset`: PNG of 8 and 16 bits, .flo, .pfm, the manifest. With Pillow
and NumPy where they are installed they are quick; the standard library does the same without them.
"""

import array
import csv
import pathlib
import struct
import sys
import zlib


class Picture:
    """Whole numbers or floats, row by row from the top, channels interleaved."""

    def __init__(self, width, height, channels, values):
        self.width, self.height, self.channels, self.values = width, height, channels, values

    def at(self, x, y):
        """The values of a pixel, as a slice."""
        k = (y * self.width + x) * self.channels
        return self.values[k:k + self.channels]

    def numpy(self):
        """As an array of height x width x channels, for training."""
        import numpy
        return numpy.array(self.values).reshape(self.height, self.width, self.channels)


def read_png(path):
    data = pathlib.Path(path).read_bytes()
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        raise ValueError(f"{path}: not a PNG")
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height, bits, colour = struct.unpack(">IIBB", body[:10])
        elif kind == b"IDAT":
            packed += body
        at += size + 12
    channels = {0: 1, 2: 3}[colour]
    if bits == 8:
        try:
            from PIL import Image
            with Image.open(path) as image:
                return Picture(width, height, channels, array.array("B", image.tobytes()))
        except ImportError:
            pass
    step = channels * bits // 8
    row_size = width * step
    raw, previous, out = zlib.decompress(packed), bytearray(row_size), bytearray()
    for y in range(height):
        kind = raw[y * (row_size + 1)]
        row = bytearray(raw[y * (row_size + 1) + 1:(y + 1) * (row_size + 1)])
        for i in range(row_size):
            left = row[i - step] if i >= step else 0
            up = previous[i]
            corner = previous[i - step] if i >= step else 0
            if kind == 1:
                guess = left
            elif kind == 2:
                guess = up
            elif kind == 3:
                guess = (left + up) // 2
            elif kind == 4:  # Paeth
                p = left + up - corner
                guess = min((left, up, corner), key=lambda v: abs(p - v))
            else:
                guess = 0
            row[i] = (row[i] + guess) & 255
        out += row
        previous = row
    values = array.array("B" if bits == 8 else "H", bytes(out))
    if bits == 16 and sys.byteorder == "little":
        values.byteswap()
    return Picture(width, height, channels, values)


def read_floats(data, count):
    values = array.array("f", data[:4 * count])
    if sys.byteorder == "big":
        values.byteswap()
    return values


def read_flo(path):
    """Flow in pixels to the right and down; above 1e9 where nothing is known."""
    data = pathlib.Path(path).read_bytes()
    magic, width, height = struct.unpack("<fii", data[:12])
    if magic != 202021.25:
        raise ValueError(f"{path}: not a .flo")
    return Picture(width, height, 2, read_floats(data[12:], 2 * width * height))


def read_pfm(path):
    """One number per pixel; infinite where nothing is known."""
    data = pathlib.Path(path).read_bytes()
    kind, size, scale, values = data.split(b"\n", 3)
    if kind != b"Pf" or float(scale) >= 0:
        raise ValueError(f"{path}: not a little-endian .pfm of one channel")
    width, height = map(int, size.split())
    upwards = read_floats(values, width * height)
    rows = [upwards[k:k + width] for k in range(0, width * height, width)]
    downwards = array.array("f")
    for row in reversed(rows):
        downwards.extend(row)
    return Picture(width, height, 1, downwards)


def views(folder):
    """The rows of the manifest, as dictionaries."""
    with open(pathlib.Path(folder) / "manifest.csv", newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def files(folder, view):
    """The paths of a view's files by their roles: "image", "depth", "flow", ..."""
    import json
    record = json.loads((pathlib.Path(folder) / view["record"]).read_text(encoding="utf-8"))
    return {file["role"]: pathlib.Path(folder) / file["path"] for file in record["files"]}, record
