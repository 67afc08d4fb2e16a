"""Rules: legal shots, and verdicts on shots."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, get_args

import numpy as np

from carom import _carom
from carom._arguments import checked
from carom._names import GameName
from carom._record import Record
from carom._scene import Scene, SceneLike, as_scene, scene_with_cue
from carom._types import Call, GameInfo, Legal, Option, RuleOption, State, Verdict

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

GAMES: tuple[GameName, ...] = get_args(GameName)


def all_games() -> list[GameInfo]:
    """Every game, with its book and its options."""
    listed: list[GameInfo] = _carom.games()
    return listed


def rule_options() -> list[RuleOption]:
    """The options of the games, as `carom describe games` prints them."""
    return [option for game in all_games() for option in game.options]


@checked
def book_of(game: GameName) -> str:
    """The published rules of a game, with their edition."""
    for info in all_games():
        if info.name == game:
            return info.book
    raise ValueError(f"no game {game!r}; expected one of {', '.join(GAMES)}")


@checked
def new_game(
    game: GameName, first: int = 0, target: int = 0, *, rules: Mapping[str, str | bool] | None = None
) -> State:
    """The state before the first shot.

    game: one of `GAMES`; `book_of` names its rules
    first: the player who begins
    target: points that win; 0: no end, in free pyramid 8
    rules: options that are not defaults: {"call": "eight"}, {"push_out": False}

    Raises ValueError for an unknown game, option or value.
    """
    chosen = tuple(f"{key}={str(value).lower()}" for key, value in (rules or {}).items())
    state: State = _carom.new_game(State(game, first, target=target, rules=chosen))
    return state


@checked
def legal(state: State, balls: Scene | Sequence[str]) -> Legal:
    """Returns the legal choices for the next shot.

    balls: a scene, or the ids of the balls on the table, named as in racks: "cue", "1" to "15"; "white",
        "yellow", "red" (four-ball: "red1", "red2"); in snooker, numbered reds and colours by name. Only a
        scene shows which balls lie behind the head string, for a cue ball in hand there

    Raises ValueError if the game is over or no ball is left to play at.
    """
    if isinstance(balls, Scene):
        allowed: Legal = _carom.legal_on(state, balls._native)
    else:
        allowed = _carom.legal(state, list(balls))
    return allowed


@checked
def judge(state: State, record: Record, call: Call = Call()) -> Verdict:
    """Judges a shot.

    state: before the shot
    call: the player's call

    Facts that no record contains are not judged: feet on the floor, touched balls, double hits, pushes, time.

    Raises ValueError if the game is over, or the record does not end at rest, has no cue strike, or lacks the
    game's balls.
    """
    verdict: Verdict = _carom.judge(state, record._native, call)
    return verdict


@checked
def may_place(record: Record, option: Option, place: ArrayLike) -> bool:
    """Whether the cue ball may be placed there [m] before the next shot.

    It must be in hand there, lie between the cushions, and overlap no ball.

    Raises ValueError for an option of another record.
    """
    return _carom.may_place(record._native, option, _two(place))


@checked
def next_scene(
    record: Record, option: Option | Verdict, cue: Mapping[str, Any] | str | None = None,
    *, place: ArrayLike | None = None, scene: SceneLike | None = None,
) -> Scene:
    """The scene of the next shot: pocketed balls are removed, respotted ones are back, the cue ball is
    placed, and the cue strikes.

    option: of the verdict, and one that does not rack again; a verdict means its first option
    cue: the strike, as for Scene; without "ball" it strikes the cue ball; None for none
    place: of the cue ball [m]; needed if the cue ball is gone, allowed if it is in hand. Without a cue, a
        ball in hand may lie on the free place nearest to the head spot
    scene: the scene that was played; needed if the record was loaded from a file

    Raises ValueError for a missing or forbidden place, an option of another record, a new rack, or a finished
    game, and SceneError if the result is not a valid scene.
    """
    taken = option.options[0] if isinstance(option, Verdict) else option
    played, at = None if scene is None else as_scene(scene)._native, None if place is None else _two(place)

    def make(section: str) -> _carom.Scene:
        return _carom.next_table(record._native, played, taken, at, section)

    return scene_with_cue(cue, make, ball=taken.state.cue_ball)


@checked
def spots(record: Record) -> dict[str, tuple[float, float]]:
    """The spots of a table [m]: "head", "center" and "foot", and in snooker those of the colours."""
    return dict(_carom.spots(record._native))


def _two(place: ArrayLike) -> tuple[float, float]:
    x, y = np.asarray(place, np.float64).tolist()
    return x, y
