# ctest labels: analytic
"""Images that PyTorch differentiates. Run where PyTorch is installed."""

import numpy as np
import torch

import uwvdb
import uwvdb.torch

RENDERER = uwvdb.Renderer()


def foggy(scene):
    scene.update({"camera.resolution": [8, 6], "render": {"samples": 1, "scattering": "single"},
                  "water.absorption": [0.3, 0.1, 0.05],
                  "water.scattering": {"b": [0.2, 0.25, 0.3], "phase": {"type": "hg", "g": 0.8}}})
    rng = np.random.default_rng(3)
    scene.volumes.add(rng.uniform(0.2, 1, (5, 4, 4)), voxel_size=0.3, origin=(-0.6, -0.5, 1),
                      absorption=0.5, scattering=1, name="ink")
    return scene


def test_gradients_are_those_of_backward(scene):
    scene = foggy(scene)
    values = {"water.scattering.b": torch.tensor(scene["water.scattering.b"], dtype=torch.float64,
                                                 requires_grad=True),
              "volumes[0].array": torch.full((5, 4, 4), 0.5, dtype=torch.float64,
                                             requires_grad=True),
              "water.absorption": torch.tensor([0.3, 0.1, 0.05], dtype=torch.float64)}
    image = uwvdb.torch.render(RENDERER, scene, values, quality="exact")
    weights = torch.rand(image.shape, dtype=torch.float64)
    (image * weights).sum().backward()
    expected = RENDERER.backward(uwvdb.torch.with_values(scene, values), weights.numpy(),
                                 ["water.scattering.b", "volumes[0].array"], quality="exact")
    for path, gradient in expected.items():
        assert np.array_equal(values[path].grad.numpy(), gradient)
    assert values["water.absorption"].grad is None


def test_differentiates_a_sensors_numbers(scene):
    scene = foggy(scene)
    scene.update({"camera.lens": {"f_number": 2.8, "focal_length": 0.006}, "camera.sensor": {
        "exposure": 2e-4, "gain": 0.5, "pixel_pitch": 20e-6, "quantum_efficiency": 0.5}})
    values = {"camera.sensor.gain": torch.tensor(0.5, dtype=torch.float64, requires_grad=True),
              "lamps.left.intensity": torch.full((3,), 50.0, dtype=torch.float64,
                                                 requires_grad=True)}
    numbers = uwvdb.torch.render(RENDERER, scene, values, quality="exact", layer="sensor")
    assert numbers.shape == (6, 8)
    numbers.sum().backward()
    # In proportion to the gain; and to both lamps.
    proportional = torch.isclose(values["camera.sensor.gain"].grad, numbers.detach().sum() / 0.5)
    assert proportional
    assert 0 < (values["lamps.left.intensity"].grad * 50).sum() < numbers.detach().sum()


def test_descends_to_the_water_of_a_picture(scene):
    scene = foggy(scene)
    seen = torch.as_tensor(np.array(RENDERER.render(scene, quality="exact")["total"]))
    b = torch.full((3,), 0.1, requires_grad=True)
    descent = torch.optim.LBFGS([b], line_search_fn="strong_wolfe")

    def off():
        descent.zero_grad()
        image = uwvdb.torch.render(RENDERER, scene, {"water.scattering.b": b}, quality="exact")
        loss = ((image / seen.mean() - seen / seen.mean())**2).mean()
        loss.backward()
        return loss
    for _ in range(3):
        descent.step(off)
    # To single precision, in which the image is.
    assert np.allclose(b.detach(), scene["water.scattering.b"], rtol=1e-3)
