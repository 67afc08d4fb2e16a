"""The teaching scripts run, draw, and check their own expectations, and these checks can fail.

CAROM_PICTURES=FOLDER keeps the pictures in that folder.
"""

from __future__ import annotations

import copy
import os
import pathlib

import carom
import numpy as np
import pytest
from conftest import SOURCE

SCRIPTS = sorted((SOURCE / "examples/teaching").glob("*.py"))
# For each script a change that breaks its physics; one of its checks must detect it.
WRONG = {
    "aim_by_gradient": ("-np.linalg.pinv(slopes)", "-0.9 * np.linalg.pinv(slopes)"),
    "accuracy_and_margin": ("abs(order - 1)", "abs(order - 2)"),
    "cushions": ("(1 + E_C) * v[:, 0] * cosine", "(1 + E_C) * v[:, 0]"),
    "draw_and_follow": ("(1 - E_B) / 2 * v, rw", "(1 + E_B) / 2 * v, rw"),
    "thirty_degrees": ("+ 2 / 7", "+ 2 / 5"),
    "throw": ("2 / (1 + E_B) / 7", "1 / 7"),
}


def run(name, source, folder=None):
    """Runs a script cell by cell, as a notebook does; keeps the pictures in the folder. Returns the number of
    colours in each picture."""
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    from matplotlib import pyplot

    pictures = []

    def show():
        for number in pyplot.get_fignums():
            figure = pyplot.figure(number)
            if folder is not None:
                figure.savefig(
                    folder / f"teaching_{name}_{len(pictures) + 1}.png", dpi=60, metadata={"Software": None})
            figure.canvas.draw()
            pictures.append(len(np.unique(np.ascontiguousarray(figure.canvas.buffer_rgba()).view(np.uint32))))
        pyplot.close("all")

    kept, pyplot.show = pyplot.show, show
    names: dict[str, object] = {"__name__": "__main__"}
    try:
        for cell in source.split("# %%"):
            exec(compile(cell.removeprefix(" [markdown]"), f"{name}.py", "exec"), names)
            # At the end of a cell, a notebook shows and closes all open figures.
            assert pyplot.get_fignums() == [], f"a picture is not shown in its cell: {cell}"
    finally:
        pyplot.show = kept
        pyplot.close("all")
    return pictures


@pytest.fixture(scope="module", autouse=True)
def accuracy_once():
    """Caches reports per call of `carom.accuracy`, which takes seconds; the correct and the wrong script each
    receive a copy."""
    kept, reports = carom.accuracy, {}

    def accuracy(*arguments, **named):
        key = (*arguments, *sorted(named.items()))
        if key not in reports:
            reports[key] = kept(*arguments, **named)
        return copy.deepcopy(reports[key])

    carom.accuracy = accuracy
    yield
    carom.accuracy = kept


def test_each_script_has_a_wrong_formula():
    assert [path.stem for path in SCRIPTS] == sorted(WRONG)


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda p: p.stem)
def test_a_scripts_expectations_hold(path, capsys):
    folder = pathlib.Path(os.environ["CAROM_PICTURES"]) if "CAROM_PICTURES" in os.environ else None
    source = path.read_text()
    pictures = run(path.stem, source, folder)
    assert len(pictures) == source.count("plt.show()") >= 2 and min(pictures) > 50
    assert capsys.readouterr().out.strip()
    assert source.startswith("# %% [markdown]\n# # ")


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda p: p.stem)
def test_a_wrong_formula_is_detected(path):
    right, wrong = WRONG[path.stem]
    source = path.read_text()
    assert source.count(right) == 1
    with pytest.raises(AssertionError):
        run(path.stem, source.replace(right, wrong))
