"""Shards on threads, processes and machines."""

from __future__ import annotations

import collections
import contextlib
import functools
import itertools
import json
import os
import queue
import time
from collections.abc import Callable, Generator, Iterable, Mapping
from concurrent.futures import BrokenExecutor, ThreadPoolExecutor
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from carom._arguments import checked
from carom.sweep._columns import NEVER
from carom.sweep._folder import PLAN, in_parallel, status, those_there
from carom.sweep._plan import Plan, SweepError, wrong_worker
from carom.sweep._shard import Tally, footer, make_shard, need, run_shard, tables

if TYPE_CHECKING:
    import pyarrow
    from numpy.typing import NDArray

#: The least number of shards in an executor's queue; limited so that the client's memory does not grow with
#: the sweep.
_WINDOW = 1024
#: As above, if results wait for earlier ones.
_WINDOW_OF_RESULTS = 64
_RUN_AGAIN = "; finished shards are kept; run it again"


class Progress(NamedTuple):
    """The progress of a run."""

    shards: int  # requested
    done: int  # of these, that exist
    rows: int  # in them
    played: int  # rows that this run has played
    seconds: float  # since this run began
    outcomes: dict[str, int]  # of all rows

    @property
    def rate(self) -> float:
        """Shots per second in this run."""
        return self.played / max(self.seconds, 1e-9)

    @property
    def failed(self) -> int:
        """The number of shots whose simulation could not continue."""
        return self.outcomes.get("failed", 0)


class _Count:
    """Adds up the results of shards as Progress, and reports it."""

    def __init__(self, shards: int, tell: Callable[[Progress], None] | None) -> None:
        self.tell, self.start = tell, time.perf_counter()
        self.progress = Progress(shards, 0, 0, 0, 0.0, {})

    def add(self, outcomes: dict[str, int], played: bool) -> None:
        rows, now = sum(outcomes.values()), self.progress
        self.progress = now._replace(
            done=now.done + 1, rows=now.rows + rows, played=now.played + rows * played,
            seconds=time.perf_counter() - self.start,
            outcomes=dict(collections.Counter(now.outcomes) + collections.Counter(outcomes)))

    def show(self) -> None:
        if self.tell is not None:
            self.tell(self.progress)


class _Threads:
    """The executor within one process. It can stop in the middle of a shard."""

    def __init__(self, threads: int) -> None:
        self.ended = np.zeros(1, np.uint8)
        self.pool = ThreadPoolExecutor(threads or len(os.sched_getaffinity(0)), "carom-sweep")

    def submit(self, work: Callable[..., Any], *arguments: Any) -> Any:
        return self.pool.submit(work, *arguments, self.ended)

    def __enter__(self) -> _Threads:
        return self

    def __exit__(self, *_: object) -> None:
        self.ended[0] = 1
        self.pool.shutdown(cancel_futures=True)


def _is_dask(executor: Any) -> bool:
    return any(type_.__module__.partition(".")[0] == "distributed" for type_ in type(executor).__mro__)


def _window(executor: Any, least: int) -> int:
    return max(least, 4 * sum(executor.nthreads().values())) if _is_dask(executor) else least


class _Tasks:
    """Submits the work on shards to an executor, a window at a time, and takes results as they come."""

    def __init__(
        self, executor: Any, work: Callable[..., Any], arguments: Callable[[int], tuple[Any, ...]],
        retries: int,
    ) -> None:
        self.executor, self.work, self.arguments = executor, work, arguments
        self.left = retries
        self.ended: queue.SimpleQueue[tuple[int, Any]] = queue.SimpleQueue()
        self.running: dict[int, Any] = {}

    def begin(self, shard: int) -> None:
        options: dict[str, Any] = {}
        if _is_dask(self.executor):
            options = {"pure": False, "key": f"carom-shard-{shard}-{os.urandom(4).hex()}"}
        try:
            future = self.executor.submit(self.work, *self.arguments(shard), **options)
        except (BrokenExecutor, RuntimeError) as error:
            what = f"the executor accepts no more work ({error})"
            raise SweepError(f"shard {shard}: {what}{_RUN_AGAIN}") from None
        self.running[shard] = future
        future.add_done_callback(lambda done: self.ended.put((shard, done)))

    def next(self) -> tuple[int, Any]:
        """The next shard whose work has ended, and its result."""
        while True:
            shard, future = self.ended.get()
            if self.running.pop(shard, None) is None:
                continue
            try:
                return shard, future.result()
            except Exception as error:
                kind = type(error).__name__
                # Dask has errors of its own with these names.
                if isinstance(error, BrokenExecutor) or kind in ("CancelledError", "FutureCancelledError"):
                    what = f"its worker or the scheduler has gone ({kind})"
                    raise SweepError(f"shard {shard}: {what}{_RUN_AGAIN}") from None
                # Dask gives up a task whose workers have died several times, which may be the machines'
                # fault.
                if kind != "KilledWorker" or self.left == 0:
                    raise
                self.left -= 1
                self.begin(shard)

    def give_up(self) -> None:
        for future in self.running.values():
            future.cancel()


def _call(work: Callable[..., Any], arguments: tuple[Any, ...]) -> Any:
    """For executors with only `map`, whose functions take one argument."""
    return work(*arguments)


def _results(
    executor: Any, work: Callable[..., Any], arguments: Callable[[int], tuple[Any, ...]],
    shards: Iterable[int], retries: int, *, in_order: bool = False,
) -> Generator[Any, None, None]:
    """The results of `work` on shards as they come, or in the order of the shards, with only a few
    waiting."""
    if not hasattr(executor, "submit"):
        each = getattr(executor, "imap" if in_order else "imap_unordered", executor.map)
        yield from each(functools.partial(_call, work), map(arguments, shards))
        return
    tasks = _Tasks(executor, work, arguments, retries)
    window = _window(executor, _WINDOW_OF_RESULTS if in_order else _WINDOW)
    todo, waiting = iter(shards), dict[int, Any]()
    begun = dict[int, None]()  # in order, until their results are yielded
    try:
        while True:
            for shard in itertools.islice(todo, window - len(begun)):
                tasks.begin(shard)
                begun[shard] = None
            if not begun:
                return
            ended, result = tasks.next()
            waiting[ended] = result
            ready: int | None = next(iter(begun)) if in_order else ended
            while ready is not None and ready in waiting:
                del begun[ready]
                yield waiting.pop(ready)
                ready = next(iter(begun), None)
    finally:
        tasks.give_up()


def _workers(executor: Any, threads: int) -> contextlib.AbstractContextManager[Any]:
    if executor == "threads":
        return _Threads(threads)
    if not hasattr(executor, "submit") and not hasattr(executor, "map"):
        wanted = '"threads", a concurrent.futures executor, a Dask client, or an object with submit or map'
        raise ValueError(f"executor={executor!r}: expected {wanted}")
    return contextlib.nullcontext(executor)


@checked
def run(
    plan: Plan,
    folder: str | os.PathLike[str],
    executor: Any = "threads",
    *,
    threads: int = 0,
    shards: Iterable[int] | None = None,
    retries: int = 3,
    progress: Callable[[Progress], None] | None = None,
) -> Progress:
    """Makes the missing shards of a sweep in the folder, and the folder with its plan if there is none.

    executor: "threads" of this process, an executor of concurrent.futures, a Dask client, or anything else
        with `submit` or `map`; its workers need access to the folder
    threads: the number of "threads"; 0 uses one per core
    shards: make only these
    retries: how often to retry shards that Dask gives up because their workers died
    progress: called after every shard

    A run may be killed at any time, as may any of its workers: the files in the folder are complete, and the
    next run makes the rest. Raises SweepError if the folder has other contents or a worker has another
    carom, and OSError if a file cannot be written.
    """
    need("pyarrow.parquet")
    workers = _workers(executor, threads)
    name = os.path.abspath(folder)
    path = os.path.join(name, PLAN)
    os.makedirs(name, exist_ok=True)
    plan.save(path)
    wanted = range(plan.shards) if shards is None else sorted(set(shards))
    for shard in wanted if shards is not None else ():
        plan.range(shard)
    found = status(name)
    missing, there = set(found.missing), those_there(found, wanted)
    count = _Count(len(wanted), progress)
    footers = in_parallel(lambda shard: footer(plan, shard, os.path.join(name, plan.file(shard))), there)
    for about in footers:
        count.add(json.loads(about["carom.outcomes"]), played=False)
    count.show()
    work: tuple[Any, Any] = (make_shard, lambda shard: (plan, shard, name, 1))
    if executor != "threads":  # its workers read the plan from the folder, so that a task is small
        work = (run_shard, lambda shard: (path, shard, name))
    todo = (shard for shard in wanted if shard in missing)
    with workers as those, contextlib.closing(_results(those, *work, todo, retries)) as results:
        for result in results:
            count.add(result["outcomes"], result["played"])
            count.show()
    return count.progress


def _reduced(
    plan: Plan, shard: int, fn: Callable[[pyarrow.Table], Any], stop: NDArray[np.uint8] = NEVER
) -> tuple[Any, dict[str, int]]:
    import pyarrow

    need("pyarrow")
    wrong = wrong_worker(plan)
    if wrong:
        raise SweepError(f"shard {shard}: process {os.getpid()}: {wrong}")
    tally = Tally()
    table = pyarrow.concat_tables(tables(plan, shard, 1, stop, tally))
    return fn(table), tally.outcomes()


def _merge(a: Any, b: Any) -> Any:
    if isinstance(a, Mapping):
        keys = [*a, *(key for key in b if key not in a)]
        both = a.keys() & b.keys()
        return {key: _merge(a[key], b[key]) if key in both else a.get(key, b.get(key)) for key in keys}
    if isinstance(a, (tuple, list)):
        if len(a) != len(b):
            raise ValueError(f"cannot add a {type(a).__name__} of {len(b)} to one of {len(a)}")
        return type(a)(_merge(x, y) for x, y in zip(a, b))
    return a + b


@checked
def reduce(
    plan: Plan,
    fn: Callable[[pyarrow.Table], Any],
    executor: Any = "threads",
    *,
    merge: Callable[[Any, Any], Any] = _merge,
    threads: int = 0,
    retries: int = 3,
    progress: Callable[[Progress], None] | None = None,
) -> Any:
    """Plays a sweep without keeping rows: `fn` turns the table of every shard into a result, and `merge`
    combines two results.

    fn: for processes it must be picklable, such as a function of a module
    merge: the default adds numbers, arrays, and the matching parts of mappings, tuples and lists

    Results are merged in the order of the shards, so that the bits do not depend on the workers.
    Everything else is as for `run`, except that a killed reduction starts again.
    """
    need("pyarrow")
    workers = _workers(executor, threads)
    count = _Count(plan.shards, progress)
    whole: Any = None
    with workers as those, contextlib.closing(
        _results(those, _reduced, lambda shard: (plan, shard, fn), range(plan.shards), retries, in_order=True)
    ) as results:
        for number, (part, outcomes) in enumerate(results):
            whole = part if number == 0 else merge(whole, part)
            count.add(outcomes, played=True)
            count.show()
    return whole
