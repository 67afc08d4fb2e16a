"""One shard: a Parquet file, whole or absent, that says where it comes from."""

from __future__ import annotations

import hashlib
import importlib
import json
import os
import threading
import time
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from carom import _carom
from carom._arguments import checked
from carom._files import whole_file
from carom._simulate import Shots
from carom.sweep._columns import OUTCOMES, Column, arrow, arrow_schema, provenance
from carom.sweep._plan import HASH_EVERY, Plan, SweepError, canonical, player_of, sha256, wrong_worker

if TYPE_CHECKING:
    import pyarrow

#: Where files grow, inside the folder of the sweep. Readers of a folder pass over names with a point in front.
UNFINISHED = ".unfinished"
_ROW_GROUP = 1 << 16
_MOST_AT_ONCE = 1 << 14
#: [s] Shots are played in blocks of about so long: between two of them a run can be stopped.
_BLOCK_TIME = 0.2
#: For the first array of pyarrow that becomes one of numpy: pyarrow looks for pandas then, and without the global lock two threads that do so at
#: once wait for each other forever (pyarrow 26).
_FIRST_ARRAY = threading.Lock()


class Stopped(Exception):
    """The run that wanted this shard has ended."""


def need(name: str) -> None:
    """Raises ImportError that says where the package comes from."""
    try:
        importlib.import_module(name)
    except ImportError as error:
        raise ImportError(f"{name} is missing ({error}): pip install 'carom-billiards[sweep]'", name=name) from None


class ContentHash:
    """SHA-256 of a table's content: names, types, values. It does not depend on how the table is cut, nor on what wrote a file."""

    def __init__(self, schema: pyarrow.Schema) -> None:
        import pyarrow

        with _FIRST_ARRAY:
            pyarrow.array([0]).to_numpy()
        self._names = [[field.name, str(field.type)] for field in schema]
        # Of each column the rows without a value; the lengths of texts; the values.
        self._streams = [[hashlib.sha256() for _ in range(3)] for _ in schema]
        self.rows = 0

    def add(self, table: pyarrow.Table) -> None:
        for column, streams in zip(table.columns, self._streams):
            row = self.rows
            for chunk in column.chunks:
                self._add(chunk, row, *streams)
                row += len(chunk)
        self.rows += len(table)

    @staticmethod
    def _add(chunk: pyarrow.Array, row: int, nulls: Any, lengths: Any, values: Any) -> None:
        import pyarrow
        import pyarrow.compute

        if chunk.null_count > 0:
            nulls.update((np.flatnonzero(chunk.is_null().to_numpy(zero_copy_only=False)) + row).astype("<i8").tobytes())
            chunk = pyarrow.compute.fill_null(chunk, "" if pyarrow.types.is_string(chunk.type) else 0)
        if not pyarrow.types.is_string(chunk.type):
            values.update(np.ascontiguousarray(chunk.to_numpy(), chunk.type.to_pandas_dtype()).data)
        elif len(chunk) > 0:
            _, offsets, data = chunk.buffers()
            ends = np.frombuffer(offsets, np.int32)[chunk.offset : chunk.offset + len(chunk) + 1]
            lengths.update(np.diff(ends).astype("<i4").data)
            if data is not None:
                values.update(memoryview(data)[ends[0] : ends[-1]])

    def hexdigest(self) -> str:
        streams = [[name, *(stream.hexdigest() for stream in streams)] for name, streams in zip(self._names, self._streams)]
        return sha256(canonical([self.rows, streams]))


def about_rows(plan: Plan, first: int, last: int) -> dict[str, str]:
    """What every file and dataset of a plan says about itself."""
    own = {"carom.plan": plan.id, "carom.version": plan.version, "carom.scene": plan.scene, "carom.scene_sha256": sha256(plan.scene.encode())}
    return own | provenance(plan.scene, plan.vary, plan.seed, first, last)


def schema_of(plan: Plan, first: int, last: int) -> pyarrow.Schema:
    return arrow_schema(plan.types(), about_rows(plan, first, last))


def footer(plan: Plan, shard: int, path: str) -> dict[str, str]:
    """What the file of a shard says about itself. Raises SweepError where it is none of this plan, or damaged; the rows are not read."""
    import pyarrow.parquet

    try:
        metadata = pyarrow.parquet.read_metadata(path)
        said = {key.decode(): value.decode() for key, value in (metadata.metadata or {}).items() if key.startswith(b"carom.")}
        rows = metadata.num_rows
    except Exception as error:  # what a damaged file makes of pyarrow has no type of its own
        raise SweepError(f"{path}: no whole Parquet file ({_first_line(error)}); remove it, and it is made again") from None
    digest = said.pop("carom.sha256", None)
    if "carom.plan" in said and digest == sha256(canonical(said)):
        for name, wanted in about_rows(plan, *plan.range(shard)).items():
            if said.get(name) != wanted:
                words = f"shots {said.get('carom.first')} to {said.get('carom.last')}" if said["carom.plan"] == plan.id else f"plan {said['carom.plan']}"
                raise SweepError(f"{path}: a file of {words}, not of shard {shard} of plan {plan.id}; take another folder, or remove the file")
        if rows == int(said["carom.last"]) - int(said["carom.first"]):
            return said
    raise SweepError(f"{path}: its description is damaged, or carom did not write it; remove it, and it is made again")


def _first_line(error: BaseException) -> str:
    return (str(error).strip() or type(error).__name__).splitlines()[0][:200]


def _hash_every(plan: Plan) -> int:
    return {"none": 0, "digest": HASH_EVERY, "column": 1}[plan.hashes]


def _blocks(plan: Plan, shard: int, threads: int, stop: Callable[[], bool]) -> Iterator[tuple[int, dict[str, Column], Shots]]:
    player = player_of(plan)
    at, last = plan.range(shard)
    most = 256
    while at < last:
        if stop():
            raise Stopped
        end, start = min(at + most, last), time.perf_counter()
        columns, shots = player.play(at, end, threads, hash_every=_hash_every(plan))
        if plan.hashes == "column":
            assert shots.hash is not None
            columns["record_hash"] = shots.hash
        yield at, columns, shots
        if time.perf_counter() - start < _BLOCK_TIME and most < _MOST_AT_ONCE:
            most *= 2
        at = end


class Tally:
    """Of the shots of a shard: how they ended, and the digest of their records."""

    def __init__(self) -> None:
        self.counts = np.zeros(len(OUTCOMES), np.int64)
        self.records: Any = hashlib.sha256()

    def add(self, first: int, shots: Shots) -> None:
        self.counts += np.bincount(shots.status, minlength=len(OUTCOMES))
        if shots.hash is not None:
            self.records.update(np.ascontiguousarray(shots.hash[-first % HASH_EVERY :: HASH_EVERY], "<u8").data)

    def outcomes(self) -> dict[str, int]:
        return {name: count for name, count in zip(OUTCOMES, self.counts.tolist()) if count > 0}


def tables(plan: Plan, shard: int, threads: int, stop: Callable[[], bool], tally: Tally) -> Iterator[pyarrow.Table]:
    """Plays a shard: tables of as many rows as a row group has, whatever the blocks were."""
    import pyarrow

    schema = schema_of(plan, *plan.range(shard))
    waiting: list[pyarrow.Table] = []
    rows = 0
    for first, columns, shots in _blocks(plan, shard, threads, stop):
        tally.add(first, shots)
        waiting.append(arrow(columns, schema))
        rows += len(shots.status)
        while rows >= _ROW_GROUP:
            whole = pyarrow.concat_tables(waiting)
            yield whole.slice(0, _ROW_GROUP).combine_chunks()
            waiting, rows = [whole.slice(_ROW_GROUP)], rows - _ROW_GROUP
    if rows > 0:
        yield pyarrow.concat_tables(waiting).combine_chunks()


def _write(plan: Plan, shard: int, file: Any, threads: int, stop: Callable[[], bool]) -> dict[str, str]:
    """Writes a Parquet file; what its metadata say."""
    import inspect

    import pyarrow
    import pyarrow.parquet

    first, last = plan.range(shard)
    types = plan.types()
    schema = schema_of(plan, first, last)
    kinds = {name: kind for name, (kind, _) in types.items()}
    encoding = {"float64": "BYTE_STREAM_SPLIT", "int64": "DELTA_BINARY_PACKED", "uint64": "PLAIN"}
    content, tally = ContentHash(schema), Tally()
    # One page for the column of a row group: zstd packs the bytes of numbers by their place the better, the longer the runs of one place are.
    # What has no such option has no such limit.
    pages = {"max_rows_per_page": _ROW_GROUP} if "max_rows_per_page" in inspect.signature(pyarrow.parquet.ParquetWriter).parameters else {}
    writer = pyarrow.parquet.ParquetWriter(
        file,
        schema,
        compression="zstd",
        use_dictionary=[name for name, kind in kinds.items() if kind == "text"],
        column_encoding={name: encoding[kind] for name, kind in kinds.items() if kind != "text"},
        # Pages have a check sum; least and greatest values would tell a reader what to skip without one.
        write_page_checksum=True,
        write_statistics=False,
        **pages,
    )
    try:
        for table in tables(plan, shard, threads, stop, tally):
            content.add(table)
            writer.write_table(table, row_group_size=_ROW_GROUP)
        about = about_rows(plan, first, last) | {
            "carom.writer": f"pyarrow {pyarrow.__version__}",
            "carom.content": content.hexdigest(),
            "carom.records": "" if plan.hashes == "none" else tally.records.hexdigest(),
            "carom.records_every": str(HASH_EVERY),
            "carom.outcomes": canonical(tally.outcomes()).decode(),
        }
        writer.add_key_value_metadata(about | {"carom.sha256": sha256(canonical(about))})
        writer.close()
    except BaseException:
        writer.is_open = False  # or it would write on into the file that is given up
        raise
    return about


def _forget_the_dead(folder: str, name: str) -> None:
    """Removes what processes of this machine left unfinished when they were killed."""
    for left in os.listdir(folder):
        if not left.startswith(f"{name}.{_host()}.") or not left.endswith(".tmp"):
            continue
        pid = left[len(f"{name}.{_host()}.") :].partition(".")[0]
        if not os.path.exists(f"/proc/{pid}"):
            try:
                os.unlink(os.path.join(folder, left))
            except FileNotFoundError:
                pass


def _host() -> str:
    return os.uname().nodename


def make_shard(plan: Plan, shard: int, folder: str, threads: int, stop: Callable[[], bool]) -> dict[str, Any]:
    """`run_shard`, which raises Stopped between two blocks of shots once `stop` says so."""
    need("pyarrow")
    start = time.perf_counter()
    name = plan.file(shard)
    path = os.path.join(folder, name)
    if os.path.exists(path):
        return _result(plan, shard, path, footer(plan, shard, path), played=False, start=start)
    wrong = wrong_worker(plan)
    if wrong:
        raise SweepError(f"{path}: {_host()}, process {os.getpid()}: {wrong}")
    if not os.path.isdir(folder):
        raise SweepError(f"{folder}: there is no such folder on {_host()}; all workers have to see the folder of the sweep")
    growing = os.path.join(folder, UNFINISHED)
    temporary = os.path.join(growing, f"{name}.{_host()}.{os.getpid()}.{os.urandom(4).hex()}.tmp")
    about: dict[str, str] = {}
    try:
        os.makedirs(growing, exist_ok=True)
        _forget_the_dead(growing, name)
        with whole_file(path, temporary, lambda *_: _publish(plan, shard, temporary, path, about)) as file:
            about |= _write(plan, shard, file, threads, stop)
    except OSError as error:
        raise OSError(error.errno, f"cannot write: {error.strerror or error}", path) from None
    return _result(plan, shard, path, about, played=True, start=start)


def _publish(plan: Plan, shard: int, temporary: str, path: str, about: dict[str, str]) -> None:
    if not os.path.exists(path):
        os.replace(temporary, path)
        return
    # A twin of this worker was faster. It has the same rows, or one of the two machines is broken.
    if footer(plan, shard, path)["carom.content"] != about["carom.content"]:
        raise SweepError(f"{path}: two workers played the same shots with different results, one of them on {_host()}; check both machines")


def _result(plan: Plan, shard: int, path: str, about: dict[str, str], *, played: bool, start: float) -> dict[str, Any]:
    first, last = plan.range(shard)
    return {
        "shard": shard,
        "first": first,
        "last": last,
        "played": played,
        "file": path,
        "bytes": os.path.getsize(path),
        "content": about["carom.content"],
        "records": about["carom.records"],
        "outcomes": json.loads(about["carom.outcomes"]),
        "host": _host(),
        "process": os.getpid(),
        "seconds": time.perf_counter() - start,
    }


@checked
def run_shard(plan: Plan | str | os.PathLike[str], shard: int, folder: str | os.PathLike[str], *, threads: int = 1) -> dict[str, Any]:
    """Makes one shard, unless it is there. The file appears whole or not at all, and is the same whoever makes it, and how often.

    plan: or the path of its file
    threads: 0 takes one for each core

    Returns what was made: shard, first, last, played (False if it was there), file, bytes, content and records (hashes), outcomes, host,
    process, seconds. Raises SweepError where carom is not the plan's, or the file in its place is not this shard; OSError where the file cannot be
    written.
    """
    if not isinstance(plan, Plan):
        plan = Plan.load(plan)
    return make_shard(plan, shard, os.fspath(folder), threads, lambda: False)
