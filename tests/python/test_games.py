"""carom.games: the noise of a strike."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import carom_program, rows_of

import carom
from carom import games


def test_noise_has_names_and_is_the_same_for_a_seed():
    assert games.Noise.named("none") == games.Noise()
    assert games.Noise.named("ai3603") == (0.1, 0.1, 0.1, 0.003, 0.003)
    assert games.Noise.named("fastfiz", 0.025)[:3] == (0.075, 0.125, 0.1)
    assert games.Noise.named("fastfiz", 0.025).side == pytest.approx(0.02)
    with pytest.raises(ValueError, match="fastfiz, ai3603"):
        games.Noise.named("human")
    cue = {"speed": 3.0, "aim_deg": 40.0, "ball": "cue"}
    struck = games.noisy(cue, "ai3603", 7, 2)
    assert struck == games.noisy(cue, "ai3603", 7, 2) != games.noisy(cue, "ai3603", 7, 3)
    assert struck["ball"] == "cue" and struck["speed"] != 3.0 and struck["elevation_deg"] >= 0.0
    assert games.noisy({}, "none", 1) == {"speed": 9.0, "aim_deg": 90.0, "elevation_deg": 0.0, "offset": [0.0, 0.1]}
    carom.Scene(ball=[{"id": "cue", "position": [0.5, 0.5]}], cue=struck)
    many = games.noisy(np.tile([3.0, 40.0, 0.0, 0.0, 0.1], (5, 1)), "ai3603", 7)
    assert many[2].tolist() == [struck["speed"], struck["aim_deg"], struck["elevation_deg"], *struck["offset"]]


def test_noise_is_what_a_sweep_draws(tmp_path):
    scene = carom.Scene(ball=[{"id": "cue", "position": [0.5, 0.5]}], cue={"speed": 4.0, "aim_deg": 30.0, "elevation_deg": 9.0, "offset": [0.1, 0.0]})
    (tmp_path / "s.toml").write_text(scene.text())
    rules = ["cue.speed=normal(0.2)", "cue.aim_deg=normal(0.3)", "cue.elevation_deg=normal(0.4)", "cue.offset.side=normal(0.01)", "cue.offset.height=normal(0.02)"]
    carom_program("sweep", tmp_path / "s.toml", *[a for rule in rules for a in ("--vary", rule)], "--count", 20, "--seed", 5, "-o", tmp_path / "s.csv")
    header, *rows = rows_of(tmp_path / "s.csv")
    strikes = games.noisy(np.tile([4.0, 30.0, 9.0, 0.1, 0.0], (20, 1)), games.Noise(0.2, 0.3, 0.4, 0.01, 0.02), 5)
    columns = [header.index(rule.split("=")[0]) for rule in rules]
    assert [[float(row[c]) for c in columns] for row in rows] == strikes.tolist()


def test_a_noisy_strike_is_legal_whatever_it_was():
    random = np.random.default_rng(1)
    wild = games.noisy(random.normal(0.0, 3.0, (2000, 5)), games.Noise(1.0, 500.0, 50.0, 0.3, 0.3), 3)
    assert (wild[:, 0] >= 0.0).all() and (wild[:, 2] >= 0.0).all() and (wild[:, 2] < 90.0).all()
    assert ((wild[:, 3:] ** 2).sum(axis=1) <= 0.25).all() and (wild[:, 0] == 0.0).any()
    for strike in wild[:50]:
        cue = dict(zip(games.STRIKE[:3], strike)) | {"offset": strike[3:]}
        carom.Scene(ball=[{"id": "cue", "position": [0.5, 0.5]}], cue=cue)
    for bad in ([1.0] * 4, np.zeros((2, 2, 5)), [np.nan] * 5):
        with pytest.raises(ValueError):
            games.noisy(bad, "none", 1)
    with pytest.raises(ValueError, match="at least 0"):
        games.noisy({}, games.Noise(speed=-1.0), 1)
