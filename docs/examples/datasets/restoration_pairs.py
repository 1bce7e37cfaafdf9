#!/usr/bin/env python3
"""Images with and without water, pixel by pixel, ready to train a restoration:

    uwvdb dataset assets/scenes/wreck.yaml -o pairs --format clean --cameras left
    docs/examples/datasets/restoration_pairs.py pairs

As the simplest of models it fits one line per colour on the first frames, and says what that restores
of the last ones: a floor for whatever is trained.
"""

import math
import sys

from set_reader import files, read_png, views


def pairs(folder):
    """Yields (image, clean), one pair per view."""
    for view in views(folder):
        paths, _ = files(folder, view)
        yield read_png(paths["image"]), read_png(paths["clean"])


def fit(samples):
    """Least squares: clean = gain * image + offset, per colour."""
    lines = []
    for c in range(3):
        n = len(samples)
        x = [a[c] for a, _ in samples]
        y = [b[c] for _, b in samples]
        mx, my = sum(x) / n, sum(y) / n
        variance = sum((a - mx) ** 2 for a in x)
        gain = sum((a - mx) * (b - my) for a, b in zip(x, y)) / variance if variance else 0
        lines.append((gain, my - gain * mx))
    return lines


def psnr(samples, lines):
    squares = [(gain * a[c] + offset - b[c]) ** 2
               for a, b in samples for c, (gain, offset) in enumerate(lines)]
    return 10 * math.log10(255 ** 2 / max(sum(squares) / len(squares), 1e-9))


def main(folder):
    sampled = []  # by view: some of its pixels
    for image, clean in pairs(folder):
        sampled.append([(image.at(x, y), clean.at(x, y)) for y in range(0, image.height, 4)
                        for x in range(0, image.width, 4)])
    split = max(1, len(sampled) * 3 // 4)
    train = [s for view in sampled[:split] for s in view]
    test = [s for view in sampled[split:] or sampled[:1] for s in view]
    lines = fit(train)
    print(f"{len(sampled)} pairs, {split} to train with")
    print(f"as it is: {psnr(test, [(1, 0)] * 3):.2f} dB, by a line per colour: "
          f"{psnr(test, lines):.2f} dB")


if __name__ == "__main__":
    main(sys.argv[1])
