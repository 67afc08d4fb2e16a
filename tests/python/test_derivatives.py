"""Derivatives of shots, and fits."""

from __future__ import annotations

import carom
import numpy as np
import pytest
from conftest import SOURCE

DRAW = SOURCE / "scenes/draw.toml"


def moved(key: str, by: float) -> carom.Record:
    text = carom.Scene.load(DRAW).to_dict()
    text["cue"][key] += by
    return carom.simulate(carom.Scene.from_dict(text))


def test_the_jacobian_matches_differences():
    record = carom.simulate(DRAW)
    times = np.array([0.1, 1.0])
    slopes = record.jacobian(["cue.speed", "cue.aim_deg"], times)
    assert slopes.shape == (2, 2, 3, 3, 2)
    for k, key in enumerate(("speed", "aim_deg")):
        by = 1e-5
        expected = (moved(key, by).states(times) - moved(key, -by).states(times)) / (2 * by)
        np.testing.assert_allclose(slopes[..., k][:, 0], expected[:, 0], rtol=1e-4, atol=1e-3)
    end = record.jacobian(["cue.speed"])
    assert end.shape == (2, 3, 3, 1)
    assert (end[1] == 0).all()  # it has fallen


def test_columns_without_derivatives_are_refused():
    resting = carom.simulate(SOURCE / "scenes/snooker_break.toml")
    assert np.isfinite(resting.jacobian(["cue.speed"])).all()
    # It rolls from the stroke on, and slides with any side.
    with pytest.raises(ValueError, match="cue.offset.side has no derivative here"):
        carom.simulate(SOURCE / "scenes/follow.toml").jacobian(["cue.offset.side"])
    with pytest.raises(ValueError, match="cue.spede"):
        carom.simulate(DRAW).jacobian(["cue.spede"])


def test_a_fit_recovers_the_numbers_of_the_tracks():
    truth = carom.Scene.load(DRAW)
    guess = truth.to_dict()
    guess["cue"]["speed"] = 2.24
    guess.setdefault("balls", {})["mu_s"] = 0.204
    t = np.arange(0, 1.5, 0.02)
    xy = carom.simulate(truth).states(t)[:, 0, 0, :2]
    xy[10] = np.nan
    found = carom.fit(carom.Scene.from_dict(guess), t, ["cue"] * len(t), xy, vary=["balls.mu_s", "cue.speed"])
    assert found.success, found.message
    np.testing.assert_allclose(found.x, [0.2, 2.25], rtol=1e-6)
    assert np.isnan(found.fun[10]).all() and np.nanmax(abs(found.fun)) < 1e-7
    assert found.cov.shape == (2, 2) and found.std.shape == (2,)
    assert found.scene["cue.speed"] == found.x[1] and found.points == len(t) - 1
    with pytest.warns(UserWarning, match="balls.e_c has no effect on the tracked positions"):
        carom.fit(truth, t[:5], ["cue"] * 5, xy[:5], vary=["balls.e_c"])
    with pytest.raises(ValueError, match="no ball 'blue'"):
        carom.fit(truth, [0.1], ["blue"], [[1.0, 1.0]], vary=["balls.mu_s"])
