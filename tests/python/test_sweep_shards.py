"""Sweeps in shards: the rows of `carom sweep` whatever the shards and workers, whole files or none, and nothing wrong read silently."""

from __future__ import annotations

import concurrent.futures
import json
import multiprocessing
import multiprocessing.pool
import os
import pathlib
import pickle
import shutil
import signal
import subprocess
import sys
import time

import carom
import numpy as np
import pytest
from carom import sweep
from conftest import HANGS, SLOW, SOURCE, carom_program, rows_of
from test_sweep import RULES, same

pyarrow = pytest.importorskip("pyarrow", reason="pyarrow is not installed: pip install pyarrow")
parquet = pytest.importorskip("pyarrow.parquet")

from carom.sweep import _plan, _shard  # noqa: E402

DRAW = ["cue.aim_deg=normal(2)", "cue.speed=uniform(1,4)"]
# Each shot takes milliseconds: time to kill a worker in.
BREAKS = ["cue.aim_deg=normal(0.3)", "cue.speed=uniform(8,10)"]
# Half of the shots come to an end that nobody can compute.
STUCK = """
balls = {mu_s = 0.6, mu_b = 4.0}
physics = {substeps = 10}
ball = [{id = "a", position = [0.6, 1], velocity = [0, 1], spin = [-1e6, 0, 0]}, {id = "b", position = [0.6, 1.06]}]
stop = {time = 1}
"""


def draw_plan(shots=60, shard=7, **more):
    return sweep.plan(SOURCE / "scenes/draw.toml", DRAW, shots, shard=shard, seed=4, **more)


def break_plan(shots, shard):
    return sweep.plan(SOURCE / "scenes/eight_ball_break.toml", BREAKS, shots, shard=shard)


def stamps(folder):
    """For every file of a shard what changes when it is written again."""
    return {path.name: (path.stat().st_ino, path.stat().st_mtime_ns) for path in pathlib.Path(folder).glob("*.parquet")}


def contents(folder):
    return {path.name: path.read_bytes() for path in pathlib.Path(folder).glob("*.parquet")}


def unfinished(folder):
    return sorted(os.listdir(pathlib.Path(folder) / ".unfinished"))


def worker(plan, shard, folder, **options):
    """A process of its own that makes a shard."""
    code = f"from carom import sweep; print(sweep.run_shard({str(plan)!r}, {shard}, {str(folder)!r})['played'])"
    return subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options)


def wait_for(what):
    end = time.monotonic() + HANGS
    while not (found := what()):
        assert time.monotonic() < end, "it did not happen"
        time.sleep(0.005)
    return found


@pytest.mark.parametrize("name", RULES)
def test_any_shards_and_workers_give_the_rows_of_the_program(tmp_path, name):
    path, count, rules = SOURCE / f"scenes/{name}.toml", 60, RULES[name]
    carom_program("sweep", path, "--count", count, "--seed", 4, "-o", tmp_path / "s.csv", *[word for rule in rules for word in ("--vary", rule)])
    header, *rows = rows_of(tmp_path / "s.csv")
    tables = []
    for shard, threads in (1, 4), (7, 1), (7, 2), (1000, 2):
        folder = tmp_path / f"{shard}-{threads}"
        done = sweep.run(sweep.plan(path, rules, count, seed=4, shard=shard), folder, threads=threads)
        assert (done.done, done.rows, done.played) == (-(-count // shard), count, count)
        tables.append(sweep.open(folder).to_table())
    assert all(table.equals(tables[0]) for table in tables)
    assert tables[0].column_names == header
    for k, column in enumerate(header):
        wrong = [(row[k], value) for row, value in zip(rows, tables[0][column].to_pylist()) if not same(row[k], value)]
        assert not wrong, (column, wrong[:3])
    # Who makes a file, and in which company, is not in it.
    assert contents(tmp_path / "7-1") == contents(tmp_path / "7-2")


def test_processes_that_were_spawned_make_the_same_files(tmp_path):
    plan = draw_plan()
    sweep.run(plan, tmp_path / "threads")
    with concurrent.futures.ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn")) as pool:
        assert sweep.run(plan, tmp_path / "processes", pool).played == 60
        again = sweep.reduce(plan, _moments, pool)
    assert contents(tmp_path / "threads") == contents(tmp_path / "processes")
    assert again == sweep.reduce(plan, _moments, threads=1)
    with multiprocessing.pool.ThreadPool(2) as pool:  # has no submit
        assert sweep.run(plan, tmp_path / "map", pool).played == 60
        assert sweep.reduce(plan, _moments, pool) == again
    assert contents(tmp_path / "threads") == contents(tmp_path / "map")


def _moments(table):
    import pyarrow.compute

    duration = table["duration"].to_numpy()
    return {"shots": len(table), "sums": (duration.sum(), (duration**2).sum()), "histogram": np.histogram(duration, 10, (0, 10))[0].tolist()}


def test_a_reduction_is_that_of_the_rows_and_merges_in_order(tmp_path):
    plan = draw_plan(1000, 90)
    whole = sweep.reduce(plan, _moments, threads=3, merge=_add)
    duration = sweep.table(carom.Scene.load(SOURCE / "scenes/draw.toml"), DRAW, 1000, seed=4)["duration"].to_numpy()
    parts = [duration[k : k + 90] for k in range(0, 1000, 90)]
    assert whole["sums"][0] == sum(part.sum() for part in parts)  # to the bit: the order is that of the shards
    assert whole["histogram"] == np.histogram(duration, 10, (0, 10))[0].tolist()
    first = sweep.reduce(plan, lambda table: [table["shot"][0].as_py()], threads=4, merge=lambda a, b: a + b)
    assert first == list(range(0, 1000, 90))
    added = sweep.reduce(plan, lambda table: ({"n": len(table)}, np.ones(3), 0.5, {"only in some": 1} if table["shot"][0].as_py() == 90 else {}))
    assert added[0] == {"n": 1000} and added[1].tolist() == [12.0] * 3 and added[2:] == (6.0, {"only in some": 1})
    with pytest.raises(ZeroDivisionError):
        sweep.reduce(plan, lambda table: 1 / 0)


def _add(a, b):
    return {
        "shots": a["shots"] + b["shots"],
        "sums": tuple(x + y for x, y in zip(a["sums"], b["sums"])),
        "histogram": [x + y for x, y in zip(a["histogram"], b["histogram"])],
    }


def test_a_file_says_where_it_comes_from(tmp_path):
    scene = carom.Scene.load(SOURCE / "scenes/draw.toml")
    plan = draw_plan(20, 8, hashes="column")
    sweep.run(plan, tmp_path)
    table = parquet.read_table(tmp_path / "shard-1.parquet")
    file = parquet.read_metadata(tmp_path / "shard-1.parquet")
    said = {key.decode(): value.decode() for key, value in file.metadata.items()}
    assert all(said[key.decode()] == value.decode() for key, value in table.schema.metadata.items())
    assert carom.Scene.loads(table.schema.metadata[b"carom.scene"].decode()) == scene
    assert said["carom.scene_sha256"] == _plan.sha256(scene.source.encode())
    wanted = {"plan": plan.id, "version": carom.__version__, "vary": "\n".join(DRAW), "seed": "4", "first": "8", "last": "16"}
    assert {key: said[f"carom.{key}"] for key in wanted} == wanted
    assert said["carom.writer"] == f"pyarrow {pyarrow.__version__}"
    assert json.loads(said["carom.outcomes"]) == {"at_rest": 8}
    units = {field.name: field.metadata[b"unit"].decode() for field in table.schema if field.metadata and b"unit" in field.metadata}
    metres = {f"{ball}.{axis}": "m" for ball in ("cue", "1") for axis in "xy"}
    assert units == {"cue.aim_deg": "degrees", "cue.speed": "m/s", "duration": "s"} | metres
    # A row can be played again and compared, and the digest is of these hashes.
    hashes = table["record_hash"].to_numpy()
    for row in table.to_pylist()[:3]:
        again = carom.simulate(scene.replace(**{key: row[key] for key in ("cue.aim_deg", "cue.speed")}))
        assert int(again.hash(), 16) == row["record_hash"]
    digest = sweep.run_shard(draw_plan(140, 130, hashes="column"), 0, tmp_path_of(tmp_path, "all"))["records"]
    all_hashes = parquet.read_table(tmp_path / "all/shard-0.parquet")["record_hash"].to_numpy()
    assert (hashes == all_hashes[8:16]).all()
    assert said["carom.records_every"] == "64" and digest == _plan.sha256(all_hashes[[0, 64, 128]].astype("<u8").tobytes())
    assert sweep.run_shard(draw_plan(140, 130), 0, tmp_path_of(tmp_path, "digest"))["records"] == digest
    late = sweep.run_shard(draw_plan(140, 60), 1, tmp_path_of(tmp_path, "late"))["records"]
    assert late == _plan.sha256(all_hashes[[64]].astype("<u8").tobytes())
    assert sweep.run_shard(draw_plan(20, 8, hashes="none"), 1, tmp_path_of(tmp_path, "none"))["records"] == ""


def tmp_path_of(tmp_path, name):
    (tmp_path / name).mkdir()
    return tmp_path / name


def test_the_hash_of_the_content_does_not_depend_on_how_a_table_is_cut(draw_scene):
    table = sweep.table(draw_scene, RULES["draw"], 100)
    assert table["duration"].null_count > 0

    def digest(*parts):
        content = _shard.ContentHash(table.schema)
        for part in parts:
            content.add(part)
        return content.hexdigest()

    whole = digest(table)
    assert whole == digest(table.slice(0, 0), table.slice(0, 33), table.slice(33, 1), table.slice(34))
    assert whole == digest(pyarrow.concat_tables([table.slice(0, 50), table.slice(50)]))
    assert whole != digest(table.slice(0, 99)) and whole != digest(table.slice(50), table.slice(0, 50))
    # A value and its absence, and where a text ends, make a difference.
    one, two = (pyarrow.table({"a": pyarrow.array(values)}) for values in (["ab", "c"], ["a", "bc"]))
    null, zero = (pyarrow.table({"a": pyarrow.array(values, pyarrow.int64())}) for values in ([1, None], [1, 0]))
    digests = set()
    for part in one, two, null, zero:
        content = _shard.ContentHash(part.schema)
        content.add(part)
        digests.add(content.hexdigest())
    assert len(digests) == 4


def test_shots_that_fail_are_rows_and_are_counted(tmp_path):
    plan = sweep.plan(carom.Scene.loads(STUCK, "s.toml"), ["balls.mu_s=list(0.6,0.0)"], 8, shard=3)
    told = []
    done = sweep.run(plan, tmp_path, progress=told.append, threads=1)
    assert done.failed > 0 and done.failed + done.outcomes["time"] == 8
    assert [progress.done for progress in told] == [0, 1, 2, 3]
    rows = sweep.open(tmp_path).to_table().to_pylist()
    assert [row["outcome"] == "failed" for row in rows] == ["did not end within its bound" in row["message"] for row in rows]
    assert all((row["duration"] is None) == (row["outcome"] == "failed") for row in rows)
    assert sweep.check(tmp_path).outcomes == done.outcomes


def test_a_plan_is_read_back_and_refused_when_it_was_changed(tmp_path):
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
    with pytest.raises(sweep.SweepError, match="p.json: there is another plan already"):
        draw_plan(61).save(path)
    with pytest.raises(sweep.SweepError, match="nowhere/p.json: cannot write it: No such file"):
        plan.save(tmp_path / "nowhere/p.json")
    for text, message in [
        (path.read_text().replace('"shots": 60', '"shots": 61'), "p.json: the plan was changed by hand or is damaged"),
        (path.read_text().replace('"seed": 4', '"sed": 4'), "p.json: the plan was changed by hand or is damaged"),
        (path.read_text()[:-10], r"p.json:\d+:\d+: .*; a plan is what"),
        ("[]", 'p.json: no plan of a sweep: "format" has to be'),
        ("\udcff", "p.json: cannot read it: .*utf-8"),
    ]:
        path.write_text(text, errors="surrogateescape")
        with pytest.raises(sweep.SweepError, match=message):
            sweep.Plan.load(path)
    with pytest.raises(sweep.SweepError, match="plan.json: cannot read it: No such file"):
        sweep.status(tmp_path)


def test_what_cannot_be_planned_is_said():
    for options, message in [
        ({"shots": 0}, r"shots=0: expected 1 to 2\*\*53"),
        ({"shots": 2**53 + 1}, r"expected 1 to 2\*\*53"),
        ({"shard": 0}, "shard=0: expected at least 1"),
        ({"shots": 2**53}, "more than 10000000 shards; take at least 900719926 shots for each"),
        ({"hashes": "all"}, "hashes='all': expected one of none, digest, column"),
        ({"seed": -1}, "seed=-1"),
        ({"vary": "cue.speed=uniform(1,2)"}, "vary: expected a list"),
        ({"vary": ["cue.spede=uniform(1,2)"]}, "none of the first 100 shots is a valid scene.*spede"),
    ]:
        with pytest.raises(ValueError, match=message):
            sweep.plan(**{"scene": SOURCE / "scenes/draw.toml", "vary": DRAW, "shots": 10} | options)
    with pytest.raises(carom.SceneError, match="nowhere.toml"):
        sweep.plan("nowhere.toml", DRAW, 10)
    large = draw_plan(2**53, 10**10)
    assert large.range(large.shards - 1)[1] == 2**53 and large.file(0) == "shard-000000.parquet"
    with pytest.raises(ValueError, match="shard=900720: expected 0 to 900719"):
        large.range(900720)
    with pytest.raises(ValueError, match="executor='dask'"):
        sweep.run(draw_plan(), "nowhere", "dask")


def test_the_last_shots_of_the_largest_sweep_are_played(tmp_path):
    large = draw_plan(2**53, 10**10)
    # Cut so that the last shard has few shots: their numbers survive.
    small = large._replace(shard=2**53 - 5)
    sweep.run_shard(small, 1, tmp_path)
    table = parquet.read_table(tmp_path / small.file(1))
    assert table["shot"].to_pylist() == list(range(2**53 - 5, 2**53))
    alone = sweep.columns(carom.Scene.load(SOURCE / "scenes/draw.toml"), DRAW, 2**53, seed=4, first=2**53 - 2)
    assert table["cue.speed"].to_pylist()[-2:] == alone["cue.speed"].tolist()


def test_a_worker_with_another_carom_refuses(tmp_path):
    plan = draw_plan()
    with pytest.raises(sweep.SweepError, match=f"process {os.getpid()}: this is carom {carom.__version__}, and the plan is of carom 0.0.9"):
        sweep.run(plan._replace(version="0.0.9"), tmp_path / "a")
    with pytest.raises(sweep.SweepError, match="plays the first shots with other bits"):
        sweep.run(plan._replace(probe="0" * 64), tmp_path / "b")
    with pytest.raises(sweep.SweepError, match="other bits"):
        sweep.reduce(plan._replace(probe="0" * 64), len)
    assert contents(tmp_path / "a") == contents(tmp_path / "b") == {}


def test_what_is_missing_or_strange_is_not_read_over(tmp_path):
    plan = draw_plan(40, 10)
    sweep.run(plan, tmp_path, shards=[2, 0])
    found = sweep.status(tmp_path)
    assert (found.done, found.missing, found.rows, found.unfinished, found.strangers) == (2, (1, 3), 20, (), ())
    assert not sweep.check(tmp_path).whole and sweep.check(tmp_path).rows == 20
    with pytest.raises(sweep.SweepError, match="2 of 4 shards are missing"):
        sweep.open(tmp_path)
    assert sweep.open(tmp_path, partial=True).to_table()["shot"].to_pylist() == [*range(10), *range(20, 30)]
    before = stamps(tmp_path)
    assert sweep.run(plan, tmp_path).played == 20
    assert before.items() <= stamps(tmp_path).items()  # what is whole is not made again
    with pytest.raises(sweep.SweepError, match="plan.json: there is another plan already"):
        sweep.run(draw_plan(41, 10), tmp_path)
    shutil.copy(tmp_path / "shard-0.parquet", tmp_path / "shard-00.parquet")
    assert list(sweep.check(tmp_path).faults) == ["shard-00.parquet"]
    for verify in True, False:
        with pytest.raises(sweep.SweepError, match="shard-00.parquet: a file that is none of this plan's"):
            sweep.open(tmp_path, verify=verify)


def test_a_file_of_another_plan_or_place_is_named_by_everyone(tmp_path):
    plan, other = draw_plan(30, 10), draw_plan(31, 10)
    sweep.run(plan, tmp_path / "a")
    sweep.run(other, tmp_path / "b")
    for source, words in ("b/shard-1.parquet", f"a file of plan {other.id}, not of shard 1 of plan {plan.id}"), ("a/shard-0.parquet", "a file of shots 0 to 10"):
        shutil.copy(tmp_path / source, tmp_path / "a/shard-1.parquet")
        assert words in sweep.check(tmp_path / "a").faults["shard-1.parquet"]
        for call in (
            lambda: sweep.open(tmp_path / "a"),
            lambda: sweep.open(tmp_path / "a", verify=False),
            lambda: sweep.run_shard(plan, 1, tmp_path / "a"),
            lambda: sweep.run(plan, tmp_path / "a"),
        ):
            with pytest.raises(sweep.SweepError, match=words):
                call()


def test_a_truncated_file_is_named_by_everyone(tmp_path):
    plan = draw_plan(30, 10)
    sweep.run(plan, tmp_path)
    path = tmp_path / "shard-1.parquet"
    whole = path.read_bytes()
    for length in 0, 3, 100, len(whole) // 2, len(whole) - 8, len(whole) - 1:
        path.write_bytes(whole[:length])
        assert "shard-1.parquet: no whole Parquet file" in sweep.check(tmp_path).faults["shard-1.parquet"]
        for call in (lambda: sweep.open(tmp_path, verify=False), lambda: sweep.run(plan, tmp_path)):
            with pytest.raises(sweep.SweepError, match="shard-1.parquet: no whole Parquet file.*remove it, and it is made again"):
                call()
    path.unlink()
    assert sweep.run(plan, tmp_path).played == 10
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
        else:  # of what nobody reads: who wrote the file, how large parts of it are
            assert sweep.open(tmp_path).to_table().equals(table, check_metadata=True)
    assert found > 0.6 * len(whole) / step


def test_a_page_that_changes_after_the_check_is_not_read(tmp_path):
    plan = draw_plan(20_000, 20_000, hashes="none")
    sweep.run(plan, tmp_path)
    path = tmp_path / plan.file(0)
    rows = sweep.open(tmp_path, verify=False)
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 1
    path.write_bytes(data)
    with pytest.raises(OSError, match="CRC|checksum|corrupt"):
        rows.to_table()
    assert "shard-0.parquet: its rows cannot be read" in sweep.check(tmp_path).faults["shard-0.parquet"]


def test_a_full_disk_leaves_no_file_and_work_goes_on_when_there_is_room(tmp_path):
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
    assert done.stdout == f"[Errno 27] cannot write: File too large: '{tmp_path}/shard-0.parquet'\n" and done.stderr == ""
    assert contents(tmp_path) == {} and unfinished(tmp_path) == []
    assert sweep.run(plan, tmp_path).played == 30_000
    assert sweep.check(tmp_path).whole


def _mounted(folder):
    """Whether a small disk could be put there."""
    if os.geteuid() != 0 or shutil.which("mount") is None:
        return False
    return subprocess.run(["mount", "-t", "tmpfs", "-o", "size=300k", "none", folder], capture_output=True, check=False).returncode == 0


def test_a_small_disk_that_fills_up(tmp_path):
    if not _mounted(tmp_path):
        pytest.skip("mounting a small disk takes root")
    try:
        plan = draw_plan(30_000, 3_000)
        with pytest.raises(OSError, match="cannot write: No space left on device: '.*/shard-1.parquet'"):
            sweep.run(plan, tmp_path, threads=1)
        assert list(contents(tmp_path)) == ["shard-0.parquet"] and unfinished(tmp_path) == []
        subprocess.run(["mount", "-o", "remount,size=30m", tmp_path], check=True)
        before = stamps(tmp_path)
        assert sweep.run(plan, tmp_path).played == 27_000
        assert before.items() <= stamps(tmp_path).items() and sweep.check(tmp_path).whole
    finally:
        subprocess.run(["umount", tmp_path], check=True)


def test_a_worker_that_is_killed_while_it_writes_leaves_nothing_that_counts(tmp_path):
    plan = break_plan(6000, 3000)
    plan.save(tmp_path / "plan.json")
    process = worker(tmp_path / "plan.json", 0, tmp_path)
    wait_for(lambda: (tmp_path / ".unfinished").exists() and unfinished(tmp_path))
    process.kill()
    process.communicate()
    assert contents(tmp_path) == {}
    found = sweep.status(tmp_path)
    assert len(found.unfinished) == 1 and found.missing == (0, 1)
    with pytest.raises(sweep.SweepError, match="2 of 2 shards are missing"):
        sweep.open(tmp_path, partial=True)
    # The next one who makes this shard clears up; files of a process that lives, or of another machine, stay.
    alive, far = (f"shard-0.parquet.{name}.tmp" for name in (f"{os.uname().nodename}.{os.getpid()}.00", "elsewhere.1.00"))
    for name in alive, far:
        (tmp_path / ".unfinished" / name).touch()
    again = worker(tmp_path / "plan.json", 0, tmp_path)
    wait_for(lambda: any(str(again.pid) in name for name in unfinished(tmp_path)))
    assert {alive, far} <= set(unfinished(tmp_path)) and not any(str(process.pid) in name for name in unfinished(tmp_path))
    again.kill()
    again.communicate()


def test_a_late_twin_is_harmless(tmp_path):
    plan = break_plan(800, 800)
    plan.save(tmp_path / "plan.json")
    late = worker(tmp_path / "plan.json", 0, tmp_path)
    wait_for(lambda: (tmp_path / ".unfinished").exists() and unfinished(tmp_path))
    late.send_signal(signal.SIGSTOP)
    try:
        assert contents(tmp_path) == {}
        assert sweep.run(plan, tmp_path).played == 800
        before = stamps(tmp_path)
    finally:
        late.send_signal(signal.SIGCONT)
    out, err = late.communicate(timeout=HANGS)
    assert (out, err, late.returncode) == ("True\n", "", 0)
    assert stamps(tmp_path) == before and unfinished(tmp_path) == []
    assert sweep.check(tmp_path).whole


def test_a_twin_with_other_results_is_reported(tmp_path):
    plan = draw_plan(10, 10)
    sweep.run(plan, tmp_path)
    path = str(tmp_path / plan.file(0))
    about = _shard.footer(plan, 0, path) | {"carom.content": "0" * 64}
    with pytest.raises(sweep.SweepError, match="two workers played the same shots with different results"):
        _shard._publish(plan, 0, str(tmp_path / "none"), path, about)


def test_ctrl_c_ends_a_run_soon_and_the_next_one_goes_on(tmp_path):
    plan = break_plan(100_000, 300)
    plan.save(tmp_path / "plan.json")
    code = f"from carom import sweep; sweep.run(sweep.Plan.load({str(tmp_path / 'plan.json')!r}), {str(tmp_path)!r}, threads=2)"
    process = subprocess.Popen([sys.executable, "-c", code], stderr=subprocess.PIPE, text=True)
    wait_for(lambda: len(contents(tmp_path)) >= 2)
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=HANGS)
    assert err.endswith("KeyboardInterrupt\n")
    assert unfinished(tmp_path) == []
    done = contents(tmp_path)
    assert 2 <= len(done) < 300
    before = stamps(tmp_path)
    some = sorted(set(sweep.status(tmp_path).missing[:1]) | {int(name[6:9]) for name in done})
    assert sweep.run(plan, tmp_path, shards=some).played == 300
    assert before.items() <= stamps(tmp_path).items()
    assert sweep.check(tmp_path).faults == {}


def test_a_dead_worker_of_a_pool_is_an_error_that_says_what_to_do(tmp_path):
    with concurrent.futures.ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
        victim = pool.submit(os.getpid).result()

        def kill(progress):
            if progress.done == 1:
                os.kill(victim, signal.SIGKILL)

        plan = break_plan(2000, 200)
        with pytest.raises(sweep.SweepError, match="what is made is whole: run again"):
            sweep.run(plan, tmp_path, pool, progress=kill)
    done = sweep.status(tmp_path).done
    assert 1 <= done < 10
    assert sweep.run(plan, tmp_path).played == 2000 - 200 * done
    assert sweep.check(tmp_path).whole


class _GivesUp(concurrent.futures.ThreadPoolExecutor):
    """Gives the first tasks up, as Dask does whose workers die."""

    def __init__(self, times):
        super().__init__(1)
        self.times = times

    def submit(self, work, *arguments):
        if self.times == 0:
            return super().submit(work, *arguments)
        self.times -= 1
        given_up = concurrent.futures.Future()
        given_up.set_exception(type("KilledWorker", (Exception,), {})("its workers died"))
        return given_up


def test_what_an_executor_gives_up_is_tried_again(tmp_path):
    plan = draw_plan(30, 10)
    with _GivesUp(2) as executor:
        assert sweep.run(plan, tmp_path / "a", executor, retries=2).played == 30
    with _GivesUp(2) as executor, pytest.raises(Exception, match="its workers died"):
        sweep.run(plan, tmp_path / "b", executor, retries=1)
    with _GivesUp(2) as executor:
        assert sweep.reduce(plan, len, executor) == 30


def test_duckdb_reads_the_files(tmp_path):
    duckdb = pytest.importorskip("duckdb", reason="duckdb is not installed: pip install duckdb")
    plan = sweep.plan(SOURCE / "scenes/eight_ball_break.toml", RULES["eight_ball_break"], 60, shard=25)
    sweep.run(plan, tmp_path)
    table = sweep.open(tmp_path).to_table()
    query = f"SELECT count(*), sum(events), count(DISTINCT shot), sum((pocketed <> '')::int) FROM '{tmp_path}/*.parquet'"
    rows = table.to_pylist()
    assert duckdb.sql(query).fetchall()[0] == (60, sum(row["events"] for row in rows), 60, sum(row["pocketed"] != "" for row in rows))


def test_the_plan_of_the_study_can_be_read():
    plan = sweep.Plan.load(SOURCE / "docs/lab/2026-11-million_breaks.json")
    assert (plan.shots, plan.shards) == (1_000_000, 20)


def test_without_pyarrow_the_extra_is_named():
    code = """
import sys
sys.modules["pyarrow"] = None
from carom import sweep
try:
    sweep.run(None, "nowhere")
except ImportError as error:
    print(error)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "pip install 'carom-billiards[sweep]'" in done.stdout
