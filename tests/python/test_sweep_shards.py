"""Sharded sweeps: the rows of `carom sweep` for any shards and workers, checked plans, and files that state
their origin."""

from __future__ import annotations

import concurrent.futures
import json
import multiprocessing
import multiprocessing.pool
import pickle
import subprocess
import sys
import time

import carom
import numpy as np
import pytest
from carom import sweep
from conftest import SOURCE, program_sweep, refused
from sweep_support import DRAW, STUCK, contents, draw_plan
from test_sweep import RULES, all_the_same

pyarrow = pytest.importorskip("pyarrow", reason="pyarrow is not installed: pip install pyarrow")
parquet = pytest.importorskip("pyarrow.parquet")

from carom.sweep import _plan, _shard  # noqa: E402


@pytest.mark.parametrize("name", RULES)
def test_any_shards_and_workers_match_the_program(tmp_path, name):
    path, count, rules = SOURCE / f"scenes/{name}.toml", 60, RULES[name]
    header, rows = program_sweep(tmp_path, path, rules, count, 4)
    tables = []
    for shard, threads in (1, 4), (7, 1), (7, 2), (1000, 2):
        folder = tmp_path / f"{shard}-{threads}"
        done = sweep.run(sweep.plan(path, rules, count, seed=4, shard=shard), folder, threads=threads)
        assert (done.done, done.rows, done.played) == (-(-count // shard), count, count)
        tables.append(sweep.open(folder).to_table())
    assert all(table.equals(tables[0]) for table in tables)
    all_the_same(header, rows, tables[0].to_pydict())
    # A file depends neither on the process that makes it nor on the other files.
    assert contents(tmp_path / "7-1") == contents(tmp_path / "7-2")


def test_spawned_processes_make_the_same_files(tmp_path):
    plan = draw_plan()
    sweep.run(plan, tmp_path / "threads")
    with concurrent.futures.ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn")) as pool:
        assert sweep.run(plan, tmp_path / "processes", pool).played == 60
        again = sweep.reduce(plan, _moments, pool)
    assert contents(tmp_path / "threads") == contents(tmp_path / "processes")
    assert again == sweep.reduce(plan, _moments, threads=1)
    with multiprocessing.pool.ThreadPool(2) as pool:  # it has no submit
        assert sweep.run(plan, tmp_path / "map", pool).played == 60
        assert sweep.reduce(plan, _moments, pool) == again
    assert contents(tmp_path / "threads") == contents(tmp_path / "map")


def _moments(table):
    import pyarrow.compute

    duration = table["duration"].to_numpy()
    return {"shots": len(table), "sums": (duration.sum(), (duration**2).sum()),
            "histogram": np.histogram(duration, 10, (0, 10))[0].tolist()}


def test_a_reduction_matches_the_rows_and_merges_in_order(tmp_path):
    plan = draw_plan(1000, 90)
    whole = sweep.reduce(plan, _moments, threads=3, merge=_add)
    duration = sweep.table(
        carom.Scene.load(SOURCE / "scenes/draw.toml"), DRAW, 1000, seed=4)["duration"].to_numpy()
    parts = [duration[k : k + 90] for k in range(0, 1000, 90)]
    # Equal bit for bit, because results are merged in the order of the shards.
    assert whole["sums"][0] == sum(part.sum() for part in parts)
    assert whole["histogram"] == np.histogram(duration, 10, (0, 10))[0].tolist()
    first = sweep.reduce(plan, lambda table: [table["shot"][0].as_py()], threads=4, merge=lambda a, b: a + b)
    assert first == list(range(0, 1000, 90))
    added = sweep.reduce(plan, lambda table: (
        {"n": len(table)}, np.ones(3), 0.5, {"only in some": 1} if table["shot"][0].as_py() == 90 else {}))
    assert added[0] == {"n": 1000} and added[1].tolist() == [12.0] * 3
    assert added[2:] == (6.0, {"only in some": 1})
    with pytest.raises(ZeroDivisionError):
        sweep.reduce(plan, lambda table: 1 / 0)


def _add(a, b):
    return {
        "shots": a["shots"] + b["shots"],
        "sums": tuple(x + y for x, y in zip(a["sums"], b["sums"])),
        "histogram": [x + y for x, y in zip(a["histogram"], b["histogram"])],
    }


def test_a_file_states_its_origin(tmp_path):
    scene = carom.Scene.load(SOURCE / "scenes/draw.toml")
    plan = draw_plan(20, 8, hashes="column")
    sweep.run(plan, tmp_path)
    table = parquet.read_table(tmp_path / "shard-1.parquet")
    file = parquet.read_metadata(tmp_path / "shard-1.parquet")
    said = {key.decode(): value.decode() for key, value in file.metadata.items()}
    assert all(said[key.decode()] == value.decode() for key, value in table.schema.metadata.items())
    assert carom.Scene.loads(table.schema.metadata[b"carom.scene"].decode()) == scene
    assert said["carom.scene_sha256"] == _plan.sha256(scene.source.encode())
    wanted = {"plan": plan.id, "version": carom.__version__, "vary": "\n".join(DRAW), "seed": "4",
              "first": "8", "last": "16"}
    assert {key: said[f"carom.{key}"] for key in wanted} == wanted
    assert said["carom.writer"] == f"pyarrow {pyarrow.__version__}"
    assert json.loads(said["carom.outcomes"]) == {"at_rest": 8}
    units = {
        field.name: field.metadata[b"unit"].decode() for field in table.schema if field.metadata
        and b"unit" in field.metadata}
    metres = {f"{ball}.{axis}": "m" for ball in ("cue", "1") for axis in "xy"}
    assert units == {"cue.aim_deg": "degrees", "cue.speed": "m/s", "duration": "s"} | metres
    # A row can be replayed and compared; the digest is over these hashes.
    hashes = table["record_hash"].to_numpy()
    for row in table.to_pylist()[:3]:
        again = carom.simulate(scene.replace(**{key: row[key] for key in ("cue.aim_deg", "cue.speed")}))
        assert int(again.hash(), 16) == row["record_hash"]

    def records(name, plan, shard):
        (tmp_path / name).mkdir()
        return sweep.run_shard(plan, shard, tmp_path / name)["records"]

    digest = records("all", draw_plan(140, 130, hashes="column"), 0)
    all_hashes = parquet.read_table(tmp_path / "all/shard-0.parquet")["record_hash"].to_numpy()
    assert (hashes == all_hashes[8:16]).all()
    assert said["carom.records_every"] == "64"
    assert digest == _plan.sha256(all_hashes[[0, 64, 128]].astype("<u8").tobytes())
    assert records("digest", draw_plan(140, 130), 0) == digest
    assert records("late", draw_plan(140, 60), 1) == _plan.sha256(all_hashes[[64]].astype("<u8").tobytes())
    assert records("none", draw_plan(20, 8, hashes="none"), 1) == ""


def test_the_content_hash_is_independent_of_a_tables_chunks(draw_scene):
    table = sweep.table(draw_scene, RULES["draw"], 100)
    assert table["duration"].null_count > 0

    def digest(*parts):
        content = _shard.ContentHash(parts[0].schema)
        for part in parts:
            content.add(part)
        return content.hexdigest()

    whole = digest(table)
    assert whole == digest(table.slice(0, 0), table.slice(0, 33), table.slice(33, 1), table.slice(34))
    assert whole == digest(pyarrow.concat_tables([table.slice(0, 50), table.slice(50)]))
    assert whole != digest(table.slice(0, 99)) and whole != digest(table.slice(50), table.slice(0, 50))
    # The digest distinguishes null from 0, and the ends of strings.
    one, two = (pyarrow.table({"a": pyarrow.array(values)}) for values in (["ab", "c"], ["a", "bc"]))
    null, zero = (
        pyarrow.table({"a": pyarrow.array(values, pyarrow.int64())}) for values in ([1, None], [1, 0]))
    assert len({digest(part) for part in (one, two, null, zero)}) == 4


def test_failed_shots_are_rows_and_are_counted(tmp_path):
    plan = sweep.plan(carom.Scene.loads(STUCK, "s.toml"), ["balls.mu_s=list(0.6,0.0)"], 8, shard=3)
    told = []
    done = sweep.run(plan, tmp_path, progress=told.append, threads=1)
    assert done.failed > 0 and done.failed + done.outcomes["time"] == 8
    assert [progress.done for progress in told] == [0, 1, 2, 3]
    rows = sweep.open(tmp_path).to_table().to_pylist()
    assert [row["outcome"] == "failed" for row in rows] == [
        "reached its limit of steps" in row["message"] for row in rows]
    assert all((row["duration"] is None) == (row["outcome"] == "failed") for row in rows)
    assert sweep.check(tmp_path).outcomes == done.outcomes


def test_a_plan_reads_back_and_is_refused_if_changed(tmp_path):
    path = tmp_path / "p.json"
    plan = draw_plan()
    plan.save(path)
    plan.save(path)
    assert sweep.Plan.load(path) == plan == pickle.loads(pickle.dumps(plan))
    tree = json.loads(path.read_text())
    assert (tree["scene"], tree["vary"], tree["seed"], tree["shots"], tree["shard"], tree["version"]) == (
        (SOURCE / "scenes/draw.toml").read_text(),
        DRAW,
        4,
        60,
        7,
        carom.__version__,
    )
    with pytest.raises(sweep.SweepError, match="p.json: another plan is already there"):
        draw_plan(61).save(path)
    with pytest.raises(sweep.SweepError, match="nowhere/p.json: cannot write it: No such file"):
        plan.save(tmp_path / "nowhere/p.json")
    for text, message in [
        (path.read_text().replace('"shots": 60', '"shots": 61'),
         "p.json: the plan was changed by hand or is damaged"),
        (path.read_text().replace('"seed": 4', '"sed": 4'),
         "p.json: the plan was changed by hand or is damaged"),
        (path.read_text()[:-10], r"p.json:\d+:\d+: .*; a plan is written"),
        ("[]", 'p.json: not a plan of a sweep: "format" must be'),
        ("\udcff", "p.json: cannot read it: .*utf-8"),
    ]:
        path.write_text(text, errors="surrogateescape")
        with pytest.raises(sweep.SweepError, match=message):
            sweep.Plan.load(path)
    with pytest.raises(sweep.SweepError, match="plan.json: cannot read it: No such file"):
        sweep.status(tmp_path)


def test_impossible_plans_are_explained():
    refused(
        ValueError,
        lambda **options: sweep.plan(
            **{"scene": SOURCE / "scenes/draw.toml", "vary": DRAW, "shots": 10} | options),
        ({"shots": 0}, r"shots=0: expected 1 to 2\*\*53"),
        ({"shots": 2**53 + 1}, r"expected 1 to 2\*\*53"),
        ({"shard": 0}, "shard=0: expected at least 1"),
        ({"shots": 2**53}, "more than 10000000 shards; use at least 900719926 shots in each"),
        ({"hashes": "all"}, "hashes='all': expected one of none, digest, column"),
        ({"seed": -1}, "seed=-1"),
        ({"vary": "cue.speed=uniform(1,2)"}, "vary: expected a mapping or a list"),
        ({"vary": ["cue.spede=uniform(1,2)"]}, r"unknown key \"spede\" in \[cue\]; .*; did you mean speed\?"),
        ({"scene": "nowhere.toml"}, "nowhere.toml"),
    )
    large = draw_plan(2**53, 10**10)
    assert large.range(large.shards - 1)[1] == 2**53 and large.file(0) == "shard-000000.parquet"
    with pytest.raises(ValueError, match="shard=900720: expected 0 to 900719"):
        large.range(900720)
    with pytest.raises(ValueError, match="executor='dask'"):
        sweep.run(draw_plan(), "nowhere", "dask")


def test_the_last_shots_of_the_largest_sweep_are_played(tmp_path):
    large = draw_plan(2**53, 10**10)
    # Cut so that the last shard has few shots, whose values survive.
    small = large._replace(shard=2**53 - 5)
    sweep.run_shard(small, 1, tmp_path)
    table = parquet.read_table(tmp_path / small.file(1))
    assert table["shot"].to_pylist() == list(range(2**53 - 5, 2**53))
    alone = sweep.columns(carom.Scene.load(SOURCE / "scenes/draw.toml"), DRAW, 2**53, seed=4, first=2**53 - 2)
    assert table["cue.speed"].to_pylist()[-2:] == alone["cue.speed"].tolist()


def test_duckdb_reads_the_files(tmp_path):
    duckdb = pytest.importorskip("duckdb", reason="duckdb is not installed: pip install duckdb")
    plan = sweep.plan(SOURCE / "scenes/eight_ball_break.toml", RULES["eight_ball_break"], 60, shard=25)
    sweep.run(plan, tmp_path)
    table = sweep.open(tmp_path).to_table()
    columns = "count(*), sum(events), count(DISTINCT shot), sum((pocketed <> '')::int)"
    query = f"SELECT {columns} FROM '{tmp_path}/*.parquet'"
    rows = table.to_pylist()
    assert duckdb.sql(query).fetchall()[0] == (
        60, sum(row["events"] for row in rows), 60, sum(row["pocketed"] != "" for row in rows))


def test_the_plan_of_the_study_can_be_read():
    plan = sweep.Plan.load(SOURCE / "lab/notes/2026-11-million_breaks.json")
    assert (plan.shots, plan.shards) == (1_000_000, 20)


def test_without_pyarrow_the_extra_is_named():
    code = """
import sys
sys.modules["pyarrow"] = None
from carom import sweep
try:
    sweep.check("nowhere")
except ImportError as error:
    print(error)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "pip install pyarrow" in done.stdout
