"""Shots of a sweep as columns: arrays, lists, tables of pyarrow."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from carom import _carom, _toml
from carom._arguments import checked
from carom._scene import SceneLike, as_scene
from carom._simulate import Shots, ShotStatus

if TYPE_CHECKING:
    import pyarrow
    from numpy.typing import NDArray

#: What a shot is called in the column "outcome".
OUTCOMES = tuple(status.name.lower() for status in ShotStatus)
#: A sweep has at most so many shots: doubles count to there.
MOST_SHOTS = 2**53


class Texts(NamedTuple):
    """A column of texts: for each shot the place of its text in `names`; without a text it has `missing`."""

    names: list[str]
    codes: NDArray[np.int32]
    missing: NDArray[np.bool_] | None = None


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


class _Drawn:
    """Receives what one rule draws. The type goes by the rule and not by what happened to come: all parts of a sweep have the same."""

    def __init__(self, rule: str) -> None:
        self.kind, _, values = rule.partition("=")[2].partition("(")
        if self.kind == "list":
            import tomllib

            listed = tomllib.loads(f"v = [{values[:-1]}\n]")["v"]
            self.whole = all(type(value) is int for value in listed)
            self.number = all(type(value) in (int, float) for value in listed)
        else:
            self.whole, self.number = self.kind == "integer", True

    def type(self) -> str:
        return "int64" if self.whole else "float64" if self.number else "text"

    def column(self, draws: NDArray[Any], names: list[str]) -> Column:
        if self.kind != "list":
            return draws
        if not self.number:
            return Texts(names, draws)
        values: NDArray[Any] = np.array([int(name, 0) for name in names], np.int64) if self.whole else np.array([float(name) for name in names])
        return np.take(values, draws)


class Player:
    """Plays ranges of shots of one sweep; any thread may ask.

    Raises ValueError for a rule that cannot be read or that gives no valid scene.
    """

    def __init__(self, scene: SceneLike, vary: Mapping[str, Any] | Sequence[str], seed: int) -> None:
        if not 0 <= seed < 2**64:
            raise ValueError(f"seed={seed}: expected 0 to 2**64 - 1")
        scene = as_scene(scene)
        self.rules = rules_of(vary)
        self.ids = scene.ids
        self._sweep = _carom.make_sweep(scene._native, self.rules, seed)
        self._drawn = [_Drawn(rule) for rule in self.rules]
        self._pockets = _carom.pocket_ids(scene._native)

    def types(self) -> dict[str, tuple[str, str]]:
        """For every column "int64", "float64" or "text", and the unit, or ""."""
        keys = {key: (drawn.type(), self._sweep.unit(k)) for k, (key, drawn) in enumerate(zip(self._sweep.keys, self._drawn))}
        ends = {"outcome": ("text", ""), "duration": ("float64", "s"), "events": ("int64", ""), "first_contact": ("text", ""), "contacts": ("int64", ""), "cushions": ("int64", ""), "pocketed": ("text", "")}
        balls = {f"{ball}.{name}": what for ball in self.ids for name, what in {"x": ("float64", "m"), "y": ("float64", "m"), "pocket": ("text", "")}.items()}
        return {"shot": ("int64", ""), **keys, **ends, **balls, "message": ("text", "")}

    def play(self, first: int, last: int, threads: int, *, hash_every: int = 0) -> tuple[dict[str, Column], Shots]:
        """Shots first to last - 1: the columns of `carom sweep`, and the arrays that they come from.

        hash_every: hash the shots whose number is a multiple of it; 0: none
        """
        n = last - first
        shots = Shots.empty(n, len(self.ids), hashes=hash_every > 0)
        draws: list[NDArray[Any]] = [
            np.empty(n, np.int32 if drawn.kind == "list" else np.int64 if drawn.whole else np.float64) for drawn in self._drawn
        ]
        floats, wholes, lists = ([(k, array) for k, array in enumerate(draws) if array.dtype == kind] for kind in (np.float64, np.int64, np.int32))
        failures, texts = self._sweep.play(first, n, threads, shots._native(), floats, wholes, lists, hash_every)
        shots = shots._replace(messages=dict(failures))
        names = dict(zip((k for k, _ in lists), texts))
        columns: dict[str, Column] = {"shot": np.arange(first, last, dtype=np.int64)}
        for k, (key, drawn) in enumerate(zip(self._sweep.keys, self._drawn)):
            columns[key] = drawn.column(draws[k], names.get(k, []))
        return columns | self._outcomes(shots), shots

    def _outcomes(self, shots: Shots) -> dict[str, Column]:
        failed = shots.status >= ShotStatus.INVALID
        columns: dict[str, Column] = {
            "outcome": Texts(list(OUTCOMES), shots.status.astype(np.int32)),
            "duration": shots.duration,
            "events": Counts(shots.events, failed),
            # The place -1, nothing, is that of the last text.
            "first_contact": Texts([*self.ids, ""], shots.first_hit % (len(self.ids) + 1), failed),
            "contacts": Counts(shots.contacts.astype(np.int64), failed),
            "cushions": Counts(shots.approach_cushions.astype(np.int64), failed),
            "pocketed": self._pocketed(shots, failed),
        }
        nowhere = len(self._pockets)
        for ball, name in enumerate(self.ids):
            columns[f"{name}.x"] = shots.xy[:, ball, 0]
            columns[f"{name}.y"] = shots.xy[:, ball, 1]
            # "out" for a ball that has left the table, and nothing for one that lies on it.
            pocket = shots.pocket[:, ball]
            places = np.where(pocket >= 0, pocket, np.where(pocket == -2, nowhere, nowhere + 1)).astype(np.int32)
            columns[f"{name}.pocket"] = Texts([*self._pockets, "out", ""], places, failed)
        messages, places = [""], np.zeros(len(failed), np.int32)
        for shot, message in shots.messages.items():
            places[shot] = len(messages)
            messages.append(message)
        columns["message"] = Texts(messages, places)
        return columns

    def _pocketed(self, shots: Shots, failed: NDArray[np.bool_]) -> Texts:
        """Of every order in which balls fall the text is made once."""
        places = np.zeros(len(failed), np.int32)
        some = np.flatnonzero((shots.fell >= 0).any(axis=1))
        fell, balls = shots.fell[some], len(self.ids)
        # Up to 15 balls an order is one number of 64 bits, and these are sorted much faster than rows.
        rows = (fell + 1) @ (balls + 1) ** np.arange(balls, dtype=np.int64) if balls <= 15 else fell
        _, where, which = np.unique(rows, axis=0, return_index=True, return_inverse=True)
        places[some] = which.reshape(-1) + 1
        names = [""]
        for order in fell[where].tolist():
            names.append(";".join(self.ids[ball] for _, ball in sorted((place, ball) for ball, place in enumerate(order) if place >= 0)))
        return Texts(names, places, failed)


def _shots(shots: int, first: int, last: int | None, threads: int) -> tuple[int, int]:
    end = shots if last is None else last
    if not 0 <= first <= end <= shots <= MOST_SHOTS:
        raise ValueError(f"first={first}, last={last}: expected 0 <= first <= last <= {shots}, and at most 2**53 shots")
    if threads < 0:
        raise ValueError(f"threads={threads}: expected at least 0")
    return first, end


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
    first, end = _shots(shots, first, last, threads)
    played, _ = Player(scene, vary, seed).play(first, end, threads)
    return {name: _plain(column) for name, column in played.items()}


def _plain(column: Column) -> Any:
    if isinstance(column, Texts):
        values: list[Any] = [column.names[code] for code in column.codes.tolist()]
    elif isinstance(column, Counts):
        values = column.values.tolist()
    else:
        return column
    if column.missing is None:
        return values
    return [None if gone else value for value, gone in zip(values, column.missing.tolist())]


def arrow(columns: Mapping[str, Column], schema: pyarrow.Schema) -> pyarrow.Table:
    """Columns as a table; what a shot lacks is null."""
    import pyarrow

    def array(column: Column) -> pyarrow.Array:
        if isinstance(column, Texts):
            return pyarrow.array(column.names, pyarrow.string()).take(pyarrow.array(column.codes, mask=column.missing))
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
    first, end = _shots(shots, first, last, threads)
    scene = as_scene(scene)
    player = Player(scene, vary, seed)
    played, _ = player.play(first, end, threads)
    about = {
        "carom.scene": scene.source,
        "carom.vary": "\n".join(player.rules),
        "carom.seed": str(seed),
        "carom.first": str(first),
        "carom.last": str(end),
        "carom.version": _carom.VERSION,
    }
    return arrow(played, arrow_schema(player.types(), about))
