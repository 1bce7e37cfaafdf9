# ctest labels: unit
"""Scenes of version 1 as they were when it was first released: they are read, and mean, what they did
then (docs/stability.md). Never change them, nor their numbers but for what the changelog lists under
*Changes pixels*; a new major version adds a folder."""

import json
import warnings

import numpy as np
import pytest

import uwvdb
from conftest import ROOT

FOLDER = ROOT / "tests/data/version-1"
NUMBERS = json.loads((FOLDER / "numbers.json").read_text())


def numbers_of(scene):
    """What an image of a few pixels says of keys, units and defaults: radiance and distances."""
    camera = 0 if scene.cameras else None
    frame = scene.frames[0] if scene.frames else None
    # Light scattered once has no noise: what all light is, other tests say.
    scene.update({"render.scattering": "single", "render.samples": 1})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", uwvdb.SceneWarning)
        image = uwvdb.Renderer().render(scene, ["total", "depth", "backscatter"], size=(24, 16),
                                        frame=frame, camera=camera)
    depth = image["depth"]
    return {"lamps": scene.lamps, "bands": list(scene.bands),
            "total": image["total"].mean(axis=(0, 1), dtype=float).tolist(),
            "backscatter": image["backscatter"].mean(axis=(0, 1), dtype=float).tolist(),
            "depth": float(np.median(depth[np.isfinite(depth)]))}


def test_every_scene_has_numbers():
    assert sorted(NUMBERS) == sorted(file.stem for file in FOLDER.glob("*.yaml"))


@pytest.mark.parametrize("name", NUMBERS)
def test_is_read_and_means_the_same(name):
    found, kept = numbers_of(uwvdb.Scene.load(FOLDER / f"{name}.yaml")), NUMBERS[name]
    assert found["lamps"] == kept["lamps"] and found["bands"] == kept["bands"]
    # Images may change within the errors that validation states.
    for what, tolerance in (("total", 0.02), ("backscatter", 0.02), ("depth", 1e-3)):
        np.testing.assert_allclose(found[what], kept[what], rtol=tolerance, err_msg=what)
