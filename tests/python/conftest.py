"""What the tests of the Python package share."""

import os
import pathlib
import subprocess

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
