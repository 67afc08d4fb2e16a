"""Records: the same bits as the program, views without copies, files."""

from __future__ import annotations

import gc
import json
import pickle

import carom
import numpy as np
import pytest
from conftest import SCENES, SOURCE, carom_program, rows_of, stuck_scene


@pytest.mark.parametrize("path", SCENES, ids=lambda p: p.stem)
def test_a_record_has_the_bits_of_the_program(path):
    result = json.loads(carom_program("simulate", path, "--json"))
    record = carom.simulate(carom.Scene.load(path), verify=True)
    assert record.hash() == result["hash"]
    assert record.duration == result["duration"]
    assert len(record.events) == result["events"]
    assert list(record.ids) == [ball["id"] for ball in result["balls"]]
    end = record.states(record.duration)
    for i, ball in enumerate(result["balls"]):
        assert end[i].tolist() == [ball["position"], ball["velocity"], ball["spin"]]
        assert record.MOTIONS[record.motion(record.duration)[i]] == ball["state"]


def test_a_record_from_a_file_is_verified(break_scene, tmp_path):
    record = carom.simulate(break_scene)
    assert record.verify() is None
    record.save(tmp_path / "shot.json")
    data = json.loads((tmp_path / "shot.json").read_text())
    assert carom.Record.load(tmp_path / "shot.json").verify(break_scene) is None
    with pytest.raises(ValueError, match="give the scene that was played"):
        carom.Record.load(tmp_path / "shot.json").verify()
    del data["events"][5]
    (tmp_path / "bad.json").write_text(json.dumps(data))
    broken = carom.Record.load(tmp_path / "bad.json").verify(break_scene)
    assert broken is not None and broken.startswith("U6 broken at ")
    data["gravity"] = 9.8
    (tmp_path / "other.json").write_text(json.dumps(data))
    with pytest.raises(carom.SceneError, match="gravity is 9.8, and 9.81 in the scene"):
        carom.Record.load(tmp_path / "other.json").verify(break_scene)


def test_states_match_the_samples(break_scene, tmp_path):
    carom_program("simulate", SOURCE / "scenes/eight_ball_break.toml", "--samples", tmp_path / "s.csv",
                  "--sample-dt", 0.25)
    record = carom.simulate(break_scene)
    header, *lines = rows_of(tmp_path / "s.csv")
    rows = [dict(zip(header, line)) for line in lines]
    times = np.array(sorted({float(row["time"]) for row in rows}))
    states, kinds = record.states(times), record.motion(times)
    assert states.shape == (len(times), 16, 3, 3) and kinds.shape == (len(times), 16)
    for row in rows:
        k, i = np.searchsorted(times, float(row["time"])), record.ids.index(row["ball"])
        assert states[k, i].ravel().tolist() == [
            float(row[c]) for c in ("x", "y", "z", "vx", "vy", "vz", "wx", "wy", "wz")]
        assert record.MOTIONS[kinds[k, i]] == row["state"]


def test_shapes_follow_the_times(break_scene):
    record = carom.simulate(break_scene)
    assert record.states(0.5).shape == (16, 3, 3)
    assert record.states([[0.0, 1.0]]).shape == (1, 2, 16, 3, 3)
    assert record.states([]).shape == (0, 16, 3, 3)
    assert record.orientations([0.1, 0.2]).shape == (2, 16, 4)
    assert (record.states([-1.0, np.inf]) == record.states([0.0, record.duration])).all()
    out = np.empty((2, 16, 3, 3))
    assert record.states([0.1, 0.2], out=out) is out
    assert (out == record.states([0.1, 0.2])).all()
    np.testing.assert_allclose(
        np.linalg.norm(record.orientations(np.linspace(0, 9, 50)), axis=-1), 1, atol=1e-12)
    for bad in (np.empty((2, 16, 3)), np.empty((2, 16, 3, 3), np.float32), np.empty((4, 16, 3, 3))[::2]):
        with pytest.raises(ValueError, match="out: expected"):
            record.states([0.1, 0.2], out=bad)
    with pytest.raises(ValueError, match="not a number"):
        record.states([0.0, np.nan])
    with pytest.raises(ValueError, match="not a number"):
        record.orientations(np.nan)


def test_events_are_a_view_that_keeps_the_record_alive(break_scene):
    record = carom.simulate(break_scene)
    events, segments = record.events, record.segments
    hash_of = (events.tobytes(), segments[3].tobytes())
    assert not events.flags.writeable and not segments[0].flags.writeable
    assert np.shares_memory(events, record.events) and np.shares_memory(segments[3], record.segments[3])
    with pytest.raises(ValueError):
        events["time"][0] = 1
    named = record.event_list()
    assert [record.EVENT_TYPES[kind] for kind in events["type"]] == [e.type for e in named]
    assert events["time"].tolist() == [e.time for e in named]
    assert named[0] == (0.0, "cue_strike", "cue", "")
    del record
    gc.collect()
    assert [carom.simulate(break_scene).hash() for _ in range(20)]  # would overwrite freed memory
    assert (events.tobytes(), segments[3].tobytes()) == hash_of


def test_events_match_the_program(break_scene, tmp_path):
    carom_program("simulate", SOURCE / "scenes/eight_ball_break.toml", "--events", tmp_path / "e.csv")
    rows = rows_of(tmp_path / "e.csv")[1:]
    listed = carom.simulate(break_scene).event_list()
    assert [(float(time), kind, a, b) for time, kind, a, b, *_ in rows] == listed


def test_segments_contain_the_closed_form(draw_scene):
    record = carom.simulate(draw_scene)
    for ball, segments in enumerate(record.segments):
        moving = segments[segments["state"] != record.MOTIONS.index("stationary")]
        for segment in moving[:3]:
            tau = 0.3 * min(segment["duration"], 0.01)
            r = segment["r"][:2] + tau * (segment["v"][:2] + 0.5 * tau * segment["a"])
            state = record.states(segment["start"] + tau)[ball]
            np.testing.assert_allclose(state[0, :2], r, atol=1e-12)
    assert np.all(np.diff(record.segments[0]["start"]) >= 0)


def test_a_record_saves_and_loads(break_scene, tmp_path):
    record = carom.simulate(break_scene)
    record.save(tmp_path / "r.json")
    carom_program("simulate", SOURCE / "scenes/eight_ball_break.toml", "-o", tmp_path / "p.json")
    assert (tmp_path / "r.json").read_bytes() == (tmp_path / "p.json").read_bytes()
    again = carom.Record.load(tmp_path / "p.json")
    assert again.hash() == record.hash() and again.event_list() == record.event_list()
    assert again.final_scene(scene=break_scene) == record.final_scene()
    with pytest.raises(ValueError, match="has no physics; give the scene"):
        again.final_scene()
    with pytest.raises(ValueError, match="saved as .json"):
        record.save(tmp_path / "r.png")
    with pytest.raises(OSError, match="nowhere"):
        record.save(tmp_path / "nowhere/r.json")
    (tmp_path / "bad.json").write_text("{}")
    with pytest.raises(carom.SceneError):
        carom.Record.load(tmp_path / "bad.json")
    with pytest.raises(TypeError, match="simulate"):
        carom.Record()


def test_a_record_pickles_with_its_scene(break_scene, tmp_path):
    record = carom.simulate(break_scene)
    again = pickle.loads(pickle.dumps(record))
    assert again == record and hash(again) == hash(record) and record != "another"
    assert carom.simulate(break_scene, until=0.1) != record
    assert again.hash() == record.hash() and again.event_list() == record.event_list()
    assert again.stopped == record.stopped
    assert again.final_scene() == record.final_scene()
    assert carom.simulate(again.final_scene(cue={"speed": 1})).hash() == carom.simulate(
        record.final_scene(cue={"speed": 1})).hash()
    record.save(tmp_path / "r.json")
    loaded = pickle.loads(pickle.dumps(carom.Record.load(tmp_path / "r.json")))
    assert loaded.hash() == record.hash()
    with pytest.raises(ValueError, match="has no physics"):
        loaded.final_scene()
    again.save(tmp_path / "again.json")
    assert (tmp_path / "again.json").read_bytes() == (tmp_path / "r.json").read_bytes()


def test_the_final_scene_is_the_next_shot(break_scene):
    record = carom.simulate(break_scene)
    down = {e.a for e in record.event_list() if e.type == "ball_pocket"}
    after = record.final_scene(cue={"speed": 2, "aim_deg": 45})
    assert down and set(after.ids) == set(record.ids) - down
    end = record.states(record.duration)
    kept = [i for i, ball in enumerate(record.ids) if ball in after.ids]
    assert (after.positions == end[kept, 0, :2]).all()
    assert carom.simulate(after).event_list()[0].type == "cue_strike"
    # Over many shots, a resting ball keeps its place bit for bit.
    for shot in range(1, 8):
        record = carom.simulate(after)
        if record.final_scene().ids.count("cue") == 0:
            break
        end = dict(zip(record.ids, record.states(record.duration)[:, 0, :2]))
        after = record.final_scene(cue={"speed": 0.5, "aim_deg": 50 * shot})
        assert all((place == end[ball]).all() for ball, place in zip(after.ids, after.positions))
        assert after == record.final_scene().replace(cue={"speed": 0.5, "aim_deg": 50 * shot})
    other = carom.Scene(ball=[{"id": "x"}])
    with pytest.raises(ValueError, match="different balls"):
        record.final_scene(scene=other)
    with pytest.raises(carom.SceneError, match=r'no ball "nobody"'):
        record.final_scene(cue={"ball": "nobody"})
    with pytest.raises(carom.SceneError, match="velocity or spin of its own"):
        carom.simulate(after, until=0.05).final_scene(cue={"speed": 1})


def test_limits_end_a_shot(break_scene):
    whole = carom.simulate(break_scene)
    assert whole.stopped == "at_rest"
    short = carom.simulate(break_scene, until=0.5)
    assert (short.stopped, short.duration) == ("time", 0.5)
    assert (short.states(0.4) == whole.states(0.4)).all()
    few = carom.simulate(break_scene, max_events=10)
    assert (few.stopped, len(few.events)) == ("events", 10)
    assert carom.simulate(break_scene.replace(stop={"events": 5}), max_events=10).events.size == 5
    for bad in (dict(until=-1), dict(until=np.nan), dict(until=np.inf), dict(max_events=-1)):
        with pytest.raises(ValueError, match="expected"):
            carom.simulate(break_scene, **bad)


def test_a_record_includes_its_table(break_scene):
    record = carom.simulate(break_scene, until=0.0)
    table = record.table
    assert table.preset == "nine_foot" and len(table.pockets) == 6 and len(table.jaws) == 12
    assert table.width == pytest.approx(1.27) and table.length == pytest.approx(2.54)
    assert (record.radii == 0.028575).all() and record.masses.shape == (16,)


def test_a_failed_run_has_its_record():
    with pytest.raises(carom.SimulationError, match="simulation stopped at t = ") as caught:
        carom.simulate(stuck_scene(0.9999999))
    record = caught.value.record
    assert record is not None and record.ids == ("a", "b") and len(record.events) == 1000000
    assert record.states(record.duration)[1, 0, 0] == pytest.approx(0.2, abs=1e-6)
    assert str(pickle.loads(pickle.dumps(carom.SimulationError("why")))) == "why"


def test_disabling_a_needed_effect_is_a_scene_error(draw_scene):
    scene = draw_scene.replace(effects={"sliding": False})
    with pytest.raises(carom.SceneError, match="effects.sliding = false, but the scene needs it"):
        carom.simulate(scene)
