"""The folder of a sweep: what is there, whether it is right, and how to read it."""

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
    """What is in the folder of a sweep, by the names of the files."""

    plan: Plan
    done: int  # shards that are there
    missing: tuple[int, ...]  # shards that are not
    rows: int  # of those that are there
    unfinished: tuple[str, ...]  # files that grow, or that a killed worker left
    strangers: tuple[str, ...]  # Parquet files that are none of the sweep's


class Check(NamedTuple):
    """What `check` found."""

    plan: Plan
    rows: int  # that are right
    outcomes: dict[str, int]
    faults: dict[str, str]  # name of a file: what is wrong with it
    missing: tuple[int, ...]  # shards that are not there

    @property
    def whole(self) -> bool:
        """Whether every shot is there, once, and as it was written."""
        return not self.faults and not self.missing


@checked
def status(folder: str | os.PathLike[str]) -> Status:
    """Which shards of a sweep are there. No file but the plan is read: one that has its name is whole. Raises SweepError where there is
    no plan."""
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
    return Status(plan, plan.shards - len(missing), tuple(missing), rows, tuple(unfinished), tuple(sorted(there)))


def those_there(found: Status, wanted: Iterable[int]) -> list[int]:
    """Of some shards those that are there."""
    missing = set(found.missing)
    return [shard for shard in wanted if shard not in missing]


def in_parallel(work: Callable[[int], _Result], shards: Iterable[int], threads: int = 0) -> Iterator[_Result]:
    """The results of `work` on shards, in their order, on threads; few of them at a time are in memory."""
    todo = iter(shards)
    with ThreadPoolExecutor(threads or len(os.sched_getaffinity(0))) as pool:
        while some := list(itertools.islice(todo, 256)):
            yield from pool.map(work, some)


def _described(schema: pyarrow.Schema) -> tuple[object, ...]:
    """Columns, units and provenance; not what Parquet adds to the description of a column."""
    columns = [(field.name, field.type, field.nullable, (field.metadata or {}).get(b"unit")) for field in schema]
    return columns, {key: value for key, value in (schema.metadata or {}).items() if key.startswith(b"carom.")}


def _check_shard(plan: Plan, shard: int, path: str) -> dict[str, int]:
    """Reads a whole shard; its outcomes. Raises SweepError for anything that is not as it was written."""
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
        raise SweepError(f"{path}: its rows cannot be read ({_first_line(error)}); remove it, and it is made again") from None
    if not right or not described:
        raise SweepError(f"{path}: its rows are not those that were written; remove it, and it is made again")
    outcomes: dict[str, int] = json.loads(about["carom.outcomes"])
    return outcomes


@checked
def check(folder: str | os.PathLike[str], *, threads: int = 0) -> Check:
    """Reads every file of a sweep and compares its content with its hash and its description with the plan.

    threads: 0 takes one for each core

    Raises SweepError where there is no plan; what is wrong with files is in `Check.faults`.
    """
    need("pyarrow.parquet")
    name = os.fspath(folder)
    found = status(name)
    shards = those_there(found, range(found.plan.shards))
    faults = {stranger: f"{os.path.join(name, stranger)}: a file that is none of this plan's" for stranger in found.strangers}
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
def open(folder: str | os.PathLike[str], *, verify: bool = True, partial: bool = False) -> pyarrow.dataset.Dataset:
    """The rows of a sweep as a pyarrow Dataset, in the order of the shots. Its columns are those of `carom sweep`, with their units.

    verify: read every file once before, as `check` does. Without it the descriptions are compared with the plan, and every page that is
        read later with its check sum.
    partial: give what is there, although shards are missing

    Raises SweepError, naming the files, where anything is wrong or missing.
    """
    need("pyarrow.dataset")
    import pyarrow.dataset

    name = os.fspath(folder)
    found = status(name)
    plan = found.plan
    if found.missing and not (partial and found.done):
        raise SweepError(f"{name}: {len(found.missing)} of {plan.shards} shards are missing; run the sweep again, or open with partial=True what is there")
    if found.strangers:
        raise SweepError(f"{os.path.join(name, found.strangers[0])}: a file that is none of this plan's; remove it")
    shards = those_there(found, range(plan.shards))
    paths = [os.path.join(name, plan.file(shard)) for shard in shards]
    if verify:
        for fault in check(name).faults.values():
            raise SweepError(fault)
    else:
        collections.deque(in_parallel(lambda shard: footer(plan, shard, os.path.join(name, plan.file(shard))), shards), 0)
    pages = pyarrow.dataset.ParquetFileFormat(
        default_fragment_scan_options=pyarrow.dataset.ParquetFragmentScanOptions(page_checksum_verification=True)
    )
    return pyarrow.dataset.dataset(paths, schema=schema_of(plan, 0, plan.shots), format=pages)
