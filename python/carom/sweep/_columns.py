"""Shots of a sweep as columns: arrays, lists, pyarrow tables."""

from __future__ import annotations

import importlib
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from carom import _carom, _toml
from carom._arguments import checked
from carom._names import GameName
from carom._scene import Scene, SceneLike, as_scene

if TYPE_CHECKING:
    import pyarrow
    from numpy.typing import NDArray

#: The largest number of shots in a sweep, up to which doubles count exactly.
MOST_SHOTS = 2**53


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


def need(name: str) -> Any:
    """The package. Raises ImportError, with the way to install it, if it is missing."""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        what = f"{name} is missing ({error}): pip install {name.partition('.')[0]}"
        raise ImportError(what, name=name) from None


class Player:
    """Plays ranges of shots of one sweep. `about` is added to the metadata of its tables.

    Raises ValueError for a rule that cannot be read or that makes no valid scene.
    """

    def __init__(
        self, scene: Scene, vary: Mapping[str, Any] | Sequence[str], seed: int,
        measures: Sequence[str] = (), game: str | None = None, about: Mapping[str, str] | None = None,
    ) -> None:
        if not 0 <= seed < 2**64:
            raise ValueError(f"seed={seed}: expected 0 to 2**64 - 1")
        self.scene, self.rules, self.seed = scene, rules_of(vary), seed
        self.about = {"carom.version": _carom.VERSION, **(about or {})}
        self.sweep = _carom.make_sweep(scene._native, self.rules, seed, list(measures), game)

    def play(self, first: int, last: int, threads: int) -> list[tuple[Any, ...]]:
        """The columns of shots first to last - 1: values; texts of which these are the indices, or None; and
        for each shot whether its value is missing, or None if no value can be."""
        return list(self.sweep.play(first, last - first, threads, False)[0])

    def schema(self, first: int, last: int) -> pyarrow.Schema:
        """The columns with their units, and the origin of the shots as metadata."""
        pyarrow = need("pyarrow")
        kinds = {"int64": pyarrow.int64(), "float64": pyarrow.float64(), "text": pyarrow.string()}
        fields = [pyarrow.field(name, kinds[kind], metadata={"unit": unit} if unit else None)
                  for name, kind, unit in self.sweep.columns]
        numbers = {"carom.seed": str(self.seed), "carom.first": str(first), "carom.last": str(last)}
        texts = {"carom.scene": self.scene.source, "carom.vary": "\n".join(self.rules), **self.about}
        return pyarrow.schema(fields, metadata=texts | numbers)

    def table(self, first: int, last: int, threads: int) -> pyarrow.Table:
        """Plays shots first to last - 1; missing values are null."""
        pyarrow = need("pyarrow")
        arrays = []
        for values, texts, missing in self.play(first, last, threads):
            array = pyarrow.array(values, mask=None if missing is None else missing.astype(bool))
            arrays.append(array if texts is None else pyarrow.array(texts, pyarrow.string()).take(array))
        return pyarrow.table(arrays, schema=self.schema(first, last))


@checked
def columns(
    scene: SceneLike, vary: Mapping[str, Any] | Sequence[str], shots: int, *,
    seed: int = 1, first: int = 0, last: int | None = None, threads: int = 0,
    measures: Sequence[str] = (), game: GameName | None = None,
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
    end = _end(shots, first, last, threads)
    player = Player(as_scene(scene), vary, seed, measures, game)
    played = zip(player.sweep.columns, player.play(first, end, threads))
    return {name: _plain(*column) for (name, _, _), column in played}


def _end(shots: int, first: int, last: int | None, threads: int) -> int:
    """The number after the last shot. Raises ValueError if a number is out of range."""
    end = shots if last is None else last
    if not 0 <= first <= end <= shots <= MOST_SHOTS:
        wanted = f"0 <= first <= last <= {shots}, and at most 2**53 shots"
        raise ValueError(f"first={first}, last={last}: expected {wanted}")
    if threads < 0:
        raise ValueError(f"threads={threads}: expected at least 0")
    return end


def _plain(values: NDArray[Any], texts: list[str] | None, missing: NDArray[np.uint8] | None) -> Any:
    if texts is not None:
        names = [*texts, None]  # the index -1 is the last one
        return [names[code] for code in values.tolist()]
    if missing is not None and values.dtype == np.int64:
        return [None if gone else value for value, gone in zip(values.tolist(), missing.tolist())]
    return values


@checked
def table(
    scene: SceneLike, vary: Mapping[str, Any] | Sequence[str], shots: int, *,
    seed: int = 1, first: int = 0, last: int | None = None, threads: int = 0,
    measures: Sequence[str] = (), game: GameName | None = None,
) -> pyarrow.Table:
    """`columns` as a pyarrow Table. Needs pyarrow (extra [sweep]).

    The table's metadata give its origin: scene, vary, seed, first, last, version; a column's metadata give
    its unit. Missing values of a shot without a result are null.
    """
    end = _end(shots, first, last, threads)
    return Player(as_scene(scene), vary, seed, measures, game).table(first, end, threads)
