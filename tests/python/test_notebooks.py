# ctest labels: unit
"""The notebooks' code, smaller and without Jupyter; test_slow.py runs them whole."""

import json

import matplotlib
import numpy as np
import pytest

from conftest import ROOT

FOLDER = ROOT / "docs/examples/notebooks"
NOTEBOOKS = sorted(file.stem for file in FOLDER.glob("*.ipynb"))
# Quicker than what is written there.
SMALLER = {"[240, 160]": "[24, 16]", "[240, 135]": "[24, 14]", "(32, 24)": "(12, 9)",
           "np.linspace(0.05, 2, 14)": "np.linspace(0.05, 2, 4)"}


def code_of(notebook):
    cells = json.loads((FOLDER / f"{notebook}.ipynb").read_text())["cells"]
    return [cell for cell in cells if cell["cell_type"] == "code"]


@pytest.fixture(scope="module")
def names(request):
    """What the code of a notebook has defined in the end."""
    matplotlib.use("Agg")
    result = {}
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(FOLDER)
        for cell in code_of(request.param):
            source = "".join(cell["source"])
            for long, short in SMALLER.items():
                source = source.replace(long, short)
            exec(source, result)
    return result


@pytest.mark.parametrize("names", ["water"], indirect=True)
def test_the_muddier_the_more_of_the_light_is_veil(names):
    fractions = [float((image["backscatter"] / image["total"]).mean())
              for image in names["images"].values()]
    assert len(fractions) == 4 and fractions == sorted(fractions)


@pytest.mark.parametrize("names", ["lamps"], indirect=True)
def test_a_mixture_is_a_rendering(names):
    np.testing.assert_allclose(names["mixed"], names["rendered"],
                               atol=2e-3 * names["rendered"].max())
    ratio = names["signal"] / names["veil"]
    assert np.all(np.diff(ratio) > 0) and ratio[-1] > 10 * ratio[0]


@pytest.mark.parametrize("names", ["fitting"], indirect=True)
def test_the_fit_finds_the_truth(names):
    truth = np.concatenate(list(names["truth"].values()))
    found, errors = np.exp(names["result"].x), names["errors"]
    assert np.all(np.abs(found - truth) < 4 * errors * truth) and np.all(errors < 0.2)


@pytest.mark.parametrize("notebook", NOTEBOOKS)
def test_what_is_stored_is_of_one_run(notebook):
    cells = code_of(notebook)
    assert [cell["execution_count"] for cell in cells] == list(range(1, len(cells) + 1))
    outputs = [output for cell in cells for output in cell["outputs"]]
    assert not any(output["output_type"] == "error" for output in outputs)
    assert any("image/png" in output.get("data", {}) for output in outputs)


def test_each_notebook_has_a_test():
    assert NOTEBOOKS == ["fitting", "lamps", "water"]
