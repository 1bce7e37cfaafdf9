# ctest labels: unit
"""What docs/python.md shows, done line by line."""

import ast
import importlib.util
import re
import shutil
import warnings

import numpy as np
import pytest

import uwvdb
from conftest import ROOT, SCENES

TEXT = (ROOT / "docs/python.md").read_text()
# Quicker than what is written there: a tenth of the resolution, and less of what is many.
SMALLER = {"[640, 480]": "[64, 48]", "range(1000)": "range(2)",
           "sequence(dive)": "sequence(dive, range(2))"}


@pytest.fixture(scope="module")
def shown(tmp_path_factory):
    """The folder that the page's code has run in, and of each expression its source, its value and
    what a comment says of that."""
    folder = tmp_path_factory.mktemp("docs")
    shutil.copy(ROOT / "assets/grids/plume128_blosc_half_0030.vdb", folder / "smoke.vdb")
    rig, dive = (uwvdb.Scene.load(SCENES / name) for name in ("stereo.yaml", "dive.yaml"))
    rig.update({f"cameras.{name}.resolution": [32, 18] for name in rig.cameras})
    dive["camera.resolution"] = [32, 18]
    names = {"rig": rig, "dive": dive, "points": np.array([[0, 0, 2.0]]),
             "seen": np.float32(1e-3)}
    expressions = []
    blocks = re.findall(r"```python\n(.*?)```", TEXT, re.DOTALL)
    with pytest.MonkeyPatch.context() as patch, warnings.catch_warnings():
        patch.chdir(folder)
        warnings.simplefilter("ignore", uwvdb.SceneWarning)
        for block in blocks:
            if "import torch" in block and not importlib.util.find_spec("torch"):
                continue  # it is not among what uwvdb needs
            for long, short in SMALLER.items():
                block = block.replace(long, short)
            for statement in ast.parse(block).body:
                source = ast.get_source_segment(block, statement)
                if not isinstance(statement, ast.Expr):
                    exec(source, names)
                    continue
                line = block.splitlines()[statement.end_lineno - 1]
                comment = line[statement.end_col_offset:].partition("# ")[2]
                expressions.append((source, eval(source, names), comment))
    return folder, expressions


def test_arrays_are_what_comments_say(shown):
    checked = 0
    for source, value, comment in shown[1]:
        if not (stated := re.match(r"(float32|uint8) \((480), (640)(, 3)?\)", comment)):
            continue
        assert value.dtype == stated[1], source
        assert value.shape == ((48, 64, 3) if stated[4] else (48, 64)), source
        checked += 1
    assert checked == 3


def test_values_are_what_comments_say(shown):
    values = {source: (value, comment) for source, value, comment in shown[1]}
    intensity, comment = values['scene["lamps.left.intensity"]']
    assert comment.startswith(str(intensity))
    drawn, comment = values["scene.variation_values(17)"]
    path, value = next(iter(drawn.items()))
    assert comment.startswith(f'{{"{path}": {value:.3f}...'), drawn
    assert set(drawn) == {"lamps.left.intensity", "water.particles.large"}


def test_images_are_saved(shown):
    assert (shown[0] / "image.exr").stat().st_size > 0


def test_the_error_is_what_is_shown():
    path, error, message = re.search(
        r'>>> scene\["(.*?)"\] = 3\nuwvdb\.errors\.(\w+): (.*)', TEXT).groups()
    lamp = {"name": "left", "position": [0, 0, 0], "direction": [0, 0, 1], "intensity": 1}
    scene = uwvdb.Scene(camera={"resolution": [4, 4], "intrinsics": {"fov_x": 50}}, lamps=[lamp])
    with pytest.raises(getattr(uwvdb, error)) as caught:
        scene[path] = 3
    assert str(caught.value) == message
