#!/usr/bin/env python3
"""The cost of sharded sweeps: CPU time compared with the engine's batch and `carom sweep`, bytes per row,
memory of the client.

    PYTHONPATH=build/release/python lab/measure/sweep_cost.py [--rounds 9]

Everything runs on one thread, alternating; medians over the rounds. Needs pyarrow.
"""

import argparse
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time

from carom import _carom, sweep

CASES = [
    ("draw", ["cue.aim_deg=normal(2)", "cue.speed=uniform(1,4)"], 250_000),
    ("three_cushion", ["cue.aim_deg=normal(2)", "cue.speed=uniform(3,6)"], 250_000),
    ("eight_ball_break", ["cue.aim_deg=uniform(86.3,90.9)", "cue.speed=uniform(2,11)"], 4_000),
]
PROGRAM = os.environ.get("CAROM_PROGRAM", "build/release/carom")


def children():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def batch(plan, hashes):
    """CPU seconds of the engine alone, the plain batch, including its random draws."""
    scene = sweep._plan.Scene.loads(plan.scene, plan.name)
    native = _carom.make_sweep(scene._native, list(plan.vary), plan.seed)
    start = time.process_time()
    native.play(0, plan.shots, 1, int(hashes), sweep._columns.NEVER)
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
    print("| shots | plain batch, us a shot | with hashes | shards, no hashes | shards, digest | "
          "`carom sweep` | bytes a row: Parquet | CSV | ratio |")
    print("|---|---|---|---|---|---|---|---|---|")
    for name, rules, shots in CASES:
        path = f"scenes/{name}.toml"
        plain = sweep.plan(path, rules, shots, shard=shots, hashes="none")
        digest = plain._replace(hashes="digest")
        seconds = {key: [] for key in ("batch", "hashes", "plain", "digest", "csv")}
        for _ in range(rounds):
            seconds["batch"].append(batch(plain, False))
            seconds["hashes"].append(batch(plain, True))
            cost, parquet = shards(plain)
            seconds["plain"].append(cost)
            seconds["digest"].append(shards(digest)[0])
            cost, csv = table(plain, path)
            seconds["csv"].append(cost)

        def ratio(key):
            return statistics.median(a / b for a, b in zip(seconds[key], seconds["batch"]))

        cost = statistics.median(seconds["batch"]) / shots * 1e6
        print(
            f"| {name} | {cost:.2f} | {ratio('hashes'):.3f} | {ratio('plain'):.3f} | {ratio('digest'):.3f} | "
            f"{ratio('csv'):.3f} | "
            f"{parquet / shots:.1f} | {csv / shots:.1f} | {parquet / csv:.3f} |"
        )


def memory():
    """Prints the cost of planning and supervising a large sweep, measured in its own process."""
    code = """
import os, sys, tempfile, time
from carom import sweep
import pyarrow.parquet

def peak():  # not ru_maxrss, which includes the parent process
    with open("/proc/self/status") as file:
        return next(int(line.split()[1]) for line in file if line.startswith("VmHWM")) / 1024

shots, shard = int(sys.argv[1]), int(sys.argv[2])
before = peak()
start = time.perf_counter()
plan = sweep.plan("scenes/eight_ball_break.toml", ["cue.speed=uniform(2,11)"], shots, shard=shard)
planned = time.perf_counter() - start
with tempfile.TemporaryDirectory() as folder:
    plan.save(os.path.join(folder, "plan.json"))
    for name in plan.files():
        open(os.path.join(folder, name), "w").close()
    start = time.perf_counter()
    found = sweep.status(folder)
    seen = time.perf_counter() - start
    assert found.done == plan.shards
    size = os.path.getsize(os.path.join(folder, "plan.json"))
    for name in plan.files():
        os.unlink(os.path.join(folder, name))
    # An executor that makes nothing, so that only the client's own cost remains.
    class Done:
        def __init__(self, arguments): self.arguments = arguments
        def add_done_callback(self, call): call(self)
        def cancel(self): pass
        def result(self):
            first, last = plan.range(self.arguments[1])
            return {"outcomes": {"at_rest": last - first}, "played": True}
    class Executor:
        def submit(self, work, *arguments): return Done(arguments)
    start = time.perf_counter()
    assert sweep.run(plan, folder, Executor()).rows == shots
    ran = time.perf_counter() - start
row = (f"{shots:.0e}", plan.shards, size, f"{1e3 * planned:.1f}", f"{1e3 * seen:.0f}",
       f"{1e6 * ran / plan.shards:.0f}", f"{before:.0f}", f"{peak() - before:.1f}")
print("|", " | ".join(map(str, row)), "|")
"""
    print("\n| shots | shards | bytes of the plan | planning, ms | `status`, ms | client, us a shard | "
          "a Python with carom and pyarrow, MB | on top, MB |")
    print("|---|---|---|---|---|---|---|---|")
    for shots, shard in (10**6, 250_000), (10**9, 250_000), (10**9, 10_000), (2**53, 10**11):
        sys.stdout.flush()
        subprocess.run([sys.executable, "-c", code, str(shots), str(shard)], check=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=9, metavar="N", help="default: 9")
    rows(parser.parse_args().rounds)
    memory()


if __name__ == "__main__":
    main()
