"""Impacts on arrays agree with the program and with the engine's shots."""

from __future__ import annotations

import inspect
import json

import carom
import numpy as np
import pytest
from carom import kernel
from conftest import carom_program

RANDOM = np.random.default_rng(5)
R = 0.028575


def pairs(n):
    """Pairs of touching balls that approach each other."""
    rvw = RANDOM.normal(0, [[0.0], [2.0], [40.0]], (n, 2, 3, 3))
    rvw[:, :, 1, 2] = 0
    angle = RANDOM.uniform(0, 2 * np.pi, n)
    line = np.stack([np.cos(angle), np.sin(angle), 0 * angle], -1)
    rvw[:, 0, 0] = [0.5, 0.5, R]
    rvw[:, 1, 0] = rvw[:, 0, 0] + 2 * R * line
    closing = np.sum((rvw[:, 1, 1] - rvw[:, 0, 1]) * line, -1)
    rvw[:, 0, 1] += np.maximum(closing + 0.5, 0)[:, None] * line
    return rvw


def answers(lines, *options):
    text = "".join(json.dumps(line) + "\n" for line in lines)
    return [json.loads(line) for line in carom_program("impact", *options, text=text).splitlines()]


@pytest.mark.parametrize("model", ["mathavan", "inelastic", "elastic"])
def test_ball_ball_matches_the_program(model):
    n = 70
    rvw, mu_b, e_b = pairs(n), RANDOM.uniform(0, 0.1, n), RANDOM.uniform(0.5, 1, n)
    after = kernel.ball_ball(
        rvw, model=model, tolerance=1e-9, mu_b=mu_b, e_b=e_b, radius=R, mass=0.17, mu_s=0.2)
    lines = []
    for (one, two), mu, e in zip(rvw.tolist(), mu_b, e_b):
        params = {"R": R, "m": 0.17, "mu_s1": 0.2, "mu_s2": 0.2, "mu_b": mu, "e_b": e}
        lines.append({"kind": "ball_ball", "params": params, "r1": one[0], "v1": one[1], "w1": one[2],
                      "r2": two[0], "v2": two[1], "w2": two[2]})
    options = ["--tolerance", "1e-9"] if model == "mathavan" else ["--method", model]
    speed = np.abs(rvw[:, :, 1]).max()
    for i, answer in enumerate(answers(lines, *options)):
        wanted = np.array([[answer["v1"], answer["w1"]], [answer["v2"], answer["w2"]]])
        # Batches and single impacts may differ within the tolerance.
        slack = 2e-9 * 2 * speed if model == "mathavan" else 0
        np.testing.assert_allclose(after[i, :, 1], wanted[:, 0], rtol=0, atol=slack)
        np.testing.assert_allclose(after[i, :, 2], wanted[:, 1], rtol=0, atol=slack / R)
    assert (after[:, :, 0] == rvw[:, :, 0]).all() and (after[:, 0, 1] != rvw[:, 0, 1]).any(axis=-1).all()


@pytest.mark.parametrize("model", ["han_2005", "mathavan_2010", "stronge", "impulse", "smooth"])
def test_ball_cushion_matches_the_program(model):
    n = 20
    rvw = RANDOM.normal(0, [[0.1], [2.0], [40.0]], (n, 3, 3))
    rvw[:, 1, 2] = 0
    angle = RANDOM.uniform(0, 2 * np.pi, n)
    normal = np.stack([np.cos(angle), np.sin(angle)], -1)
    after = kernel.ball_cushion(rvw, normal, model=model)
    params = {"R": R, "m": 0.170097, "mu_s": 0.2, "e_c": 0.85, "f_c": 0.2, "height": 1.28 * R}
    lines = [
        {"kind": "cushion", "model": model, "params": params, "normal": nn, "v": v, "w": w}
        for (_, v, w), nn in zip(rvw.tolist(), normal.tolist())
    ]
    for i, answer in enumerate(answers(lines)):
        assert after[i, 1:].tolist() == [answer["v"], answer["w"]]
    moved = (after[:, 1] != rvw[:, 1]).any(axis=-1)
    assert (moved == (np.sum(rvw[:, 1, :2] * normal, -1) < 0)).all() and moved.any()


def test_shapes_broadcast():
    rvw = pairs(6).reshape(2, 3, 2, 3, 3)
    after = kernel.ball_ball(rvw)
    assert after.shape == rvw.shape
    assert (kernel.ball_ball(rvw, mu_b=np.full(6, 0.05)) == after).all()
    assert (kernel.ball_ball(rvw[0, 0]) == after[0, 0]).all()
    assert kernel.ball_ball(np.empty((0, 2, 3, 3))).shape == (0, 2, 3, 3)
    into = rvw.copy()
    assert kernel.ball_ball(into, out=into) is into and (into == after).all()
    ball = rvw[0, 0, 0]
    assert (kernel.ball_cushion(ball, [1, 0]) == kernel.ball_cushion([ball, ball], [[1, 0], [1, 0]])[1]).all()


def test_defaults_are_pool_classic():
    text = carom.Scene(balls="pool_classic", ball=[{"id": "a"}]).text()
    balls = dict(line.split(" = ") for line in text.splitlines() if " = " in line)
    for function, keys in ((kernel.ball_ball, ("radius", "mass", "mu_s", "mu_b", "e_b")), (
        kernel.ball_cushion, ("radius", "mass", "mu_s", "e_c", "f_c")
    )):
        for key in keys:
            assert inspect.signature(function).parameters[key].default == float(balls[key])


def test_invalid_impacts_are_refused():
    rvw = pairs(3)
    bad = rvw.copy()
    bad[1, 0, 1, 0] = np.nan
    for call, message in [
        (lambda: kernel.ball_ball(bad), "impact 1: "),
        (lambda: kernel.ball_ball(bad, model="elastic"), "impact 1: "),
        (lambda: kernel.ball_ball(rvw[:, 0]), r"rvw: expected the shape \(..., 2, 3, 3\)"),
        (lambda: kernel.ball_ball(rvw, e_b=1.5), "impact 0: "),
        (lambda: kernel.ball_ball(rvw, mu_b=[0.1, 0.2]), "mu_b: 2 numbers for 3 impacts"),
        (lambda: kernel.ball_ball(rvw, tolerance=1.0), "tolerance: expected"),
        (lambda: kernel.ball_ball(rvw, model="march"),
         'no ball-ball model "march"; expected one of mathavan'),
        (lambda: kernel.ball_ball(rvw, out=np.empty(3)), "out: expected"),
        (lambda: kernel.ball_cushion(rvw[:, 0], [1, 1]), "normal: expected vectors of length 1"),
        (lambda: kernel.ball_cushion(rvw[:, 0], [[1, 0], [1, 0]]), "normal: 2 vectors for 3 impacts"),
        (lambda: kernel.ball_cushion(rvw[:, 0], [1, 0], e_c=-1), "e_c: expected numbers from 0 to 1"),
        (lambda: kernel.ball_cushion(rvw[:, 0], [1, 0], height=1), "height: expected"),
        (lambda: kernel.ball_cushion(bad[:, 0], [1, 0]), "rvw: expected finite"),
        (lambda: kernel.ball_cushion(rvw[:, 0], [1, 0], model="rubber"), "no cushion model"),
        (lambda: kernel.ball_cushion(rvw[:, 0], [1, 0], model="mathavan_2010", f_c=1.0, mu_s=1.0),
         "could jam"),
    ]:
        with pytest.raises(ValueError, match=message):
            call()
