"""Wavelength bands, and what becomes of Blender's colours in them."""

from .notes import Refusal

RGB_BANDS = [620.0, 540.0, 450.0]


def parse(text):
    """The bands [nm] of a text such as "620, 540, 450"."""
    try:
        bands = [float(word) for word in text.replace(",", " ").split()]
    except ValueError:
        bands = []
    if not 1 <= len(bands) <= 32:
        raise Refusal(f"Render > uwvdb > Bands: '{text}' should list 1 to 32 wavelengths in nm, "
                      "such as 620, 540, 450")
    return bands


def from_rgb(rgb, bands):
    """Three bands are red, green and blue; others are interpolated between these in wavelength, as
    uwvdb does with the colours of textures."""
    rgb = [float(value) for value in rgb[:3]]
    if len(bands) == 3:
        return rgb
    known = sorted(zip(RGB_BANDS, rgb))
    return [_interpolated(known, band) for band in bands]


def _interpolated(known, x):
    if x <= known[0][0]:
        return known[0][1]
    for (x0, y0), (x1, y1) in zip(known, known[1:]):
        if x <= x1:
            return y0 + (y1 - y0) * (x - x0) / (x1 - x0)
    return known[-1][1]
