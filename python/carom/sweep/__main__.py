"""The command `python -m carom.sweep`."""

from __future__ import annotations

import argparse
import os
import signal
import sys
import time
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NoReturn

from carom.sweep import _folder, _run, _slurm
from carom.sweep._plan import Plan, SweepError, plan
from carom.sweep._shard import need

if TYPE_CHECKING:
    from types import FrameType

_ABOUT = """Makes the missing shards of a sweep in its folder, on the threads of this machine, on a Dask
cluster or as a Slurm array. It may be killed at any time; the same command continues. With --scene it writes
the plan PLAN instead."""
_END = """Exit status: 0 done, 1 something failed or is missing, 2 bad input, 130 or 143 after a signal."""
#: [s] Between two lines of progress if there is no terminal.
_EVERY = 10.0


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        self.exit(2, f"carom.sweep: {message}; see python -m carom.sweep --help\n")


def _arguments() -> argparse.ArgumentParser:
    parser = _Parser(prog="python -m carom.sweep", description=_ABOUT, epilog=_END, allow_abbrev=False)
    add = parser.add_argument
    add("plan", metavar="PLAN", help="file of the plan (JSON)")
    add("-o", "--output", metavar="FOLDER",
        help="folder of the shards; default: PLAN without .json, or the folder of a plan called plan.json")
    add("--threads", type=int, default=0, metavar="N", help="threads on this machine, 0 for one per core")
    add("--dask", metavar="ADDRESS",
        help="play on a Dask cluster: tcp://HOST:PORT of its scheduler, or its scheduler file")
    add("--slurm", action="store_true", help="submit the missing shards as a Slurm array, with sbatch")
    add("--sbatch", default="", metavar="OPTIONS",
        help="more options for sbatch: --sbatch='--time=60 --cpus-per-task=16'")
    add("--elements", type=int, default=1000, metavar="N",
        help="most elements of an array, at most Slurm's MaxArraySize (default: 1000)")
    add("--part", metavar="I/N",
        help="play only the shards whose number modulo N is I, as an array element does")
    add("--status", action="store_true", help="print how many shards and rows are finished")
    add("--missing", action="store_true",
        help="print the numbers of the missing shards in the form of sbatch --array")
    add("--check", action="store_true", help="read the finished shards and compare them with their hashes")
    new = parser.add_argument_group("a new plan")
    new.add_argument("--scene", metavar="SCENE", help="scene file (TOML)")
    new.add_argument("--vary", action="append", default=[], metavar="KEY=DISTRIBUTION",
                     help="as in carom sweep; may be repeated")
    new.add_argument("--shots", type=int, metavar="N", help="at most 2^53")
    new.add_argument("--seed", type=int, default=1, metavar="S", help="seed of all draws (default: 1)")
    new.add_argument("--shard", type=int, default=250_000, metavar="N",
                     help="shots per file (default: 250000)")
    new.add_argument(
        "--hashes", choices=("none", "digest", "column"), default="digest",
        help="hashes of the records: none, one per shard (of every 64th shot), or also a column")
    return parser


def _usage(message: str) -> NoReturn:
    raise SystemExit(_complain(message, 2))


def _complain(message: object, code: int) -> int:
    print(f"carom.sweep: {message}", file=sys.stderr)
    return code


def _new_plan(args: argparse.Namespace) -> int:
    if not args.vary or args.shots is None:
        _usage("--scene needs --vary and --shots")
    try:
        made = plan(args.scene, args.vary, args.shots, seed=args.seed, shard=args.shard, hashes=args.hashes)
    except ValueError as error:
        return _complain(error, 2)
    made.save(args.plan)
    print(f"{args.plan}: {made.shots} shots in {made.shards} shards")
    return 0


def numbers(shards: Sequence[int]) -> str:
    """Ascending numbers in the form of sbatch --array: 0-3,7."""
    runs: list[list[int]] = []
    for shard in shards:
        if runs and shard == runs[-1][1] + 1:
            runs[-1][1] = shard
        else:
            runs.append([shard, shard])
    return ",".join(str(first) if first == last else f"{first}-{last}" for first, last in runs)


def _part(text: str, of: Plan) -> range:
    number, _, count = text.partition("/")
    if not (number.isdecimal() and count.isdecimal() and int(number) < int(count)):
        _usage(f"--part {text}: expected I/N with 0 <= I < N, as in 3/100")
    return range(int(number), of.shards, int(count))


class _Line:
    """Progress on standard error: one line that is updated on a terminal, otherwise a line now and then."""

    def __init__(self) -> None:
        self.terminal = sys.stderr.isatty()
        self.next = 0.0
        self.waiting: _run.Progress | None = None

    def __call__(self, progress: _run.Progress) -> None:
        self.waiting = progress
        if time.monotonic() >= self.next:
            self.show(progress)

    def show(self, progress: _run.Progress) -> None:
        self.waiting = None
        self.next = time.monotonic() + (0.2 if self.terminal else _EVERY)
        left = progress.shards - progress.done
        text = (
            f"{progress.done} of {progress.shards} shards, {left} left, {progress.rows} rows, "
            f"{progress.rate:.0f} shots/s, {progress.failed} failed"
        )
        before, end = ("\r\x1b[K", "") if self.terminal else ("", "\n")
        print(f"{before}{text}", end=end, file=sys.stderr, flush=True)

    def end(self) -> None:
        if self.waiting is not None:
            self.show(self.waiting)
        if self.terminal:
            print(file=sys.stderr)


def _play(args: argparse.Namespace, of: Plan, folder: str) -> int:
    shards = _part(args.part, of) if args.part else None
    line = _Line()
    executor: Any = "threads"
    if args.dask:
        executor = _dask_client(args.dask)
    try:
        done = _run.run(of, folder, executor, threads=args.threads, shards=shards, progress=line)
    finally:
        line.end()
        if args.dask:
            executor.close(timeout=5)
    kinds = ", ".join(f"{name} {count}" for name, count in done.outcomes.items())
    played = f"{done.played} of them played in {done.seconds:.1f} s, {done.rate:.0f} a second"
    print(f"{folder}: {done.rows} rows ({kinds}), {played}")
    return _complain(f"{done.failed} shots failed while running; their rows say why", 1) if done.failed else 0


def _dask_client(address: str) -> Any:
    need("distributed")
    import distributed

    connect: Any = distributed.Client
    where: dict[str, Any] = {"scheduler_file" if address.endswith(".json") else "address": address}
    client = connect(**where, timeout=30)
    print(f"dashboard: {client.dashboard_link}", flush=True)
    return client


def _say_status(folder: str) -> int:
    found = _folder.status(folder)
    print(f"{folder}: {found.done} of {found.plan.shards} shards, {found.rows} of {found.plan.shots} rows")
    if found.missing:
        print(f"missing: {numbers(found.missing)}")
    for name in found.unfinished:
        print(f"unfinished: {name}")
    for name in found.strangers:
        print(f"not of this sweep: {name}")
    return 1 if found.missing or found.strangers else 0


def _say_check(folder: str) -> int:
    found = _folder.check(folder)
    kinds = ", ".join(f"{name} {count}" for name, count in found.outcomes.items())
    print(f"{folder}: {found.rows} of {found.plan.shots} rows are complete and unchanged ({kinds})")
    if found.missing:
        print(f"missing: {numbers(found.missing)}")
    for fault in found.faults.values():
        _complain(fault, 1)
    return 0 if found.whole else 1


def _do(args: argparse.Namespace) -> int:
    if args.scene:
        return _new_plan(args)
    try:
        of = Plan.load(args.plan)
    except SweepError as error:
        return _complain(error, 2)
    own = os.path.basename(args.plan) == _folder.PLAN
    folder = args.output or (os.path.dirname(args.plan) or "." if own else os.path.splitext(args.plan)[0])
    if args.threads < 0 or args.elements < 1:
        _usage("--threads must be at least 0, and --elements at least 1")
    if not args.output and folder == args.plan:
        _usage(f"{args.plan}: name the folder of the shards with --output")
    if args.status or args.missing or args.check:
        os.makedirs(folder, exist_ok=True)
        of.save(os.path.join(folder, _folder.PLAN))
    if args.status:
        return _say_status(folder)
    if args.missing:
        print(numbers(_folder.status(folder).missing))
        return 0
    if args.check:
        return _say_check(folder)
    if args.slurm:
        print(_slurm.submit(of, folder, args.elements, args.sbatch, numbers))
        return 0
    return _play(args, of, folder)


def _terminated(number: int, frame: FrameType | None) -> NoReturn:
    raise SystemExit(128 + number)


def main() -> int:
    """Runs the command line and returns the exit status."""
    args = _arguments().parse_args()
    signal.signal(signal.SIGTERM, _terminated)
    try:
        return _do(args)
    except (SweepError, ImportError, OSError) as error:
        return _complain(error, 1)
    except KeyboardInterrupt:
        return _complain("stopped; run the same command to continue", 130)


if __name__ == "__main__":
    sys.exit(main())
