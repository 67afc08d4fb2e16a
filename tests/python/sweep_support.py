"""What the tests of sweeps in shards share: plans, workers, and what lies in a folder."""

from __future__ import annotations

import os
import pathlib
import subprocess
import sys
import time

from carom import sweep
from conftest import HANGS, SOURCE

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
    return {
        path.name: (path.stat().st_ino, path.stat().st_mtime_ns)
        for path in pathlib.Path(folder).glob("*.parquet")}


def contents(folder):
    return {path.name: path.read_bytes() for path in pathlib.Path(folder).glob("*.parquet")}


def unfinished(folder):
    return sorted(os.listdir(pathlib.Path(folder) / ".unfinished"))


def worker(plan, shard, folder, **options):
    """A process of its own that makes a shard."""
    code = f"from carom import sweep; print(sweep.run_shard({str(plan)!r}, {shard}, {str(folder)!r})['played'])"
    return subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options)


def wait_for(what):
    end = time.monotonic() + HANGS
    while not (found := what()):
        assert time.monotonic() < end, "it did not happen"
        time.sleep(0.005)
    return found
