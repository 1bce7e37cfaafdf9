# ctest labels: unit
"""What a scene's section `variations` draws."""

import json
import warnings

import numpy as np
import pytest

import uwvdb
from conftest import SCENES, run_program

VARIED = SCENES / "varied.yaml"


def test_variations_are_those_of_the_command_line(tmp_path, renderer):
    run_program("render", VARIED, "-o", tmp_path / "{variation}.exr", "--variations", "3", "--size",
                "12x8", "--quality", "draft", "--layers", "all", "--precision", "float", "--quiet")
    manifest = json.loads((tmp_path / "varied.variations.json").read_text())
    scene = uwvdb.Scene.load(VARIED)
    before = scene.to_dict()
    for number in range(3):
        varied = scene.variation(number)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", uwvdb.SceneWarning)
            image = renderer.render(varied, "all", "draft", size=(12, 8))
        image.save(tmp_path / "ours.exr", precision="float")
        # Pixels and header.
        assert (tmp_path / "ours.exr").read_bytes() == (tmp_path / f"{number:04}.exr").read_bytes()
        listed = manifest["variations"][number]
        assert varied.hash == listed["scene_hash"] != scene.hash
        values = scene.variation_values(number)
        assert values == listed["values"]
        assert all(varied[path] == value for path, value in values.items())
    assert scene.to_dict() == before


def test_variations_can_be_set_and_keep_arrays(scene):
    scene.volumes.add(np.ones((4, 4, 4)), voxel_size=0.2, origin=(-0.4, -0.4, 1),
                      concentration={"small": 1})
    scene["variations"] = {"keys": {"volumes[0].grids.array1.small": {"uniform": [5, 10]},
                                    "lamps.left.intensity": {"choice": [[1, 2, 3], 20]}}}
    values = scene.variation_values(1)
    assert list(values) == ["volumes[0].grids.array1.small", "lamps.left.intensity"]
    assert 5 <= values["volumes[0].grids.array1.small"] <= 10
    assert values["lamps.left.intensity"] in ([1, 2, 3], 20)
    by_hand = scene.copy()
    by_hand.update(values)
    of_variation = [uwvdb.Renderer().render(each, "all").pixels
                    for each in (scene.variation(1), by_hand, scene)]
    assert np.array_equal(of_variation[0], of_variation[1], equal_nan=True)
    assert not np.array_equal(of_variation[0], of_variation[2], equal_nan=True)
    # A variation has the variations of its scene, and can be changed like any other.
    assert scene.variation(1).variation_values(0) == scene.variation_values(0)
    changed = scene.variation(1)
    changed["lamps.left.intensity"] = 3
    assert scene.variation(1)["lamps.left.intensity"] == values["lamps.left.intensity"]


def test_what_is_no_variation(scene):
    for ask in (scene.variation, scene.variation_values):
        with pytest.raises(uwvdb.UsageError, match="has no variations; set them, such as"):
            ask(0)
    scene["variations"] = {"keys": {"lamps.left.intensty": {"uniform": [1, 2]}}}
    with pytest.raises(uwvdb.UsageError, match="expected a whole number of 0 or more, found -1"):
        scene.variation(-1)
    with pytest.raises(uwvdb.InputError, match="variation 0: lamps.left.intensty.*did you mean"):
        scene.variation(0)
    with pytest.raises(uwvdb.InputError, match="uniform"):
        scene["variations"] = {"keys": {"lamps.left.intensity": {"uniform": [2, 1]}}}
