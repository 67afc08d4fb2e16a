"""The example that learns against a level: what its learner does, and one round."""

from __future__ import annotations

import runpy

import carom
import numpy as np
import pytest
from conftest import SOURCE

pytest.importorskip("pettingzoo")
from carom import gym  # noqa: E402  (needs gymnasium)


@pytest.fixture(scope="module")
def example():
    return runpy.run_path(str(SOURCE / "examples/learning/opponent.py"))


def test_the_learner_pots_a_ball_that_hangs(example):
    xy = np.array([[0.6, 0.8], [0.15, 0.14]])
    legal = np.array([0, 1])
    seen = {"phase": 0, "legal": legal, "balls": np.column_stack((xy / example["HALF"] - 1, [1, 1]))}
    action = example["act"](seen, np.array([1.0, 1.0, 0.0, 0.0, -0.6, 0.0, 0.0, 0.0]))
    strikes = gym.Strikes("ball", (0.3, 8.0))
    speed, aim, *_ = strikes.cue(action[None], xy[None], 0, legal[None] > 0, np.full(2, 0.028575))[0]
    balls = [{"id": "cue", "position": xy[0].tolist()}, {"id": "3", "position": xy[1].tolist()}]
    scene = carom.Scene(table="nine_foot", balls="pool", ball=balls, cue={"speed": speed, "aim_deg": aim})
    events = carom.simulate(scene).event_list()
    assert ("ball_pocket", "3") in [(event.type, event.a) for event in events]


def test_a_round_is_learned_and_told(example, capsys):
    example["learn"].__globals__["CANDIDATES"] = 3
    example["main"](["--rounds", "1", "--test", "1"])
    said = capsys.readouterr().out.splitlines()
    assert said[0].startswith("round 1: score ") and said[1].startswith("won against beginner: ")
