"""Water from one image: absorption and scattering in every band, and how dense a cloud is, by least
squares. The renderer gives the derivatives of the image, so that each step takes one rendering
instead of one for each unknown.

    python3 fit_water.py
"""

import argparse

import numpy as np
from scipy.optimize import least_squares

import uwvdb

TRUTH = {"absorption": np.array([0.35, 0.09, 0.06]), "scattering": np.array([0.15, 0.2, 0.25]),
         "cloud": np.array([1.5])}


def scene():
    """A wall at a slant and a cloud of known shape before part of it."""
    made = uwvdb.Scene(
        camera={"resolution": [320, 240], "intrinsics": {"fov_x": 60}},
        water={"absorption": 0.1, "scattering": {"b": 0.1, "phase": {"type": "hg", "g": 0.85}}},
        geometry=[{"type": "plane", "point": [0, 0, 3], "normal": [0.5, 0, -1],
                   "reflectance": 0.5}],
        lamps=[{"name": "lamp", "position": [-0.5, -0.2, 0], "direction": [0.1, 0, 1],
                "intensity": 50}],
        render={"samples": 1})
    x, y, z = np.meshgrid(*[np.linspace(-1, 1, 24)] * 3, indexing="ij")
    made.volumes.add(np.clip(1 - x * x - y * y - z * z, 0, None), voxel_size=0.04,
                     origin=(0, -0.46, 1), concentration={"large": 1}, name="cloud")
    return made


class Model:
    """The image and its derivatives as functions of the logarithms of the seven unknowns."""

    def __init__(self, size):
        self.scene, self.size = scene(), size
        self.renderer = uwvdb.Renderer()
        self.unknowns, self.renderings = None, 0

    def render(self, unknowns):
        if self.unknowns is not None and np.array_equal(unknowns, self.unknowns):
            return
        a, b, cloud = np.split(np.exp(unknowns), [3, 6])
        self.scene.update({"water.absorption": a, "water.scattering.b": b,
                           "volumes[0].grids.cloud.large": cloud[0]})
        image = self.renderer.render(self.scene, quality="exact", size=self.size, derivatives=[
            "water.absorption", "water.scattering", "concentration.large"])
        self.unknowns, self.renderings = unknowns.copy(), self.renderings + 1
        self.image = image["total"].astype(np.float64)
        # d/d(log u) = u d/du; bands do not affect each other.
        by = np.zeros((*self.image.shape, 7))
        for band in range(3):
            by[..., band, band] = a[band] * image.derivative("water.absorption")[..., band]
            by[..., band, 3 + band] = b[band] * image.derivative("water.scattering")[..., band]
        by[..., 6] = image.derivative("concentration.large")  # a factor's, at 1
        self.derivative = by.reshape(-1, 7)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--size", type=int, nargs=2, default=(32, 24))
    parser.add_argument("--noise", type=float, default=0.01, help="of the image's mean")
    arguments = parser.parse_args()
    model = Model(arguments.size)
    model.render(np.log(np.concatenate(list(TRUTH.values()))))
    sigma = arguments.noise * model.image.mean()
    observed = model.image + np.random.default_rng(7).normal(0, sigma, model.image.shape)

    def residuals(unknowns):
        model.render(unknowns)
        return ((model.image - observed) / sigma).ravel()

    def jacobian(unknowns):
        model.render(unknowns)
        return model.derivative / sigma

    model.renderings = 0
    result = least_squares(residuals, np.log([0.1] * 3 + [0.1] * 3 + [0.5]), jacobian)
    errors = np.sqrt(np.diag(np.linalg.inv(result.jac.T @ result.jac)))
    found = np.split(np.exp(result.x), [3, 6])
    for (name, truth), values, error in zip(TRUTH.items(), found, np.split(errors, [3, 6])):
        for one, value, relative in zip(truth, values, error):
            print(f"{name:10} {value:.4f} +- {value * relative:.4f}  (true {one:.4f})")
    print(f"{model.renderings} renderings")


if __name__ == "__main__":
    main()
