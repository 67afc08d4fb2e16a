"""One shard: a Parquet file, complete or absent, that states its origin."""

from __future__ import annotations

import hashlib
import importlib
import json
import os
import threading
import time
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from carom._arguments import checked
from carom._files import whole_file
from carom.sweep._columns import NEVER, OUTCOMES, Column, Played, arrow, arrow_schema, provenance
from carom.sweep._plan import HASH_EVERY, Plan, SweepError, canonical, player_of, sha256, wrong_worker

if TYPE_CHECKING:
    import pyarrow
    from numpy.typing import NDArray

#: The subfolder for unfinished files. Readers of a folder ignore names that begin with a dot.
UNFINISHED = ".unfinished"
_ROW_GROUP = 1 << 16
#: Held for the first conversion from pyarrow to numpy: pyarrow then looks for pandas, and without the GIL two
#: threads that do so at once wait for each other forever (pyarrow 26).
_FIRST_ARRAY = threading.Lock()


def need(name: str) -> None:
    """Raises ImportError, with the way to install the package, if it is missing."""
    try:
        importlib.import_module(name)
    except ImportError as error:
        what = f"{name} is missing ({error}): pip install {name}"
        raise ImportError(what, name=name) from None


class ContentHash:
    """SHA-256 of a table's names, types and values, independent of how the table is divided and who wrote
    the file."""

    def __init__(self, schema: pyarrow.Schema) -> None:
        import pyarrow

        with _FIRST_ARRAY:
            pyarrow.array([0]).to_numpy()
        self._names = [[field.name, str(field.type)] for field in schema]
        # Three hashes per column: the rows without a value, the lengths of strings, and the values.
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
            rows = np.flatnonzero(chunk.is_null().to_numpy(zero_copy_only=False)) + row
            nulls.update(rows.astype("<i8").tobytes())
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
        named = zip(self._names, self._streams)
        streams = [[name, *(stream.hexdigest() for stream in streams)] for name, streams in named]
        return sha256(canonical([self.rows, streams]))


def about_rows(plan: Plan, first: int, last: int) -> dict[str, str]:
    """The metadata of every file and dataset of a plan."""
    own = {"carom.plan": plan.id, "carom.version": plan.version, "carom.scene": plan.scene,
           "carom.scene_sha256": sha256(plan.scene.encode())}
    return own | provenance(plan.scene, plan.vary, plan.seed, first, last)


def schema_of(plan: Plan, first: int, last: int) -> pyarrow.Schema:
    return arrow_schema(plan.types(), about_rows(plan, first, last))


def footer(plan: Plan, shard: int, path: str) -> dict[str, str]:
    """A file's metadata, without reading its rows. Raises SweepError if it is not this shard's or is
    damaged."""
    import pyarrow.parquet

    try:
        metadata = pyarrow.parquet.read_metadata(path)
        pairs = (metadata.metadata or {}).items()
        said = {key.decode(): value.decode() for key, value in pairs if key.startswith(b"carom.")}
        rows = metadata.num_rows
    except Exception as error:  # pyarrow raises errors of any type for a damaged file
        what = f"not a complete Parquet file ({_first_line(error)})"
        raise SweepError(f"{path}: {what}; remove it and run the sweep again") from None
    digest = said.pop("carom.sha256", None)
    if "carom.plan" in said and digest == sha256(canonical(said)):
        for name, wanted in about_rows(plan, *plan.range(shard)).items():
            if said.get(name) != wanted:
                words = f"plan {said['carom.plan']}"
                if said["carom.plan"] == plan.id:
                    words = f"shots {said.get('carom.first')} to {said.get('carom.last')}"
                what = f"the file contains {words}, not shard {shard} of plan {plan.id}"
                raise SweepError(f"{path}: {what}; use another folder, or remove the file")
        if rows == int(said["carom.last"]) - int(said["carom.first"]):
            return said
    what = "its description is damaged, or carom did not write it"
    raise SweepError(f"{path}: {what}; remove it and run the sweep again")


def _first_line(error: BaseException) -> str:
    return (str(error).strip() or type(error).__name__).splitlines()[0][:200]


class Tally:
    """How the shots of a shard ended, and the digest of their records."""

    def __init__(self) -> None:
        self.counts = np.zeros(len(OUTCOMES), np.int64)
        self.records: Any = hashlib.sha256()

    def add(self, first: int, played: Played) -> None:
        self.counts += np.bincount(played.status, minlength=len(OUTCOMES))
        hashed = played.hash[-first % HASH_EVERY :: HASH_EVERY]
        self.records.update(np.ascontiguousarray(hashed, "<u8").data)

    def outcomes(self) -> dict[str, int]:
        return {name: count for name, count in zip(OUTCOMES, self.counts.tolist()) if count > 0}


def tables(
    plan: Plan, shard: int, threads: int, stop: NDArray[np.uint8], tally: Tally
) -> Iterator[pyarrow.Table]:
    """Plays a shard and yields tables with the rows of one row group each."""
    first, last = plan.range(shard)
    schema = schema_of(plan, first, last)
    hash_every = {"none": 0, "digest": HASH_EVERY, "column": 1}[plan.hashes]
    for at in range(first, last, _ROW_GROUP):
        end = min(at + _ROW_GROUP, last)
        played = player_of(plan).play(at, end, threads, hash_every=hash_every, stop=stop)
        if plan.hashes == "column":
            played.columns["record_hash"] = Column(played.hash)
        tally.add(at, played)
        yield arrow(played.columns, schema)


def _write(plan: Plan, shard: int, file: Any, threads: int, stop: NDArray[np.uint8]) -> dict[str, str]:
    """Writes a Parquet file and returns its metadata."""
    import inspect

    import pyarrow
    import pyarrow.parquet

    first, last = plan.range(shard)
    types = plan.types()
    schema = schema_of(plan, first, last)
    kinds = {name: kind for name, (kind, _) in types.items()}
    encoding = {"float64": "BYTE_STREAM_SPLIT", "int64": "DELTA_BINARY_PACKED", "uint64": "PLAIN"}
    content, tally = ContentHash(schema), Tally()
    # One page per column of a row group: zstd packs bytes sorted by their place in the number, the better the
    # longer the page. A pyarrow without this option has no limit on the rows of a page.
    options = inspect.signature(pyarrow.parquet.ParquetWriter).parameters
    pages = {"max_rows_per_page": _ROW_GROUP} if "max_rows_per_page" in options else {}
    writer = pyarrow.parquet.ParquetWriter(
        file,
        schema,
        compression="zstd",
        use_dictionary=[name for name, kind in kinds.items() if kind == "text"],
        column_encoding={name: encoding[kind] for name, kind in kinds.items() if kind != "text"},
        # Pages have a checksum. Without statistics, because readers would use them to skip pages unchecked.
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
        writer.is_open = False  # otherwise it would continue writing to the abandoned file
        raise
    return about


def _forget_the_dead(folder: str, name: str) -> None:
    """Removes the unfinished files of killed processes of this machine."""
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


def make_shard(plan: Plan, shard: int, folder: str, threads: int, stop: NDArray[np.uint8]) -> dict[str, Any]:
    """`run_shard`, except that it raises RuntimeError once the flag `stop` is not 0."""
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
        where = f"there is no such folder on {_host()}"
        raise SweepError(f"{folder}: {where}; every worker needs access to the folder of the sweep")
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
    # Another worker made this shard first. It has the same rows, unless one of the two machines is broken.
    if footer(plan, shard, path)["carom.content"] != about["carom.content"]:
        what = f"two workers played the same shots with different results, one of them on {_host()}"
        raise SweepError(f"{path}: {what}; check both machines")


def _result(
    plan: Plan, shard: int, path: str, about: dict[str, str], *, played: bool, start: float
) -> dict[str, Any]:
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
def run_shard(
    plan: Plan | str | os.PathLike[str], shard: int, folder: str | os.PathLike[str], *, threads: int = 1
) -> dict[str, Any]:
    """Makes one shard if it is missing. Its file appears complete or not at all, and is the same on every
    machine.

    plan: a plan, or the path of its file
    threads: 0 uses one thread per core

    Returns a report: shard, first, last, played (False if it existed), file, bytes, content and records
    (hashes), outcomes, host, process, seconds. Raises SweepError if this carom does not match the plan, or
    the existing file is not this shard, and OSError if the file cannot be written.
    """
    if not isinstance(plan, Plan):
        plan = Plan.load(plan)
    return make_shard(plan, shard, os.fspath(folder), threads, NEVER)
