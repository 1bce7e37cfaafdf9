"""Pictures and plots without further packages."""

import struct
import zlib

import numpy as np


def write_png(file, pixels):
    """Writes uint8 pixels of shape (height, width, 3)."""
    height, width, _ = pixels.shape
    rows = np.zeros((height, 1 + 3 * width), np.uint8)  # each begins with its filter: 0
    rows[:, 1:] = pixels.reshape(height, -1)

    def chunk(kind, content):
        return (struct.pack(">I", len(content)) + kind + content +
                struct.pack(">I", zlib.crc32(kind + content)))

    with open(file, "wb") as png:
        png.write(b"\x89PNG\r\n\x1a\n" +
                  chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
                  chunk(b"IDAT", zlib.compress(rows.tobytes())) + chunk(b"IEND", b""))


def tiled(rows, gap=4):
    """One picture of rows of pictures of the same size, on white."""
    def joined(pictures, axis):
        shape = list(pictures[0].shape)
        shape[axis] = gap
        white = np.full(shape, 255, np.uint8)
        parts = [part for picture in pictures for part in (picture, white)]
        return np.concatenate(parts[:-1], axis=axis)
    return joined([joined(row, 1) for row in rows], 0)


def write_plot(file, x, curves, x_label, y_label):
    """Writes an SVG of `curves`, a dict of arrays by their names, over `x`."""
    width, height, left, bottom = 640, 400, 70, 50
    top_value = 1.05 * max(np.nanmax(curve) for curve in curves.values())
    colours = ["#c0392b", "#27ae60", "#2980b9", "#8e44ad", "#d68910"]

    def place(a, b):
        return (left + (a - x[0]) / (x[-1] - x[0]) * (width - left - 110),
                height - bottom - b / top_value * (height - bottom - 20))

    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
             'font-family="sans-serif" font-size="13"><rect width="100%" height="100%" '
             'fill="white"/>']
    for share in np.linspace(0, 1, 5):
        at_x, at_y = place(x[0] + share * (x[-1] - x[0]), 0), place(x[0], share * top_value)
        lines.append(f'<text x="{at_x[0]:.1f}" y="{at_x[1] + 18:.1f}" text-anchor="middle">'
                     f'{x[0] + share * (x[-1] - x[0]):.3g}</text>')
        lines.append(f'<text x="{left - 8}" y="{at_y[1] + 4:.1f}" text-anchor="end">'
                     f'{share * top_value:.3g}</text>')
        lines.append(f'<path d="M{left} {at_y[1]:.1f} H{width - 110}" stroke="#ddd"/>')
    for number, (name, curve) in enumerate(curves.items()):
        colour = colours[number % len(colours)]
        points = " ".join("{:.1f},{:.1f}".format(*place(a, b)) for a, b in zip(x, curve))
        lines.append(f'<polyline points="{points}" fill="none" stroke="{colour}" '
                     'stroke-width="2"/>')
        lines.append(f'<text x="{width - 100}" y="{40 + 20 * number}" fill="{colour}">{name}'
                     '</text>')
    lines.append(f'<text x="{width / 2}" y="{height - 10}" text-anchor="middle">{x_label}</text>')
    lines.append(f'<text x="16" y="{height / 2}" text-anchor="middle" '
                 f'transform="rotate(-90 16 {height / 2})">{y_label}</text></svg>')
    with open(file, "w") as svg:
        svg.write("\n".join(lines))
