"""Shots as functions with derivatives, for NumPy, PyTorch and JAX where they are installed."""

from __future__ import annotations

import runpy
import types

import carom
import numpy as np
import pytest
from conftest import SOURCE

X = np.array([2.25, 135.0, -0.4])


@pytest.fixture(scope="module")
def gradients():
    return types.SimpleNamespace(**runpy.run_path(str(SOURCE / "examples/learning/gradients.py")))


@pytest.fixture(scope="module")
def shot(gradients):
    scene = carom.Scene.load(SOURCE / "scenes/draw.toml")
    return gradients.Shot(scene, ["cue.speed", "cue.aim_deg", "cue.offset.height"])


def test_forwards_and_backwards_agree_with_differences(gradients, shot):
    places, slopes = shot.with_slopes(X)
    np.testing.assert_array_equal(places, shot(X))
    push, pull, h = np.array([0.3, -1.0, 0.2]), np.array([[1.0, 2.0], [-0.5, 0.1]]), 1e-5
    moved = (shot(X + h * push) - shot(X - h * push)) / (2 * h)
    np.testing.assert_allclose(gradients.pushed(slopes, push), moved, atol=1e-7)
    assert gradients.pulled(slopes, pull) @ push == pytest.approx((pull * moved).sum(), abs=1e-7)


def test_the_script_reports_agreement(gradients, capsys, monkeypatch):
    monkeypatch.chdir(SOURCE)
    gradients.main()
    said = capsys.readouterr().out.splitlines()
    assert said[0].startswith("NumPy: differences agree within ")
    assert float(said[0].split()[-1]) < 1e-7 and len(said) == 3


def test_torch(gradients, shot):
    torch = pytest.importorskip("torch")
    x = torch.tensor(X, requires_grad=True)
    assert torch.autograd.gradcheck(gradients.for_torch(shot), x)


def test_jax(gradients, shot):
    jax = pytest.importorskip("jax")
    jax.config.update("jax_enable_x64", True)
    play, slopes = gradients.for_jax(shot), shot.with_slopes(X)[1]
    np.testing.assert_allclose(jax.jit(jax.jacfwd(play))(X), slopes, rtol=1e-12)
    np.testing.assert_allclose(jax.jacrev(play)(X), slopes, rtol=1e-12)
