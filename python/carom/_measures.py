"""Measures of shots, and the search for a shot."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any, Literal, NamedTuple

from carom import _carom
from carom._arguments import checked
from carom._names import GameName, RackName, TableName
from carom._scene import Scene, SceneLike, as_scene
from carom._types import Cost, Fall, Hand, Unknown


class Measure(NamedTuple):
    """A measure that expressions may use: its name, arguments ("BALL", "GAME", ...), unit, and meaning.

    unit: "m", "s", ...; "truth" for 0 or 1, "text", "list"
    """

    name: str
    arguments: str
    unit: str
    what: str


def measures() -> list[Measure]:
    """The measures of a shot, as in `carom describe measures`. Expressions combine them: `Record.measure`,
    `carom.sweep.columns(measures=...)` and `carom.solve` take `'"9" in pocketed and not scratch'`."""
    return [Measure(*row) for row in _carom.measures()]


class Solution(NamedTuple):
    """A shot that achieves the goal, and its success rate.

    success: share of successes of a hand with errors, in shots that the search has not used
    interval: 95 of 100 such intervals contain the true share
    shots: the number of these shots
    values: the chosen values, by key
    falls: which ball falls into which pocket, the most frequent first
    costs: the costs of errors of one input
    scene: the shot without errors
    miss: with exact=True, the largest distance of a ball from its place [m], otherwise NaN
    trouble: with exact=True, why it is not smaller, or ""
    exact_success: share of successes on exact tables
    searches: the success of the best of each search from other places, half-way; far apart, they warn that
        there may be a better shot
    """

    success: float
    interval: tuple[float, float]
    shots: int
    values: dict[str, float]
    falls: list[Fall]
    costs: list[Cost]
    scene: Scene
    miss: float = float("nan")
    trouble: str = ""
    exact_success: float = float("nan")
    searches: Sequence[float] = ()

    def __repr__(self) -> str:
        values = ", ".join(f"{key} {value:.4g}" for key, value in self.values.items())
        low, high = self.interval
        success = f"{self.success:.3f} ({low:.3f} to {high:.3f}) of {self.shots} shots"
        return f"<carom.Solution: success {success}; {values}>"


def _solutions(rows: Sequence[tuple[Any, ...]]) -> list[Solution]:
    return [Solution(*row)._replace(scene=Scene._of(row[6])) for row in rows]


def _limits(shots: int, best: int, seed: int, threads: int, hand: Hand, unknown: Unknown) -> None:
    for name, value, low, high in (("shots", shots, 1000, 10**10), ("best", best, 1, 20),
                                   ("seed", seed, 0, 2**64 - 1), ("threads", threads, 0, 256)):
        if not low <= value <= high:
            raise ValueError(f"{name}={value}: expected {low} to {high}")
    for name, errors, most in (("hand", hand, 100), ("unknown", unknown, 1)):
        if not all(0 <= error <= most for error in errors):
            raise ValueError(f"{name}={errors}: expected standard deviations from 0 to {most}")


#: A range as `carom solve --vary` accepts it.
_UNIFORM = re.compile(r"uniform\(([^,]+),([^,]+)\)")


def _range(key: str, ends: Sequence[float] | str) -> tuple[float, float]:
    """The smallest and the largest value that a key may have."""
    if isinstance(ends, str):
        text = _UNIFORM.fullmatch(ends.strip())
        parts: Sequence[float | str] = text.groups() if text else ()
    else:
        parts = ends
    try:
        low, high = map(float, parts)
    except (TypeError, ValueError):
        raise ValueError(
            f"vary: {key}: expected the smallest and the largest value, or \"uniform(a,b)\"") from None
    return low, high


@checked
def solve(
    scene: SceneLike,
    want: str,
    vary: Mapping[str, Sequence[float] | str] | None = None,
    *,
    hand: Hand = Hand(),
    unknown: Unknown = Unknown(),
    game: GameName | None = None,
    layouts: int = 0,
    shots: int = 200_000,
    best: int = 3,
    seed: int = 1,
    threads: int = 0,
    exact: bool = False,
) -> list[Solution]:
    """Finds the shots most likely to achieve a goal, given the errors of a hand: `carom solve`.

    want: an expression over `measures()`: '"1" in pocketed and not scratch'
    vary: the inputs to search, by key: the smallest and the largest value, or "uniform(a,b)". "hit.1"
        aims at ball 1: 0 is full, 1 and -1 its edges. The default is aim, speed and height of the tip
    hand: the errors
    unknown: the properties of the table that each shot draws
    game: the rules for measures such as "foul"
    layouts: number of random racks to play the shot on, if the scene has a rack; 0 draws one for each shot
    shots: number of shots that the search plays
    best: number of shots of different kinds to return, the surest first
    threads: 0 uses one thread per core; the result does not depend on it
    exact: refine each shot until the balls rest at the centre of every "near", within 1e-6 m; if no exact
        shot is nearby, `trouble` says why and the shot stays as found

    Raises ValueError for an expression, key or range that cannot be used.
    """
    _limits(shots, best, seed, threads, hand, unknown)
    if not 0 <= layouts <= 100000:
        raise ValueError(f"layouts={layouts}: expected 0 to 100000")
    choices = _carom.default_choices() if vary is None else []
    choices += [(key, *_range(key, ends)) for key, ends in (vary or {}).items()]
    return _solutions(
        _carom.solve(as_scene(scene)._native, want, game, choices, hand, unknown, layouts, shots, best, seed,
                     threads, exact))


@checked
def best_break(
    game: RackName = "nine_ball",
    *,
    table: TableName = "nine_foot",
    rack: Literal["template", "triangle"] | float = "template",
    radius_sd: float = 0.0,
    speed_max: float = 10.0,
    box: bool = False,
    hand: Hand = Hand(),
    unknown: Unknown = Unknown(),
    shots: int = 200_000,
    best: int = 3,
    seed: int = 1,
    threads: int = 0,
) -> list[Solution]:
    """Recommends a break: cue-ball position, cut, speed, and success rate: `carom break`.

    rack: how it was made, or the gap between its balls [m]
    radius_sd: standard deviation of the radii of the racked balls [m]
    speed_max: maximum speed of the cue ball [m/s]
    box: place the cue ball at least a diamond from either long rail
    hand, unknown, shots, best, seed, threads: as for `solve`

    Raises ValueError for a game without a break or a number out of range.
    """
    _limits(shots, best, seed, threads, hand, unknown)
    how = rack if isinstance(rack, str) else f"gap={float(rack)!r}"
    return _solutions(
        _carom.best_break(game, table, how, float(radius_sd), float(speed_max), box, hand, unknown, shots,
                          best, seed, threads))
