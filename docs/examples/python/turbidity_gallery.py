"""A gallery of turbidities: one cloud of NumPy noise, from clear water to soup.

    python3 turbidity_gallery.py gallery.png
"""

import argparse

import numpy as np

import uwvdb
from pictures import tiled, write_png


def cloud(size, seed=0):
    """Smooth noise between 0 and 1, (size, size, size), with power falling as 1/f^3."""
    frequencies = np.fft.fftfreq(size)
    f = np.sqrt(sum(np.square(axis) for axis in np.meshgrid(*[frequencies] * 3, indexing="ij")))
    f[0, 0, 0] = 1
    noise = np.random.default_rng(seed).standard_normal((size,) * 3)
    smooth = np.fft.ifftn(np.fft.fftn(noise) / f ** 1.8).real
    smooth = (smooth - smooth.mean()) / smooth.std()
    return np.clip(0.4 * smooth, 0, 1).astype(np.float32)


def scene_of(array, turbidity):
    """A checkered wall behind the cloud, lit from both sides of the camera."""
    scene = uwvdb.Scene(
        camera={"resolution": [320, 240], "intrinsics": {"fov_x": 60}},
        water={"preset": "jerlov-IB"},
        lamps=[{"name": side, "position": [x, -0.3, 0], "direction": [-0.3 * x, 0.1, 1],
                "profile": {"type": "spot", "beam": 70, "edge": 30}, "intensity": 60}
               for side, x in (("left", -0.6), ("right", 0.6))])
    x, y = np.meshgrid(np.linspace(-2, 2, 9), np.linspace(-1.5, 1.5, 7))
    for colour in (0, 1):
        squares = [(i, j) for j in range(6) for i in range(8) if (i + j) % 2 == colour]
        corners = [[(x[j, i], y[j, i], 3) for j, i in ((b, a), (b, a + 1), (b + 1, a + 1),
                                                       (b + 1, a))] for a, b in squares]
        faces = [[4 * n + k for k in face] for n in range(len(squares))
                 for face in ((0, 1, 2), (0, 2, 3))]
        scene.geometry.add(np.reshape(corners, (-1, 3)), faces, reflectance=(0.05, 0.7)[colour])
    if turbidity > 0:
        edge = 2.4 / len(array)
        scene.volumes.add(array, voxel_size=edge, origin=(-1.2, -1.2, 0.5),
                          concentration={"small": 0.2 * turbidity, "large": turbidity})
    return scene


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("picture")
    parser.add_argument("--size", type=int, nargs=2, default=(320, 240))
    parser.add_argument("--voxels", type=int, default=64)
    arguments = parser.parse_args()
    array = cloud(arguments.voxels)
    renderer = uwvdb.Renderer()
    pictures, exposure = [], None
    for turbidity in (0, 0.5, 1, 2, 4, 8):
        image = renderer.render(scene_of(array, turbidity), size=arguments.size)
        exposure = exposure or image.automatic_exposure  # the clear water's, for all
        pictures.append(image.srgb(exposure))
        print(f"turbidity {turbidity:3}: mean radiance {image['total'].mean():.4f}")
    write_png(arguments.picture, tiled([pictures[:3], pictures[3:]]))


if __name__ == "__main__":
    main()
