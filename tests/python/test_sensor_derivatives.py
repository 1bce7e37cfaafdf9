# ctest labels: analytic
"""Derivatives of a sensor's mean numbers, against central differences."""

import numpy as np
import pytest

import uwvdb

RENDERER = uwvdb.Renderer()

SENSOR = {"exposure": 2e-4, "gain": 0.5, "pixel_pitch": 20e-6, "mosaic": "rggb",
          "quantum_efficiency": {"r": [0.4, 0.05, 0.01], "g": [0.05, 0.5, 0.1],
                                 "b": [0.01, 0.1, 0.45]},
          "dark_current": 50, "black_level": 64, "bit_depth": 16}


@pytest.fixture
def seen(scene):
    scene.update({"camera.resolution": [6, 4], "render": {"samples": 1, "scattering": "single"},
                  "water.absorption": [0.3, 0.1, 0.05],
                  "water.scattering": {"b": 0.2, "phase": {"type": "hg", "g": 0.8}},
                  "camera.lens": {"f_number": 2.8, "focal_length": 0.006},
                  "camera.sensor": SENSOR})
    return scene


def numbers(scene):
    return RENDERER.render(scene, quality="exact").mean_numbers()


@pytest.mark.parametrize("mosaic", ["rggb", "mono", "three"])
def test_mean_numbers_are_what_noise_scatters_about(seen, mosaic):
    efficiency = 0.5 if mosaic == "mono" else SENSOR["quantum_efficiency"]
    seen.update({"camera.sensor.mosaic": mosaic, "camera.sensor.quantum_efficiency": efficiency,
                 "camera.sensor.read_noise": 5})
    image = RENDERER.render(seen, ["total", "sensor"], quality="exact", size=(60, 40))
    means = image.mean_numbers()
    assert means.shape == image["sensor"].shape
    # Poisson's noise of the electrons, that of reading, and rounding.
    deviation = np.sqrt(0.5 * (means - 64) + (0.5 * 5)**2 + 1 / 12)
    off = (image["sensor"] - means) / deviation
    assert abs(off.mean()) < 4 / np.sqrt(off.size)
    assert off.std() == pytest.approx(1, abs=4 / np.sqrt(2 * off.size))


@pytest.mark.parametrize("path, direction, step", [
    ("camera.sensor.gain", 1, 0.01), ("camera.sensor.exposure", 1, 1e-5),
    ("camera.sensor.black_level", 1, 1), ("camera.sensor.dark_current", 1, 5),
    ("camera.sensor.quantum_efficiency.g", [1, 0.5, -1], 0.005),
    ("water.absorption", [1, 2, 0.5], 0.004), ("lamps.left.intensity", [1, 2, 3], 0.1)])
def test_jvp_and_backward(seen, path, direction, step):
    values = np.array(seen[path], dtype=float)
    along = np.array(direction, dtype=float)

    def moved(h):
        changed = seen.copy()
        changed[path] = (values + h * along).tolist()
        return numbers(changed)
    # By Richardson from two steps.
    expected = (8 * (moved(step / 2) - moved(-step / 2)) - (moved(step) - moved(-step))) / (6 * step)
    image = RENDERER.render(seen, quality="exact")
    derivative = image.jvp({path: direction}, layer="sensor")
    size = np.abs(expected).max()
    # Images are float32.
    assert derivative.shape == (4, 6) and np.abs(derivative - expected).max() < 1e-4 * size
    weights = np.random.default_rng(1).normal(size=expected.shape)
    found = image.backward(weights, path, layer="sensor")[path]
    assert found.shape == values.shape
    assert (found * along).sum() == pytest.approx((weights * expected).sum(), abs=1e-4 * 24 * size)


def test_light_and_sensor_move_together(seen):
    along = {"camera.sensor.gain": 0.3, "water.absorption": [1, 0, 1],
             "camera.sensor.black_level": 2}
    image = RENDERER.render(seen, quality="exact")
    derivative = image.jvp(along, layer="sensor")
    apart = sum(image.jvp({path: value}, layer="sensor") for path, value in along.items())
    assert np.allclose(derivative, apart, rtol=1e-5, atol=1e-5 * np.abs(apart).max())
    # Black level and gain, whose parts are known.
    assert np.allclose(image.jvp({"camera.sensor.black_level": 1}, layer="sensor"), 1)
    assert np.allclose(image.jvp({"camera.sensor.gain": 1}, layer="sensor"),
                       (image.mean_numbers() - 64) / 0.5, rtol=1e-5)


def test_full_wells_hold_no_more(seen):
    electrons = (numbers(seen) - 64) / 0.5
    seen["camera.sensor.full_well"] = well = float(np.median(electrons))
    image = RENDERER.render(seen, quality="exact")
    is_full = image.mean_numbers() == 0.5 * well + 64
    assert is_full.any() and not is_full.all()
    derivative = image.jvp({"lamps.left.intensity": 1}, layer="sensor")
    assert (derivative[is_full] == 0).all() and (derivative[~is_full] > 0).all()


def test_what_has_no_sensor(seen):
    image = RENDERER.render(seen)
    with pytest.raises(uwvdb.UsageError, match='expected "total" or "sensor", found \'rgb\''):
        image.jvp({"water.absorption": 1}, layer="rgb")
    with pytest.raises(uwvdb.UsageError, match=r"the shape of the image's sensor, \(4, 6\)"):
        image.backward(np.ones((4, 6, 3)), "water.absorption", layer="sensor")
    with pytest.raises(uwvdb.UsageError, match="give layer=\"sensor\""):
        image.jvp({"camera.sensor.gain": 1})
    del seen["camera.sensor"]
    with pytest.raises(uwvdb.UsageError, match="the scene's camera has none"):
        RENDERER.render(seen).mean_numbers()
