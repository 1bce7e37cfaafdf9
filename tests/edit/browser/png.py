"""Reads PNG files of 8 bits, as browsers and uwvdb write them."""

import struct
import zlib


class Picture:
    """Red, green and blue of all pixels, row by row. `data` may have a fourth channel."""

    def __init__(self, width, height, channels, data, texts=None):
        self.width, self.height = width, height
        self.texts = texts or {}  # tEXt: keyword -> text
        self.planes = [bytes(data[channel::channels]) for channel in range(3)]

    def at(self, x, y):
        index = int(y) * self.width + int(x)
        return [plane[index] for plane in self.planes]

    def brightness(self, x=0, y=0, width=None, height=None):
        """The mean of all channels over a rectangle, 0 to 255."""
        first, last = max(int(x), 0), self.width if width is None else int(x + width)
        rows = range(max(int(y), 0), self.height if height is None else int(y + height))
        total = sum(sum(plane[row * self.width + first:row * self.width + last])
                    for row in rows for plane in self.planes)
        return total / (3 * len(rows) * (last - first))


def _unfiltered(kind, row, above, step):
    if kind == 0:
        return row
    if kind == 2:
        return bytearray((value + up) & 255 for value, up in zip(row, above))
    for i, value in enumerate(row):
        left = row[i - step] if i >= step else 0
        up = above[i]
        if kind == 1:
            guess = left
        elif kind == 3:
            guess = (left + up) // 2
        else:
            corner = above[i - step] if i >= step else 0
            to_left, to_up, to_corner = abs(up - corner), abs(left - corner), abs(
                left + up - 2 * corner)
            guess = (left if to_left <= to_up and to_left <= to_corner
                     else up if to_up <= to_corner else corner)
        row[i] = (value + guess) & 255
    return row


def read_png(data):
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        raise ValueError("no PNG")
    at, packed, texts, header = 8, b"", {}, None
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        chunk = data[at + 8:at + 8 + length]
        at += 12 + length
        if kind == b"IHDR":
            header = struct.unpack(">IIBBBBB", chunk)
        elif kind == b"IDAT":
            packed += chunk
        elif kind == b"tEXt":
            keyword, text = chunk.split(b"\0", 1)
            texts[keyword.decode("latin-1")] = text.decode("latin-1")
    width, height, depth, colour, _, _, interlaced = header
    if depth != 8 or colour not in (2, 6) or interlaced:
        raise ValueError(f"PNG of {depth} bits, colour type {colour}")
    channels = 3 if colour == 2 else 4
    raw, stride = zlib.decompress(packed), width * channels
    data, above = bytearray(), bytearray(stride)
    for y in range(height):
        first = y * (stride + 1)
        above = _unfiltered(raw[first], bytearray(raw[first + 1:first + 1 + stride]), above,
                            channels)
        data += above
    return Picture(width, height, channels, data, texts)
