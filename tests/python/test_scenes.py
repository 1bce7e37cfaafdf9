# ctest labels: unit
"""Scenes as objects: values at paths, checks, messages."""

import enum
import itertools
import pathlib
import subprocess

import numpy as np
import pytest

import uwvdb
from conftest import PROGRAM, SCENES, SECTIONS

TEXT = """\
uwvdb: 1
camera: {resolution: [12, 8], intrinsics: {fov_x: 50}}
water: {preset: jerlov-II}
lamps:
  - {name: left, position: [-0.5, 0, 0], direction: [0, 0, 1], intensity: [50, 40, 30.5]}
"""


def test_reads_values_as_they_are_written():
    scene = uwvdb.Scene.parse(TEXT)
    assert scene["lamps.left.intensity"] == [50, 40, 30.5]
    assert scene["lamps[0].position[0]"] == -0.5
    assert scene["water"] == {"preset": "jerlov-II"}
    assert isinstance(scene["camera.resolution[0]"], int)
    assert scene.lamps == ["left"] and scene.cameras == [] and scene.bands == [620, 540, 450]
    assert "water.preset" in scene and "water.bands" not in scene
    assert scene.get("water.bands", 3) == 3
    with pytest.raises(KeyError, match="water.bands: is not in the scene"):
        scene["water.bands"]


class Practical(float):
    """A number that, like NumPy's, does not show itself as one."""

    def __repr__(self):
        return f"Practical({float(self)})"


def test_stars_stand_for_every_entry_and_quotes_hold_names():
    lamp = {"position": [0, 0, 0], "intensity": 1}
    scene = uwvdb.Scene(**{**SECTIONS, "lamps": [{"name": "front", **lamp}, lamp]})
    scene["lamps.*.intensity"] = 7
    assert [scene[f"lamps[{i}].intensity"] for i in range(2)] == [7, 7]
    scene["lamps.'front'.intensity"] = 8
    assert [scene[f"lamps[{i}].intensity"] for i in range(2)] == [8, 7]
    with pytest.raises(uwvdb.InputError, match="nothing of that kind"):
        scene["cameras.*.name"] = "a"
    with pytest.raises(KeyError):
        scene["lamps.*.intensity"]


def test_sets_values_of_every_kind_of_python():
    scene = uwvdb.Scene.parse(TEXT)
    scene["lamps.left.intensity"] = np.array([1, 2, 3], dtype=np.float32)
    assert scene["lamps.left.intensity"] == [1, 2, 3]
    scene["lamps.left.intensity"] = (np.float64(0.1), 2, 3e-9)
    assert scene["lamps.left.intensity"] == [0.1, 2, 3e-9]
    scene["water.particles"] = {"small": 1, "large": np.int64(2)}
    assert scene["water.particles.large"] == 2
    scene["water.bands"] = range(450, 651, 100)
    assert scene.bands == [450, 550, 650]
    scene["camera.port"] = {"type": "flat", "distance": 0.02, "thickness": 0.01, "fresnel": True}
    assert scene["camera.port.fresnel"] is True
    del scene["camera.port"]
    assert "camera.port" not in scene
    with pytest.raises(KeyError):
        del scene["camera.port"]
    scene["water.salinity"] = Practical(30)
    scene["camera.resolution"] = [enum.IntEnum("Size", "small")(1), 8]
    assert scene["water.salinity"] == 30 and scene["camera.resolution"] == [1, 8]
    with pytest.raises(TypeError, match="paths of a scene are str, found 3"):
        scene.update({3: 4})
    with pytest.raises(TypeError, match="numbers, text, lists and dicts"):
        scene["water.salinity"] = object()


def test_sections_are_the_same_as_text():
    made = uwvdb.Scene(**SECTIONS)
    assert made["lamps.right.intensity"] == [20, 30, 40]
    assert made.to_dict() == {"uwvdb": 1, **SECTIONS}


def test_files_are_relative_to_the_folder(tmp_path):
    (tmp_path / "data").mkdir()
    (tmp_path / "data/mesh.obj").write_text("v 0 0 3\nv 1 0 3\nv 0 1 3\nf 1 2 3\n")
    sections = {**SECTIONS, "geometry": [{"file": pathlib.Path("mesh.obj")}]}
    uwvdb.Scene(**sections, folder=tmp_path / "data")
    with pytest.raises(uwvdb.InputError, match="no such file 'mesh.obj'"):
        uwvdb.Scene(**sections, folder=tmp_path)


def test_errors_say_where_and_how_to_mend():
    with pytest.raises(uwvdb.InputError) as caught:
        uwvdb.Scene.parse(TEXT.replace("intensity", "intensty"), file="folder/plume.yaml")
    error = caught.value
    assert str(error).startswith("folder/plume.yaml:5:")
    assert (error.file, error.line, error.key) == ("folder/plume.yaml", 5, "lamps[0].intensty")
    assert error.column == TEXT.splitlines()[4].index("intensity") + 1
    assert "did you mean 'intensity'" in error.mend
    assert isinstance(error, ValueError)

    scene = uwvdb.Scene.parse(TEXT)
    with pytest.raises(uwvdb.InputError) as caught:
        scene["lamps.left.intensity"] = [1, 2]
    error = caught.value
    assert (error.file, error.line, error.key) == (None, None, "lamps[0].intensity")
    assert error.mend == "give one value per band, or a single number for all of them"

    with pytest.raises(uwvdb.IoError, match="nowhere.yaml"):
        uwvdb.Scene.load("nowhere.yaml")
    with pytest.raises(uwvdb.UsageError, match="not of the form key.path=value"):
        scene["lamps..x"] = 1


def test_a_scene_is_valid_at_all_times():
    scene = uwvdb.Scene.parse(TEXT)
    before = scene.to_dict()
    for path, value in (("lamps.left.intensity", -1), ("lamps.middle.intensity", 1),
                        ("lamps[1].intensity", 1), ("water.presett", "jerlov-II"),
                        ("water.bands", [500, 600])):
        with pytest.raises(uwvdb.InputError):
            scene[path] = value
        assert scene.to_dict() == before
    with pytest.raises(uwvdb.InputError):
        del scene["camera"]
    # Together they are valid.
    scene.update({"water.bands": [500, 600], "lamps.left.intensity": [1, 2]})
    assert scene["lamps.left.intensity"] == [1, 2]


@pytest.mark.parametrize("path, yaml, value", [
    ("lamps[0].intensity", "[1, 2]", [1, 2]),
    ("lamps[0].position", "[1, 2, x]", [1, 2, "x"]),
    ("lamps[7].power", "3", 3),
    ("lamps.middle.power", "3", 3),
    ("camera.resolution", "[0, 8]", [0, 8]),
    ("water.salinty", "35", 35),
    ("water.bands", "[1]", [1]),
    ("camera.intrinsics.fov_x", "1e999", float("inf")),
    ("lamps[0].name.x", "1", 1),
])
def test_messages_are_those_of_set(tmp_path, path, yaml, value):
    file = tmp_path / "scene.yaml"
    file.write_text(TEXT)
    said = subprocess.run([PROGRAM, "info", str(file), "--set", f"{path}={yaml}"],
                          capture_output=True, text=True)
    assert said.returncode == 3
    message = said.stderr.splitlines()[-1]
    scene = uwvdb.Scene.load(file)
    with pytest.raises(uwvdb.InputError) as caught:
        scene[path] = value
    # What follows the place: "--set path=value" there, "path = value" here.
    expected = message.split(f"--set {path}={yaml}: ")[1]
    found = str(caught.value).split(": ", 1)[1]
    for text in ("'x'", "1e999", "inf"):  # Python's text is text, and it has no 1e999
        expected, found = expected.replace(text, "T"), found.replace(text, "T")
    assert found.replace("quoted text", "text") == expected.replace(
        "too large or too small for a number", "not a finite number")


def nested(levels):
    value = 1
    for _ in range(levels):
        value = [value]
    return value


def within_itself(kind):
    value = kind()
    if kind is list:
        value.append(value)
    else:
        value["x"] = value
    return value


class Endless:
    """What NumPy's arrays are not: a list of itself, or a list without an end."""

    def tolist(self):
        return self


@pytest.mark.parametrize("value, path", [
    (within_itself(list), r"lamps\[0\]\[0\]\[0\]"),
    (within_itself(dict), r"lamps\.x\.x\.x"),
    (nested(100_000), r"lamps\[0\]\[0\]\[0\]"),
    ([{"name": "left", "position": within_itself(list)}], r"lamps\[0\]\.position\[0\]\[0\]"),
    (Endless(), "lamps"),
])
def test_what_contains_itself_is_refused(value, path):
    scene = uwvdb.Scene.parse(TEXT)
    before = scene.to_dict()
    places = [lambda: uwvdb.Scene(**{**SECTIONS, "lamps": value}),
              lambda: scene.update({"lamps": value}),
              lambda: scene.__setitem__("lamps", value)]
    for place in places:
        with pytest.raises(uwvdb.InputError, match=f": {path}.*: nested more than 64 levels deep") \
                as caught:
            place()
        assert "\n" not in str(caught.value) and len(str(caught.value)) < 200
        assert caught.value.key.startswith("lamps") and caught.value.mend
    assert scene.to_dict() == before
    with pytest.raises(uwvdb.InputError, match="Water: water.particles.*: nested more than 64"):
        uwvdb.Water("jerlov-II", particles=value)
    with pytest.raises(uwvdb.InputError, match="volumes.add: transform.*: nested more than 64"):
        scene.volumes.add(np.ones((2, 2, 2)), voxel_size=1, concentration={"small": 1},
                          transform={"scale": value})


def test_as_deep_and_as_long_as_a_file_may_be():
    scene = uwvdb.Scene.parse(TEXT)
    # The map of sections itself is one level. The reader's complaint, not that of the depth.
    with pytest.raises(uwvdb.InputError, match="name: expected"):
        uwvdb.Scene(**{**SECTIONS, "lamps": [{"name": nested(61)}]})
    with pytest.raises(uwvdb.InputError, match="nested more than 64"):
        uwvdb.Scene(**{**SECTIONS, "lamps": [{"name": nested(62)}]})
    for endless in (itertools.count(), range(10**12), np.broadcast_to(1.0, (10**4,) * 3)):
        with pytest.raises(uwvdb.InputError, match="bands.*: more than 200000 values"):
            scene["water.bands"] = endless


def test_paths_without_an_end():
    scene = uwvdb.Scene.parse(TEXT)
    with pytest.raises(uwvdb.Error):
        scene["water." + "a." * 100_000 + "b"] = 1


def test_copies_are_scenes_of_their_own():
    scene = uwvdb.Scene.load(SCENES / "uniform.yaml")
    other = scene.copy()
    other["water.salinity"] = 10
    assert "water.salinity" not in scene or scene["water.salinity"] != 10
    assert scene.hash != other.hash and scene.file == other.file
