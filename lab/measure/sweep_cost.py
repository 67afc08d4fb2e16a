#!/usr/bin/env python3
"""The cost of sharded sweeps: CPU time compared with the engine's batch and `carom sweep`, bytes per row,
time and memory of Dask's client and scheduler.

    PYTHONPATH=build/release/python lab/measure/sweep_cost.py [--rounds 9]

Everything runs on one thread, alternating; medians over the rounds. Needs pyarrow
and distributed.
"""

import argparse
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time

from carom import sweep
from carom.sweep._plan import player_of

CASES = [
    ("draw", ["cue.aim_deg=normal(2)", "cue.speed=uniform(1,4)"], 250_000),
    ("three_cushion", ["cue.aim_deg=normal(2)", "cue.speed=uniform(3,6)"], 250_000),
    ("eight_ball_break", ["cue.aim_deg=uniform(86.3,90.9)", "cue.speed=uniform(2,11)"], 4_000),
]
PROGRAM = os.environ.get("CAROM_PROGRAM", "build/release/carom")


def children():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def batch(plan):
    """CPU seconds of the engine alone, the plain batch, including its random draws."""
    native = player_of(plan).sweep
    start = time.process_time()
    native.play(0, plan.shots, 1, False)
    return time.process_time() - start


def shards(plan):
    """CPU seconds of a run with one thread, and the size of its files in bytes."""
    with tempfile.TemporaryDirectory() as folder:
        start = time.process_time()
        sweep.run(plan, folder, threads=1)
        seconds = time.process_time() - start
        return seconds, sum(
            entry.stat().st_size for entry in os.scandir(folder) if entry.name.endswith(".parquet"))


def table(plan, path):
    """CPU seconds of `carom sweep` with one thread, and the size of its table in bytes."""
    with tempfile.TemporaryDirectory() as folder:
        csv = os.path.join(folder, "t.csv")
        words = [word for rule in plan.vary for word in ("--vary", rule)]
        before = children()
        subprocess.run([PROGRAM, "sweep", path, *words, "--count", str(plan.shots), "--jobs", "1", "-o", csv],
                       check=True, stdout=subprocess.DEVNULL)
        return children() - before, os.path.getsize(csv)


def rows(rounds):
    print("| shots | plain batch, us a shot | shards | `carom sweep` | bytes a row: Parquet | CSV | ratio |")
    print("|---|---|---|---|---|---|---|")
    for name, rules, shots in CASES:
        path = f"scenes/{name}.toml"
        plan = sweep.plan(path, rules, shots, shard=shots)
        seconds = {key: [] for key in ("batch", "shards", "csv")}
        for _ in range(rounds):
            seconds["batch"].append(batch(plan))
            cost, parquet = shards(plan)
            seconds["shards"].append(cost)
            cost, csv = table(plan, path)
            seconds["csv"].append(cost)

        def ratio(key):
            return statistics.median(a / b for a, b in zip(seconds[key], seconds["batch"]))

        cost = statistics.median(seconds["batch"]) / shots * 1e6
        print(f"| {name} | {cost:.2f} | {ratio('shards'):.3f} | {ratio('csv'):.3f} | {parquet / shots:.1f} | "
              f"{csv / shots:.1f} | {parquet / csv:.3f} |")


def memory():
    """Prints the cost of a large sweep for Dask's client and scheduler, measured in their own process."""
    code = """
import sys, tempfile, time
import distributed
from carom import sweep
from carom.sweep import _shards

def peak():  # not ru_maxrss, which includes the parent process
    with open("/proc/self/status") as file:
        return next(int(line.split()[1]) for line in file if line.startswith("VmHWM")) / 1024

def nothing(plan, shard, folder):
    return {"outcomes": {"at_rest": 1}, "played": True}

shards = int(sys.argv[1])
_shards.run_shard = nothing
plan = sweep.plan("scenes/eight_ball_break.toml", ["cue.speed=uniform(2,11)"], shards, shard=1)
client = distributed.Client(processes=False, dashboard_address=None)
with tempfile.TemporaryDirectory() as folder, client:
    before, start = peak(), time.perf_counter()
    sweep.run(plan, folder, client)
    ran = time.perf_counter() - start
print(f"| {shards} | {1e6 * ran / shards:.0f} | {before:.0f} | {peak() - before:.1f} |")
"""
    print("\n| shards | us a shard | Python with carom and Dask, MB | on top, MB |")
    print("|---|---|---|---|")
    for shards in 1000, 4000, 100_000:
        sys.stdout.flush()
        subprocess.run([sys.executable, "-c", code, str(shards)], check=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=9, metavar="N", help="default: 9")
    rows(parser.parse_args().rounds)
    memory()


if __name__ == "__main__":
    main()
