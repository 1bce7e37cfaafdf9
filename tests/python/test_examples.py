# ctest labels: unit
"""The examples, small."""

import os
import re
import subprocess
import sys

import pytest

from conftest import ROOT

EXAMPLES = ROOT / "docs/examples/python"


def run_example(name, *arguments, folder):
    return subprocess.run([sys.executable, "-B", EXAMPLES / name, *map(str, arguments)], check=True,
                          capture_output=True, text=True, cwd=folder, env=os.environ).stdout


def test_turbidity_gallery(tmp_path):
    said = run_example("turbidity_gallery.py", "gallery.png", "--size", 16, 12, "--voxels", 16,
                       folder=tmp_path)
    assert said.count("turbidity") == 6
    assert (tmp_path / "gallery.png").read_bytes().startswith(b"\x89PNG")


def test_lamp_sweep(tmp_path):
    said = run_example("lamp_sweep.py", "plot.svg", "--steps", 3, folder=tmp_path)
    rows = [[float(cell) for cell in line.split()] for line in said.splitlines()[1:]]
    assert len(rows) == 3 and (tmp_path / "plot.svg").read_text().startswith("<svg")
    # Contrast falls with distance, and the sooner the nearer the lamp is to the camera.
    for column in (1, 2, 3):
        assert rows[0][column] > rows[1][column] > rows[2][column]
    assert rows[1][1] < rows[1][2] < rows[1][3]


def test_flat_port_calibration(tmp_path):
    said = run_example("flat_port_calibration.py", folder=tmp_path).splitlines()
    focal_length, rms = (float(re.search(rf"{name} (\S+?),? ?(?:k1.*|pixels)$", said[1])[1])
                         for name in ("fx", "RMS"))
    # Refraction makes a pinhole's focal length n times as long, near the axis.
    assert focal_length == pytest.approx(900 * 1.334, rel=0.005)
    assert rms < 0.02  # pixels: where it was made, the model fits
    errors = {float(line.split()[1]): float(line.split()[-2]) for line in said[2:]}
    assert errors[0.2] > errors[0.4] > 5 * errors[0.8] and errors[2] > 5 * errors[0.8]


def test_dataset(tmp_path):
    said = run_example("dataset.py", 2, folder=tmp_path).splitlines()
    assert len(said) == 2 and "'image': (3, 96, 128)" in said[0]


def test_fit_water(tmp_path):
    said = run_example("fit_water.py", "--size", 12, 9, folder=tmp_path)
    rows = re.findall(r"(\S+) \+- (\S+)  \(true (\S+)\)", said)
    assert len(rows) == 7
    for value, error, truth in (map(float, row) for row in rows):
        assert abs(value - truth) < 4 * error and error < 0.5 * truth
    # One each step: by differences each would take eight.
    assert int(said.splitlines()[-1].split()[0]) < 40


def test_fit_plume(tmp_path):
    figure = tmp_path / "plume.png"
    said = run_example("fit_plume.py", "--size", "20x15", "--voxels", 9, "--steps", 20, "--figure",
                       figure, folder=tmp_path)
    pictures, density = map(float, re.search(r"by +(\S+) % of.*by +(\S+) %", said).groups())
    # From a haze, 90 % off, and with the 1 % of noise in the pictures.
    assert pictures < 10 and density < 60
    assert figure.stat().st_size > 10000


def test_restore_texture(tmp_path):
    figure = tmp_path / "floor.png"
    said = run_example("restore_texture.py", "--size", "32x24", "--texels", 24, "--steps", 5,
                       "--figure", figure, folder=tmp_path)
    pictures, texels = map(float, re.search(r"by +(\S+) %, texels in view by +(\S+) %",
                                            said).groups())
    # From an even grey, 50 % off, and with the 1 % of noise in the pictures.
    assert pictures < 3 and texels < 12
    assert figure.stat().st_size > 10000
