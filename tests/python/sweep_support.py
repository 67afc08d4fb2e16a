"""Shared by the tests of sharded sweeps: plans, workers, and the contents of folders."""

from __future__ import annotations

import os
import pathlib
import subprocess
import sys
import time

from carom import sweep
from conftest import HANGS, SOURCE

DRAW = ["cue.aim_deg=normal(2)", "cue.speed=uniform(1,4)"]
# Each shot lasts milliseconds, which leaves time to kill a worker.
BREAKS = ["cue.aim_deg=normal(0.3)", "cue.speed=uniform(8,10)"]
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
    return sweep.plan(SOURCE / "scenes/eight_ball_break.toml", BREAKS, shots, shard=shard)


def stamps(folder):
    """Values per shard file that change when the file is rewritten."""
    return {
        path.name: (path.stat().st_ino, path.stat().st_mtime_ns)
        for path in pathlib.Path(folder).glob("*.parquet")}


def contents(folder):
    return {path.name: path.read_bytes() for path in pathlib.Path(folder).glob("*.parquet")}


def unfinished(folder):
    return sorted(os.listdir(pathlib.Path(folder) / ".unfinished"))


def worker(plan, shard, folder, **options):
    """Starts a process that makes one shard."""
    call = f"sweep.run_shard({str(plan)!r}, {shard}, {str(folder)!r})"
    code = f"from carom import sweep; print({call}['played'])"
    return subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options)


def wait_for(what):
    end = time.monotonic() + HANGS
    while not (found := what()):
        assert time.monotonic() < end, "it did not happen"
        time.sleep(0.005)
    return found
