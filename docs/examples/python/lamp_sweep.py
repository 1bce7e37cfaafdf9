"""How far from the camera should a lamp be? The contrast of a target over its distance, for lamps
at several heights above the camera: the nearer the lamp, the sooner backscatter hides the target.

    python3 lamp_sweep.py contrast.svg
"""

import argparse

import numpy as np

import uwvdb
from pictures import write_plot


def scene_of(distance, above):
    """A half black, half white wall at `distance`, and a lamp `above` the camera, aimed at it."""
    scene = uwvdb.Scene(
        camera={"resolution": [64, 32], "intrinsics": {"fov_x": 30}},
        water={"preset": "jerlov-3C"},
        lamps=[{"name": "lamp", "position": [0, -above, 0], "direction": [0, above, distance],
                "profile": {"type": "spot", "beam": 60, "edge": 10}, "intensity": 100}])
    for low, high, reflectance in ((-10, 0, 0.02), (0, 10, 0.9)):
        corners = [(x, y, distance) for y in (-10, 10) for x in (low, high)]
        scene.geometry.add(corners, [(0, 1, 3), (0, 3, 2)], reflectance=reflectance)
    return scene


def contrast(image):
    """(white - black) / (white + black), in the image's middle, in green."""
    total = image["total"][:, :, 1].astype(np.float64)
    height, width = total.shape
    rows = total[height // 3:-(height // 3) or None]
    black = rows[:, width // 4:width // 2 - 1].mean()
    white = rows[:, width // 2 + 1:width - width // 4].mean()
    return (white - black) / (white + black)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("plot")
    parser.add_argument("--size", type=int, nargs=2, default=(64, 32))
    parser.add_argument("--steps", type=int, default=12)
    arguments = parser.parse_args()
    renderer = uwvdb.Renderer()
    distances = np.linspace(1, 7, arguments.steps)
    curves = {}
    for above in (0.1, 0.5, 1.5):
        curves[f"{above} m"] = [
            contrast(renderer.render(scene_of(distance, above), size=arguments.size))
            for distance in distances]
    print("distance " + " ".join(f"{name:>8}" for name in curves))
    for row in zip(distances, *curves.values()):
        print(f"{row[0]:8.2f} " + " ".join(f"{value:8.3f}" for value in row[1:]))
    write_plot(arguments.plot, distances, {name: np.array(c) for name, c in curves.items()},
               "distance of the target [m]", "contrast")


if __name__ == "__main__":
    main()
