#!/usr/bin/env python3
"""Stereo pairs with disparity and depth, ready to train on:

    uwvdb dataset assets/scenes/wreck.yaml -o stereo --format png,disparity,depth
    docs/examples/datasets/stereo_depth.py stereo

It turns disparity into depth by the cameras of the records, compares that with the depth images, and
matches blocks along some rows as a floor for what is trained.
"""

import json
import math
import pathlib
import sys

from set_reader import files, read_pfm, read_png, views


def pairs(folder):
    """Yields (left, right, disparity, depth in metres by pixel, focal length times base)."""
    scale = json.loads((pathlib.Path(folder) / "dataset.json").read_text())["set"]["depth_scale"]
    rows = views(folder)
    cameras = list(dict.fromkeys(v["camera"] for v in rows))
    by_place = {(v["draw"], v["frame"], v["camera"]): v for v in rows}
    for (draw, frame, camera), view in by_place.items():
        if camera != cameras[0]:
            continue
        other = by_place[draw, frame, cameras[1]]
        paths, left = files(folder, view)
        right_paths, right = files(folder, other)
        base = math.dist(left["view"]["position"], right["view"]["position"])
        depth = read_png(paths["depth"])
        yield (read_png(paths["image"]), read_png(right_paths["image"]),
               read_pfm(paths["disparity"]), [d / scale for d in depth.values],
               left["view"]["fx"] * base)


def match(left, right, x, y, most, half=3):
    """The whole number of pixels that a block is to the left in the right image."""
    def cost(d):
        return sum(abs(left.at(x + i, y + j)[1] - right.at(x + i - d, y + j)[1])
                   for j in range(-half, half + 1) for i in range(-half, half + 1))
    return min(range(min(most, x - half) + 1), key=cost)


def main(folder):
    worst, count, matched, tried, number = 0.0, 0, 0, 0, 0
    for left, right, disparity, depth, focal_base in pairs(folder):
        number += 1
        for k in range(0, len(depth), 7):
            d = disparity.values[k]
            if depth[k] > 0 and math.isfinite(d):
                worst = max(worst, abs(focal_base / d / depth[k] - 1))
                count += 1
        y = left.height // 2
        for x in range(left.width // 4, left.width - 8, 24):
            truth = disparity.at(x, y)[0]
            if math.isfinite(truth):
                tried += 1
                matched += abs(match(left, right, x, y, 64) - truth) < 3
    print(f"{number} pairs, {count} depths: off by {100 * worst:.3f} % at most")
    print(f"block matching is within 3 px at {matched} of {tried} places")


if __name__ == "__main__":
    main(sys.argv[1])
