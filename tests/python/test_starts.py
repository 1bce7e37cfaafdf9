# ctest labels: unit slow
"""What docs/starts.md tells newcomers to type, typed in."""

import os
import pathlib
import re
import subprocess

import pytest

from conftest import PROGRAM, ROOT

TEXT = (ROOT / "docs/starts.md").read_text()
BLOCKS = re.findall(r"^## An? (.*?):.*?```sh\n(.*?)```", TEXT, re.DOTALL | re.MULTILINE)
# Quicker than what is written there: a hundredth of the pixels, and less of what is many.
SMALLER = {"480x270": "48x27", "320x240": "32x24", "[24, 14]": "[6, 4]", "20-22": "20-21",
           "-1.5:-0.1:0.2": "-1.5:-0.1:1.4"}


@pytest.mark.parametrize("who, commands", BLOCKS, ids=[who for who, _ in BLOCKS])
def test_commands_work_as_written(who, commands, tmp_path):
    (tmp_path / "assets").symlink_to(ROOT / "assets")
    folder = pathlib.Path(PROGRAM).parent
    for long, short in SMALLER.items():
        commands = commands.replace(long, short)
    done = subprocess.run(["sh", "-euc", commands], cwd=tmp_path, capture_output=True, text=True,
                          env={**os.environ, "PATH": f"{folder}:{os.environ['PATH']}"})
    assert done.returncode == 0, done.stderr
    made = re.findall(r"(?:-o|--svg|>) (\S+)", commands)
    assert made and all((tmp_path / name).exists() for name in made)


def test_all_four_are_there():
    assert [who for who, _ in BLOCKS] == ["researcher", "artist", "robot engineer", "teacher"]
