"""Shots of a sweep as columns: arrays, lists, pyarrow tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from carom import _carom, _toml
from carom._arguments import checked
from carom._names import GameName
from carom._scene import Scene, SceneLike, as_scene
from carom._simulate import Shots, ShotStatus

if TYPE_CHECKING:
    import pyarrow
    from numpy.typing import NDArray

#: The names of a shot's status in the column "outcome".
OUTCOMES = tuple(_carom.status_names())
#: The largest number of shots in a sweep, up to which doubles count exactly.
MOST_SHOTS = 2**53


class Texts(NamedTuple):
    """A column of strings: for each shot the index of its string in `names`, -1 for none."""

    names: list[str]
    codes: NDArray[np.int32]


class Counts(NamedTuple):
    """A column of integers, missing for some shots."""

    values: NDArray[np.int64]
    missing: NDArray[np.bool_]


#: In an array of floats, NaN stands for a missing value.
Column = np.ndarray[Any, Any] | Texts | Counts


def rules_of(vary: Mapping[str, Any] | Sequence[str]) -> list[str]:
    """The rules as for `carom sweep --vary`."""
    if not isinstance(vary, Mapping):
        return list(vary)
    rules = []
    for key, values in vary.items():
        if not isinstance(values, str):
            values = f"list({','.join(_toml.value(value, key, 'vary') for value in values)})"
        rules.append(f"{key}={values}")
    return rules


class Player:
    """Plays ranges of shots of one sweep, from any thread.

    Raises ValueError for a rule that cannot be read or that makes no valid scene.
    """

    def __init__(
        self, scene: Scene, vary: Mapping[str, Any] | Sequence[str], seed: int,
        measures: Sequence[str] = (), game: str | None = None,
    ) -> None:
        if not 0 <= seed < 2**64:
            raise ValueError(f"seed={seed}: expected 0 to 2**64 - 1")
        self.rules = rules_of(vary)
        self.balls = len(scene.ids)
        self._sweep = _carom.make_sweep(scene._native, self.rules, seed, list(measures), game)

    def types(self) -> dict[str, tuple[str, str]]:
        """For every column its type, "int64", "float64" or "text", and its unit or ""."""
        return {name: (kind, unit) for name, kind, unit, _ in self._sweep.columns}

    def play(
        self, first: int, last: int, threads: int, *, hash_every: int = 0
    ) -> tuple[dict[str, Column], Shots]:
        """Plays shots first to last - 1. Returns the columns of `carom sweep` and the outcomes behind them.

        hash_every: hash the shots whose number is a multiple of this; 0 for none
        """
        n = last - first
        shots = Shots.empty(n, self.balls, hashes=hash_every > 0)
        failures, values = self._sweep.play(first, n, threads, shots._native(), hash_every)
        failed = shots.status >= ShotStatus.INVALID
        columns: dict[str, Column] = {}
        for (name, kind, _, of_result), (array, texts) in zip(self._sweep.columns, values):
            if kind == "text":
                columns[name] = Texts(texts, array)
            else:
                columns[name] = Counts(array, failed) if kind == "int64" and of_result else array
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
    measures: Sequence[str] = (),
    game: GameName | None = None,
) -> dict[str, Any]:
    """Plays shots of a sweep. Returns the columns of `carom sweep` as arrays, or as lists if they hold
    strings.

    vary: rules as for `carom sweep --vary`, or a mapping from keys to distributions ("normal(0.5)") or lists
        of values
    shots: the number of shots in the whole sweep
    seed: of all draws
    first, last: play only the shots first to last - 1
    threads: 0 uses one thread per core; the rows do not depend on it
    measures: expressions over `carom.measures()`, a column each: "travel(cue)", '"9" in pocketed'. Numbers
        are floats, 1 and 0 for a truth; lists are texts with ";" between their items
    game: the rules for measures such as "foul"

    Missing values of a shot without a result are NaN, or None for strings and integers. Raises ValueError for
    a rule that cannot be read or that makes no valid scene, and SceneError for a value that no scene file can
    hold.
    """
    played = _played(as_scene(scene), vary, shots, seed, first, last, threads,
                     measures, game)[1]
    return {name: _plain(column) for name, column in played.items()}


def _played(
    scene: Scene, vary: Mapping[str, Any] | Sequence[str], shots: int, seed: int,
    first: int, last: int | None, threads: int, measures: Sequence[str], game: str | None,
) -> tuple[Player, dict[str, Column], int]:
    """The player, the columns, and the number after the last shot."""
    end = shots if last is None else last
    if not 0 <= first <= end <= shots <= MOST_SHOTS:
        wanted = f"0 <= first <= last <= {shots}, and at most 2**53 shots"
        raise ValueError(f"first={first}, last={last}: expected {wanted}")
    if threads < 0:
        raise ValueError(f"threads={threads}: expected at least 0")
    player = Player(scene, vary, seed, measures, game)
    return player, player.play(first, end, threads)[0], end


def _plain(column: Column) -> Any:
    if isinstance(column, Texts):
        names = [*column.names, None]  # the index -1 is the last one
        return [names[code] for code in column.codes.tolist()]
    if isinstance(column, Counts):
        values = zip(column.values.tolist(), column.missing.tolist())
        return [None if gone else value for value, gone in values]
    return column


def arrow(columns: Mapping[str, Column], schema: pyarrow.Schema) -> pyarrow.Table:
    """The columns as a table; missing values are null."""
    import pyarrow

    def array(column: Column) -> pyarrow.Array:
        if isinstance(column, Texts):
            codes = pyarrow.array(column.codes, mask=column.codes < 0)
            return pyarrow.array(column.names, pyarrow.string()).take(codes)
        if isinstance(column, Counts):
            return pyarrow.array(column.values, mask=column.missing)
        return pyarrow.array(column, mask=np.isnan(column) if column.dtype == np.float64 else None)

    return pyarrow.table([array(column) for column in columns.values()], schema=schema)


def arrow_schema(types: Mapping[str, tuple[str, str]], about: Mapping[str, str]) -> pyarrow.Schema:
    """The columns with their units, and the table's metadata."""
    import pyarrow

    kinds = {"int64": pyarrow.int64(), "float64": pyarrow.float64(), "uint64": pyarrow.uint64(),
             "text": pyarrow.string()}
    fields = [pyarrow.field(name, kinds[kind], metadata={"unit": unit} if unit else None) for name,
              (kind, unit) in types.items()]
    return pyarrow.schema(fields, metadata=dict(about))


def provenance(scene: str, vary: Sequence[str], seed: int, first: int, last: int) -> dict[str, str]:
    """A table's metadata about its origin."""
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
    measures: Sequence[str] = (),
    game: GameName | None = None,
) -> pyarrow.Table:
    """`columns` as a pyarrow Table. Needs pyarrow (extra [sweep]).

    The table's metadata give its origin: scene, vary, seed, first, last, version; a column's metadata give
    its unit. Missing values of a shot without a result are null.
    """
    scene = as_scene(scene)
    player, played, end = _played(scene, vary, shots, seed, first, last, threads, measures, game)
    about = provenance(scene.source, player.rules, seed, first, end) | {"carom.version": _carom.VERSION}
    return arrow(played, arrow_schema(player.types(), about))
