"""Sweeps as Slurm arrays."""

from __future__ import annotations

import os
import shlex
import subprocess
import sys
from collections.abc import Callable, Sequence

from carom.sweep._folder import PLAN, status
from carom.sweep._plan import Plan, SweepError


def command(plan: Plan, folder: str, elements: int) -> str:
    """The command of an array's element. Its shards depend only on its number, so a requeued element has the
    same ones."""
    words = [sys.executable, "-m", "carom.sweep", os.path.join(folder, PLAN), "-o", folder]
    part, threads = f'"$SLURM_ARRAY_TASK_ID/{min(elements, plan.shards)}"', '"${SLURM_CPUS_PER_TASK:-1}"'
    return f"{shlex.join(words)} --part {part} --threads {threads}"


def submit(
    plan: Plan, folder: str, elements: int, options: str, numbers: Callable[[Sequence[int]], str]
) -> str:
    """Submits an array whose elements make the missing shards. Returns a report. Raises SweepError if sbatch
    fails."""
    folder = os.path.abspath(folder)
    os.makedirs(folder, exist_ok=True)
    plan.save(os.path.join(folder, PLAN))
    missing = status(folder).missing
    if not missing:
        return f"{folder}: nothing is missing"
    count = min(elements, plan.shards)
    array = numbers(sorted({shard % count for shard in missing}))
    words = ["sbatch", "--parsable", "--job-name=carom-sweep", f"--array={array}"]
    words += [f"--output={folder}/slurm-%A_%a.out", *shlex.split(options)]
    words.append(f"--wrap={command(plan, folder, elements)}")
    try:
        done = subprocess.run(words, capture_output=True, text=True, check=False)
    except FileNotFoundError:
        raise SweepError("sbatch: program not found; run this on a machine of a Slurm cluster") from None
    if done.returncode != 0:
        raise SweepError(f"sbatch failed with status {done.returncode}: {done.stderr.strip()}")
    job = done.stdout.strip().partition(";")[0]
    shards = f"{len(missing)} of {plan.shards} shards"
    return f"job {job}: --array={array} for {shards}; --status shows how far they are"
