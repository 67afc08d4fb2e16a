"""Sweeps in shards: the rows of `carom sweep` for any shards and workers, whole files, and refused ones."""

from __future__ import annotations

import os
import pathlib
import pickle
import signal
import subprocess
import sys

import carom
import numpy as np
import pytest
from carom import sweep
from conftest import HANGS, SLOW, SOURCE, program_sweep, refused
from test_sweep import RULES, all_the_same

pyarrow = pytest.importorskip("pyarrow", reason="pyarrow is not installed: pip install pyarrow")
parquet = pytest.importorskip("pyarrow.parquet")
distributed = pytest.importorskip("distributed", reason="it is not installed: pip install distributed")

from carom.sweep import _shards  # noqa: E402

DRAW = ["cue.aim_deg=normal(2)", "cue.speed=uniform(1,4)"]
# Half of these shots reach a state that cannot be computed.
STUCK = """
balls = {mu_s = 0.6, mu_b = 4.0}
physics = {substeps = 10}
ball = [
    {id = "a", position = [0.6, 1], velocity = [0, 1], spin = [-1e6, 0, 0]},
    {id = "b", position = [0.6, 1.06]},
]
stop = {time = 1}
"""


def draw_plan(shots=60, shard=7, **more):
    return sweep.plan(SOURCE / "scenes/draw.toml", DRAW, shots, shard=shard, seed=4, **more)


def break_plan(shots, shard):
    """Each shot lasts milliseconds, which leaves time to kill a worker."""
    rules = ["cue.aim_deg=normal(0.3)", "cue.speed=uniform(8,10)"]
    return sweep.plan(SOURCE / "scenes/eight_ball_break.toml", rules, shots, shard=shard)


def stamps(folder):
    """Values per shard file that change when the file is rewritten."""
    return {path.name: (path.stat().st_ino, path.stat().st_mtime_ns)
            for path in pathlib.Path(folder).glob("*.parquet")}


def contents(folder):
    return {path.name: path.read_bytes() for path in pathlib.Path(folder).glob("*.parquet")}


def unfinished(folder):
    return [path.name for path in pathlib.Path(folder).glob("*.tmp")]


@pytest.fixture(scope="module")
def client():
    """A Dask cluster in this process."""
    options = {"processes": False, "n_workers": 1, "threads_per_worker": 1, "dashboard_address": None}
    with distributed.Client(**options) as dask:
        yield dask


@pytest.mark.parametrize("name", RULES)
def test_any_shards_and_workers_match_the_program(tmp_path, name, client):
    path, count, rules = SOURCE / f"scenes/{name}.toml", 60, RULES[name]
    header, rows = program_sweep(tmp_path, path, rules, count, 4)
    tables = []
    for shard, threads, dask in (1, 4, None), (7, 1, None), (7, 2, client), (1000, 2, None):
        folder = tmp_path / f"{shard}-{threads}"
        done = sweep.run(sweep.plan(path, rules, count, seed=4, shard=shard), folder, dask, threads=threads)
        assert (done.rows, done.played) == (count, count)
        assert sweep.check(folder).whole and sweep.check(folder).outcomes == done.outcomes
        tables.append(sweep.open(folder).to_table())
    assert all(table.equals(tables[0]) for table in tables)
    all_the_same(header, rows, tables[0].to_pydict())
    # A file depends neither on the process that makes it nor on the other files.
    assert contents(tmp_path / "7-1") == contents(tmp_path / "7-2")


def test_a_file_states_its_origin(tmp_path):
    plan = draw_plan(20, 8)
    sweep.run(plan, tmp_path)
    table = parquet.read_table(tmp_path / "shard-1.parquet")
    said = {key.decode(): value.decode() for key, value in table.schema.metadata.items()}
    assert said == {"carom.plan": plan.id, "carom.version": carom.__version__, "carom.vary": "\n".join(DRAW),
                    "carom.scene": plan.scene, "carom.seed": "4", "carom.first": "8", "carom.last": "16"}
    units = {field.name: field.metadata[b"unit"].decode() for field in table.schema if field.metadata}
    metres = {f"{ball}.{axis}": "m" for ball in ("cue", "1") for axis in "xy"}
    assert units == {"cue.aim_deg": "degrees", "cue.speed": "m/s", "duration": "s"} | metres


def test_a_resumed_sweep_plays_only_missing_shards(tmp_path, client):
    plan = draw_plan(40, 10)
    for shard in 2, 0:
        assert sweep.run_shard(plan, shard, tmp_path)["played"]
    assert not sweep.run_shard(plan, 0, tmp_path)["played"]
    plan.save(tmp_path / "plan.json")
    found = sweep.status(tmp_path)
    assert (found.finished, found.missing, found.rows, found.whole) == ((0, 2), (1, 3), 20, False)
    with pytest.raises(sweep.SweepError, match="2 of 4 shards are missing"):
        sweep.open(tmp_path)
    assert sweep.open(tmp_path, partial=True).to_table()["shot"].to_pylist() == [*range(10), *range(20, 30)]
    before = stamps(tmp_path)
    assert sweep.run(plan, tmp_path, client) == (40, 20, {"at_rest": 40})
    (tmp_path / "shard-3.parquet").unlink()
    assert sweep.run(plan, tmp_path, client) == (40, 10, {"at_rest": 40})
    assert before.items() <= stamps(tmp_path).items()
    assert sweep.check(tmp_path).whole


def test_a_changed_plan_is_refused(tmp_path):
    plan = draw_plan(30, 10)
    sweep.run(plan, tmp_path / "a")
    for other in draw_plan(31, 10), draw_plan(30, 11), plan._replace(game="snooker"):
        with pytest.raises(sweep.SweepError, match="plan.json: another plan is already there"):
            sweep.run(other, tmp_path / "a")
    path = tmp_path / "a/plan.json"
    assert sweep.Plan.load(path) == plan == pickle.loads(pickle.dumps(plan))
    text = path.read_text()
    changed = "the plan was changed by hand or is damaged"
    for changed_text, message in [
        (text.replace('"shots": 30', '"shots": 31'), changed),
        (text.replace('"seed": 4', '"sed": 4'), changed),
        (text[:-10], r"plan.json:\d+:\d+: .*; make a new plan"),
        ("[]", 'plan.json: not a plan of a sweep: "format" must be'),
        (text.replace("plan 2", "plan 1"), 'plan.json: not a plan of a sweep: "format" must be'),
        ("\udcff", "plan.json: cannot read it: .*utf-8"),
    ]:
        path.write_text(changed_text, errors="surrogateescape")
        with pytest.raises(sweep.SweepError, match=message):
            sweep.run(plan, tmp_path / "a")
    with pytest.raises(OSError, match="cannot write: No such file.*nowhere/p.json"):
        plan.save(tmp_path / "nowhere/p.json")
    with pytest.raises(sweep.SweepError, match="plan.json: cannot read it: No such file"):
        sweep.status(tmp_path)


def test_impossible_plans_are_explained(tmp_path):
    refused(
        ValueError,
        lambda **options: sweep.plan(
            **{"scene": SOURCE / "scenes/draw.toml", "vary": DRAW, "shots": 10} | options),
        ({"shots": 0}, r"shots=0: expected 1 to 2\*\*53"),
        ({"shots": 2**53 + 1}, r"expected 1 to 2\*\*53"),
        ({"shard": 0}, "shard=0: expected at least 1, for at most 100000 shards"),
        ({"shots": 2**53}, "shard=250000: expected at least 90071992548"),
        ({"seed": -1}, "seed=-1"),
        ({"vary": "cue.speed=uniform(1,2)"}, "vary: expected a mapping or a list"),
        ({"vary": ["cue.spede=uniform(1,2)"]}, r"unknown key \"spede\" in \[cue\]; .*; did you mean speed\?"),
        ({"scene": "nowhere.toml"}, "nowhere.toml"),
    )
    large = draw_plan(2**53, 10**11)
    assert large.range(large.shards - 1)[1] == 2**53 and large.file(0) == "shard-00000.parquet"
    with pytest.raises(ValueError, match="shard=90072: expected 0 to 90071"):
        large.range(90072)
    with pytest.raises(ValueError, match="client='dask': expected a distributed.Client"):
        sweep.run(draw_plan(), tmp_path, "dask")


def test_the_last_shots_of_the_largest_sweep_are_played(tmp_path):
    # Cut so that the last shard has few shots, whose values survive.
    small = draw_plan(2**53, 10**11)._replace(shard=2**53 - 5)
    sweep.run_shard(small, 1, tmp_path)
    table = parquet.read_table(tmp_path / small.file(1))
    assert table["shot"].to_pylist() == list(range(2**53 - 5, 2**53))
    alone = sweep.columns(carom.Scene.load(SOURCE / "scenes/draw.toml"), DRAW, 2**53, seed=4, first=2**53 - 2)
    assert table["cue.speed"].to_pylist()[-2:] == alone["cue.speed"].tolist()


@pytest.mark.parametrize("wrong", [{"version": "0.0.9"}, {"probe": "0" * 64}])
def test_a_worker_with_another_carom_refuses(tmp_path, client, wrong):
    plan = draw_plan()._replace(**wrong)
    here = f"{os.uname().nodename}, process {os.getpid()}: carom {carom.__version__} is another build"
    assert draw_plan().probe != sweep.plan(SOURCE / "scenes/draw.toml", DRAW, 60, seed=5).probe
    for dask in None, client:
        with pytest.raises(sweep.SweepError, match=here):
            sweep.run(plan, tmp_path, dask)
        with pytest.raises(sweep.SweepError, match=here):
            sweep.reduce(plan, len, dask)
    assert contents(tmp_path) == {}


def test_failed_shots_are_rows_and_are_counted(tmp_path):
    plan = sweep.plan(carom.Scene.loads(STUCK, "s.toml"), ["balls.mu_s=list(0.6,0.0)"], 8, shard=3)
    done = sweep.run(plan, tmp_path, threads=1)
    assert done.outcomes["failed"] > 0 and done.outcomes["failed"] + done.outcomes["time"] == 8
    rows = sweep.open(tmp_path).to_table().to_pylist()
    assert [row["status"] == "failed" for row in rows] == [
        "reached its limit of steps" in row["message"] for row in rows]
    assert all((row["duration"] is None) == (row["status"] == "failed") for row in rows)


def test_a_reduction_matches_the_rows_and_merges_in_order(client):
    plan = draw_plan(1000, 90)

    def moments(table):
        duration = table["duration"].to_numpy()
        return {"shots": len(table), "sums": (duration.sum(), (duration**2).sum()),
                "histogram": np.histogram(duration, 10, (0, 10))[0],
                **({"only in some": 1} if table["shot"][0].as_py() == 90 else {})}

    whole = sweep.reduce(plan, moments, threads=3)
    duration = sweep.table(SOURCE / "scenes/draw.toml", DRAW, 1000, seed=4)["duration"].to_numpy()
    # Equal bit for bit, because results are merged in the order of the shards.
    assert whole["sums"][0] == sum(duration[k : k + 90].sum() for k in range(0, 1000, 90))
    assert whole["histogram"].tolist() == np.histogram(duration, 10, (0, 10))[0].tolist()
    assert (whole["shots"], whole["only in some"]) == (1000, 1)
    again = sweep.reduce(plan, moments, client)
    assert all(np.array_equal(whole[key], again[key]) for key in whole)
    first = sweep.reduce(plan, lambda table: [table["shot"][0].as_py()], client, merge=lambda a, b: a + b)
    assert first == list(range(0, 1000, 90))
    with pytest.raises(ValueError, match="shorter"):
        sweep.reduce(plan, lambda table: [0] * len(table))
    with pytest.raises(ZeroDivisionError):
        sweep.reduce(plan, lambda table: 1 / 0, client, retries=0)


def test_dask_repeats_a_shard_that_ended_with_an_error(tmp_path, client, monkeypatch):
    write, calls = _shards._write, []

    def sometimes(table, file):
        calls.append(table)
        if len(calls) < 3:
            raise OSError(5, "a network file system has a bad day")
        write(table, file)

    monkeypatch.setattr(_shards, "_write", sometimes)
    words = "cannot write: a network file system has a bad day: .*shard-0.parquet"
    with pytest.raises(OSError, match=words) as kept:
        sweep.run(draw_plan(10, 10), tmp_path, client, retries=1)
    assert contents(tmp_path) == {} and unfinished(tmp_path) == []
    calls.clear()
    # Dask still knows the failed task, as after an error in a notebook, but plays it again.
    assert sweep.run(draw_plan(10, 10), tmp_path, client, retries=2).played == 10
    assert kept.traceback


def test_a_worker_killed_while_writing_leaves_no_half_file(tmp_path):
    plan = draw_plan(20, 10)
    plan.save(tmp_path / "plan.json")
    code = f"""
import os, signal
from carom import sweep
from carom.sweep import _shards
def half(table, file):
    file.write(b"PAR1")
    file.flush()
    os.kill(os.getpid(), signal.SIGKILL)
_shards._write = half
sweep.run_shard({str(tmp_path / "plan.json")!r}, 0, {str(tmp_path)!r})
"""
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == -signal.SIGKILL
    assert contents(tmp_path) == {} and len(unfinished(tmp_path)) == 1
    assert sweep.status(tmp_path).missing == (0, 1)
    assert sweep.run(plan, tmp_path).played == 20
    assert sweep.check(tmp_path).whole and unfinished(tmp_path) == []


def test_a_late_twin_is_harmless(tmp_path, monkeypatch):
    plan = draw_plan(10, 10)
    write = _shards._write

    def late(table, file):
        # Meanwhile another run makes the shard and removes unfinished files.
        monkeypatch.setattr(_shards, "_write", write)
        assert sweep.run(plan, tmp_path).played == 10
        assert unfinished(tmp_path) == []
        write(table, file)

    monkeypatch.setattr(_shards, "_write", late)
    assert sweep.run_shard(plan, 0, tmp_path)["outcomes"] == {"at_rest": 10}
    assert sweep.check(tmp_path).whole and unfinished(tmp_path) == []


def test_ctrl_c_ends_a_run_soon_and_the_next_one_resumes(tmp_path):
    plan = break_plan(100_000, 300)
    plan.save(tmp_path / "p.json")
    code = f"""
import os, signal, threading, time
from carom import sweep
def press():
    while not os.path.exists({str(tmp_path / "a/shard-001.parquet")!r}):
        time.sleep(0.005)
    os.kill(os.getpid(), signal.SIGINT)
threading.Thread(target=press).start()
sweep.run(sweep.Plan.load({str(tmp_path / "p.json")!r}), {str(tmp_path / "a")!r})
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=HANGS,
                          check=False)
    assert done.stderr.endswith("KeyboardInterrupt\n")
    assert unfinished(tmp_path / "a") == [] and 2 <= len(contents(tmp_path / "a")) < 300
    assert sweep.check(tmp_path / "a").faults == {}


def test_every_reader_names_a_damaged_or_foreign_file(tmp_path):
    plan, other = draw_plan(30, 10), draw_plan(31, 10)
    sweep.run(plan, tmp_path / "a")
    sweep.run(other, tmp_path / "b")
    path = tmp_path / "a/shard-1.parquet"
    whole = path.read_bytes()
    foreign = f"its rows are not shots 10 to 19 of plan {plan.id}; remove it, or use another folder"
    parquet.write_table(parquet.read_table(path).slice(1), tmp_path / "fewer")
    for data, words in [
        ((tmp_path / "b/shard-1.parquet").read_bytes(), foreign),
        ((tmp_path / "fewer").read_bytes(), foreign),
        ((tmp_path / "a/shard-0.parquet").read_bytes(), foreign),
        *((whole[:length], r"damaged \(.*\); remove it and run the sweep again")
          for length in (0, 3, 100, len(whole) // 2, len(whole) - 8, len(whole) - 1)),
    ]:
        path.write_bytes(data)
        assert list(sweep.check(tmp_path / "a").faults) == ["shard-1.parquet"]
        for call in (
            lambda: sweep.open(tmp_path / "a"),
            lambda: sweep.open(tmp_path / "a", verify=False),
            lambda: sweep.run_shard(plan, 1, tmp_path / "a"),
            lambda: sweep.run(plan, tmp_path / "a"),
        ):
            with pytest.raises(sweep.SweepError, match=f"shard-1.parquet: {words}"):
                call()
    path.unlink()
    assert sweep.run(plan, tmp_path / "a").played == 10
    assert path.read_bytes() == whole


def test_a_flipped_byte_is_found_or_changes_nothing(tmp_path):
    plan = draw_plan(3, 3)
    sweep.run(plan, tmp_path)
    path = tmp_path / plan.file(0)
    whole, table = path.read_bytes(), sweep.open(tmp_path).to_table()
    found = 0
    step = 1 if SLOW else 41
    for place in range(0, len(whole), step):
        path.write_bytes(whole[:place] + bytes([whole[place] ^ (1 << place % 8)]) + whole[place + 1 :])
        if sweep.check(tmp_path).faults:
            found += 1
            with pytest.raises(sweep.SweepError, match="shard-0.parquet"):
                sweep.open(tmp_path)
        else:  # in bytes that readers ignore: the writer's name, the sizes of parts
            assert sweep.open(tmp_path).to_table().equals(table, check_metadata=True), place
    assert found > 0.6 * len(whole) / step


def test_a_damaged_page_is_not_read(tmp_path):
    plan = draw_plan(20_000, 20_000)
    sweep.run(plan, tmp_path)
    path = tmp_path / plan.file(0)
    rows = sweep.open(tmp_path, verify=False)
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 1
    path.write_bytes(data)
    with pytest.raises(OSError, match="CRC|checksum|corrupt"):
        rows.to_table()


def test_a_full_disk_leaves_no_file_and_work_resumes_with_room(tmp_path):
    plan = draw_plan(30_000, 10_000)
    plan.save(tmp_path / "plan.json")
    code = f"""
import resource, signal
from carom import sweep
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, resource.RLIM_INFINITY))
try:
    sweep.run(sweep.Plan.load({str(tmp_path / "plan.json")!r}), {str(tmp_path)!r}, threads=1)
except OSError as error:
    print(error)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == f"[Errno 27] cannot write: File too large: '{tmp_path}/shard-0.parquet'\n"
    assert done.stderr == ""
    assert contents(tmp_path) == {} and unfinished(tmp_path) == []
    assert sweep.run(plan, tmp_path).played == 30_000
    assert sweep.check(tmp_path).whole


def test_duckdb_reads_the_files(tmp_path):
    duckdb = pytest.importorskip("duckdb", reason="duckdb is not installed: pip install duckdb")
    plan = sweep.plan(SOURCE / "scenes/eight_ball_break.toml", RULES["eight_ball_break"], 60, shard=25)
    sweep.run(plan, tmp_path)
    rows = sweep.open(tmp_path).to_table().to_pylist()
    columns = "count(*), sum(events), count(DISTINCT shot), sum((pocketed <> '')::int)"
    assert duckdb.sql(f"SELECT {columns} FROM '{tmp_path}/*.parquet'").fetchall()[0] == (
        60, sum(row["events"] for row in rows), 60, sum(row["pocketed"] != "" for row in rows))


def test_without_pyarrow_the_package_is_named(tmp_path):
    draw_plan().save(tmp_path / "plan.json")
    code = f"""
import sys
sys.modules["pyarrow"] = None
from carom import sweep
try:
    sweep.run(sweep.Plan.load({str(tmp_path / "plan.json")!r}), {str(tmp_path)!r})
except ImportError as error:
    print(error)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "pip install pyarrow" in done.stdout
