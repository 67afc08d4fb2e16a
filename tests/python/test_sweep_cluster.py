"""Sweeps on worker processes of Dask, which are killed; and the command `python -m carom.sweep`.

The folder must then contain the same files as after a run in one process.
"""

from __future__ import annotations

import concurrent.futures
import contextlib
import os
import re
import signal
import subprocess
import sys
import time

import pytest
from carom import sweep
from conftest import HANGS, SLOW, SOURCE

pytest.importorskip("pyarrow", reason="pyarrow is not installed: pip install pyarrow")
distributed = pytest.importorskip("distributed", reason="it is not installed: pip install distributed")

from test_sweep_shards import break_plan, contents, draw_plan, stamps, unfinished  # noqa: E402


def wait_for(what):
    end = time.monotonic() + HANGS
    while not (found := what()):
        assert time.monotonic() < end, "it did not happen"
        time.sleep(0.005)
    return found


def command(*arguments):
    return subprocess.Popen([sys.executable, "-m", *map(str, arguments)], stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True, start_new_session=True)


def sweep_command(*arguments):
    """Runs `python -m carom.sweep` to its end."""
    process = command("carom.sweep", *arguments)
    out, err = process.communicate(timeout=HANGS)
    return process.returncode, out, err


def sweep_in_process(capsys, monkeypatch, *arguments):
    """The same in this process, for many calls that end at once."""
    from carom.sweep.__main__ import main

    monkeypatch.setattr(sys, "argv", ["carom.sweep", *map(str, arguments)])
    try:
        code = main()
    except SystemExit as end:
        code = end.code
    return code, *capsys.readouterr()


@pytest.fixture(scope="module")
def once(tmp_path_factory):
    """A plan, its file, and its shards after a run in one process."""
    folder = tmp_path_factory.mktemp("once")
    plan = break_plan(3600, 150)
    plan.save(folder / "breaks.json")
    sweep.run(plan, folder / "breaks")
    return plan, folder / "breaks.json", contents(folder / "breaks")


@pytest.mark.parametrize("deaths", [1, pytest.param(6, marks=pytest.mark.skipif(
    not SLOW, reason="takes long; CAROM_SLOW_TESTS=1 runs it"))])
def test_killed_workers_lose_nothing(tmp_path, once, deaths):
    plan, _, files = once
    workers = {"n_workers": 2, "threads_per_worker": 1, "silence_logs": "CRITICAL"}
    with distributed.Client(dashboard_address=None, **workers) as client, \
            concurrent.futures.ThreadPoolExecutor() as pool:
        running = pool.submit(sweep.run, plan, tmp_path, client)
        for death in range(deaths):
            wait_for(lambda: len(stamps(tmp_path)) > 2 * death or running.done())
            assert death > 0 or len(stamps(tmp_path)) < plan.shards
            victim = next(iter(wait_for(lambda: client.run(os.getpid)).values()))
            with contextlib.suppress(ProcessLookupError):
                os.kill(victim, signal.SIGKILL)
        assert running.result(timeout=HANGS).rows == 3600
        before = stamps(tmp_path)
        (tmp_path / "shard-07.parquet").unlink()
        assert sweep.run(plan, tmp_path, client).played == 150
    before.pop("shard-07.parquet")
    assert before.items() <= stamps(tmp_path).items()
    assert contents(tmp_path) == files and unfinished(tmp_path) == []
    assert sweep.check(tmp_path).whole


def test_the_command_plays_on_a_cluster_and_continues_with_another(tmp_path, once):
    plan, file, files = once
    dask = ["--host", "127.0.0.1"]
    processes = []
    scheduler = tmp_path / "scheduler.json"
    arguments = file, "-o", tmp_path / "a", "--dask", scheduler

    def start(*words):
        processes.append(subprocess.Popen(
            [sys.executable, "-m", "dask", *map(str, words)], stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL, cwd=tmp_path))
        return processes[-1]

    def begin():
        scheduler.unlink(missing_ok=True)
        start("scheduler", "--scheduler-file", scheduler, "--port", 0, *dask, "--no-dashboard")
        wait_for(scheduler.exists)
        start("worker", "--scheduler-file", scheduler, "--nthreads", 1, *dask, "--no-dashboard",
              "--death-timeout", 60)
        return processes[-2]

    try:
        first = begin()
        client = command("carom.sweep", *arguments)
        wait_for(lambda: len(stamps(tmp_path / "a")) >= 3)
        first.kill()
        out, err = client.communicate(timeout=HANGS)
        assert client.returncode == 1, err
        assert "finished shards are kept: run the same command to continue" in err
        processes[-1].kill()
        processes[-1].wait()
        before = stamps(tmp_path / "a")
        assert 3 <= len(before) < plan.shards
        begin()
        code, out, err = sweep_command(*arguments)
        assert code == 0, err
        assert re.match(r"dashboard: http://127\.0\.0\.1:\d+/status\n", out)
        assert f"a: 3600 rows (at_rest 3600), {3600 - 150 * len(before)} of them played now\n" in out
        assert before.items() <= stamps(tmp_path / "a").items()
        assert contents(tmp_path / "a") == files and unfinished(tmp_path / "a") == []
    finally:
        for process in processes:
            process.kill()
            process.wait()


def test_the_command_makes_plans_runs_them_and_reports_files(tmp_path, capsys, monkeypatch):
    file, folder = tmp_path / "p.json", tmp_path / "p"
    arguments = ["--scene", SOURCE / "scenes/draw.toml", "--vary", "cue.aim_deg=normal(2)", "--vary",
                 "cue.speed=uniform(1,4)", "--seed", 4, "--shard", 20]
    assert sweep_command(file, *arguments, "--shots", 60) == (0, f"{file}: 60 shots in 3 shards\n", "")
    assert sweep.Plan.load(file) == draw_plan(60, 20)
    assert sweep_in_process(capsys, monkeypatch, file, *arguments, "--shots", 60)[0] == 0
    see = "; see python -m carom.sweep --help"
    for words, code, message in [
        ([file, *arguments, "--shots", 61], 2,
         f"{file}: another plan is already there; remove it, or write elsewhere"),
        ([file, *arguments], 2, f"--scene needs --vary and --shots{see}"),
        ([file, "--scene", "no.toml", "--vary", "cue.speed=list(1)", "--shots", 3], 2,
         "no.toml: cannot be read: there is no such file; check the path"),
        ([tmp_path / "q.json", *arguments, "--shots", 0], 2, "shots=0: expected 1 to 2**53"),
        ([tmp_path / "q.json"], 2, f"{tmp_path}/q.json: cannot read it: No such file or directory"),
        ([file, "--threads", "-1"], 2, f"--threads -1: expected at least 0{see}"),
        ([file, "--thread", "1"], 2, f"unrecognized arguments: --thread 1{see}"),
        ([file, "-o", file], 2, f"{file}: name the folder of the shards with --output"),
    ]:
        assert sweep_in_process(capsys, monkeypatch, *words) == (code, "", f"carom.sweep: {message}\n")
    # As its own process, the exit status is the code.
    assert sweep_command(*words) == (code, "", f"carom.sweep: {message}\n")
    folder.mkdir()
    sweep.run_shard(file, 1, folder)
    assert sweep_in_process(capsys, monkeypatch, file, "--status") == (
        1, f"{folder}: 1 of 3 shards, 20 of 60 rows\nmissing: 0, 2\n", "")
    code, out, err = sweep_command(folder / "plan.json", "--threads", "2")
    assert (code, out, err) == (0, f"{folder}: 60 rows (at_rest 60), 40 of them played now\n", "")
    assert sweep_in_process(capsys, monkeypatch, file, "--check") == (
        0, f"{folder}: 3 of 3 shards, 60 of 60 rows (at_rest 60)\n", "")
    path = folder / "shard-1.parquet"
    path.write_bytes(path.read_bytes()[:-1])
    code, out, err = sweep_in_process(capsys, monkeypatch, file, "--check")
    assert (code, out) == (1, f"{folder}: 3 of 3 shards, 40 of 60 rows (at_rest 40)\n")
    assert err.startswith(f"carom.sweep: {path}: damaged (")
    code, out, err = sweep_command(file)
    assert code == 1 and err.startswith(f"carom.sweep: {path}: damaged ("), err


@pytest.mark.parametrize(
    ("number", "status"), [(signal.SIGINT, 130), (signal.SIGTERM, -15), (signal.SIGKILL, -9)])
def test_a_stopped_command_leaves_no_workers_and_whole_files(tmp_path, number, status):
    plan = break_plan(100_000, 200)
    plan.save(tmp_path / "p.json")
    process = command("carom.sweep", tmp_path / "p.json", "--threads", 2)
    wait_for(lambda: len(stamps(tmp_path / "p")) > 1)
    if number == signal.SIGINT:  # a terminal signals all processes
        os.killpg(process.pid, number)
    else:
        process.send_signal(number)
    _, err = process.communicate(timeout=HANGS)  # until no worker keeps the pipe open
    assert process.returncode == status, err
    if number == signal.SIGINT:
        assert err == "carom.sweep: stopped; run the same command to continue\n"
    assert sweep.check(tmp_path / "p").faults == {} and len(stamps(tmp_path / "p")) < 500
