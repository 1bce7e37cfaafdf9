"""Takes the water off pictures: finds the colours of a lamp-lit sea floor, texel by texel.

    python3 restore_texture.py [--size 160x120] [--texels 96] [--steps 25] [--figure floor.png]

A floor whose shape is known, as from photogrammetry, is rendered from three places with two lamps
in turbid, greenish water, with 1 % of noise. From water, lamps and pictures its texture is found:
each step multiplies texels by how much brighter their pixels were seen than predicted, without
what the water scatters (Richardson and Lucy). Renderer.backward() hands pixels back to the texels
that they show. Prints how far texels in view are off, and shows a picture beside the texture
(needs Matplotlib).
"""

import argparse
import time

import numpy as np

import uwvdb

PLACES = [(-0.35, 0.0), (0.0, 0.15), (0.35, -0.1)]  # of the camera above the floor [m]
HEIGHT = 1.6


def size_of(text):
    width, height = text.split("x")
    return int(width), int(height)


def true_texture(count):
    """Sand with pebbles, and a chart of eight colours."""
    rng = np.random.default_rng(4)
    y, x = np.mgrid[0:count, 0:count] / count
    sand = 0.45 + 0.05 * np.sin(40 * y + 3 * np.sin(9 * x)) + 0.03 * rng.normal(size=x.shape)
    texture = sand[..., None] * np.array([1.0, 0.9, 0.7])
    for _ in range(60):
        at, radius = rng.uniform(0, 1, 2), rng.uniform(0.015, 0.05)
        inside = (x - at[0])**2 + (y - at[1])**2 < radius**2
        texture[inside] = rng.uniform(0.1, 0.6) * rng.uniform(0.7, 1, 3)
    chart = [(0.6, 0.08, 0.06), (0.1, 0.45, 0.1), (0.06, 0.1, 0.5), (0.7, 0.6, 0.08),
             (0.6, 0.1, 0.4), (0.05, 0.45, 0.5), (0.85, 0.85, 0.85), (0.05, 0.05, 0.05)]
    for i, colour in enumerate(chart):
        inside = (np.abs(x - 0.38 - 0.08 * (i % 4)) < 0.037) & (
            np.abs(y - 0.46 - 0.08 * (i // 4)) < 0.037)
        texture[inside] = colour
    return np.clip(texture, 0.02, 0.95)


def scene_with(texture, size):
    lamp = {"intensity": [20, 20, 20], "profile": {"type": "spot", "beam": 80, "edge": 40}}
    scene = uwvdb.Scene(
        camera={"resolution": list(size), "intrinsics": {"fov_x": 60}},
        water={"absorption": [0.45, 0.08, 0.15],
               "scattering": {"b": 0.25, "phase": {"type": "hg", "g": 0.85}}},
        lamps=[{"name": "left", "position": [-0.6, -0.3, 0], "direction": [0.3, 0.15, 1], **lamp},
               {"name": "right", "position": [0.6, -0.3, 0], "direction": [-0.3, 0.15, 1], **lamp}],
        render={"scattering": "single"})
    # A floor with ripples, 3 m wide, below a camera that looks down (y is up in the world).
    count = 49
    v, u = np.mgrid[0:count, 0:count] / (count - 1)
    height = 0.06 * np.sin(7 * u + 2 * v) * np.cos(5 * v)
    vertices = np.stack([3 * u - 1.5, height, 3 * v - 1.5], axis=-1).reshape(-1, 3)
    corner = (np.arange(count - 1)[:, None] * count + np.arange(count - 1)).reshape(-1, 1)
    faces = np.concatenate([corner + [0, 1, count + 1], corner + [0, count + 1, count]])
    scene.geometry.add(vertices, faces, uvs=np.stack([u, v], axis=-1).reshape(-1, 2),
                       texture=texture, name="floor")
    return scene


def from_above(scene, place):
    seen = scene.copy()
    seen["camera.pose"] = {"position": [place[0], HEIGHT, place[1]],
                           "look_at": [0.5 * place[0], 0, 0.5 * place[1]], "up": [0, 0, -1]}
    return seen


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--size", type=size_of, default=(160, 120), help="of the pictures")
    parser.add_argument("--texels", type=int, default=96, help="along a side")
    parser.add_argument("--steps", type=int, default=25)
    parser.add_argument("--figure", help="file for a picture and the textures")
    arguments = parser.parse_args()

    renderer = uwvdb.Renderer()
    rng = np.random.default_rng(1)
    truth = true_texture(arguments.texels)
    scene = scene_with(truth, arguments.size)
    path = "geometry[0].texture"
    seen = []
    for place in PLACES:
        picture = renderer.render(from_above(scene, place))["total"].astype(float)
        seen.append(picture * (1 + 0.01 * rng.normal(size=picture.shape)))

    found = np.full(truth.shape, 0.3)
    begun = time.monotonic()
    for step in range(1, arguments.steps + 1):
        scene.geometry.set_texture("floor", found)
        more, weight, off = np.zeros_like(found), np.zeros_like(found), []
        for place, picture in zip(PLACES, seen):
            image = renderer.render(from_above(scene, place), "total,backscatter")
            of_floor = image["total"] - image["backscatter"]
            ratio = (picture - image["backscatter"]) / np.maximum(of_floor, 1e-12)
            off.append(np.abs(picture / image["total"] - 1).mean())
            # What each texel sends to the camera, and that times how much brighter it was seen.
            weight += image.backward(np.ones_like(picture), path)[path]
            more += image.backward(ratio, path)[path]
        in_view = (weight > 0.02 * weight.max(axis=(0, 1))).all(axis=-1, keepdims=True)
        found = np.where(in_view, np.clip(found * more / np.maximum(weight, 1e-12), 0.005, 1), found)
        error = np.sqrt((((found - truth) * in_view)**2).sum() / ((truth * in_view)**2).sum())
        if step % 5 == 0 or step == arguments.steps:
            print(f"step {step:3d}: pictures off by {100 * np.mean(off):5.2f} %, texels in view by "
                  f"{100 * error:5.1f} %, {time.monotonic() - begun:.0f} s", flush=True)

    if arguments.figure:
        import matplotlib
        matplotlib.use("Agg")
        from matplotlib import pyplot

        def srgb(light):
            return np.where(light < 0.0031308, 12.92 * light,
                            1.055 * np.clip(light, 0.0031308, 1)**(1 / 2.4) - 0.055).clip(0, 1)
        rows, columns = (np.flatnonzero(in_view[..., 0].any(axis=axis)) for axis in (1, 0))
        part = np.s_[rows[0]:rows[-1] + 1, columns[0]:columns[-1] + 1]
        figure, axes = pyplot.subplots(1, 3, figsize=(10, 2.8), layout="constrained")
        for axis, title, values in zip(axes, ["a picture", "found texture", "true texture"], [
                seen[1] / np.percentile(seen[1], 99.5), np.where(in_view, found, 0)[part],
                truth[part]]):
            axis.imshow(srgb(values), interpolation="nearest")
            axis.set_title(title, fontsize=10)
            axis.set_axis_off()
        figure.savefig(arguments.figure, dpi=100)


if __name__ == "__main__":
    main()
