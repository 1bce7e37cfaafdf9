# ctest labels: slow
"""What takes long: validation, memory, speed, the stubs, a wheel."""

import gc
import os
import pathlib
import pickle
import subprocess
import sys
import time

import numpy as np
import pytest

import uwvdb
from conftest import ROOT, SCENES, expect_same_file

BUILD = pathlib.Path(os.environ["UWVDB_BUILD"])


EXAMPLES = sorted(path.relative_to(SCENES).with_suffix("").as_posix()
                  for path in SCENES.rglob("*.yaml")
                  if path.stem != "houdini")  # which is for a file of its user's


@pytest.mark.parametrize("name", EXAMPLES)
def test_files_are_those_of_the_command_line(tmp_path, renderer, name):
    expect_same_file(SCENES / f"{name}.yaml", renderer, tmp_path)


def test_validation(scene):
    scene["camera.resolution"] = [6, 4]
    scene["lamps"] = scene["lamps"][:1]
    result = uwvdb.validate(scene)
    assert result and result.passed and {check.band for check in result.checks} == {620, 540, 450}
    assert not uwvdb.validate(scene, tolerance=1e-12)


def test_notebooks_run_in_jupyter(tmp_path):
    subprocess.run([ROOT / "scripts/notebooks", BUILD, tmp_path], check=True)
    assert sorted(file.name for file in tmp_path.glob("*.ipynb")) == sorted(
        file.name for file in (ROOT / "docs/examples/notebooks").glob("*.ipynb"))


def resident_bytes():
    return int(pathlib.Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGESIZE")


def test_ten_thousand_renders_leak_nothing(scene):
    scene["camera.resolution"] = [4, 3]
    scene["render"] = {"samples": 1}
    renderer = uwvdb.Renderer(threads=1)
    kept = renderer.render(scene)["depth"]

    def run(count):
        for number in range(count):
            scene["lamps.left.intensity[0]"] = number
            renderer.render(scene)["total"]
        gc.collect()
        return resident_bytes()
    warm = run(500)
    grown = run(10000) - warm
    print(f"grown by {grown / 1e6:.2f} MB")
    # 100 bytes lost per render would be 1 MB; the heap itself breathes by less than two.
    assert grown < 2e6
    assert kept.shape == (3, 4)


def test_arrays_leak_nothing(scene):
    array = np.random.default_rng(4).uniform(0, 1, (64, 64, 64))

    def run(count):
        for _ in range(count):
            changed = pickle.loads(pickle.dumps(scene))
            changed.volumes.add(array, voxel_size=0.1, concentration={"small": 1})
            pickle.loads(pickle.dumps(changed))
        gc.collect()
        return resident_bytes()
    warm = run(30)
    # Each time is 1 MB of voxels, three times.
    assert run(200) - warm < 10e6


def least_seconds(action, times):
    """CPU seconds of this thread's process: other processes do not count."""
    def once():
        begin = time.process_time()
        action()
        return time.process_time() - begin
    return min(once() for _ in range(times))


def sorting_seconds():
    """What sorting a million numbers takes, 0.085 CPU s where 0.3 s and the rest were promised:
    figures are ratios to it, so that they hold on slower and on busy machines."""
    numbers = np.random.default_rng(0).uniform(0, 1, 1 << 20)
    return least_seconds(lambda: np.sort(numbers), 5)


def test_a_volume_of_256_cubed_is_made_in_a_fraction_of_a_second(scene):
    array = np.random.default_rng(5).uniform(0, 1, (256, 256, 256)).astype(np.float32)
    seconds = least_seconds(lambda: scene.copy().volumes.add(
        array, voxel_size=0.01, concentration={"small": 1}), 3)
    print(f"256^3: {seconds:.3f} CPU s")
    # Promised are 0.3 s on two processors.
    assert seconds < 7 * sorting_seconds()


def test_small_images_by_the_hundred_per_second(scene):
    scene["camera.resolution"] = [64, 64]
    scene["render"] = {"samples": 1}
    renderer = uwvdb.Renderer(threads=2)

    def render():
        for number in range(50):
            scene["lamps.left.intensity[0]"] = 10 + number
            renderer.render(scene)
    seconds = least_seconds(render, 3) / 50
    print(f"64 x 64: {1 / seconds:.0f} per CPU second")
    # Promised are 100 per second on two processors.
    assert seconds < 0.23 * sorting_seconds()


def test_calls_cost_little(scene):
    scene.update({"camera.resolution": [1, 1], "render": {"samples": 1}})
    renderer = uwvdb.Renderer(threads=1)
    image = renderer.render(scene, quality="draft")

    def render():
        for _ in range(100):
            renderer.render(scene, quality="draft")

    def change():
        for number in range(100):
            scene["lamps.left.intensity[0]"] = number

    def view():
        for _ in range(100):
            image["depth"]
    seconds = [least_seconds(action, 5) / 100 for action in (render, change, view)]
    print("render {:.3f} ms, set {:.3f} ms, view {:.4f} ms".format(*(1e3 * s for s in seconds)))
    # Promised is 1 ms beside the rendering; here that is one pixel's.
    assert sum(seconds) < 0.0117 * sorting_seconds()


def test_stubs():
    run = subprocess.run(
        ["/usr/bin/mypy", "--strict", "--python-executable", sys.executable, "--cache-dir",
         os.devnull, str(ROOT / "python/uwvdb")], capture_output=True, text=True)
    assert run.returncode == 0, run.stdout


def test_stubs_name_what_there_is():
    stub = (ROOT / "python/uwvdb/_uwvdb.pyi").read_text()
    for name in ("Scene", "Image", "Renderer", "Camera", "Water"):
        part = stub.split(f"class {name}:")[1].split("\nclass ")[0]
        members = {name for name in vars(getattr(uwvdb._uwvdb, name)) if not name.startswith("_")}
        stated = {line.split("def ")[1].split("(")[0] for line in part.splitlines()
                  if line.startswith("    def ") and "__init__" not in line}
        assert members == stated, name


def test_pip_installs_it(tmp_path):
    python = tmp_path / "venv/bin/python"
    subprocess.run([sys.executable, "-m", "venv", "--system-site-packages", tmp_path / "venv"],
                   check=True)
    # Quicker than a build of its own: the folder that this test belongs to.
    subprocess.run([python, "-m", "pip", "install", ROOT, "--no-build-isolation", "--no-index",
                    "--config-settings", f"build-dir={BUILD}"], check=True, cwd=tmp_path)
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    found = subprocess.run(
        [python, "-c", "import uwvdb; print(uwvdb.__file__, uwvdb.Water('jerlov-II').absorption)"],
        check=True, capture_output=True, text=True, env=environment, cwd=tmp_path).stdout
    assert found.startswith(str(tmp_path / "venv"))
    installed = tmp_path.glob("venv/lib/python*/site-packages/uwvdb/py.typed")
    assert list(installed)
