#!/usr/bin/env python3
"""What COLMAP makes of sets: it reconstructs the camera's path from the images alone, which is compared with
the true one. Needs COLMAP and NumPy.

    uwvdb dataset assets/scenes/reconstruction.yaml -o air --format png,colmap
    uwvdb dataset assets/scenes/reconstruction.yaml -o port --format png,colmap \\
        --set 'camera.port={type: flat, distance: 0.05, thickness: 0.02}'
    uwvdb dataset assets/scenes/reconstruction.yaml -o fitted --format png,colmap --pinhole-fit \\
        --set 'camera.port={type: flat, distance: 0.05, thickness: 0.02}'
    docs/examples/datasets/colmap_poses.py air port fitted --plot errors.svg

COLMAP works beside each set, in air-colmap; what is there is not done again. It gets the camera of the set's
model: that in air, the true one without a port, as a port is not among its camera models; or, of a set that was
written with --pinhole-fit, the pinhole and lens that were fitted to the rays in the water. Rotation, position
and size of its world are free, so they are fitted; what is left is the error. The picture shows the error of
each image and, over the image, by how far features lie from where the reconstruction has them, as means of
cells: noise where the camera's model is right, a pattern where it is not.
"""

import argparse
import os
import pathlib
import subprocess
import sys

import numpy as np

CELLS = (16, 12)  # of the picture, across and down


def lines(path):
    return [line for line in path.read_text().splitlines() if not line.startswith("#")]


# COLMAP's models of lenses, and how many numbers follow fx, fy, cx, cy.
MODELS = {"PINHOLE": 0, "OPENCV": 4, "OPENCV_FISHEYE": 4, "FULL_OPENCV": 8}


class Camera:
    """The only camera of a model, by its line of cameras.txt: ID, MODEL, WIDTH, HEIGHT, numbers."""

    def __init__(self, folder):
        cameras = lines(folder / "cameras.txt")
        cells = cameras[0].split()
        self.model, numbers = cells[1], [float(v) for v in cells[4:]]
        if len(cameras) > 1:
            sys.exit(f"{folder}: has {len(cameras)} cameras; give the set of one")
        if len(numbers) != 4 + MODELS.get(self.model, -5):
            sys.exit(f"{folder}: a lens of the model {self.model}, which is none of {', '.join(MODELS)}")
        self.width, self.height = int(cells[2]), int(cells[3])
        self.numbers = numbers

    def project(self, x, y, z):
        """Where a point in the camera's axes is seen [pixels]."""
        fx, fy, cx, cy, *k = self.numbers
        u, v = x / z, y / z
        if self.model == "OPENCV_FISHEYE":
            r = np.hypot(u, v)
            angle = np.arctan(r)
            t = angle * (1 + sum(c * angle ** (2 * i + 2) for i, c in enumerate(k)))
            factor = t / r if r > 0 else 1
            u, v = u * factor, v * factor
        elif k:
            k1, k2, p1, p2, k3, k4, k5, k6 = (*k, 0, 0, 0, 0)[:8]
            r = u * u + v * v
            radial = (1 + r * (k1 + r * (k2 + r * k3))) / (1 + r * (k4 + r * (k5 + r * k6)))
            u, v = (u * radial + 2 * p1 * u * v + p2 * (r + 2 * u * u),
                    v * radial + p1 * (r + 2 * v * v) + 2 * p2 * u * v)
        return fx * u + cx, fy * v + cy


def matrix_of(w, x, y, z):
    w, x, y, z = np.array((w, x, y, z)) / np.linalg.norm((w, x, y, z))
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def read_images(folder):
    """File's name -> (rotation camera_from_world, translation, features as rows of x, y, point's id)."""
    images = {}
    rows = lines(folder / "images.txt")
    for head, features in zip(rows[::2], rows[1::2]):
        cells = head.split()
        numbers = [float(v) for v in cells[1:8]]
        images[pathlib.PurePath(cells[9]).name] = (
            matrix_of(*numbers[:4]), np.array(numbers[4:]),
            np.array(features.split(), dtype=float).reshape(-1, 3))
    return images


def read_points(folder):
    return {int(c[0]): np.array(c[1:4], dtype=float)
            for c in (line.split() for line in lines(folder / "points3D.txt"))}


def reconstruct(images, camera, folder):
    """Runs COLMAP's steps; the model as text in folder/model."""
    model = folder / "model"
    if (model / "images.txt").exists():
        return model
    (folder / "sparse").mkdir(parents=True, exist_ok=True)
    model.mkdir(exist_ok=True)
    database = ("--database_path", folder / "colmap.db")
    steps = (
        ("feature_extractor", *database, "--image_path", images, "--ImageReader.single_camera", "1",
         "--ImageReader.camera_model", camera.model, "--ImageReader.camera_params",
         ",".join(str(v) for v in camera.numbers), "--SiftExtraction.use_gpu", "0",
         "--SiftExtraction.max_num_features", "3000"),
        ("exhaustive_matcher", *database, "--SiftMatching.use_gpu", "0"),
        ("mapper", *database, "--image_path", images, "--output_path", folder / "sparse",
         "--Mapper.ba_refine_focal_length", "0", "--Mapper.ba_refine_extra_params", "0"),
        ("model_converter", "--input_path", folder / "sparse/0", "--output_path", model,
         "--output_type", "TXT"))
    for step in steps:
        done = subprocess.run(["colmap", *map(str, step)], capture_output=True, text=True,
                              env={**os.environ, "QT_QPA_PLATFORM": "offscreen"})
        if done.returncode != 0:
            sys.exit(f"colmap {step[0]} failed:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return model


def centre(image):
    return -image[0].T @ image[1]


class Comparison:
    """Errors of the images that were reconstructed, once the two worlds are fitted to each other."""

    def __init__(self, set_folder):
        truth_folder = set_folder / "sparse/0"
        self.camera = Camera(truth_folder)
        self.width, self.height = self.camera.width, self.camera.height
        self.name = set_folder.name
        model = reconstruct(set_folder / "images", self.camera,
                            set_folder.with_name(set_folder.name + "-colmap"))
        truth, self.found = read_images(truth_folder), read_images(model)
        self.points = read_points(model)
        self.count = len(truth)
        self.names = sorted(set(truth) & set(self.found))
        # Rotation by all images' axes, then scale and offset by their centres: least squares.
        axes = sum(truth[n][0].T @ self.found[n][0] for n in self.names)
        left, _, right = np.linalg.svd(axes)
        turn = left @ np.diag((1, 1, np.sign(np.linalg.det(left @ right)))) @ right
        ours = np.array([turn @ centre(self.found[n]) for n in self.names])
        true = np.array([centre(truth[n]) for n in self.names])
        self.extent = np.linalg.norm(true.max(0) - true.min(0))  # of the path [m]
        centred = ours - ours.mean(0)
        scale = (centred * (true - true.mean(0))).sum() / (centred ** 2).sum()
        self.metres = np.linalg.norm(scale * centred - (true - true.mean(0)), axis=1)
        traces = [np.trace(self.found[n][0] @ turn.T @ truth[n][0].T) for n in self.names]
        self.degrees = np.degrees(np.arccos(np.clip((np.array(traces) - 1) / 2, -1, 1)))

    def residuals(self):
        """Rows of x, y, and the feature less the projection there [pixels]."""
        rows = []
        for rotation, translation, features in self.found.values():
            for x, y, number in features:
                if number < 0:
                    continue
                p = rotation @ self.points[int(number)] + translation
                u, v = self.camera.project(*p)
                rows.append((x, y, x - u, y - v))
        return np.array(rows)

    def text(self):
        rms = np.sqrt((self.residuals()[:, 2:] ** 2).sum(1).mean())
        return (f"{self.name}: {len(self.names)} of {self.count} images; positions off by "
                f"{1e3 * np.sqrt((self.metres ** 2).mean()):.2f} mm (RMS), "
                f"{1e3 * self.metres.max():.2f} mm at most, {100 * self.metres.max() / self.extent:.3f} % "
                f"of the path's {self.extent:.2f} m; rotations by "
                f"{np.sqrt((self.degrees ** 2).mean()):.4f} and {self.degrees.max():.4f} degrees; "
                f"features by {rms:.3f} px (RMS)")

    def cell_means(self):
        """(x, y, dx, dy) of each cell that has at least 5 features."""
        rows = self.residuals()
        across, down = CELLS
        cells = (np.clip((rows[:, 0] / self.width * across).astype(int), 0, across - 1) +
                 across * np.clip((rows[:, 1] / self.height * down).astype(int), 0, down - 1))
        means = []
        for cell in range(across * down):
            own = rows[cells == cell]
            if len(own) >= 5:
                means.append(((cell % across + 0.5) / across, (cell // across + 0.5) / down,
                              *own[:, 2:].mean(0)))
        return means


def bars(values, x0, y0, width, height, most, colour):
    step = width / len(values)
    return "".join(
        f'<rect x="{x0 + i * step + 1:.1f}" y="{y0 + height * (1 - v / most):.1f}" '
        f'width="{step - 2:.1f}" height="{height * v / most:.1f}" fill="{colour}"/>'
        for i, v in enumerate(values))


def picture(comparisons):
    """SVG: a column for each set, with its residuals over the image and the errors of its images."""
    wide, high, gap, low = 400, 300, 50, 110
    arrows = {c.name: c.cell_means() for c in comparisons}
    longest = max(max(np.hypot(dx, dy) for _, _, dx, dy in a) for a in arrows.values())
    factor = 0.9 * wide / CELLS[0] / longest
    most_mm = 1e3 * max(c.metres.max() for c in comparisons)
    most_degrees = max(c.degrees.max() for c in comparisons)
    out = []
    for column, c in enumerate(comparisons):
        x0 = gap + column * (wide + gap)
        out.append(f'<text x="{x0}" y="24" font-size="15">{c.name}: residuals, arrows × '
                   f'{factor * c.width / wide:.3g}</text>'
                   f'<rect x="{x0}" y="36" width="{wide}" height="{high}" fill="none" stroke="#888"/>')
        for u, v, dx, dy in arrows[c.name]:
            x, y = x0 + u * wide, 36 + v * high
            out.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="1.6" fill="#06c"/>'
                       f'<line x1="{x:.1f}" y1="{y:.1f}" x2="{x + factor * dx:.2f}" '
                       f'y2="{y + factor * dy:.2f}" stroke="#06c" stroke-width="1.5"/>')
        for row, (what, values, most, colour) in enumerate((
                ("position error of each image, mm", 1e3 * c.metres, most_mm, "#c60"),
                ("rotation error of each image, degrees", c.degrees, most_degrees, "#383"))):
            y0 = 36 + high + 40 + row * (low + 45)
            out.append(f'<text x="{x0}" y="{y0 - 8}">{what}, at most {values.max():.3g}</text>'
                       f'<text x="{x0 - 4}" y="{y0 + 5}" font-size="10" text-anchor="end">{most:.3g}'
                       f'</text><path d="M{x0} {y0}V{y0 + low}H{x0 + wide}" fill="none" stroke="#888"/>')
            out.append(bars(values, x0, y0, wide, low, most, colour))
    total_width = gap + len(comparisons) * (wide + gap)
    total_height = 36 + high + 2 * (low + 45) + 10
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{total_width}" height="{total_height}" '
            f'viewBox="0 0 {total_width} {total_height}" font-family="sans-serif" font-size="13">'
            f'<rect width="100%" height="100%" fill="white"/>{"".join(out)}</svg>\n')


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sets", nargs="+", type=pathlib.Path)
    parser.add_argument("--plot", metavar="FILE.svg", type=pathlib.Path)
    a = parser.parse_args()
    comparisons = [Comparison(folder.resolve()) for folder in a.sets]
    for comparison in comparisons:
        print(comparison.text())
    if a.plot:
        a.plot.write_text(picture(comparisons))


main()
