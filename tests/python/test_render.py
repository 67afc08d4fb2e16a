"""Frames: the pixels of the program, and what cannot be drawn."""

from __future__ import annotations

import struct
import threading
import zlib

import carom
import numpy as np
import pytest
from conftest import SOURCE, carom_program

SCENE = SOURCE / "scenes/draw.toml"


def png(path):
    """The pixels of a PNG whose rows are not filtered, which the program writes."""
    data, at, parts, width, height = path.read_bytes(), 8, [], 0, 0
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at : at + 8])
        body = data[at + 8 : at + 8 + length]
        at += 12 + length
        if kind == b"IHDR":
            width, height = struct.unpack(">II", body[:8])
        if kind == b"IDAT":
            parts.append(body)
    rows = np.frombuffer(zlib.decompress(b"".join(parts)), np.uint8).reshape(height, 1 + 3 * width)
    assert (rows[:, 0] == 0).all()
    return rows[:, 1:].reshape(height, width, 3)


@pytest.mark.parametrize("backend", ["egl", "osmesa"])
def test_frames_are_those_of_the_program(tmp_path, backend):
    size = ("--size", "160x90", "--gl", backend)
    try:
        carom_program("render", SCENE, *size, "--fps", 4, "-o", tmp_path / "%d.png")
    except Exception:  # noqa: BLE001
        pytest.skip(f"the program cannot draw with {backend} here")
    files = sorted(tmp_path.glob("*.png"), key=lambda p: int(p.stem))
    frames = list(carom.render(carom.Scene.load(SCENE), size=(160, 90), fps=4, backend=backend))
    assert len(frames) == len(files) > 5
    for frame, file in zip(frames, files):
        assert frame.shape == (90, 160, 3) and frame.flags.owndata and frame.flags.writeable
        assert (frame == png(file)).all()
    carom_program("render", SCENE, *size, "--at", 0.37, "--camera", "player", "--overlay", "trails,spin", "-o", tmp_path / "at%d.png")
    (frame,) = carom.render(
        carom.simulate(carom.Scene.load(SCENE)), times=[0.37], size=(160, 90), camera="player", overlays=["trails", "spin"], backend=backend
    )
    assert (frame == png(next(tmp_path.glob("at*.png")))).all()


def test_the_scene_says_what_is_left_out(draw_scene):
    scene = draw_scene.replace(render={"fps": 2.0, "size": [96, 64], "camera": "rail"})
    frames = list(carom.render(scene))
    assert len(frames) == 1 + int(carom.simulate(scene).duration * 2) and frames[0].shape == (64, 96, 3)
    other = list(carom.render(scene, camera="top"))
    assert (frames[0] != other[0]).any()
    placed = next(iter(carom.render(scene.replace(render={"size": [96, 64], "eye": [1.0, 1.0, 2.0], "target": [0.5, 1.0, 0.0]}))))
    assert (placed != frames[0]).any()


def test_another_thread_does_not_draw(draw_scene):
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
    assert raised == ["frames are drawn by the thread that asked for the first one"]


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
def test_what_does_not_exist_is_refused_at_once(draw_scene, arguments, message):
    with pytest.raises(ValueError, match=message):
        carom.render(draw_scene, **arguments)
