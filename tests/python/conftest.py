"""What the tests of the Python package share."""

import os
import pathlib
import subprocess
import warnings

import pytest

import uwvdb

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENES = ROOT / "assets/scenes"
PROGRAM = os.environ["UWVDB_PROGRAM"]

# A lamp beside the camera, before a wall: rendered in milliseconds.
SECTIONS = {
    "camera": {"resolution": [12, 8], "intrinsics": {"fov_x": 50}},
    "water": {"bands": [620, 540, 450], "preset": "jerlov-II"},
    "geometry": [{"type": "plane", "point": [0, 0, 3], "normal": [0, 0, -1], "reflectance": 0.5}],
    "lamps": [{"name": "left", "position": [-0.5, 0, 0], "direction": [0.1, 0, 1],
               "intensity": [50, 50, 50]},
              {"name": "right", "position": [0.5, 0.1, 0], "direction": [0, 0, 1],
               "intensity": [20, 30, 40]}],
}

# How to render what takes seconds on any machine if nothing ends it.
LONG = dict(integrator="path", samples=60000, size=(480, 320))


@pytest.fixture
def scene():
    return uwvdb.Scene(**SECTIONS)


@pytest.fixture
def renderer():
    return uwvdb.Renderer(threads=2)


def run_program(*arguments, **options):
    """What `uwvdb` prints; it has to succeed."""
    return subprocess.run([PROGRAM, *map(str, arguments)], check=True, capture_output=True,
                          text=True, **options).stdout


def expect_same_file(file, renderer, folder):
    """A scene rendered here, and by the command line: the same bytes, pixels and header."""
    scene = uwvdb.Scene.load(file)
    choice = ["--camera", scene.cameras[0]] if scene.cameras else []
    ours, theirs = folder / "ours.exr", folder / "theirs.exr"
    run_program("render", file, "-o", theirs, "--size", "12x8", "--quality", "draft", "--layers",
                "all", "--precision", "float", "--threads", "1", "--quiet", *choice)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", uwvdb.SceneWarning)
        image = renderer.render(scene, "all", "draft", size=(12, 8),
                                camera=scene.cameras[0] if scene.cameras else None)
    image.save(ours, precision="float")
    if scene.cameras:
        theirs = theirs.with_name(f"theirs.{scene.cameras[0]}.exr")
    assert ours.read_bytes() == theirs.read_bytes()
