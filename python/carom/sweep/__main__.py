"""The command `python -m carom.sweep`."""

from __future__ import annotations

import argparse
import contextlib
import logging
import os
import signal
import sys
from typing import Any, NoReturn

from carom.sweep import _shards
from carom.sweep._columns import need
from carom.sweep._plan import Plan, SweepError, plan

_ABOUT = """Makes the missing shards of a sweep in its folder, on this machine or on a Dask cluster. It may be
killed at any time; the same command continues. With --scene it writes the plan PLAN instead."""
_END = """Exit status: 0 done, 1 something failed or is missing, 2 bad input, 130 after Ctrl-C."""


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        self.exit(2, f"carom.sweep: {message}; see python -m carom.sweep --help\n")


def _arguments() -> argparse.Namespace:
    parser = _Parser(prog="python -m carom.sweep", description=_ABOUT, epilog=_END, allow_abbrev=False)
    add = parser.add_argument
    add("plan", metavar="PLAN", help="file of the plan (JSON)")
    add("-o", "--output", metavar="FOLDER",
        help="folder of the shards; default: PLAN without .json, or the folder of a plan called plan.json")
    add("--threads", type=int, default=0, metavar="N",
        help="shards that this machine plays at a time, 0 for one per core")
    add("--dask", metavar="ADDRESS",
        help="play on a Dask cluster: tcp://HOST:PORT of its scheduler, or its scheduler file")
    add("--status", action="store_true", help="print how many shards and rows are finished")
    add("--check", action="store_true", help="read the finished shards and compare them with their checksums")
    new = parser.add_argument_group("a new plan").add_argument
    new("--scene", metavar="SCENE", help="scene file (TOML)")
    new("--vary", action="append", default=[], metavar="KEY=DISTRIBUTION",
        help="as in carom sweep; may be repeated")
    new("--shots", type=int, metavar="N", help="at most 2^53")
    new("--seed", type=int, default=1, metavar="S", help="seed of all draws (default: 1)")
    new("--shard", type=int, default=250_000, metavar="N", help="shots per file (default: 250000)")
    args = parser.parse_args()
    if args.scene and (not args.vary or args.shots is None):
        parser.error("--scene needs --vary and --shots")
    if args.threads < 0:
        parser.error(f"--threads {args.threads}: expected at least 0")
    return args


def _complain(message: object, code: int) -> int:
    print(f"carom.sweep: {message}", file=sys.stderr)
    return code


def _client(args: argparse.Namespace) -> Any:
    """A client of the named cluster, or of processes on this machine."""
    # Otherwise the tasks that wait for shards print tracebacks when Ctrl-C closes the client.
    logging.getLogger("asyncio").setLevel(logging.CRITICAL)
    connect: Any = need("distributed").Client
    if not args.dask:
        # Workers inherit that they ignore the Ctrl-C of the terminal; the client ends them.
        handler = signal.signal(signal.SIGINT, signal.SIG_IGN)
        client = connect(n_workers=args.threads or len(os.sched_getaffinity(0)), threads_per_worker=1,
                         dashboard_address=None, silence_logs="CRITICAL")
        signal.signal(signal.SIGINT, handler)
        return client
    where = "scheduler_file" if args.dask.endswith(".json") else "address"
    client = connect(**{where: args.dask}, timeout=30)
    print(f"dashboard: {client.dashboard_link}", flush=True)
    return client


def _kinds(outcomes: dict[str, int]) -> str:
    return ", ".join(f"{name} {count}" for name, count in outcomes.items())


def _play(args: argparse.Namespace, of: Plan, folder: str) -> int:
    with _client(args) as client, contextlib.redirect_stdout(sys.stderr):  # for the progress bar
        done = _shards.run(of, folder, client, progress=sys.stderr.isatty())
    print(f"{folder}: {done.rows} rows ({_kinds(done.outcomes)}), {done.played} of them played now")
    failed = done.outcomes.get("failed", 0)
    return _complain(f"{failed} shots failed while running; their rows say why", 1) if failed else 0


def _report(of: Plan, folder: str, check: bool) -> int:
    os.makedirs(folder, exist_ok=True)
    of.save(os.path.join(folder, _shards.PLAN))
    found = _shards.check(folder) if check else _shards.status(folder)
    kinds = f" ({_kinds(found.outcomes)})" if check else ""
    print(f"{folder}: {len(found.finished)} of {of.shards} shards, {found.rows} of {of.shots} rows{kinds}")
    if found.missing:
        print(f"missing: {', '.join(map(str, found.missing[:20]))}{', ...' * (len(found.missing) > 20)}")
    for fault in found.faults.values():
        _complain(fault, 1)
    return 0 if found.whole else 1


def _do(args: argparse.Namespace) -> int:
    try:
        if args.scene:
            made = plan(args.scene, args.vary, args.shots, seed=args.seed, shard=args.shard)
            made.save(args.plan)
            print(f"{args.plan}: {made.shots} shots in {made.shards} shards")
            return 0
        made = Plan.load(args.plan)
    except (SweepError, ValueError) as error:
        return _complain(error, 2)
    own = os.path.basename(args.plan) == _shards.PLAN
    folder = args.output or (os.path.dirname(args.plan) or "." if own else os.path.splitext(args.plan)[0])
    if folder == args.plan:
        return _complain(f"{args.plan}: name the folder of the shards with --output", 2)
    return _report(made, folder, args.check) if args.status or args.check else _play(args, made, folder)


def main() -> int:
    """Runs the command line and returns the exit status."""
    try:
        return _do(_arguments())
    except (SweepError, ImportError, OSError) as error:
        return _complain(error, 1)
    except KeyboardInterrupt:
        return _complain("stopped; run the same command to continue", 130)
    except Exception as error:
        # Dask's errors for shards whose workers died again and again, and for a scheduler that has gone.
        if type(error).__name__ not in ("KilledWorker", "FutureCancelledError", "CancelledError"):
            raise
        return _complain(f"{error}; finished shards are kept: run the same command to continue", 1)


if __name__ == "__main__":
    sys.exit(main())
