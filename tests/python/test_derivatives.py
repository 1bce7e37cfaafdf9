# ctest labels: analytic
"""Derivatives of images, against central differences."""

import numpy as np
import pytest

import uwvdb

# One for all: at quality exact, most of the work is light that it keeps.
RENDERER = uwvdb.Renderer()


@pytest.fixture
def murky(scene):
    scene.update({"camera.resolution": [6, 4], "water.absorption": [0.3, 0.1, 0.05],
                  "water.scattering": {"b": [0.2, 0.25, 0.3], "phase": {"type": "hg", "g": 0.8}},
                  "render": {"samples": 1}})
    return scene


def with_volumes(scene):
    rng = np.random.default_rng(6)
    scene.volumes.add(rng.uniform(0.2, 1, (8, 6, 6)), voxel_size=0.2, origin=(-0.7, -0.5, 1),
                      concentration={"small": 2, "large": 10})
    scene.volumes.add(rng.uniform(0.2, 1, (6, 6, 6)), voxel_size=0.2, origin=(-0.3, -0.6, 1.2),
                      absorption=[2, 1.5, 1], scattering=0.8, name="ink")
    return scene


def central(render, step):
    """By Richardson from two steps: the error falls with step^4."""
    def difference(h):
        return (render(h).astype(np.float64) - render(-h)) / (2 * h)
    return (4 * difference(step / 2) - difference(step)) / 3


def rendered(scene, path, values, change):
    changed = scene.copy()
    changed[path] = np.array(values) + change
    return RENDERER.render(changed, quality="exact")["total"]


def assert_alike(derivative, expected):
    # Promised is 1e-4. Images are float32: their differences are good to some 3e-5 here.
    assert derivative.shape == expected.shape and derivative.dtype == np.float32
    error = np.abs(derivative - expected) / np.abs(expected).max(axis=(0, 1))
    assert error.max() < 1e-4
    assert np.abs(expected).max() > 0


@pytest.mark.parametrize("name, path", [("water.absorption", "water.absorption"),
                                        ("water.scattering", "water.scattering.b")])
def test_by_coefficients_of_the_water(murky, name, path):
    scene = with_volumes(murky)
    # Particles scatter by phase functions of their own, whatever the water's.
    scene["volumes[1].grids.ink.phase"] = {"type": "hg", "g": 0.5}
    image = RENDERER.render(scene, quality="exact", derivatives=[name])
    values = scene[path]
    assert_alike(image.derivative(name),
                 central(lambda h: rendered(scene, path, values, h), 0.004))


@pytest.mark.parametrize("has_plume, rms, worst", [(False, 3e-3, 1e-2), (True, 4e-3, 3e-2)])
@pytest.mark.parametrize("name, path", [("water.absorption", "water.absorption"),
                                        ("water.scattering", "water.scattering.b")])
def test_at_final_are_those_of_what_is_interpolated(murky, name, path, has_plume, rms, worst):
    """Against differences at exact: those of images at final are farther off than derivatives."""
    murky["camera.resolution"] = [24, 16]
    scene = with_volumes(murky) if has_plume else murky
    values = scene[path]
    expected = central(lambda h: rendered(scene, path, values, h), 0.004)
    derivative = RENDERER.render(scene, quality="final", derivatives=[name]).derivative(name)
    error = np.abs(derivative - expected) / np.abs(expected).max(axis=(0, 1))
    assert np.sqrt((error**2).mean()) < rms
    assert error.max() < worst
    exact = RENDERER.render(scene, quality="exact", derivatives=[name]).derivative(name)
    assert_alike(exact, expected)


@pytest.mark.parametrize("name, path", [
    ("small", "volumes[0].grids.array1.small"), ("large", "volumes[0].grids.array1.large")])
def test_by_concentrations(murky, name, path):
    scene = with_volumes(murky)
    name, value = f"concentration.{name}", scene[path]
    image = RENDERER.render(scene, quality="exact", derivatives=[name])
    expected = central(lambda h: rendered(scene, path, value, h * value), 0.08)
    assert_alike(image.derivative(name), expected)


def particles_of(scene):
    """The water is that of a preset, and so are its particles unless others are given."""
    for key in ("absorption", "scattering"):
        del scene[f"water.{key}"]
    return scene


@pytest.mark.parametrize("kind, ppm, given", [
    ("small", 0.05, {"large": 0.3}), ("large", 0.3, {"small": 0.05}),
    # Which absorb, but for the preset's own, 0.5 ppm, that its measured absorption holds.
    ("large", 0.7, {"absorption": "mineral"}), ("large", 0.2, {"absorption": "mineral"})])
def test_by_the_waters_own_particles(murky, kind, ppm, given):
    scene = with_volumes(particles_of(murky))
    scene["volumes[1].grids.ink.phase"] = {"type": "hg", "g": 0.5}
    scene["water.particles"] = {kind: ppm, **given}
    name = f"water.particles.{kind}"
    image = RENDERER.render(scene, quality="exact", derivatives=[name])
    assert_alike(image.derivative(name),
                 central(lambda h: rendered(scene, name, ppm, h), 0.08 * ppm))


def test_by_particles_that_the_water_has_none_of(murky):
    scene = particles_of(murky)
    scene["water.particles"] = {"small": 0, "large": 0}
    image = RENDERER.render(scene, quality="exact", derivatives=["water.particles.large"])

    def render(h):
        return rendered(scene, "water.particles.large", 0, h).astype(np.float64)
    # There is no less than nothing: forwards, by Richardson from three steps.
    zero, h = render(0), 0.08
    first = [(render(step) - zero) / step for step in (h, h / 2, h / 4)]
    second = [2 * finer - coarser for coarser, finer in zip(first, first[1:])]
    assert_alike(image.derivative("water.particles.large"), (4 * second[1] - second[0]) / 3)


def test_particles_that_change_what_a_grid_scatters_like(murky):
    scene = with_volumes(particles_of(murky))
    with pytest.raises(uwvdb.UsageError, match="grid ink scatters like the water.*give .* a phase"):
        RENDERER.render(scene, quality="draft", derivatives=["water.particles.small"])


def test_by_a_grid_with_coefficients_of_its_own(murky):
    rng = np.random.default_rng(6)
    murky.volumes.add(rng.uniform(0.2, 1, (8, 6, 6)), voxel_size=0.2, origin=(-0.7, -0.5, 1),
                      absorption=[1, 0.8, 0.6], scattering=0.5, name="ink")
    image = RENDERER.render(murky, quality="exact", derivatives=["concentration.ink"])

    def render(h):
        changed = murky.copy()
        changed.update({"volumes[0].grids.ink.absorption": (1 + h) * np.array([1, 0.8, 0.6]),
                        "volumes[0].grids.ink.scattering": (1 + h) * 0.5})
        return RENDERER.render(changed, quality="exact")["total"]
    assert_alike(image.derivative("concentration.ink"), central(render, 0.08))


def test_a_single_path_has_the_derivative_of_its_exponential(scene):
    # Water that only absorbs: every path's light is e^(-a l), l = from lamp to wall to camera.
    scene.update({"lamps": scene["lamps"][:1], "render": {"samples": 1},
                  "water.absorption": [0.3, 0.1, 0.05],
                  "water.scattering": {"b": 0, "phase": {"type": "hg", "g": 0.8}}})
    image = uwvdb.Renderer().render(scene, ["total", "position"], derivatives=["water.absorption"])
    to_lamp = np.linalg.norm(image["position"] - np.array([-0.5, 0, 0]), axis=-1)
    length = to_lamp + np.linalg.norm(image["position"], axis=-1)
    expected = -length[..., None] * image["total"]
    assert np.allclose(image.derivative("water.absorption"), expected, rtol=1e-5)


def test_derivatives_leave_the_image_as_it_is_and_outlive_it(murky):
    renderer = uwvdb.Renderer()
    image = renderer.render(murky, "all", derivatives=["water.absorption", "water.scattering"])
    assert np.array_equal(image.pixels, uwvdb.Renderer().render(murky, "all").pixels,
                          equal_nan=True)
    derivative = image.derivative("water.absorption")
    kept = derivative.copy()
    del image
    renderer.render(murky)
    assert np.array_equal(derivative, kept)
    cropped = renderer.render(murky, crop=(1, 2, 4, 4), derivatives=["water.absorption"])
    assert cropped.derivative("water.absorption").shape == (2, 3, 3)


@pytest.mark.parametrize("changes, name, message", [
    ({}, "water.absorbtion", "unknown; use water.absorption"),
    ({}, "concentration.small", "the volumes hold nothing"),
    ({"render.integrator": "reference"}, "water.absorption", "integrators volume and path"),
    ({"water.forward_scatter": {"K": 0.1, "G": 0.1, "B": 0.1}}, "water.absorption",
     "blurs the finished image, .*; remove water.forward_scatter, or set its K to 0"),
    ({"water.snow": {"number": 2000, "diameter": ["0.2 mm", "5 mm"]}}, "water.absorption",
     "drawn particle by particle.*; remove water.snow"),
    ({}, "water.particles.small", "the water's scattering is given.*; remove water.scattering"),
])
def test_what_has_no_derivative(murky, changes, name, message):
    murky.update(changes)
    with pytest.raises(uwvdb.UsageError, match=f"^derivative '?{name}'?: .*{message}"):
        uwvdb.Renderer().render(murky, quality="draft", derivatives=[name])
    with pytest.raises(KeyError, match="request it"):
        uwvdb.Renderer().render(murky, quality="draft").derivative(name)


def test_light_matrix_mixes_lamps(scene):
    matrix = RENDERER.light_matrix(scene, quality="exact")
    assert matrix.lamps == ["left", "right"] and matrix.images.shape == (2, 8, 12, 3)
    assert np.abs(matrix.rest).max() < 1e-6
    factors = np.array([[2, 0.5, 1], [0, 3, 0.1]])
    mixed = matrix.mix(factors)
    scene.update({"lamps.left.intensity": factors[0] * scene["lamps.left.intensity"],
                  "lamps.right.intensity": factors[1] * scene["lamps.right.intensity"]})
    assert np.allclose(mixed, RENDERER.render(scene, quality="exact")["total"], rtol=1e-6)
    assert np.allclose(matrix.mix([1, 1]), matrix.images.sum(axis=0), rtol=1e-6)
    with pytest.raises(uwvdb.UsageError, match=r"expected factors of shape \(2,\) or \(2, 3\)"):
        matrix.mix([1, 2, 3])
