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


def test_a_key_of_a_scene_is_read_by_its_name():
    balls = [{"id": "cue"}, {"id": "1", "position": [0.3, 2.0]}]
    scene = carom.Scene(ball=balls, cue={"offset": [0.1, -0.4]})
    assert scene["cue.offset.height"] == -0.4
    assert scene["cue.speed"] == carom.Scene.loads(scene.text())["cue.speed"] > 0  # a default
    assert scene["ball.1.position.y"] == 2.0 and scene["ball.1.position"] == [0.3, 2.0]
    assert scene["table.preset"] == "nine_foot"
    assert scene["cue"]["ball"] == "cue"
    assert scene.replace(**{"balls.mu_s": 0.18})["balls.mu_s"] == 0.18
    for key in ("cue.sped", "ball.9.position.x", "tabel"):
        with pytest.raises(KeyError, match="the scene has no such value"):
            scene[key]
    with pytest.raises(TypeError, match="key: expected a string"):
        scene[3]  # type: ignore[index]


def test_a_missing_file_is_a_file_not_found_error(tmp_path):
    for load, name in ((carom.Scene.load, "none.toml"), (carom.Record.load, "none.json"),
                       (carom.simulate, "none.toml")):
        path = str(tmp_path / name)
        with pytest.raises(FileNotFoundError) as caught:
            load(path)
        assert isinstance(caught.value, carom.SceneError)
        assert (caught.value.filename, caught.value.file) == (path, path)
        again = pickle.loads(pickle.dumps(caught.value))
        assert (str(again), again.errno) == (str(caught.value), caught.value.errno)
    folder = tmp_path / "folder.toml"
    folder.mkdir()
    with pytest.raises(carom.SceneError) as caught:
        carom.Scene.load(folder)
    assert not isinstance(caught.value, FileNotFoundError)


def test_a_notebook_shows_a_drawing_of_a_scene():
    scene = carom.Scene(rack="nine_ball", ball=[{"id": "cue", "position": [0.6, 0.5]}], cue={"aim_deg": 90})
    text = scene._repr_html_()
    assert text.startswith("<svg") and text.count("<title>") == 6 + len(scene.ids)
    assert len(text) < 10_000
    assert "<svg" in carom.Scene(table={"cushion": []}, ball=[{}])._repr_html_()
