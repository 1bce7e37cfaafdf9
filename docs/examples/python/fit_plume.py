"""Finds a plume voxel by voxel from pictures taken around it.

    python3 fit_plume.py [--size 64x48] [--voxels 24] [--steps 120] [--figure plume.png]

Eight views of a plume with two lamps beside the camera are rendered and given 1 % of noise; then
its density is looked for, from nothing but a faint haze: gradient descent (Adam) on what the
pictures are off by, with a little of total variation, that prefers even water to speckle.
Renderer.backward() has the derivatives by all voxels from one pass over each image. Prints how far
the density is off, and shows slices of the true and of the found one (needs Matplotlib).
"""

import argparse
import time

import numpy as np

import uwvdb

VIEWS = 8
DISTANCE = 2.2  # of the cameras from the plume's middle [m]
EDGE = 1.2  # of the box of voxels [m]
ATTENUATION = {"absorption": 0.6, "scattering": 2.4}  # [1/m] where the density is 1


def size_of(text):
    width, height = text.split("x")
    return int(width), int(height)


def true_density(count):
    """Two puffs, one above the other, with a hollow."""
    x, y, z = np.meshgrid(*[np.linspace(-1, 1, count)] * 3, indexing="ij")
    low = np.exp(-((x + 0.15)**2 + (y - 0.3)**2 + z**2) / 0.12)
    high = 0.7 * np.exp(-((x - 0.2)**2 + (y + 0.35)**2 + (z - 0.1)**2) / 0.08)
    hollow = 0.8 * np.exp(-((x + 0.2)**2 + (y - 0.35)**2 + (z + 0.1)**2) / 0.015)
    return np.clip(low + high - hollow, 0, None)


def scene_with(density, size):
    """The plume in the middle of the world, and the cameras' lamps."""
    lamp = {"intensity": [20, 20, 20], "profile": {"type": "spot", "beam": 70, "edge": 30}}
    scene = uwvdb.Scene(
        camera={"resolution": list(size), "intrinsics": {"fov_x": 45}},
        water={"absorption": [0.15, 0.08, 0.05],
               "scattering": {"b": 0.05, "phase": {"type": "hg", "g": 0.8}}},
        lamps=[{"name": "left", "position": [-0.7, -0.2, 0], "direction": [0.3, 0.1, 1], **lamp},
               {"name": "right", "position": [0.7, -0.2, 0], "direction": [-0.3, 0.1, 1], **lamp}],
        render={"scattering": "single", "samples": 1})
    count = density.shape[0]
    scene.volumes.add(density, voxel_size=EDGE / (count - 1), origin=[-EDGE / 2] * 3, name="plume",
                      phase={"type": "hg", "g": 0.7}, **ATTENUATION)
    return scene


def from_side(scene, view):
    """The same, seen from one of the sides."""
    angle = 2 * np.pi * view / VIEWS
    seen = scene.copy()
    seen["camera.pose"] = {
        "position": [DISTANCE * np.sin(angle), 0.25 * DISTANCE * np.cos(3 * angle),
                     -DISTANCE * np.cos(angle)],
        "look_at": [0, 0, 0], "up": [0, -1, 0]}
    return seen


def total_variation(density):
    """Its sum over the voxels, smooth near 0, and its gradient."""
    value, gradient = 0.0, np.zeros_like(density)
    for axis in range(3):
        step = np.diff(density, axis=axis)
        length = np.sqrt(step**2 + 1e-4)
        value += length.sum()
        slope = step / length
        before = [slice(None)] * 3
        after = [slice(None)] * 3
        before[axis], after[axis] = slice(None, -1), slice(1, None)
        gradient[tuple(after)] += slope
        gradient[tuple(before)] -= slope
    return value, gradient


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--size", type=size_of, default=(64, 48), help="of the pictures")
    parser.add_argument("--voxels", type=int, default=24, help="along an edge")
    parser.add_argument("--steps", type=int, default=120)
    parser.add_argument("--smoothness", type=float, default=1e-7, help="of total variation")
    parser.add_argument("--figure", help="file for slices of both")
    arguments = parser.parse_args()

    renderer = uwvdb.Renderer()
    rng = np.random.default_rng(1)
    truth = true_density(arguments.voxels)
    scene = scene_with(truth, arguments.size)
    seen = []
    for view in range(VIEWS):
        picture = renderer.render(from_side(scene, view), "total")["total"].astype(float)
        seen.append(picture * (1 + 0.01 * rng.normal(size=picture.shape)))
    brightness = np.mean([picture.mean() for picture in seen])

    density = np.full(truth.shape, 0.05)
    mean, square = np.zeros_like(density), np.zeros_like(density)
    begun = time.monotonic()
    for step in range(1, arguments.steps + 1):
        loss, gradient = 0.0, np.zeros_like(density)
        scene.volumes.set_values("plume", density)
        for view in range(VIEWS):
            image = renderer.render(from_side(scene, view), "total")
            off = (image["total"] - seen[view]) / brightness
            loss += (off**2).mean() / VIEWS
            slope = 2 * off / (off.size * VIEWS * brightness)
            found = image.backward(slope, "volumes[0].array", seed=step)
            gradient += found["volumes[0].array"]
        variation, of_variation = total_variation(density)
        gradient += arguments.smoothness * of_variation
        # Adam (Kingma and Ba 2015), with steps that shrink towards the end.
        mean += 0.1 * (gradient - mean)
        square += 0.01 * (gradient**2 - square)
        rate = 0.06 * 0.02**(step / arguments.steps)
        correction = np.sqrt(1 - 0.99**step) / (1 - 0.9**step)
        density -= rate * correction * mean / (np.sqrt(square) + 1e-12)
        density = np.clip(density, 0, None)
        if step % 20 == 0 or step == arguments.steps:
            error = np.sqrt(((density - truth)**2).mean() / (truth**2).mean())
            print(f"step {step:3d}: pictures off by {100 * np.sqrt(loss):5.2f} % of their mean, "
                  f"density by {100 * error:5.1f} %, {time.monotonic() - begun:.0f} s", flush=True)

    if arguments.figure:
        import matplotlib
        matplotlib.use("Agg")
        from matplotlib import pyplot
        middle = arguments.voxels // 2
        slices = [("from the side", lambda d: d[:, :, middle].T),
                  ("from above", lambda d: d[:, int(0.65 * arguments.voxels), :].T)]
        figure, axes = pyplot.subplots(2, 3, figsize=(8, 5.2), layout="constrained")
        for row, (name, cut) in zip(axes, slices):
            for axis, (title, values, limit) in zip(row, [
                    ("true density", truth, 1), ("found", density, 1),
                    ("found less true", density - truth, None)]):
                drawn = axis.imshow(cut(values), cmap="viridis" if limit else "RdBu",
                                    vmin=0 if limit else -0.3, vmax=limit or 0.3)
                axis.set_title(f"{title}, {name}", fontsize=9)
                axis.set_axis_off()
                figure.colorbar(drawn, ax=axis, shrink=0.8)
        figure.savefig(arguments.figure, dpi=100)


if __name__ == "__main__":
    main()
