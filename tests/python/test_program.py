"""The program's reports as data. C++ tests check the measurements; these check that they arrive."""

from __future__ import annotations

import json
import subprocess
import sys

import carom
import numpy as np
import pytest
from conftest import SOURCE, carom_program


def test_margin_is_a_dict_of_arrays(draw_scene):
    report = carom.margin(draw_scene, runs=2, fps=30, render=False)
    frames = report["frames"]
    assert frames == 1 + int(carom.simulate(draw_scene).duration * 30)
    assert report["runs"]["count"] == 2 and report["budget_ms"] == 1000 / 30
    table = report["table"]
    assert all(len(values) == frames for values in table.values())
    assert (table["time"] == np.arange(frames) / 30).all()
    assert table["simulate_ms"].max() == pytest.approx(report["stages"]["simulate"]["max"])
    for bad in (dict(fps=-1), dict(size=(0, 1))):
        with pytest.raises(ValueError, match="--fps|--size"):
            carom.margin(draw_scene, **bad)


def test_accuracy_has_a_row_for_every_setting(draw_scene):
    report = carom.accuracy(draw_scene, march=[100], tolerances=[1e-3, 1e-6], runs=1, target=0.01)
    rows = {(row["method"], row["setting"]): row for row in report["rows"]}
    assert rows.keys() >= {("march", "N=100"), ("tolerance", "0.001"), ("tolerance", "1e-06")}
    assert all(row["ns"] > 0 for row in rows.values())
    assert report["gain"] > 0
    with pytest.raises(ValueError, match="--target"):
        carom.accuracy(draw_scene, target=-1.0)


def test_the_command_runs_the_program():
    done = subprocess.run([sys.executable, "-c", "from carom._program import main; main()", "--version"],
                          capture_output=True, text=True, check=True)
    assert carom.__version__ in done.stdout


def test_sensitivity_matches_the_program(draw_scene):
    report = carom.sensitivity(draw_scene, shots=20, seed=3)
    assert report == json.loads(carom_program(
        "sensitivity", SOURCE / "scenes/draw.toml", "--shots", 20, "--seed", 3, "--json"))
    assert {row["input"] for row in report["inputs"]} >= {"cue.aim_deg", "cue.speed"}
    with pytest.raises(ValueError, match="--hand"):
        carom.sensitivity(draw_scene, hand="aim=x")
