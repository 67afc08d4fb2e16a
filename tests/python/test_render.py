"""Frames: the program's pixels, and refusals."""

from __future__ import annotations

import subprocess
import threading

import carom
import numpy as np
import pytest
from conftest import SOURCE, carom_program

SCENE = SOURCE / "scenes/draw.toml"


def drawn(*options):
    """The program's frames, decoded from PNG."""
    raw = carom_program("render", SCENE, "--size", "160x90", "--raw", *options, binary=True)
    return np.frombuffer(raw, np.uint8).reshape(-1, 90, 160, 3)


@pytest.mark.parametrize("backend", ["egl", "osmesa"])
def test_frames_match_the_program(backend):
    try:
        wanted = drawn("--gl", backend, "--fps", 4)
    except subprocess.CalledProcessError as error:
        if b"install the Debian package" not in error.stderr:
            raise
        pytest.skip(f"the program cannot draw with {backend} here: {error.stderr}")
    frames = list(carom.render(carom.Scene.load(SCENE), size=(160, 90), fps=4, backend=backend))
    assert len(frames) == len(wanted) > 5
    for frame, theirs in zip(frames, wanted):
        assert frame.shape == (90, 160, 3) and frame.flags.owndata and frame.flags.writeable
        assert (frame == theirs).all()
    (theirs,) = drawn("--gl", backend, "--at", 0.37, "--camera", "player", "--overlay", "trails,spin")
    (frame,) = carom.render(
        carom.simulate(carom.Scene.load(SCENE)), times=[0.37], size=(160, 90), camera="player",
        overlays=["trails", "spin"], backend=backend
    )
    assert (frame == theirs).all()


def test_the_scene_supplies_the_defaults(draw_scene):
    scene = draw_scene.replace(render={"fps": 2.0, "size": [96, 64], "camera": "rail"})
    frames = list(carom.render(scene))
    assert len(frames) == 1 + int(carom.simulate(scene).duration * 2) and frames[0].shape == (64, 96, 3)
    other = list(carom.render(scene, camera="top"))
    assert (frames[0] != other[0]).any()
    placed = next(iter(carom.render(
        scene.replace(render={"size": [96, 64], "eye": [1.0, 1.0, 2.0], "target": [0.5, 1.0, 0.0]}))))
    assert (placed != frames[0]).any()


def test_another_thread_cannot_draw(draw_scene):
    frames = carom.render(draw_scene, size=(32, 32), fps=4)
    next(frames)
    raised = []

    def go_on():
        try:
            next(frames)
        except RuntimeError as error:
            raised.append(str(error))

    thread = threading.Thread(target=go_on)
    thread.start()
    thread.join()
    assert raised == ["frames must be drawn by the thread that drew the first one"]


def test_drawings_side_by_side_and_dropped_elsewhere(draw_scene):
    dropped = []

    def begin():
        frames = carom.render(draw_scene, size=(64, 64), fps=4)
        next(frames)
        dropped.append(frames)

    thread = threading.Thread(target=begin)
    thread.start()
    thread.join()
    dropped.clear()
    one, two = (carom.render(draw_scene, size=(64, 64), fps=4) for _ in range(2))
    assert (next(one) == next(two)).all()
    third = next(one)
    del one
    assert (third == next(two)).all()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (dict(size=(0, 4)), "size"),
        (dict(size=(4, 10**6)), "size"),
        (dict(fps=0), "fps=0"),
        (dict(fps=float("nan")), "fps"),
        (dict(times=[np.nan]), "not a number"),
        (dict(overlays="trails"), "overlays: expected a list"),
        (dict(overlays=["margin"]), "overlays: expected a list"),
        (dict(camera="moon"), "camera='moon'"),
        (dict(backend="x11"), "backend='x11'"),
    ],
)
def test_unknown_names_are_refused_at_once(draw_scene, arguments, message):
    with pytest.raises(ValueError, match=message):
        carom.render(draw_scene, **arguments)
