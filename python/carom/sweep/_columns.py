"""Shots of a sweep as columns: arrays, lists, pyarrow tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from carom import _carom, _toml
from carom._arguments import checked
from carom._names import GameName
from carom._scene import Scene, SceneLike, as_scene

if TYPE_CHECKING:
    import pyarrow
    from numpy.typing import NDArray

#: The names of a shot's status in the column "outcome".
OUTCOMES = tuple(_carom.status_names())
#: The largest number of shots in a sweep, up to which doubles count exactly.
MOST_SHOTS = 2**53


#: For `Player.play(stop=)`: never.
NEVER = np.zeros(1, np.uint8)


class Column(NamedTuple):
    """The values of a column. If it has texts, the values are indices of these, and -1 stands for none."""

    values: NDArray[Any]
    texts: list[str] | None = None
    missing: NDArray[np.uint8] | None = None  # for each shot 1 or 0; None for a column without gaps


class Played(NamedTuple):
    """Shots that were played."""

    columns: dict[str, Column]  # those of `carom sweep`
    status: NDArray[np.uint8]  # ShotStatus
    hash: NDArray[np.uint64]  # of each record, if requested


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
        self._sweep = _carom.make_sweep(scene._native, self.rules, seed, list(measures), game)

    def types(self) -> dict[str, tuple[str, str]]:
        """For every column its type, "int64", "float64" or "text", and its unit or ""."""
        return {name: (kind, unit) for name, kind, unit in self._sweep.columns}

    def play(
        self, first: int, last: int, threads: int, *, hash_every: int = 0, stop: NDArray[np.uint8] = NEVER
    ) -> Played:
        """Plays shots first to last - 1.

        hash_every: hash the shots whose number is a multiple of this; 0 for none
        stop: a flag that ends the batch with RuntimeError once it is not 0
        """
        columns, *rest = self._sweep.play(first, last - first, threads, hash_every, stop)
        return Played({name: Column(*column) for name, column in zip(self.types(), columns)}, *rest)


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
    express.
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
    return player, player.play(first, end, threads).columns, end


def _plain(column: Column) -> Any:
    if column.texts is not None:
        names = [*column.texts, None]  # the index -1 is the last one
        return [names[code] for code in column.values.tolist()]
    if column.missing is not None and column.values.dtype == np.int64:
        values = zip(column.values.tolist(), column.missing.tolist())
        return [None if gone else value for value, gone in values]
    return column.values


def arrow(columns: Mapping[str, Column], schema: pyarrow.Schema) -> pyarrow.Table:
    """The columns as a table; missing values are null."""
    import pyarrow

    def array(column: Column) -> pyarrow.Array:
        mask = None if column.missing is None else column.missing.astype(bool)
        values = pyarrow.array(column.values, mask=mask)
        return values if column.texts is None else pyarrow.array(column.texts, pyarrow.string()).take(values)

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
