"""Shots of a sweep as columns: arrays, lists, tables of pyarrow."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from carom import _carom, _toml
from carom._arguments import checked
from carom._scene import Scene, SceneLike, as_scene
from carom._simulate import Shots, ShotStatus

if TYPE_CHECKING:
    import pyarrow
    from numpy.typing import NDArray

#: What a shot is called in the column "outcome".
OUTCOMES = tuple(_carom.status_names())
#: A sweep has at most so many shots: doubles count to there.
MOST_SHOTS = 2**53


class Texts(NamedTuple):
    """A column of texts: for each shot the place of its text in `names`, -1 for none."""

    names: list[str]
    codes: NDArray[np.int32]


class Counts(NamedTuple):
    """A column of integers that some shots lack."""

    values: NDArray[np.int64]
    missing: NDArray[np.bool_]


#: An array of floats has NaN where a shot has no value.
Column = np.ndarray[Any, Any] | Texts | Counts


def rules_of(vary: Mapping[str, Any] | Sequence[str]) -> list[str]:
    """Rules of `carom sweep --vary`."""
    if not isinstance(vary, Mapping):
        return list(vary)
    rules = []
    for key, values in vary.items():
        if not isinstance(values, str):
            values = f"list({','.join(_toml.value(value, key, 'vary') for value in values)})"
        rules.append(f"{key}={values}")
    return rules


class Player:
    """Plays ranges of shots of one sweep; any thread may ask.

    Raises ValueError for a rule that cannot be read or that gives no valid scene.
    """

    def __init__(self, scene: Scene, vary: Mapping[str, Any] | Sequence[str], seed: int) -> None:
        if not 0 <= seed < 2**64:
            raise ValueError(f"seed={seed}: expected 0 to 2**64 - 1")
        self.rules = rules_of(vary)
        self.balls = len(scene.ids)
        self._sweep = _carom.make_sweep(scene._native, self.rules, seed)

    def types(self) -> dict[str, tuple[str, str]]:
        """For every column "int64", "float64" or "text", and the unit, or ""."""
        return {name: (kind, unit) for name, kind, unit, _ in self._sweep.columns}

    def play(self, first: int, last: int, threads: int, *, hash_every: int = 0) -> tuple[dict[str, Column], Shots]:
        """Shots first to last - 1: the columns of `carom sweep`, and the outcomes that they come from.

        hash_every: hash the shots whose number is a multiple of it; 0: none
        """
        n = last - first
        shots = Shots.empty(n, self.balls, hashes=hash_every > 0)
        failures, values = self._sweep.play(first, n, threads, shots._native(), hash_every)
        failed = shots.status >= ShotStatus.INVALID
        columns: dict[str, Column] = {}
        for (name, kind, _, of_result), (array, texts) in zip(self._sweep.columns, values):
            columns[name] = Texts(texts, array) if kind == "text" else Counts(array, failed) if kind == "int64" and of_result else array
        return columns, shots._replace(messages=dict(failures))


@checked
def columns(
    scene: SceneLike,
    vary: Mapping[str, Any] | Sequence[str],
    shots: int,
    *,
    seed: int = 1,
    first: int = 0,
    last: int | None = None,
    threads: int = 0,
) -> dict[str, Any]:
    """Plays shots of a sweep; the columns of `carom sweep` as arrays, and as lists where they hold texts.

    vary: rules as for `carom sweep --vary`, or a mapping from keys to distributions ("normal(0.5)") or lists of values
    shots: how many the whole sweep has
    seed: of all draws
    first, last: only the shots first to last - 1
    threads: 0 takes one for each core; the rows do not depend on it

    A shot without a result has NaN, and None where there are texts or integers. Raises ValueError for a rule that cannot be read or
    that gives no valid scene, SceneError for a value that no file can hold.
    """
    return {name: _plain(column) for name, column in _played(as_scene(scene), vary, shots, seed, first, last, threads)[1].items()}


def _played(
    scene: Scene, vary: Mapping[str, Any] | Sequence[str], shots: int, seed: int, first: int, last: int | None, threads: int
) -> tuple[Player, dict[str, Column], int]:
    """Who has played, the columns, and the number behind the last shot."""
    end = shots if last is None else last
    if not 0 <= first <= end <= shots <= MOST_SHOTS:
        raise ValueError(f"first={first}, last={last}: expected 0 <= first <= last <= {shots}, and at most 2**53 shots")
    if threads < 0:
        raise ValueError(f"threads={threads}: expected at least 0")
    player = Player(scene, vary, seed)
    return player, player.play(first, end, threads)[0], end


def _plain(column: Column) -> Any:
    if isinstance(column, Texts):
        names = [*column.names, None]  # the place -1 is the last one
        return [names[code] for code in column.codes.tolist()]
    if isinstance(column, Counts):
        return [None if gone else value for value, gone in zip(column.values.tolist(), column.missing.tolist())]
    return column


def arrow(columns: Mapping[str, Column], schema: pyarrow.Schema) -> pyarrow.Table:
    """Columns as a table; what a shot lacks is null."""
    import pyarrow

    def array(column: Column) -> pyarrow.Array:
        if isinstance(column, Texts):
            return pyarrow.array(column.names, pyarrow.string()).take(pyarrow.array(column.codes, mask=column.codes < 0))
        if isinstance(column, Counts):
            return pyarrow.array(column.values, mask=column.missing)
        return pyarrow.array(column, mask=np.isnan(column) if column.dtype == np.float64 else None)

    return pyarrow.table([array(column) for column in columns.values()], schema=schema)


def arrow_schema(types: Mapping[str, tuple[str, str]], about: Mapping[str, str]) -> pyarrow.Schema:
    """Columns with their units, and what a table says about itself."""
    import pyarrow

    kinds = {"int64": pyarrow.int64(), "float64": pyarrow.float64(), "uint64": pyarrow.uint64(), "text": pyarrow.string()}
    fields = [pyarrow.field(name, kinds[kind], metadata={"unit": unit} if unit else None) for name, (kind, unit) in types.items()]
    return pyarrow.schema(fields, metadata=dict(about))


def provenance(scene: str, vary: Sequence[str], seed: int, first: int, last: int) -> dict[str, str]:
    """What a table says of where it comes from."""
    numbers = {"carom.seed": str(seed), "carom.first": str(first), "carom.last": str(last)}
    return {"carom.scene": scene, "carom.vary": "\n".join(vary)} | numbers


@checked
def table(
    scene: SceneLike,
    vary: Mapping[str, Any] | Sequence[str],
    shots: int,
    *,
    seed: int = 1,
    first: int = 0,
    last: int | None = None,
    threads: int = 0,
) -> pyarrow.Table:
    """`columns` as a pyarrow Table, whose metadata say where it comes from: scene, vary, seed, first, last, version; the metadata of a
    column have its unit. What a shot without a result lacks is null. Needs pyarrow (extra [sweep])."""
    scene = as_scene(scene)
    player, played, end = _played(scene, vary, shots, seed, first, last, threads)
    about = provenance(scene.source, player.rules, seed, first, end) | {"carom.version": _carom.VERSION}
    return arrow(played, arrow_schema(player.types(), about))
