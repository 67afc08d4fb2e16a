"""Details of events, measures, and the search for a shot: the program's numbers, and closed forms."""

from __future__ import annotations

import json
import math
import typing

import carom
import numpy as np
import pytest
from carom import _names, sweep
from conftest import SOURCE, carom_program, refused, rows_of

R = 0.028575
CUT = math.asin(0.75)


def quarter_ball():
    """The cue ball slides without friction along y and meets ball 1 a quarter full: sin(cut) = 0.75."""
    far = [0.0, 10 * R]
    return carom.Scene(
        table={"cushion": []},
        balls={"mu_b": 0.0, "e_b": 1.0, "mu_s": 0.0, "mu_r": 0.0, "mu_sp": 0.0},
        physics={"ball_ball": "elastic", "clusters": "sequential"},
        ball=[{"id": "cue", "position": [0, 0], "velocity": [0, 2.0]},
              {"id": "1", "position": [far[0] + 2 * R * math.sin(CUT), far[1]]}],
        stop={"time": 0.4},
    )


def test_an_event_has_its_place_and_numbers_in_closed_form():
    record = carom.simulate(quarter_ball())
    hit = list(record.events["type"]).index(record.EVENT_TYPES.index("ball_ball"))
    told = record.event_details[hit]
    mass = record.masses[0]
    assert told["cut_deg"] == pytest.approx(math.degrees(CUT), abs=1e-9)
    assert told["closing"] == pytest.approx(2.0 * math.cos(CUT), rel=1e-12)
    assert told["impulse"] == pytest.approx(mass * 2.0 * math.cos(CUT), rel=1e-12)
    assert told["lost"] == pytest.approx(0.0, abs=1e-15)
    assert told["point_x"] == pytest.approx(R * math.sin(CUT), rel=1e-12)
    assert told["b_vy"] == pytest.approx(2.0 * math.cos(CUT) ** 2, rel=1e-12)
    assert record.met[hit] == "1"
    assert len(record.event_details) == len(record.events)


def test_details_match_the_program(draw_scene, tmp_path):
    carom_program("simulate", SOURCE / "scenes/draw.toml", "--events", tmp_path / "e.csv")
    header, *rows = rows_of(tmp_path / "e.csv")
    record = carom.simulate(draw_scene)
    details = record.event_details
    assert [column.name for column in carom.event_columns()] == list(details.dtype.names)
    for name in details.dtype.names:
        at = header.index(name)
        wanted = [float(row[at]) if row[at] else math.nan for row in rows]
        np.testing.assert_array_equal(details[name], wanted)
    frame = record.to_pandas()
    assert frame["closing"].tolist()[:0] == [] and list(frame["met"]) == record.met


def test_measures_match_the_program():
    text = carom_program("describe", "measures")
    listed = carom.measures()
    assert len(listed) > 20
    assert all(f"{measure.name}" in text and measure.what in text for measure in listed)


def test_a_measure_of_a_record(draw_scene):
    record = carom.simulate(draw_scene)
    assert record.measure('"1" in pocketed and not scratch') is True
    assert record.measure("pocketed") == ["1"]
    states = record.states(np.linspace(0, record.duration, 20001))[:, 0, 0, :2]
    path = np.linalg.norm(np.diff(states, axis=0), axis=1).sum()
    assert record.measure("travel(cue)") == pytest.approx(path, rel=1e-6)
    broken = carom.simulate(carom.scenes.load("nine_ball_break"))
    judged = carom.games.judge(carom.games.new_game("nine_ball"), broken)
    assert broken.measure("foul", game="nine_ball") == [foul.name for foul in judged.fouls]
    with pytest.raises(ValueError, match="nine_ball needs it"):
        record.measure("foul", game="nine_ball")
    refused(ValueError, record.measure, ("potted", "potted"), ("foul", "foul"),
            ({"measure": "foul", "game": "chess"}, 'no game "chess"; expected one of eight_ball'))


def test_measures_are_columns_of_sweeps(draw_scene, tmp_path):
    rules, measures = ["cue.aim_deg=normal(1)"], ['"1" in pocketed', "travel(cue)", "first_hit"]
    words = [word for m in measures for word in ("--measure", m)]
    carom_program("sweep", SOURCE / "scenes/draw.toml", "--vary", rules[0], "--count", 50, *words, "-o",
                  tmp_path / "s.csv")
    header, *rows = rows_of(tmp_path / "s.csv")
    columns = sweep.columns(draw_scene, rules, 50, measures=measures)
    assert list(columns) == header
    for name in measures:
        at = header.index(name)
        wanted = [row[at] for row in rows]
        got = columns[name]
        assert wanted == got if isinstance(got, list) else [float(text) for text in wanted] == got.tolist()
    assert 0 < columns['"1" in pocketed'].mean() < 1
    refused(ValueError, None, (lambda: sweep.columns(draw_scene, rules, 5, measures=["foul"]), "foul"),
            (lambda: sweep.columns(draw_scene, rules, 5, measures=["no"]), "no"))


def test_a_plan_keeps_its_measures(draw_scene, tmp_path):
    pytest.importorskip("pyarrow")
    plan = sweep.plan(draw_scene, ["cue.aim_deg=normal(1)"], 40, shard=20, measures=["travel(cue)"])
    plan.save(tmp_path / "p.json")
    assert sweep.Plan.load(tmp_path / "p.json") == plan
    plain = sweep.plan(draw_scene, ["cue.aim_deg=normal(1)"], 40, shard=20)
    assert plain.id != plan.id
    sweep.run(plan, tmp_path / "s")
    whole = sweep.columns(draw_scene, ["cue.aim_deg=normal(1)"], 40, measures=["travel(cue)"])
    rows = sweep.open(tmp_path / "s").to_table()
    assert rows.column("travel(cue)").to_pylist() == whole["travel(cue)"].tolist()


def test_solve_finds_the_pot(draw_scene):
    vary = {"cue.aim_deg": (120, 150), "cue.speed": (2, 2.5)}
    best, *_ = carom.solve(draw_scene, '"1" in pocketed and not scratch', vary, shots=3000)
    assert best.values["cue.aim_deg"] == pytest.approx(135, abs=2)
    assert best.interval[0] <= best.success <= best.interval[1] and best.success > 0.5
    assert best.falls[0].ball == "1"
    assert carom.simulate(best.scene).measure('"1" in pocketed') is True
    rules = ["--vary", "cue.aim_deg=uniform(120,150)", "--vary", "cue.speed=uniform(2,2.5)"]
    told = json.loads(carom_program("solve", SOURCE / "scenes/draw.toml", "--want",
                                    '"1" in pocketed and not scratch', *rules, "--shots", 3000, "--json"))
    assert told["solutions"][0]["values"] == best.values
    assert told["solutions"][0]["interval"] == list(best.interval)
    assert told["solutions"][0]["exact_success"] == best.exact_success
    assert told["solutions"][0]["falls"] == [fall._asdict() for fall in best.falls]
    assert told["solutions"][0]["costs"] == [cost._asdict() for cost in best.costs]
    assert told["searches"] == list(best.searches)
    assert len(repr(best).splitlines()) <= 10
    assert sum(fall.share for fall in best.falls if fall.ball == "1") >= best.success - 1e-12
    texts = {"cue.aim_deg": "uniform(120,150)", "cue.speed": "uniform(2, 2.5)"}
    again = carom.solve(draw_scene, '"1" in pocketed and not scratch', texts, shots=3000)
    assert again[0].values == best.values
    refused(ValueError, lambda **more: carom.solve(draw_scene, "scratch", **more),
            ({"vary": {"cue.speed": [1]}}, "vary: cue.speed: expected the smallest"),
            ({"vary": {"cue.speed": "1,2"}}, "vary: cue.speed: expected the smallest"),
            ({"vary": {"cue.speed": (2, 1)}}, "expected a range from a to b"),
            ({"vary": {"cue.sped": (1, 2)}}, "cue.sped"),
            ({"shots": 10}, "shots=10: expected 1000 to"),
            ({"hand": carom.Hand(aim_deg=-1)}, "expected standard deviations"),
            ({"unknown": carom.Unknown(gaps=-1)}, "expected standard deviations"))


def test_solve_moves_a_ball_exactly_to_its_place(draw_scene):
    want = '"1" in pocketed and cue near (1.0, 1.56, 0.1)'
    vary = {"hit.1": (-0.1, 0.1), "cue.speed": (2, 3)}
    found = carom.solve(draw_scene, want, vary, shots=4000, best=1, exact=True)[0]
    assert found.trouble == "" and found.miss <= 1e-6
    assert found.values["cue.aim_deg"] == pytest.approx(135, abs=2) and "hit.1" not in found.values
    end = carom.simulate(found.scene)
    assert end.states(end.duration)[0, 0, :2] == pytest.approx([1.0, 1.56], abs=1e-5)
    refused(ValueError, lambda **more: carom.solve(draw_scene, shots=1000, exact=True, **more),
            ({"want": "scratch"}, "the goal has no place"))


def test_a_break():
    best, *_ = carom.best_break("ten_ball", shots=1000, best=1)
    told = json.loads(carom_program("break", "ten_ball", "--shots", 1000, "--best", 1, "--json"))
    assert told["solutions"][0]["values"] == best.values
    refused(ValueError, lambda **more: carom.best_break(**more), ({"game": "chess"}, 'no break for "chess"'),
            ({"speed_max": 50.0}, "1 to 20 m/s"), ({"rack": 0.1}, "unknown rack \"gap=0.1\""),
            ({"rack": "wood"}, "use template, triangle"))


def test_names_match_the_engine():
    pages = carom_program("describe", "scene-format")
    for table in typing.get_args(_names.TableName):
        assert f"`{table}`" in pages
        carom.Scene(table=table, ball=[{"id": "cue", "position": [0.5, 0.5]}])
    assert typing.get_args(_names.RackName) == tuple(carom._carom.break_games())
    for game in typing.get_args(_names.GameName):
        carom.games.new_game(game)
    with pytest.raises(ValueError, match=", ".join(typing.get_args(_names.GameName))):
        carom.games.new_game("chess")


def test_paths_match_the_records(draw_scene):
    times = np.array([0.0, 0.2, 1.0, 99.0])
    cue = np.array([[2.25, 135, 0, 0, -0.4], [3.0, 134, 0, 0.1, 0]])
    shots = carom.simulate_many(draw_scene, cue=cue, times=times)
    assert shots.paths.shape == (2, 4, 2, 3)
    one = carom.simulate(draw_scene)
    np.testing.assert_array_equal(shots.paths[0], one.states(times)[:, :, 0])
    xy = np.broadcast_to(draw_scene.positions, (2, 2, 2)).copy()
    xy[1, 1] = np.nan
    fewer = carom.simulate_many(draw_scene, cue=cue, xy=xy, times=times, threads=2)
    assert np.isnan(fewer.paths[1, :, 1]).all() and np.isfinite(fewer.paths[1, :, 0]).all()
    np.testing.assert_array_equal(fewer.paths[0], shots.paths[0])
    bad = carom.simulate_many(draw_scene, params={"cue.speed": [-1.0]}, times=times)
    assert np.isnan(bad.paths).all()
    again = carom.simulate_many(draw_scene, cue=cue, times=times, out=shots)
    assert again.paths is shots.paths
    refused(ValueError, lambda **more: carom.simulate_many(draw_scene, cue=cue, **more),
            ({"times": [[0.0]]}, r"times: expected the shape \(t,\)"),
            ({"times": [math.nan]}, "leave NaN out"),
            ({"times": [0.0], "out": shots}, "out.paths: expected"))


def test_shots_are_tables(draw_scene):
    shots = carom.simulate_many(draw_scene, params={"cue.speed": [2.25, -1.0]}, hashes=True)
    for make, rows in (("to_pandas", "to_dict"), ("to_arrow", "to_pylist"), ("to_polars", "to_dicts")):
        try:
            table = getattr(shots, make)()
        except ImportError as error:
            assert "pip install" in str(error)
            continue
        one, two = table.to_dict("records") if rows == "to_dict" else getattr(table, rows)()
        assert one["status"] == "at_rest" and one["first_hit"] == "1" and one["1.pocket"] == "p3"
        assert one["cue.x"] == shots.xy[0, 0, 0] and one["hash"] == shots.hash[0] and one["message"] == ""
        assert two["status"] == "invalid" and "cue.speed" in two["message"] and two["first_hit"] != "1"


def test_a_repr_is_short_with_shapes_and_units(break_scene):
    shots = carom.simulate_many(break_scene, shots=1000, max_events=2, hashes=True, times=[0.0])
    record = carom.simulate(break_scene)
    for thing, words in ((shots, ("1000 shots of 16 balls", "xy [m] (1000, 16, 2)", "duration [s]")),
                         (record, ("16 balls (", "events", " s, at_rest")),
                         (break_scene, ("1.270 x 2.540 m", "16 balls ("))):
        assert len(repr(thing).splitlines()) <= 10 and all(word in repr(thing) for word in words), repr(thing)


def test_the_package_includes_the_scenes():
    assert carom.scenes.names() == sorted(path.stem for path in (SOURCE / "scenes").glob("*.toml"))
    assert carom.scenes.load("draw") == carom.Scene.load(SOURCE / "scenes/draw.toml")
    assert carom.simulate(carom.scenes.path("draw")).stopped == "at_rest"
    refused(ValueError, carom.scenes.load, ("pot", "expected one of bar_break, "))


def test_the_measures_of_tables():
    tables = carom.tables()
    assert set(tables) >= {"nine_foot", "nine_foot_tight", "snooker", "carom_small"}
    nine = tables["nine_foot"]
    assert nine["balls"] == "pool" and nine["size"] == (1.27, 2.54)
    corner = nine["corner_pockets"]
    # The mouth as seen from this angle is as wide as the ball.
    assert corner["mouth"] * np.cos(np.radians(corner["cut_off_deg"])) == pytest.approx(0.05715)
    assert tables["nine_foot_tight"]["corner_pockets"]["cut_off_deg"] < corner["cut_off_deg"]
    assert "corner_pockets" not in tables["carom"] and tables["carom"]["balls"] == "carom"
    assert tables["pyramid"]["corner_pockets"]["mouth"] == pytest.approx(0.0725)
    assert {table["balls"] for table in tables.values()} == {
        "pool", "snooker", "carom", "english_pool", "pyramid"}
