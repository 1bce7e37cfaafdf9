#!/usr/bin/env python3
"""Pairs of frames with their optical flow, ready to train on:

    uwvdb dataset assets/scenes/wreck.yaml -o flow --format png,flow --cameras left
    docs/examples/datasets/flow_pairs.py flow

It says how much of the difference between two frames the flow explains: the next frame, looked up where
the flow leads, against this one, where that is visible. What is left is the lamps' light, which moves
with the camera.
"""

import math
import sys

from set_reader import files, read_flo, read_png, views


def pairs(folder):
    """Yields (frame, next frame, flow, occluded), one for each view that has a next frame."""
    rows = {(v["draw"], v["camera"], int(v["frame"])): v for v in views(folder) if v["frame"]}
    for (draw, camera, frame), view in rows.items():
        following = rows.get((draw, camera, frame + 1))
        paths, _ = files(folder, view)
        if following is None or "flow" not in paths:
            continue
        next_paths, _ = files(folder, following)
        yield (read_png(paths["image"]), read_png(next_paths["image"]), read_flo(paths["flow"]),
               read_png(paths["flow_occluded"]))


def looked_up(image, x, y):
    """The green of a place, interpolated between pixels; the first one's centre is (0.5, 0.5)."""
    x, y = x - 0.5, y - 0.5
    i = min(max(math.floor(x), 0), image.width - 2)
    j = min(max(math.floor(y), 0), image.height - 2)
    u, v = x - i, y - j
    top = image.at(i, j)[1] * (1 - u) + image.at(i + 1, j)[1] * u
    bottom = image.at(i, j + 1)[1] * (1 - u) + image.at(i + 1, j + 1)[1] * u
    return top * (1 - v) + bottom * v


def main(folder):
    count, still, warped, length = 0, 0.0, 0.0, 0.0
    number = 0
    for first, second, flow, occluded in pairs(folder):
        number += 1
        for y in range(2, first.height - 2, 5):
            for x in range(2, first.width - 2, 5):
                if occluded.at(x, y)[0]:
                    continue
                u, v = flow.at(x, y)
                here = first.at(x, y)[1]
                still += abs(second.at(x, y)[1] - here)
                warped += abs(looked_up(second, x + 0.5 + u, y + 0.5 + v) - here)
                length += math.hypot(u, v)
                count += 1
    if not count:
        sys.exit(f"{folder}: has no pairs of frames with flow")
    print(f"{number} pairs, mean flow {length / count:.2f} px")
    print(f"mean difference of green: {still / count:.2f} without the flow, "
          f"{warped / count:.2f} along it")


if __name__ == "__main__":
    main(sys.argv[1])
