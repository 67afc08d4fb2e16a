"""Batches: the bits of single shots, failures that affect only their own shot, and reused arrays."""

from __future__ import annotations

import functools

import carom
import numpy as np
import pytest
from carom import ShotStatus
from conftest import SOURCE, refused, stuck_scene

RANDOM = np.random.default_rng(7)


def cues(n):
    return np.column_stack(
        [RANDOM.uniform(1, 6, n), RANDOM.uniform(0, 360, n), np.zeros(n), RANDOM.uniform(-0.3, 0.3, n),
         RANDOM.uniform(-0.3, 0.3, n)]
    )


def one_by_one(scene, cue, xy, params, i):
    """Shot i as its own scene."""
    changes = {f"cue.{key}": cue[i, k] for k, key in enumerate(("speed", "aim_deg", "elevation_deg"))}
    changes["cue.offset"] = [cue[i, 3], cue[i, 4]]
    for k, ball in enumerate(scene.ids):
        changes[f"ball.{ball}.position"] = xy[i, k]
    return scene.replace(**changes, **{key: values[i] for key, values in params.items()})


def test_a_batch_has_the_bits_of_single_shots(draw_scene):
    n = 60
    cue = cues(n)
    xy = draw_scene.positions + RANDOM.uniform(-0.02, 0.02, (n, len(draw_scene.ids), 2))
    params = {"balls.mu_s": RANDOM.uniform(0.15, 0.25, n), "physics.gravity": RANDOM.uniform(9.7, 9.9, n)}
    shots = carom.simulate_many(draw_scene, cue=cue, xy=xy, params=params, hashes=True)
    assert not shots.messages
    for i in range(n):
        record = carom.simulate(one_by_one(draw_scene, cue, xy, params, i))
        assert f"{shots.hash[i]:016x}" == record.hash()
        assert shots.duration[i] == record.duration and shots.events[i] == len(record.events)
        assert shots.status[i] == ShotStatus.AT_REST and record.stopped == "at_rest"
        assert (shots.xy[i] == record.states(record.duration)[:, 0, :2]).all()
        cushions = [hit.a for hit in record.hit_list() if hit.b and hit.b not in record.ids]
        assert shots.cushions[i].tolist() == [cushions.count(ball) for ball in record.ids]
        fallen = [e.a for e in record.event_list() if e.type == "ball_pocket"]
        assert [
            ball for _, ball in sorted((f, b) for f, b in zip(shots.fell[i], record.ids) if f >= 0)] == fallen
        assert ((shots.pocket[i] >= 0) == (shots.fell[i] >= 0)).all()


@pytest.mark.parametrize("threads", [0, 2, 3])
def test_threads_change_nothing(break_scene, threads):
    cue = cues(40) * [1, 0.02, 1, 1, 1] + [3, 88, 0, 0, 0]
    one = carom.simulate_many(break_scene, cue=cue, hashes=True)
    assert (one.first_hit >= 0).sum() > 30 and (one.hash != 0).all()
    many = carom.simulate_many(break_scene, cue=cue, hashes=True, threads=threads)
    for a, b in zip(one, many):
        assert np.array_equal(a, b) if isinstance(a, np.ndarray) else a == b


def test_a_bad_shot_has_a_status_and_the_others_are_played(draw_scene):
    cue = cues(6)
    good = carom.simulate_many(draw_scene, cue=cue)
    cue[1, 0] = -1
    cue[2, 0] = np.nan
    cue[4, 3] = 0.9
    shots = carom.simulate_many(draw_scene, cue=cue)
    assert shots.status.tolist() == [0, ShotStatus.INVALID, ShotStatus.INVALID, 0, ShotStatus.INVALID, 0]
    assert sorted(shots.messages) == [1, 2, 4] and "out of range" in shots.messages[1]
    for i in (1, 2, 4):
        assert np.isnan(shots.duration[i]) and np.isnan(shots.xy[i]).all()
        assert shots.events[i] == 0 and shots.first_hit[i] == -1
        assert (shots.pocket[i] == -1).all() and (shots.fell[i] == -1).all()
        assert (shots.cushions[i] == 0).all()
    for i in (0, 3, 5):
        assert np.array_equal(shots.xy[i], good.xy[i]) and shots.duration[i] == good.duration[i]


def test_a_failed_run_is_a_status():
    shots = carom.simulate_many(stuck_scene(0.5), params={"balls.e_t": [0.5, 0.9999999, 0.6]})
    assert shots.status.tolist() == [0, ShotStatus.FAILED, 0]
    assert shots.messages[1].startswith("simulation stopped at t = ")


def test_out_is_filled_and_returned(draw_scene):
    cue = cues(10)
    fresh = carom.simulate_many(draw_scene, cue=cue, hashes=True)
    out = carom.Shots.empty(10, len(draw_scene.ids), hashes=True)
    again = carom.simulate_many(draw_scene, cue=cue, out=out, hashes=True)
    for mine, given, wanted in zip(again, out, fresh):
        if isinstance(given, np.ndarray):
            assert mine is given and np.array_equal(given, wanted)
    assert carom.simulate_many(draw_scene, cue=cue, out=out).hash is None
    with pytest.raises(
        ValueError, match="out.status: expected a writable contiguous array of uint8 with the shape .11,."
    ):
        carom.simulate_many(draw_scene, cue=cues(11), out=out)
    with pytest.raises(ValueError, match="out.hash"):
        carom.simulate_many(draw_scene, cue=cue, out=carom.Shots.empty(10, 2), hashes=True)
    locked = out.xy
    locked.flags.writeable = False
    with pytest.raises(ValueError, match="out.xy"):
        carom.simulate_many(draw_scene, cue=cue, out=out)


def test_a_ball_without_a_place_is_left_out(break_scene):
    xy = np.repeat(break_scene.positions[None], 3, axis=0)
    xy[1, [3, 5, 8]] = np.nan
    xy[2, 0] = np.nan  # the struck ball
    shots = carom.simulate_many(break_scene, xy=xy, hashes=True)
    assert shots.status.tolist() == [0, 0, ShotStatus.INVALID]
    assert 'no ball "cue"' in shots.messages[2]
    tree = carom.Scene.loads(break_scene.text()).to_dict()
    tree["ball"] = [ball for i, ball in enumerate(tree["ball"]) if i not in (3, 5, 8)]
    assert f"{shots.hash[1]:016x}" == carom.simulate(carom.Scene.from_dict(tree)).hash()
    assert f"{shots.hash[0]:016x}" == carom.simulate(break_scene).hash()
    assert np.isnan(shots.xy[1]).any(axis=-1).nonzero()[0].tolist() == [3, 5, 8]
    # A single NaN coordinate is an error.
    xy[1, 3, 0] = 0.5
    assert carom.simulate_many(break_scene, xy=xy).status[1] == ShotStatus.INVALID


def test_shots_follow_each_other(break_scene):
    first = carom.simulate_many(break_scene, shots=4, threads=2)
    assert (first.pocket >= 0).any()
    places = first.places
    assert (np.isnan(places).all(axis=-1) == (first.pocket >= 0)).all()
    second = carom.simulate_many(
        break_scene, xy=places, cue=np.tile([3.0, 45, 0, 0, 0.1], (4, 1)), hashes=True)
    after = carom.simulate(break_scene).final_scene(
        cue=break_scene.to_dict()["cue"] | {"speed": 3.0, "aim_deg": 45, "offset": [0, 0.1]})
    assert {f"{h:016x}" for h in second.hash} == {carom.simulate(after).hash()}
    assert (np.isnan(second.xy[:, :, 0]) == (first.pocket >= 0)).all()


def test_limits_apply_as_to_a_single_shot(break_scene):
    assert carom.simulate_many(break_scene, shots=2, until=0.5).duration.tolist() == [0.5, 0.5]
    few = carom.simulate_many(break_scene, shots=2, max_events=10)
    assert few.events.tolist() == [10, 10] and (few.status == ShotStatus.EVENTS).all()
    assert carom.simulate_many(break_scene, shots=0).xy.shape == (0, 16, 2)


def test_mismatched_arrays_are_refused(draw_scene):
    two = len(draw_scene.ids)
    refused(
        ValueError,
        functools.partial(carom.simulate_many, draw_scene),
        (dict(), "the number of shots is unknown"),
        (dict(cue=np.zeros((3, 4))), r"cue: expected the shape \(n, 5\), not \(3, 4\)"),
        (dict(cue=np.zeros((3, 5)), shots=4), "cue: 3 values for 4 shots"),
        (dict(xy=np.zeros((3, two + 1, 2))), "xy: expected the shape"),
        (dict(params={"cue.sped": [1.0]}), "cue.sped: there is no such number"),
        (dict(params={"cue.speed": [1.0]}, cue=np.zeros((1, 5))), "cue.speed: this key appears twice"),
        (dict(shots=1, threads=-1), "threads=-1"),
        (dict(shots=-1), "shots=-1"),
    )


def test_the_enumeration_has_the_engines_names():
    from carom import _carom

    assert _carom.status_names() == [status.name.lower() for status in ShotStatus]


def test_a_run_may_ask_for_more_or_fewer_events():
    # A ball that almost never stops bouncing.
    scene = carom.Scene(balls={"e_t": 0.9999999}, ball=[{"height": 0.1}])
    shots = carom.simulate_many(scene, params={"stop.events": [1000.0, 7.0]})
    assert shots.status.tolist() == [ShotStatus.EVENTS] * 2 and shots.events.tolist() == [1000, 7]


def test_shots_beyond_the_arrays_are_refused(draw_scene):
    for shots in (2**31 + 1, 2**53 + 1, 2**64):
        wanted = "is out of range; it must be at most 2147483648"
        with pytest.raises(ValueError, match=f"^shots = {shots} {wanted}$"):
            carom.simulate_many(draw_scene, shots=shots)


def test_tables_of_shots_name_pockets_as_sweeps_do():
    pytest.importorskip("pandas", reason="pandas is not installed")
    draw = str(SOURCE / "scenes/draw.toml")
    table = carom.simulate_many(draw, params={"cue.speed": [0.1, 2.25]}).to_pandas()
    assert list(table["1.pocket"]) == ["", "p3"]
    assert list(table["cue.pocket"]) == ["", ""]
    swept = carom.sweep.columns(draw, {"cue.speed": "list(0.1, 2.25)"}, 4)
    assert set(swept["1.pocket"]) <= {"", "p3"}
