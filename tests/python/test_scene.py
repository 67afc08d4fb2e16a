"""Scenes: files, texts, dicts, keywords, and the engine's own messages."""

from __future__ import annotations

import pickle
import re
import tomllib

import carom
import numpy as np
import pytest
from conftest import BAD_SCENES, SCENES, refused


@pytest.mark.parametrize("path", SCENES, ids=lambda p: p.stem)
def test_a_scene_is_the_same_from_a_file_a_text_a_dict_and_a_pickle(path):
    scene = carom.Scene.load(path)
    text = path.read_text()
    assert carom.Scene.loads(text) == scene
    assert carom.Scene.from_dict(tomllib.loads(text)) == scene
    assert carom.Scene.from_dict(scene.to_dict()) == scene
    assert carom.Scene.loads(scene.text()) == scene
    copy = pickle.loads(pickle.dumps(scene))
    assert copy == scene and hash(copy) == hash(scene)
    assert (copy.file, copy.source) == (scene.file, scene.source)


@pytest.mark.parametrize("path", BAD_SCENES, ids=lambda p: p.stem)
def test_a_bad_scene_has_the_message_of_the_engine(path):
    text = path.read_text()
    wanted = text.splitlines()[0].removeprefix("# ")
    with pytest.raises(carom.SceneError) as caught:
        carom.Scene.loads(text, path.name)
    error = caught.value
    head = wanted.split("*")[0]  # a star matches any words
    assert str(error).startswith(head) if "*" in wanted else str(error) == wanted
    assert error.file == path.name
    assert isinstance(error, ValueError)
    place = "" if error.line is None else f":{error.line}:{error.column}"
    assert str(error) == f"{error.file}{place}: {error.message}"
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.line) == (str(error), error.line)
    try:
        tree = tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        return
    with pytest.raises(carom.SceneError) as caught:
        carom.Scene.from_dict(tree, path.name)
    assert caught.value.message == re.sub(r" in line \d+", "", error.message)
    assert caught.value.line is None


def test_keywords_are_sections():
    scene = carom.Scene(table="carom", rack="three_cushion", cue={"ball": "white", "speed": 4},
                        balls={"preset": "carom"}, stop={"time": 2.0})
    text = (
        '[table]\npreset = "carom"\n[rack]\ngame = "three_cushion"\n[cue]\nball = "white"\nspeed = 4\n'
        '[balls]\npreset = "carom"\n[stop]\ntime = 2.0\n')
    assert scene == carom.Scene.loads(text)
    assert scene != carom.Scene(table="carom", rack="three_cushion", cue={"ball": "white", "speed": 5})
    assert set(scene.ids) == {"white", "yellow", "red"}
    with pytest.raises(carom.SceneError, match="unknown section|unknown"):
        carom.Scene(tabel={})


def test_numpy_values_are_written_as_numbers():
    place = np.array([0.3, 0.4])
    scene = carom.Scene(ball=[{"id": "a", "position": place, "velocity": (np.float64(0.1), np.float32(0.5))}],
                        stop={"events": np.int64(7)})
    assert scene == carom.Scene(
        ball=[{"id": "a", "position": [0.3, 0.4], "velocity": [0.1, 0.5]}], stop={"events": 7})
    assert scene.positions.tolist() == [[0.3, 0.4]]


@pytest.mark.parametrize(
    ("tree", "message"),
    [
        ({"cue": {"speed": None}}, "scene: cue.speed is None; leave the key out"),
        ({"cue": {"speed": 1j}},
         "scene: cue.speed has the type complex; use numbers, strings, lists and dicts"),
        ({"cue": {"speed": 2**63}}, "scene: cue.speed is beyond 64 bits; write a smaller number"),
        ({3: {}}, "scene: the scene has the key 3; use strings as keys"),
    ],
)
def test_values_unknown_to_toml_are_refused(tree, message):
    with pytest.raises(carom.SceneError) as caught:
        carom.Scene.from_dict(tree)
    assert str(caught.value) == message


def test_a_dict_that_contains_itself_is_refused():
    loop: dict[str, object] = {}
    loop["cue"] = loop
    with pytest.raises(carom.SceneError, match="more than 20 others"):
        carom.Scene.from_dict(loop)


def test_any_id_is_quoted():
    for bad in ['a"b', "a\\b", "a\nb", "a\x7fb", "\u2028", "</script>"]:
        tree = {"ball": [{"id": bad}]}
        try:
            assert carom.Scene.from_dict(tree).ids == (bad,)
        except carom.SceneError as error:
            assert "control" in error.message or "comma" in error.message or "quote" in error.message


def test_replace_accepts_the_keys_of_a_sweep(draw_scene):
    ids = draw_scene.ids
    other = draw_scene.replace(**{"cue.speed": 3.25, "balls.mu_s": 0.18,
                                  f"ball.{ids[1]}.position": [0.5, 1.0], "physics.cushion": "stronge"})
    tree = draw_scene.to_dict()
    tree["cue"]["speed"] = 3.25
    tree.setdefault("balls", {})["mu_s"] = 0.18
    tree["ball"][1]["position"] = [0.5, 1.0]
    tree.setdefault("physics", {})["cushion"] = "stronge"
    assert other == carom.Scene.from_dict(tree)
    assert other.file == draw_scene.file
    tree.pop("cue")
    assert other.replace(cue=None) == carom.Scene.from_dict(tree)
    assert draw_scene.replace() == draw_scene


def test_replace_explains_errors(draw_scene):
    refused(
        carom.SceneError,
        draw_scene.replace,
        ({"cue.speed": -1}, r"draw.toml: cue.speed = -1 is out of range"),
        ({"ball.nobody.position": [0, 0]},
         r"draw.toml: ball.nobody.position: there is no such ball"),
        ({"cue.sped": 1}, "unknown key"),
    )


def test_an_unreadable_file_is_a_scene_error(tmp_path):
    with pytest.raises(carom.SceneError, match="there is no such file"):
        carom.Scene.load(tmp_path / "none.toml")
