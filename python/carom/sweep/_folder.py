"""The folder of a sweep: its contents, their check, and reading them."""

from __future__ import annotations

import collections
import itertools
import json
import os
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, NamedTuple, TypeVar

from carom._arguments import checked
from carom.sweep._plan import Plan, SweepError
from carom.sweep._shard import UNFINISHED, ContentHash, _first_line, footer, need, schema_of

if TYPE_CHECKING:
    import pyarrow
    import pyarrow.dataset

PLAN = "plan.json"
_Result = TypeVar("_Result")


class Status(NamedTuple):
    """The contents of a sweep's folder, by file names."""

    plan: Plan
    done: int  # shards that exist
    missing: tuple[int, ...]  # shards that do not
    rows: int  # in the existing shards
    unfinished: tuple[str, ...]  # files in progress, or left by a killed worker
    strangers: tuple[str, ...]  # Parquet files that do not belong to the sweep


class Check(NamedTuple):
    """The result of `check`."""

    plan: Plan
    rows: int  # that are correct
    outcomes: dict[str, int]
    faults: dict[str, str]  # file name: its fault
    missing: tuple[int, ...]  # shards that do not exist

    @property
    def whole(self) -> bool:
        """Whether every shot exists once, unchanged."""
        return not self.faults and not self.missing


@checked
def status(folder: str | os.PathLike[str]) -> Status:
    """Which shards of a sweep exist. Raises SweepError if there is no plan.

    Only the plan is read, since a file with the name of a shard is complete.
    """
    name = os.fspath(folder)
    plan = Plan.load(os.path.join(name, PLAN))
    there = {entry for entry in os.listdir(name) if entry.endswith(".parquet")}
    missing, rows = [], 0
    for shard, file in enumerate(plan.files()):
        if file in there:
            there.remove(file)
            first, last = plan.range(shard)
            rows += last - first
        else:
            missing.append(shard)
    growing = os.path.join(name, UNFINISHED)
    unfinished = sorted(os.listdir(growing)) if os.path.isdir(growing) else []
    done, strangers = plan.shards - len(missing), tuple(sorted(there))
    return Status(plan, done, tuple(missing), rows, tuple(unfinished), strangers)


def those_there(found: Status, wanted: Iterable[int]) -> list[int]:
    """Selects the shards that exist."""
    missing = set(found.missing)
    return [shard for shard in wanted if shard not in missing]


def in_parallel(work: Callable[[int], _Result], shards: Iterable[int], threads: int = 0) -> Iterator[_Result]:
    """The results of `work` on shards, in order, computed on threads; only a few are in memory at a time."""
    todo = iter(shards)
    with ThreadPoolExecutor(threads or len(os.sched_getaffinity(0))) as pool:
        while some := list(itertools.islice(todo, 256)):
            yield from pool.map(work, some)


def _described(schema: pyarrow.Schema) -> tuple[object, ...]:
    """Columns, units and provenance, without what Parquet adds to the description of a column."""
    columns = [
        (field.name, field.type, field.nullable, (field.metadata or {}).get(b"unit")) for field in schema]
    about = (schema.metadata or {}).items()
    return columns, {key: value for key, value in about if key.startswith(b"carom.")}


def _check_shard(plan: Plan, shard: int, path: str) -> dict[str, int]:
    """Reads a whole shard and returns its outcomes. Raises SweepError if anything differs from what was
    written."""
    import pyarrow.parquet

    about = footer(plan, shard, path)
    wanted = schema_of(plan, *plan.range(shard))
    try:
        with pyarrow.parquet.ParquetFile(path, page_checksum_verification=True) as file:
            content = ContentHash(file.schema_arrow)
            described = _described(file.schema_arrow) == _described(wanted)
            for batch in file.iter_batches():
                content.add(pyarrow.Table.from_batches([batch]))
            right = content.hexdigest() == about["carom.content"]
    except Exception as error:  # as in footer()
        what = f"its rows cannot be read ({_first_line(error)})"
        raise SweepError(f"{path}: {what}; remove it and run the sweep again") from None
    if not right or not described:
        what = "its rows were changed after they were written"
        raise SweepError(f"{path}: {what}; remove it and run the sweep again")
    outcomes: dict[str, int] = json.loads(about["carom.outcomes"])
    return outcomes


@checked
def check(folder: str | os.PathLike[str], *, threads: int = 0) -> Check:
    """Reads every file of a sweep, and compares its content with its hash and its description with the plan.

    threads: 0 uses one thread per core

    Raises SweepError if there is no plan; faults in files are in `Check.faults`.
    """
    need("pyarrow.parquet")
    name = os.fspath(folder)
    found = status(name)
    shards = those_there(found, range(found.plan.shards))
    foreign = "this file does not belong to the plan"
    faults = {stranger: f"{os.path.join(name, stranger)}: {foreign}" for stranger in found.strangers}
    outcomes: collections.Counter[str] = collections.Counter()

    def look(shard: int) -> dict[str, int] | SweepError:
        try:
            return _check_shard(found.plan, shard, os.path.join(name, found.plan.file(shard)))
        except SweepError as error:
            return error

    for shard, result in zip(shards, in_parallel(look, shards, threads)):
        if isinstance(result, SweepError):
            faults[found.plan.file(shard)] = str(result)
        else:
            outcomes.update(result)
    return Check(found.plan, outcomes.total(), dict(outcomes), faults, found.missing)


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
    need("pyarrow.dataset")
    import pyarrow.dataset

    name = os.fspath(folder)
    found = status(name)
    plan = found.plan
    if found.missing and not (partial and found.done):
        what = f"{len(found.missing)} of {plan.shards} shards are missing"
        raise SweepError(f"{name}: {what}; run the sweep again, or open the rest with partial=True")
    if found.strangers:
        stranger = os.path.join(name, found.strangers[0])
        raise SweepError(f"{stranger}: this file does not belong to the plan; remove it")
    shards = those_there(found, range(plan.shards))
    paths = [os.path.join(name, plan.file(shard)) for shard in shards]
    if verify:
        for fault in check(name).faults.values():
            raise SweepError(fault)
    else:
        footers = in_parallel(lambda shard: footer(plan, shard, os.path.join(name, plan.file(shard))), shards)
        collections.deque(footers, 0)
    scan = pyarrow.dataset.ParquetFragmentScanOptions(page_checksum_verification=True)
    pages = pyarrow.dataset.ParquetFileFormat(default_fragment_scan_options=scan)
    return pyarrow.dataset.dataset(paths, schema=schema_of(plan, 0, plan.shots), format=pages)
