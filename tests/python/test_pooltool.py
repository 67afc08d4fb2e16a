"""pooltool's files, both ways.

tests/data/pooltool contains Systems saved by pooltool 0.6.0: one shot before and after simulation, a potted
ball, and a jaw. lab/measure/pooltool_parity.py compares with pooltool itself.
"""

from __future__ import annotations

import json

import carom
import numpy as np
import pytest
from carom.io import pooltool
from conftest import SCENES, SOURCE

SYSTEMS = SOURCE / "tests/data/pooltool"
NAMES = {
    "stick_ball": "cue_strike", "ball_linear_cushion": "ball_cushion", "ball_circular_cushion": "ball_jaw",
    "sliding_rolling": "slide_roll", "rolling_stationary": "roll_stop"}


def system_of(path):
    return json.loads(path.read_text())


@pytest.mark.parametrize("name", ["two_balls", "pot", "jaw"])
def test_a_system_plays_as_in_pooltool(name):
    system = system_of(SYSTEMS / f"{name}.json")
    record = carom.simulate(pooltool.load(SYSTEMS / f"{name}.json"), verify=True)
    theirs = [event for event in system["events"] if event["event_type"] != "none"]
    ours = record.event_list()
    assert [e.type for e in ours] == [NAMES.get(event["event_type"], event["event_type"]) for event in theirs]
    times = np.array([[e.time, event["time"]] for e, event in zip(ours, theirs)])
    # Equal to rounding until two balls or a jaw meet; from then on, pooltool's balls are 1e-6 m apart.
    met = next(i for i, e in enumerate(ours) if e.type in ("ball_ball", "ball_jaw"))
    np.testing.assert_allclose(times[: met + 1, 0], times[: met + 1, 1], rtol=0, atol=1e-13)
    np.testing.assert_allclose(times[:, 0], times[:, 1], rtol=0, atol=1e-4)
    end = record.states(record.duration)[:, 0]
    np.testing.assert_allclose(
        end, [system["balls"][ball]["state"]["rvw"][0] for ball in record.ids], atol=1e-4)


def test_the_friction_between_balls_matches_pooltool():
    # Without the scaled friction, the balls would roll half a millisecond earlier or later.
    scene = pooltool.load(SYSTEMS / "two_balls.json")
    rolls = [
        e["time"] for e in system_of(SYSTEMS / "two_balls.json")["events"]
        if e["event_type"] == "sliding_rolling"][:2]
    for fit, agrees in ((None, True), ([0.009951, 0.108, 1.088], False)):
        played = scene if fit is None else scene.replace(balls=scene.to_dict()["balls"] | {"mu_b_fit": fit})
        ours = [e.time for e in carom.simulate(played).event_list() if e.type == "slide_roll"][:2]
        assert (np.abs(np.subtract(ours, rolls)).max() < 1e-6) == agrees
        assert np.abs(np.subtract(ours, rolls)).max() < 1e-3


def test_an_unsimulated_system_is_the_same_shot(tmp_path):
    assert pooltool.load(SYSTEMS / "start.json").text() == pooltool.load(SYSTEMS / "two_balls.json").text()
    system = system_of(SYSTEMS / "start.json")
    system["cue"]["V0"] = 0.0
    (tmp_path / "still.json").write_text(json.dumps(system))
    assert "cue" not in pooltool.load(tmp_path / "still.json").to_dict()
    state = system["balls"]["1"]["state"]
    state["rvw"][1], state["rvw"][2], state["s"] = [0.5, 0.25, 0.0], [1.0, 2.0, 3.0], 2
    system["cue"]["V0"] = 2.0
    (tmp_path / "moving.json").write_text(json.dumps(system))
    moving = pooltool.load(tmp_path / "moving.json")
    assert "cue" not in moving.to_dict()
    assert carom.simulate(moving, until=0.0).states(0.0)[moving.ids.index("1")].tolist() == state["rvw"]
    state["s"] = 4
    (tmp_path / "down.json").write_text(json.dumps(system))
    assert pooltool.load(tmp_path / "down.json").ids == ("cue",)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda s: s["balls"]["1"].pop("params"),
         "balls.1.params is missing; expected a System as pooltool 0.6.0 saves it"),
        (lambda s: s["balls"]["1"]["params"].update(R="big"), "balls.1.params.R is not a number"),
        (lambda s: s["balls"]["1"]["params"].update(m=float("nan")), "balls.1.params.m is not a number"),
        (lambda s: s["balls"]["1"]["params"].update(u_s=0.3),
         "balls.cue.params differs from other balls in more than R and m"),
        (lambda s: s["balls"]["1"]["state"].update(s=9),
         "balls.1.state.s is 9, but states of motion are 0 to 4"),
        (lambda s: s["balls"]["1"]["state"].update(rvw=[[0, 0], [0, 0, 0], [0, 0, 0]]),
         r"balls.1.state.rvw\[0\] has 2 numbers instead of 3"),
        (lambda s: s["balls"]["1"]["state"].update(rvw=[[0, 0, 0]]),
         "balls.1.state.rvw has 1 rows instead of 3"),
        (lambda s: s.update(balls={}), "balls has no ball on the table"),
        (lambda s: s.update(balls=[]), "balls is not an object"),
        (lambda s: s.update(events={}), "events is not a list"),
        (lambda s: s["cue"].update(a=0.9), "cue.offset is"),
        (lambda s: s["cue"].update(cue_ball_id=3), "cue.cue_ball_id is not a string"),
        (lambda s: s["table"].pop("cushion_segments"), "table.cushion_segments is missing"),
    ],
)
def test_a_bad_system_is_reported(change, message, tmp_path):
    system = system_of(SYSTEMS / "start.json")
    change(system)
    path = tmp_path / "bad.json"
    path.write_text(json.dumps(system))
    with pytest.raises(carom.SceneError, match=message) as caught:
        pooltool.load(path)
    assert caught.value.file == str(path)


def test_a_missing_file_or_bad_json_is_reported(tmp_path):
    (tmp_path / "a.json").write_text('{"cue": {},\n "balls": }')
    with pytest.raises(carom.SceneError, match=r"a.json:2:11: is not JSON"):
        pooltool.load(tmp_path / "a.json")
    (tmp_path / "b.json").write_bytes(b"\x85\xa3cue\xff")
    with pytest.raises(
        carom.SceneError, match="not UTF-8; pooltool writes JSON if the name of the file ends in .json"
    ):
        pooltool.load(tmp_path / "b.json")
    (tmp_path / "b.msgpack").write_bytes(b"\x85\xa3cue\xff")
    with pytest.raises(carom.SceneError, match="is not MessagePack as pooltool saves it"):
        pooltool.load(tmp_path / "b.msgpack")
    with pytest.raises(carom.SceneError, match="none.msgpack: cannot be read: No such file"):
        pooltool.load(tmp_path / "none.msgpack")
    with pytest.raises(carom.SceneError, match="none.json: cannot be read: No such file"):
        pooltool.load(tmp_path / "none.json")
    (tmp_path / "c.json").write_text("[]")
    with pytest.raises(carom.SceneError, match="events is missing"):
        pooltool.load(tmp_path / "c.json")


def keys_of(value, path=""):
    """The paths of all objects in a tree, as pairs with their keys. Names of balls, cushions and jaws are
    ignored."""
    if isinstance(value, list):
        return {pair for part in value for pair in keys_of(part, f"{path}[]")}
    if not isinstance(value, dict):
        return set()
    named = path.rsplit(".", 1)[-1] in ("balls", "linear", "circular", "pockets")
    inside = {pair for key,
              part in value.items() for pair in keys_of(part, f"{path}.*" if named else f"{path}.{key}")}
    return inside if named else inside | {(path, frozenset(value))}


# Pooltool has one size for all balls.
UNLIKE = ("heavy_cue_ball", "bar_break", "pub_break")


@pytest.mark.parametrize("path", [path for path in SCENES if path.stem not in UNLIKE], ids=lambda p: p.stem)
@pytest.mark.filterwarnings("ignore:the elevated cue")
def test_a_saved_record_is_a_system(path, tmp_path):
    record = carom.simulate(carom.Scene.load(path))
    pooltool.save(record, tmp_path / "s.json")
    system = system_of(tmp_path / "s.json")
    known = {pair for file in SYSTEMS.glob("*.json") for pair in keys_of(system_of(file))}
    assert keys_of(system) <= known
    # pooltool starts from the state after a ball's last event, which must match the record.
    assert system["events"][0]["event_type"] == system["events"][-1]["event_type"] == "none"
    times = [event["time"] for event in system["events"]]
    assert times == sorted(times) and times[0] == 0.0
    assert times[-1] == pytest.approx(record.duration, abs=2e-9)
    told = {ball: {0.0} for ball in record.ids}
    for event in system["events"][1:-1]:
        for agent in event["agents"]:
            if agent["agent_type"] == "ball":
                state = agent["final"]["state"]
                assert state["t"] == event["time"]
                assert state["rvw"] == record.states(event["time"])[record.ids.index(agent["id"])].tolist()
                told[agent["id"]].add(event["time"])
    for ball, segments in zip(record.ids, record.segments):
        assert set(segments["start"][segments["start"] < record.duration].tolist()) <= told[ball]
        history = system["balls"][ball]["history"]["states"]
        assert [state["t"] for state in history] == sorted(state["t"] for state in history)
        assert system["balls"][ball]["state"] == history[-1]
        assert history[-1]["rvw"] == record.states(record.duration)[record.ids.index(ball)].tolist()
    fallen = {e.a for e in record.event_list() if e.type == "ball_pocket"}
    assert {ball for pocket in system["table"]["pockets"].values() for ball in pocket["contains"]} == fallen


def test_a_saved_record_keeps_its_cue_and_table(break_scene, tmp_path):
    record = carom.simulate(break_scene)
    pooltool.save(record, tmp_path / "s.json")
    again = pooltool.load(tmp_path / "s.json")
    assert sorted(again.ids) == sorted(break_scene.ids)
    places = dict(zip(break_scene.ids, break_scene.positions.tolist()))
    assert [places[ball] for ball in again.ids] == again.positions.tolist()
    # The ball leaves the cue at the same velocity, and the table is the same.
    played = carom.simulate(again, until=0.05)
    np.testing.assert_allclose(played.states(0.0)[again.ids.index("cue")],
                               record.states(0.0)[break_scene.ids.index("cue")], atol=1e-12)
    assert played.table.cushions == record.table.cushions and played.table.pockets == record.table.pockets
    assert played.table.jaws == record.table.jaws
    # A record from a file has no cue: the balls move from the first event on.
    record.save(tmp_path / "r.json")
    pooltool.save(carom.Record.load(tmp_path / "r.json"), tmp_path / "t.json")
    with_cue, without = system_of(tmp_path / "s.json"), system_of(tmp_path / "t.json")
    assert without["cue"]["V0"] == 0.0 and with_cue["cue"]["V0"] == pytest.approx(8.0 * 1.73 / 2)
    assert [event["time"] for event in without["events"]] == [event["time"] for event in with_cue["events"]]


def as_numpy(tree):
    """The tree with its arrays and times as msgpack-numpy packs them, as pooltool does."""
    if isinstance(tree, dict):
        return {key: as_numpy(part) for key, part in tree.items()}
    if isinstance(tree, list) and tree and not isinstance(tree[0], (dict, str)):
        array = np.array(tree)
        return {b"nd": True, b"type": array.dtype.str, b"kind": b"", b"shape": array.shape,
                b"data": array.tobytes()}
    if isinstance(tree, float):
        return {b"nd": False, b"type": "<f8", b"data": np.float64(tree).tobytes()}
    return [as_numpy(part) for part in tree] if isinstance(tree, list) else tree


@pytest.mark.parametrize("name", ["two_balls", "pot", "jaw"])
def test_a_system_as_messagepack_is_the_same_scene(name, tmp_path):
    msgpack = pytest.importorskip("msgpack")
    path = SYSTEMS / f"{name}.json"
    (tmp_path / "s.msgpack").write_bytes(msgpack.packb(as_numpy(system_of(path))))
    assert pooltool.load(tmp_path / "s.msgpack").text() == pooltool.load(path).text()


def test_a_saved_table_reads_back_unchanged(break_scene, tmp_path):
    pooltool.save(carom.simulate(break_scene), tmp_path / "s.json")

    def heights(scene):
        return [jaw["height"] for jaw in json.loads(carom.simulate(scene)._native.text())["table"]["jaws"]]
    np.testing.assert_allclose(
        heights(pooltool.load(tmp_path / "s.json")), heights(break_scene), rtol=4e-16)


def test_a_table_specification_yields_a_table():
    # The defaults of PocketTableSpecs in pooltool 0.6.0.
    specs = {
        "l": 1.9812, "w": 1.9812 / 2, "cushion_width": 2 * 2.54 / 100, "cushion_height": 0.64 * 2 * 0.028575,
        "corner_pocket_width": 0.118, "corner_pocket_angle": 5.3, "corner_pocket_depth": 0.0417,
        "corner_pocket_radius": 0.062, "corner_jaw_radius": 0.02095, "side_pocket_width": 0.137,
        "side_pocket_angle": 7.14, "side_pocket_depth": 0.0685, "side_pocket_radius": 0.0645,
        "side_jaw_radius": 0.00795}
    scene = carom.Scene(table=pooltool.table(specs), ball=[{"position": [0.4, 0.5]}])
    theirs = carom.Scene(table="seven_foot", ball=[{"position": [0.4, 0.5]}])
    ours, shown = carom.simulate(scene).table, carom.simulate(theirs).table
    assert (ours.width, ours.length) == (shown.width, shown.length)
    for one, two in zip(ours.pockets, shown.pockets):
        np.testing.assert_allclose(one[1:], two[1:], atol=1e-12)
    spec = carom.tables()["seven_foot"]["corner_pockets"]
    made = pooltool.table(specs)["corner_pockets"]
    assert all(made[key] == pytest.approx(spec[key]) for key in made)
    del specs["side_jaw_radius"]
    with pytest.raises(carom.SceneError, match="side_jaw_radius is missing"):
        pooltool.table(specs)
    flat = pooltool.table({"l": 2.84, "w": 1.42, "cushion_height": 0.037})
    assert flat == {"preset": "carom", "size": [1.42, 2.84], "cushion_height": 0.037}


def test_scenes_beyond_pooltool_are_refused(draw_scene, tmp_path):
    record = carom.simulate(draw_scene)
    with pytest.raises(ValueError, match="saved as .json"):
        pooltool.save(record, tmp_path / "s.msgpack")
    with pytest.raises(OSError):
        pooltool.save(record, tmp_path / "nowhere/s.json")
    stadium = carom.simulate(carom.Scene.load(SOURCE / "examples/mathematics/stadium.toml"))
    with pytest.raises(ValueError, match="no round walls"):
        pooltool.save(stadium, tmp_path / "s.json")
    heavy = carom.simulate(carom.Scene.load(SOURCE / "scenes/heavy_cue_ball.toml"))
    with pytest.raises(ValueError, match="differ in radius or mass"):
        pooltool.save(heavy, tmp_path / "s.json")
    assert list(tmp_path.iterdir()) == []
