"""Sweeps on many machines, represented here by processes: Dask schedulers and workers on ports, and a stub of
sbatch.

They are killed, stopped and doubled; the folder must still contain the same files as after a run in one
process.
"""

from __future__ import annotations

import contextlib
import os
import re
import signal
import socket
import stat
import subprocess
import sys
import time

import carom
import pytest
from carom import sweep
from conftest import HANGS, SLOW, SOURCE
from sweep_support import break_plan, contents, draw_plan, stamps, unfinished, wait_for

pytest.importorskip("pyarrow", reason="pyarrow is not installed: pip install pyarrow")

# Dask gives up a worker that is silent for this long; a short time keeps the test of a returning worker
# quick.
DASK = {"DASK_DISTRIBUTED__SCHEDULER__WORKER_TTL": "3s", "DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT": "5s",
        "DASK_DISTRIBUTED__COMM__RETRY__COUNT": "0"}
slow = pytest.mark.skipif(not SLOW, reason="takes long; CAROM_SLOW_TESTS=1 runs it")


def command(*arguments, **options):
    return subprocess.Popen(
        [sys.executable, "-m", *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        text=True, **{"env": os.environ | DASK} | options
    )


def sweep_command(*arguments, **options):
    """Runs `python -m carom.sweep` to its end."""
    process = command("carom.sweep", *arguments, **options)
    out, err = process.communicate(timeout=HANGS)
    return process.returncode, out, err


def sweep_in_process(capsys, monkeypatch, *arguments):
    """The same in this process, for many calls that end at once."""
    from carom.sweep.__main__ import main

    monkeypatch.setattr(sys, "argv", ["carom.sweep", *map(str, arguments)])
    handler = signal.getsignal(signal.SIGTERM)
    try:
        code = main()
    except SystemExit as end:
        code = end.code
    finally:
        signal.signal(signal.SIGTERM, handler)
    return code, *capsys.readouterr()


class Cluster:
    """A scheduler and workers, each its own command."""

    def __init__(self, folder, **scheduler):
        self.folder, self.options = folder, scheduler
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            self.port = probe.getsockname()[1]
        self.address = f"tcp://127.0.0.1:{self.port}"
        self.processes = []
        self.scheduler = self.begin_scheduler()

    def start(self, *arguments, **options):
        with (self.folder / f"dask-{len(self.processes)}.log").open("w") as log:
            process = subprocess.Popen([sys.executable, "-m", "dask", *arguments], stdout=log, stderr=log,
                                       env=os.environ | DASK | options, cwd=self.folder)
        self.processes.append(process)
        return process

    def begin_scheduler(self):
        return self.start("scheduler", "--host", "127.0.0.1", "--port", str(self.port), "--dashboard-address",
                          "127.0.0.1:0", **self.options)

    def worker(self, *arguments, **options):
        return self.start("worker", self.address, "--nthreads", "1", "--no-dashboard", "--host", "127.0.0.1",
                          "--death-timeout", "60", *arguments, **options)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for process in self.processes:
            with contextlib.suppress(ProcessLookupError):
                process.send_signal(signal.SIGCONT)
                process.kill()
            process.wait()


@pytest.fixture
def cluster(tmp_path):
    pytest.importorskip("distributed", reason="distributed is not installed: pip install distributed")
    (tmp_path / "dask").mkdir()
    with Cluster(tmp_path / "dask") as cluster:
        yield cluster


def of_process(folder, process):
    """Whether this process is writing a file."""
    if not (folder / ".unfinished").exists():
        return False
    return any(f".{process.pid}." in name for name in unfinished(folder))


def client_of(cluster, file, folder):
    return command("carom.sweep", file, "-o", folder, "--dask", cluster.address)


def ended_well(client):
    out, err = client.communicate(timeout=HANGS)
    assert client.returncode == 0, err
    return out, err


def kill(process):
    process.kill()
    process.wait()


def whole(folder, plan, once):
    assert contents(folder) == once
    assert sweep.check(folder).whole and sweep.check(folder).rows == plan.shots
    return True


@pytest.fixture(scope="module")
def once(tmp_path_factory):
    """A plan, and its files after a run in one process."""
    folder = tmp_path_factory.mktemp("once")
    plan = break_plan(3600, 150)
    plan.save(folder / "breaks.json")
    sweep.run(plan, folder / "breaks")
    return plan, folder / "breaks.json", contents(folder / "breaks")


def test_a_killed_worker_loses_nothing(tmp_path, cluster, once):
    plan, file, files = once
    victim, _ = cluster.worker("--no-nanny"), cluster.worker("--no-nanny")
    client = client_of(cluster, file, tmp_path / "a")
    wait_for(lambda: len(stamps(tmp_path / "a")) >= 3 and of_process(tmp_path / "a", victim))
    kill(victim)
    before = stamps(tmp_path / "a")
    out, err = ended_well(client)
    assert re.match(r"dashboard: http://127\.0\.0\.1:\d+/status\n", out)
    played = re.search(
        r"a: 3600 rows \(at_rest 3600\), (\d+) of them played in [\d.]+ s, \d+ a second\n", out)
    # If the dead worker had not reported a shard yet, another worker receives it and finds its file.
    assert played and int(played[1]) in (3450, 3600), out
    assert "24 of 24 shards, 0 left, 3600 rows, " in err
    assert before.items() <= stamps(tmp_path / "a").items()
    assert whole(tmp_path / "a", plan, files)
    # The process that makes the dead worker's shard removes its leftovers, if it is on the same machine.
    assert unfinished(tmp_path / "a") == []

    from distributed import Client

    def count(table):  # not in a module that a worker could import: Dask sends the code
        return {"shots": len(table), "duration": float(table["duration"].to_numpy().sum())}

    with Client(cluster.address) as dask:
        small = draw_plan(2000, 90)
        moments = sweep.reduce(small, count, dask)
        assert moments == sweep.reduce(small, count, threads=1)
        with pytest.raises(sweep.SweepError, match="another plan is already there"):
            sweep.run(small, tmp_path / "a", dask)
        # A worker whose bits differ refuses, and says where it runs.
        with pytest.raises(
            sweep.SweepError, match=rf"{os.uname().nodename}, process \d+: this carom .* gives other bits"
        ):
            sweep.run(small._replace(probe="0" * 64), tmp_path / "b", dask)
        assert sweep.run(small, tmp_path / "c", dask, shards=[3]).played == 90


@slow
def test_a_nanny_replaces_a_dead_worker(tmp_path, cluster, once):
    plan, file, files = once
    cluster.worker("--nworkers", "2")
    client = client_of(cluster, file, tmp_path / "a")
    for _ in range(3):
        name = wait_for(lambda: (tmp_path / "a/.unfinished").exists() and unfinished(tmp_path / "a"))[0]
        with contextlib.suppress(ProcessLookupError):
            os.kill(int(name.split(".")[-3]), signal.SIGKILL)
        time.sleep(1)
    ended_well(client)
    assert whole(tmp_path / "a", plan, files)


@slow
def test_a_shard_given_up_by_dask_is_resubmitted(tmp_path, once):
    pytest.importorskip("distributed", reason="distributed is not installed: pip install distributed")
    plan, file, files = once
    (tmp_path / "dask").mkdir()
    # The first death of a worker already exceeds the limit for its task.
    with Cluster(tmp_path / "dask", DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES="0") as cluster:
        victim, _ = cluster.worker("--no-nanny"), cluster.worker("--no-nanny")
        client = client_of(cluster, file, tmp_path / "a")
        wait_for(lambda: of_process(tmp_path / "a", victim))
        kill(victim)
        ended_well(client)
        assert "KilledWorker" in (tmp_path / "dask/dask-0.log").read_text() or "marked as failed" in (
            tmp_path / "dask/dask-0.log").read_text()
        assert whole(tmp_path / "a", plan, files)


@slow
def test_a_worker_given_up_by_dask_returns(tmp_path, cluster, once):
    plan, file, files = once
    late, _ = cluster.worker("--no-nanny"), cluster.worker("--no-nanny")
    client = client_of(cluster, file, tmp_path / "a")
    wait_for(lambda: of_process(tmp_path / "a", late))
    late.send_signal(signal.SIGSTOP)
    assert of_process(tmp_path / "a", late)
    ended_well(client)
    assert whole(tmp_path / "a", plan, files)
    before = stamps(tmp_path / "a")
    assert of_process(tmp_path / "a", late)  # it is alive, so its files stay
    late.send_signal(signal.SIGCONT)
    wait_for(lambda: not of_process(tmp_path / "a", late))
    assert stamps(tmp_path / "a") == before and whole(tmp_path / "a", plan, files)


@slow
def test_without_its_scheduler_the_client_ends_and_resumes_with_another(tmp_path, cluster, once):
    plan, file, files = once
    cluster.worker("--no-nanny")
    client = client_of(cluster, file, tmp_path / "a")
    wait_for(lambda: len(stamps(tmp_path / "a")) >= 3)
    kill(cluster.scheduler)
    out, err = client.communicate(timeout=HANGS)
    assert client.returncode == 1, err
    assert "finished shards are kept; run it again" in err, err
    wait_for(lambda: cluster.processes[1].poll() is not None or unfinished(tmp_path / "a") == [])
    before = stamps(tmp_path / "a")
    assert 3 <= len(before) < plan.shards
    cluster.begin_scheduler()
    cluster.worker("--no-nanny")
    out, _ = ended_well(client_of(cluster, file, tmp_path / "a"))
    played = int(re.search(r"(\d+) of them played", out)[1])
    assert played <= plan.shots - 150 * len(before)
    assert before.items() <= stamps(tmp_path / "a").items()
    assert whole(tmp_path / "a", plan, files)


@slow
@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
def test_without_its_client_the_cluster_serves_the_next_one(tmp_path, cluster, once, number):
    plan, file, files = once
    cluster.worker("--no-nanny")
    client = client_of(cluster, file, tmp_path / "a")
    wait_for(lambda: len(stamps(tmp_path / "a")) >= 3)
    client.send_signal(number)
    client.communicate(timeout=HANGS)
    assert client.returncode == {signal.SIGKILL: -9, signal.SIGTERM: 143, signal.SIGINT: 130}[number]
    before = stamps(tmp_path / "a")
    out, _ = ended_well(client_of(cluster, file, tmp_path / "a"))
    assert before.items() <= stamps(tmp_path / "a").items()
    assert whole(tmp_path / "a", plan, files)


@slow
def test_a_worker_of_another_version_refuses(tmp_path, cluster, once):
    (tmp_path / "other").mkdir()
    (tmp_path / "other/sitecustomize.py").write_text("import carom._carom\ncarom._carom.VERSION = '0.0.9'\n")
    cluster.worker("--no-nanny", PYTHONPATH=f"{tmp_path / 'other'}:{os.environ.get('PYTHONPATH', '')}")
    code, out, err = sweep_command(once[1], "-o", tmp_path / "a", "--dask", cluster.address)
    assert code == 1
    wanted = rf"this is carom 0\.0\.9, and the plan is of carom {re.escape(carom.__version__)}"
    assert re.search(f"{wanted}: install that one here", err), err
    assert contents(tmp_path / "a") == {}


# Runs an array's elements out of order, two at a time; in the first array, the first element is killed.
SBATCH = """#!{python}
import os, random, subprocess, sys, time
options = dict(word[2:].split("=", 1) for word in sys.argv[1:] if "=" in word)
elements = []
for run in options["array"].split(","):
    first, _, last = run.partition("-")
    elements += range(int(first), int(last or first) + 1)
with open({log!r}, "a") as log:
    log.write(options["array"] + " " + options.get("time", "") + "\\n")
first_array = len(open({log!r}).readlines()) == 1
random.Random(5).shuffle(elements)
running = []
for k, element in enumerate(elements):
    while len(running) == 2:
        running = [process for process in running if process.poll() is None]
        time.sleep(0.01)
    out = open(options["output"].replace("%A", "7").replace("%a", str(element)), "w")
    environment = os.environ | {{"SLURM_ARRAY_TASK_ID": str(element), "SLURM_CPUS_PER_TASK": "1"}}
    running.append(subprocess.Popen(
        ["/bin/sh", "-c", "exec " + options["wrap"]], env=environment, stdout=out, stderr=out))
    if first_array and k == 0:
        folder = os.path.dirname(options["output"])
        def made():
            files = [name for name in os.listdir(folder) if name.endswith(".parquet")]
            return any(int(name[6:8]) % 4 == element for name in files)
        while not made():
            time.sleep(0.01)
        running[0].kill()
for process in running:
    process.wait()
print("4711;cluster")
"""


def test_a_slurm_array_and_another_for_missing_shards(tmp_path, once, capsys, monkeypatch):
    plan, file, files = once
    (tmp_path / "bin").mkdir()
    stub, log = tmp_path / "bin/sbatch", tmp_path / "log"
    stub.write_text(SBATCH.format(python=sys.executable, log=str(log)))
    stub.chmod(stub.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setenv("PATH", f"{tmp_path / 'bin'}:{os.environ['PATH']}")
    folder = tmp_path / "a"
    arguments = [file, "-o", folder, "--slurm", "--elements", "4", "--sbatch=--time=60"]
    code, out, err = sweep_command(*arguments)
    assert (code, out) == (
        0, "job 4711: --array=0-3 for 24 of 24 shards; --status shows how far they are\n"), err
    before = stamps(folder)
    missing = sweep.status(folder).missing
    assert 1 <= len(missing) <= 6 and len({shard % 4 for shard in missing}) == 1
    code, out, err = sweep_in_process(capsys, monkeypatch, file, "-o", folder, "--missing")
    assert (code, [int(run.split("-")[0]) for run in out.strip().split(",")]) == (0, list(missing))
    code, out, err = sweep_in_process(capsys, monkeypatch, *arguments)
    assert code == 0 and f"--array={missing[0] % 4} for {len(missing)} of 24 shards" in out, err
    assert before.items() <= stamps(folder).items()
    assert whole(folder, plan, files)
    assert sweep_in_process(capsys, monkeypatch, *arguments)[1] == f"{folder}: nothing is missing\n"
    assert log.read_text() == f"0-3 60\n{missing[0] % 4} 60\n"
    stub.write_text("#!/bin/sh\necho 'sbatch: error: invalid partition' >&2\nexit 1\n")
    code, out, err = sweep_in_process(capsys, monkeypatch, file, "-o", tmp_path / "b", "--slurm")
    assert (code, err) == (
        1, "carom.sweep: sbatch failed with status 1: sbatch: error: invalid partition\n")


def test_the_command_makes_plans_runs_them_and_reports_files(tmp_path, capsys, monkeypatch):
    file = tmp_path / "p.json"
    arguments = ["--scene", SOURCE / "scenes/draw.toml", "--vary", "cue.aim_deg=normal(2)", "--vary",
                 "cue.speed=uniform(1,4)", "--seed", 4, "--shard", 20]
    assert sweep_command(file, *arguments, "--shots", 60) == (0, f"{file}: 60 shots in 3 shards\n", "")
    assert sweep.Plan.load(file) == draw_plan(60, 20)
    assert sweep_in_process(capsys, monkeypatch, file, *arguments, "--shots", 60)[0] == 0
    for words, code, message in [
        ([file, *arguments, "--shots", 61], 1,
         f"{file}: another plan is already there; remove it, or write elsewhere"),
        ([file, *arguments], 2, "--scene needs --vary and --shots"),
        ([file, "--scene", "no.toml", "--vary", "cue.speed=list(1)", "--shots", 3], 2,
         "no.toml: cannot be read: there is no such file; check the path"),
        ([tmp_path / "q.json", *arguments, "--shots", 0], 2, "shots=0: expected 1 to 2**53"),
        ([tmp_path / "q.json"], 2, f"{tmp_path}/q.json: cannot read it: No such file or directory"),
        ([file, "--part", "3/2"], 2, "--part 3/2: expected I/N with 0 <= I < N, as in 3/100"),
        ([file, "--threads", "-1"], 2, "--threads must be at least 0, and --elements at least 1"),
        ([file, "--thread", "1"], 2, "unrecognized arguments: --thread 1; see python -m carom.sweep --help"),
        ([file, "--slurm"], 1, "sbatch: program not found; run this on a machine of a Slurm cluster"),
    ]:
        assert sweep_in_process(capsys, monkeypatch, *words) == (code, "", f"carom.sweep: {message}\n")
    # As its own process, the exit status is the code.
    assert sweep_command(*words) == (code, "", f"carom.sweep: {message}\n")
    folder = tmp_path / "p"
    code, out, err = sweep_command(file, "--part", "1/2")
    assert code == 0 and re.search(
        r"^1 of 1 shards, 0 left, 20 rows, \d+ shots/s, 0 failed$", err, re.MULTILINE), err
    assert out.startswith(f"{folder}: 20 rows (at_rest 20), 20 of them played in ")
    assert sweep_in_process(capsys, monkeypatch, file, "--status") == (
        1, f"{folder}: 1 of 3 shards, 20 of 60 rows\nmissing: 0,2\n", "")
    code, out, err = sweep_in_process(capsys, monkeypatch, folder / "plan.json", "--threads", "2")
    assert code == 0 and out.startswith(f"{folder}: 60 rows (at_rest 60), 40 of them played in "), err
    assert sweep_in_process(capsys, monkeypatch, file, "--check") == (
        0, f"{folder}: 60 of 60 rows are complete and unchanged (at_rest 60)\n", "")
    path = folder / "shard-1.parquet"
    path.write_bytes(path.read_bytes()[:-1])
    code, out, err = sweep_in_process(capsys, monkeypatch, file, "--check")
    assert code == 1 and err.startswith(f"carom.sweep: {path}: not a complete Parquet file"), err
    code, out, err = sweep_in_process(capsys, monkeypatch, file)
    assert code == 1 and err.startswith(f"carom.sweep: {path}: not a complete Parquet file"), err


def test_ctrl_c_and_sigterm_end_the_command(tmp_path):
    plan = break_plan(100_000, 200)
    plan.save(tmp_path / "p.json")
    for number, status in (signal.SIGINT, 130), (signal.SIGTERM, 143):
        process = command("carom.sweep", tmp_path / "p.json")
        seen = len(stamps(tmp_path / "p"))
        wait_for(lambda: len(stamps(tmp_path / "p")) > seen)
        process.send_signal(number)
        out, err = process.communicate(timeout=HANGS)
        assert process.returncode == status and "Traceback" not in err, err
        assert unfinished(tmp_path / "p") == []
    assert sweep.check(tmp_path / "p").faults == {}
