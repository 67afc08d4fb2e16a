"""Faults of sharded sweeps: damaged and foreign files, full disks, and workers that are killed, interrupted
or late."""

from __future__ import annotations

import concurrent.futures
import multiprocessing
import os
import shutil
import signal
import subprocess
import sys

import carom
import pytest
from carom import sweep
from conftest import HANGS, SLOW
from sweep_support import break_plan, contents, draw_plan, stamps, unfinished, wait_for, worker

pytest.importorskip("pyarrow", reason="pyarrow is not installed: pip install pyarrow")
parquet = pytest.importorskip("pyarrow.parquet")

from carom.sweep import _shard  # noqa: E402


def test_a_worker_with_another_carom_refuses(tmp_path):
    plan = draw_plan()
    versions = f"this is carom {carom.__version__}, and the plan is of carom 0.0.9"
    with pytest.raises(sweep.SweepError, match=f"process {os.getpid()}: {versions}"):
        sweep.run(plan._replace(version="0.0.9"), tmp_path / "a")
    with pytest.raises(sweep.SweepError, match="gives other bits for the first shots"):
        sweep.run(plan._replace(probe="0" * 64), tmp_path / "b")
    with pytest.raises(sweep.SweepError, match="other bits"):
        sweep.reduce(plan._replace(probe="0" * 64), len)
    assert contents(tmp_path / "a") == contents(tmp_path / "b") == {}


def test_missing_and_foreign_files_are_reported(tmp_path):
    plan = draw_plan(40, 10)
    sweep.run(plan, tmp_path, shards=[2, 0])
    found = sweep.status(tmp_path)
    assert (
        found.done, found.missing, found.rows, found.unfinished, found.strangers) == (2, (1, 3), 20, (), ())
    assert not sweep.check(tmp_path).whole and sweep.check(tmp_path).rows == 20
    with pytest.raises(sweep.SweepError, match="2 of 4 shards are missing"):
        sweep.open(tmp_path)
    assert sweep.open(tmp_path, partial=True).to_table()["shot"].to_pylist() == [*range(10), *range(20, 30)]
    before = stamps(tmp_path)
    assert sweep.run(plan, tmp_path).played == 20
    assert before.items() <= stamps(tmp_path).items()  # complete files are kept
    with pytest.raises(sweep.SweepError, match="plan.json: another plan is already there"):
        sweep.run(draw_plan(41, 10), tmp_path)
    shutil.copy(tmp_path / "shard-0.parquet", tmp_path / "shard-00.parquet")
    assert list(sweep.check(tmp_path).faults) == ["shard-00.parquet"]
    for verify in True, False:
        with pytest.raises(sweep.SweepError, match="shard-00.parquet: this file does not belong to the plan"):
            sweep.open(tmp_path, verify=verify)


def test_every_reader_names_a_file_of_another_plan_or_place(tmp_path):
    plan, other = draw_plan(30, 10), draw_plan(31, 10)
    sweep.run(plan, tmp_path / "a")
    sweep.run(other, tmp_path / "b")
    for source, words in (
        ("b/shard-1.parquet", f"the file contains plan {other.id}, not shard 1 of plan {plan.id}"),
        ("a/shard-0.parquet", "the file contains shots 0 to 10"),
    ):
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


def test_every_reader_names_a_truncated_file(tmp_path):
    plan = draw_plan(30, 10)
    sweep.run(plan, tmp_path)
    path = tmp_path / "shard-1.parquet"
    whole = path.read_bytes()
    for length in 0, 3, 100, len(whole) // 2, len(whole) - 8, len(whole) - 1:
        path.write_bytes(whole[:length])
        fault = sweep.check(tmp_path).faults["shard-1.parquet"]
        assert "shard-1.parquet: not a complete Parquet file" in fault
        for call in (lambda: sweep.open(tmp_path, verify=False), lambda: sweep.run(plan, tmp_path)):
            again = "shard-1.parquet: not a complete Parquet file.*remove it and run the sweep again"
            with pytest.raises(sweep.SweepError, match=again):
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
        else:  # in bytes that readers ignore: the writer's name, the sizes of parts
            assert sweep.open(tmp_path).to_table().equals(table, check_metadata=True)
    assert found > 0.6 * len(whole) / step


def test_a_damaged_parquet_page_is_not_read(tmp_path):
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


def _mounted(folder):
    """Whether a small disk could be mounted there."""
    if os.geteuid() != 0 or shutil.which("mount") is None:
        return False
    return subprocess.run(["mount", "-t", "tmpfs", "-o", "size=300k", "none", folder], capture_output=True,
                          check=False).returncode == 0


def test_a_small_disk_fills_up(tmp_path):
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


def test_a_worker_killed_while_writing_leaves_no_valid_file(tmp_path):
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
    # The next process to make this shard cleans up; files of a live process or of another machine stay.
    alive, far = (
        f"shard-0.parquet.{name}.tmp"
        for name in (f"{os.uname().nodename}.{os.getpid()}.00", "elsewhere.1.00"))
    for name in alive, far:
        (tmp_path / ".unfinished" / name).touch()
    again = worker(tmp_path / "plan.json", 0, tmp_path)
    wait_for(lambda: any(str(again.pid) in name for name in unfinished(tmp_path)))
    assert {alive, far} <= set(unfinished(tmp_path))
    assert not any(str(process.pid) in name for name in unfinished(tmp_path))
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


def test_ctrl_c_ends_a_run_soon_and_the_next_one_resumes(tmp_path):
    plan = break_plan(100_000, 300)
    plan.save(tmp_path / "plan.json")
    plan_file, folder = str(tmp_path / "plan.json"), str(tmp_path)
    code = f"from carom import sweep; sweep.run(sweep.Plan.load({plan_file!r}), {folder!r}, threads=2)"
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


def test_a_dead_pool_worker_is_an_error_with_a_remedy(tmp_path):
    with concurrent.futures.ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
        victim = pool.submit(os.getpid).result()

        def kill(progress):
            if progress.done == 1:
                os.kill(victim, signal.SIGKILL)

        plan = break_plan(2000, 200)
        with pytest.raises(sweep.SweepError, match="finished shards are kept; run it again"):
            sweep.run(plan, tmp_path, pool, progress=kill)
    done = sweep.status(tmp_path).done
    assert 1 <= done < 10
    assert sweep.run(plan, tmp_path).played == 2000 - 200 * done
    assert sweep.check(tmp_path).whole


class _GivesUp(concurrent.futures.ThreadPoolExecutor):
    """Gives up the first tasks, as Dask does when workers die."""

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


def test_tasks_given_up_by_an_executor_are_retried(tmp_path):
    plan = draw_plan(30, 10)
    with _GivesUp(2) as executor:
        assert sweep.run(plan, tmp_path / "a", executor, retries=2).played == 30
    with _GivesUp(2) as executor, pytest.raises(Exception, match="its workers died"):
        sweep.run(plan, tmp_path / "b", executor, retries=1)
    with _GivesUp(2) as executor:
        assert sweep.reduce(plan, len, executor) == 30
