"""Shards: Parquet files in the folder of a sweep, made in this process or on the workers of a Dask client."""

from __future__ import annotations

import collections
import functools
import os
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from carom._arguments import checked
from carom._files import whole_file
from carom.sweep._columns import need
from carom.sweep._plan import Plan, SweepError, player_of, require_same_bits

if TYPE_CHECKING:
    from typing import BinaryIO

    import pyarrow
    import pyarrow.dataset

PLAN = "plan.json"


class Status(NamedTuple):
    """The contents of a sweep's folder, by file names; or also by their rows, as read by `check`."""

    plan: Plan
    finished: tuple[int, ...]  # shards that exist
    missing: tuple[int, ...]  # shards that do not
    rows: int  # in the existing shards, without damaged ones after `check`
    outcomes: dict[str, int] = {}  # only from `check`
    faults: dict[str, str] = {}  # only from `check`: file name, its fault

    @property
    def whole(self) -> bool:
        """Whether every shot exists, and `check` has found no fault."""
        return not self.faults and not self.missing


class Run(NamedTuple):
    """The result of `run`."""

    rows: int
    played: int  # rows that this run has played
    outcomes: dict[str, int]  # of all rows; "failed" if a simulation could not continue


def _table(plan: Plan, shard: int, threads: int) -> pyarrow.Table:
    require_same_bits(plan)
    return player_of(plan).table(*plan.range(shard), threads)


def _write(table: pyarrow.Table, file: BinaryIO) -> None:
    need("pyarrow.parquet").write_table(
        table, file, compression="zstd",
        use_dictionary=[field.name for field in table.schema if field.type == "string"],
        use_byte_stream_split=[field.name for field in table.schema if field.type == "double"],
        # Without statistics, because readers would use them to skip pages whose checksum is wrong.
        write_page_checksum=True, write_statistics=False)


def _read(plan: Plan, shard: int, folder: str, columns: list[str] | None = None) -> pyarrow.Table:
    """A shard's rows. Raises SweepError if its file is damaged or belongs elsewhere."""
    path = os.path.join(folder, plan.file(shard))
    first, last = plan.range(shard)
    parquet = need("pyarrow.parquet")
    try:
        with parquet.ParquetFile(path, page_checksum_verification=True) as file:
            schema, table = file.schema_arrow, file.read(columns)
    except Exception as error:  # pyarrow raises errors of any type for a damaged file
        what = (str(error).strip() or type(error).__name__).splitlines()[0][:200]
        raise SweepError(f"{path}: damaged ({what}); remove it and run the sweep again") from None
    right = schema.equals(player_of(plan).schema(first, last), check_metadata=True)
    if not right or table.num_rows != last - first:
        what = f"its rows are not shots {first} to {last - 1} of plan {plan.id}"
        raise SweepError(f"{path}: {what}; remove it, or use another folder")
    return table


def _outcomes(rows: pyarrow.Table) -> dict[str, int]:
    return {pair["values"]: pair["counts"] for pair in rows["status"].value_counts().to_pylist()}


@checked
def run_shard(
    plan: Plan | str | os.PathLike[str], shard: int, folder: str | os.PathLike[str], *, threads: int = 1
) -> dict[str, Any]:
    """Makes one shard if it is missing. Its file appears complete or not at all, and is the same on every
    machine.

    plan: a plan, or the path of its file
    threads: 0 uses one thread per core

    Returns a report: shard, file, played (False if it existed), outcomes. Raises SweepError if this carom
    does not match the plan, or the existing file is not this shard, and OSError if it cannot be written.
    """
    if not isinstance(plan, Plan):
        plan = Plan.load(plan)
    name = os.fspath(folder)
    path = os.path.join(name, plan.file(shard))
    played = not os.path.exists(path)
    if played:
        table = _table(plan, shard, threads)
        try:
            with whole_file(path) as file:
                _write(table, file)
        except FileNotFoundError:
            # Another worker may have made the shard, and `run` removed the unfinished file of this one.
            if not os.path.exists(path):
                raise
    outcomes = _outcomes(_read(plan, shard, name, ["status"]))
    return {"shard": shard, "file": path, "played": played, "outcomes": outcomes}


def _each(
    client: Any, work: Any, shards: Iterable[int], threads: int, retries: int, progress: bool = False
) -> Iterable[Any]:
    """The results of `work` on shards, in their order."""
    if client is None:
        return map(functools.partial(work, threads=threads), shards)
    if not isinstance(client, need("distributed").Client):
        raise ValueError(f"client={client!r}: expected a distributed.Client, or None for this process")
    # Not pure: Dask would remember the results of shards that were removed since.
    futures = client.map(work, list(shards), pure=False, retries=retries)
    if progress:
        need("distributed").progress(futures, notebook=False)
    results: list[Any] = client.gather(futures)
    return results


@checked
def run(
    plan: Plan, folder: str | os.PathLike[str], client: Any = None, *,
    threads: int = 0, retries: int = 3, progress: bool = False,
) -> Run:
    """Makes the missing shards of a sweep in the folder, and the folder with its plan if there is none.

    client: a Dask client (`distributed.Client`), whose workers need access to the folder; None: this process
    threads: of this process; 0 uses one per core
    retries: how often Dask repeats a shard that ended with an error
    progress: print Dask's progress bar

    A run may be killed at any time, as may any of its workers: the files in the folder are complete, and the
    next run makes the rest. Raises SweepError if the folder has other contents or a worker has another
    carom, OSError if a file cannot be written, and Dask's own errors.
    """
    name = os.path.abspath(folder)
    path = os.path.join(name, PLAN)
    os.makedirs(name, exist_ok=True)
    plan.save(path)
    found = status(name)
    # A file that is damaged or of another sweep is refused before hours of playing.
    reports = [run_shard(plan, shard, name) for shard in found.finished]
    # Workers read the plan from the folder, so that a task is small.
    work = functools.partial(run_shard, path, folder=name)
    reports += _each(client, work, found.missing, threads, retries, progress)
    # Now every shard exists, so an unfinished file was left by a killed worker.
    for left in os.listdir(name):
        if left.startswith("shard-") and left.endswith(".tmp"):
            os.unlink(os.path.join(name, left))
    outcomes: collections.Counter[str] = collections.Counter()
    for report in reports:
        outcomes.update(report["outcomes"])
    played = sum(sum(report["outcomes"].values()) for report in reports if report["played"])
    return Run(outcomes.total(), played, dict(outcomes))


def _reduced(plan: Plan, fn: Callable[[pyarrow.Table], Any], shard: int, threads: int = 1) -> Any:
    return fn(_table(plan, shard, threads))


def _merge(a: Any, b: Any) -> Any:
    if isinstance(a, Mapping):
        return {**a, **b, **{key: _merge(a[key], b[key]) for key in a.keys() & b.keys()}}
    if isinstance(a, (tuple, list)):
        return type(a)(_merge(x, y) for x, y in zip(a, b, strict=True))
    return a + b


@checked
def reduce(
    plan: Plan, fn: Callable[[pyarrow.Table], Any], client: Any = None, *,
    merge: Callable[[Any, Any], Any] = _merge, threads: int = 0, retries: int = 3,
) -> Any:
    """Plays a sweep without keeping rows: `fn` turns the table of every shard into a result, and `merge`
    combines two results.

    merge: the default adds numbers, arrays, and the matching parts of mappings, tuples and lists

    Results are merged in the order of the shards, so that the bits do not depend on the workers.
    Everything else is as for `run`, except that a killed reduction starts again.
    """
    work = functools.partial(_reduced, plan, fn)
    return functools.reduce(merge, _each(client, work, range(plan.shards), threads, retries))


@checked
def status(folder: str | os.PathLike[str]) -> Status:
    """Which shards of a sweep exist. Raises SweepError if there is no plan.

    Only the plan is read, since a file with the name of a shard is complete.
    """
    plan = Plan.load(os.path.join(folder, PLAN))
    there = set(os.listdir(folder))
    finished = tuple(shard for shard in range(plan.shards) if plan.file(shard) in there)
    missing = tuple(shard for shard in range(plan.shards) if plan.file(shard) not in there)
    return Status(plan, finished, missing, sum(last - first for first, last in map(plan.range, finished)))


@checked
def check(folder: str | os.PathLike[str]) -> Status:
    """`status`, after reading every file: compares its pages with their checksums, and its description with
    the plan."""
    found = status(folder)
    faults: dict[str, str] = {}
    outcomes: collections.Counter[str] = collections.Counter()
    for shard in found.finished:
        try:
            outcomes.update(_outcomes(_read(found.plan, shard, os.fspath(folder))))
        except SweepError as error:
            faults[found.plan.file(shard)] = str(error)
    return found._replace(rows=outcomes.total(), outcomes=dict(outcomes), faults=faults)


@checked
def open(
    folder: str | os.PathLike[str], *, verify: bool = True, partial: bool = False
) -> pyarrow.dataset.Dataset:
    """The rows of a sweep as a pyarrow Dataset, in the order of the shots, with the columns and units of
    `carom sweep`.

    verify: first read every file as `check` does; otherwise only the descriptions are compared with the plan,
        and each page with its checksum when it is read
    partial: return the existing rows even if shards are missing

    Raises SweepError, naming the files, if anything is wrong or missing.
    """
    name = os.fspath(folder)
    found = status(name)
    plan = found.plan
    if found.missing and not (partial and found.finished):
        what = f"{len(found.missing)} of {plan.shards} shards are missing"
        raise SweepError(f"{name}: {what}; run the sweep again, or open the rest with partial=True")
    for shard in found.finished:
        _read(plan, shard, name, None if verify else [])
    dataset = need("pyarrow.dataset")
    scan = dataset.ParquetFragmentScanOptions(page_checksum_verification=True)
    return dataset.dataset(
        [os.path.join(name, plan.file(shard)) for shard in found.finished],
        schema=player_of(plan).schema(0, plan.shots),
        format=dataset.ParquetFileFormat(default_fragment_scan_options=scan))
