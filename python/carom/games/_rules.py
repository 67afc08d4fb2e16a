"""Rules: what is legal, and what came of a shot."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from carom import _carom
from carom._arguments import checked
from carom._record import Record
from carom._scene import Scene, SceneLike, as_scene, scene_with_cue

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

GAMES = ("eight_ball", "nine_ball", "three_cushion", "snooker", "sum_to_three")


class State(NamedTuple):
    """All that a game remembers between two shots, beside where the balls lie. Players are 0 and 1. Immutable; `_replace` changes it."""

    game: str  # one of GAMES
    turn: int  # whose shot it is
    opening: bool  # the break, or the first shot of a game of carom
    in_hand: str  # the cue ball: "no", "anywhere", "head string" (behind it) or "D"
    points: tuple[int, int]
    target: int  # points that win a game of carom; 0: no end
    over: bool
    winner: int  # -1: none, or not yet
    group: tuple[str, str]  # eight-ball, of each player: "open", "solids" or "stripes"
    may_push_out: bool  # nine-ball: this is the shot after the break
    fouls: tuple[int, int]  # nine-ball: of each player, without a legal shot between
    on: str  # snooker: "red", "colour" (any), "yellow", ..., "black"
    free_ball: bool  # snooker: any ball may be nominated as the ball on

    @property
    def cue_ball(self) -> str:
        """The ball that the player strikes: "cue", of three-cushion "white" or "yellow"."""
        return _carom.cue_ball(_fitting(self))


class Call(NamedTuple):
    """What a player says before a shot."""

    ball: str = ""  # eight-ball: that will fall; snooker: the nominated colour or free ball, "" for the one that is hit first
    pocket: str = ""  # eight-ball: "p1", ...
    safety: bool = False  # eight-ball: the turn ends whatever falls
    push_out: bool = False  # nine-ball


class Legal(NamedTuple):
    """What the next shot may do."""

    cue_balls: list[str]  # what may be struck: one id
    first: list[str]  # what the cue ball may meet first
    callable: list[str]  # what may be called; empty where the game has no calls
    in_hand: str  # as State.in_hand
    may_push_out: bool


class Foul(NamedTuple):
    """A foul, and the rule that it breaks, such as "WPA 6.1"."""

    name: str
    rule: str


class Respot(NamedTuple):
    """A ball that comes back to the table, and where [m]."""

    ball: str
    place: tuple[float, float]


class _OptionFields(NamedTuple):
    decision: str  # "play on", "take in hand", "pass back", "rerack", "rerack for other", "spot the eight", "spot touching balls"
    state: State  # of the next shot
    respots: list[Respot]  # what comes back before it


class Option(_OptionFields):
    """How the game may go on."""

    # The hash of the record that was judged; "" for an option that was made by hand.
    _record: str = ""

    @property
    def rerack(self) -> bool:
        """Whether the balls are racked anew."""
        return self.decision.startswith("rerack")


class Verdict(NamedTuple):
    """What came of a shot."""

    fouls: list[Foul]  # empty for a fair shot
    points: int  # scored by the shot
    penalty: int  # snooker: what the other player receives
    options: list[Option]  # at least one; where there are several, the first is what happens unless `chooser` takes another
    chooser: int  # the player who chooses; -1 where there is one option, and where lots decide (snooker)

    @property
    def next(self) -> State:
        """The state of the first option."""
        return self.options[0].state

    @property
    def respots(self) -> list[Respot]:
        """What comes back, by the first option."""
        return self.options[0].respots


@checked
def new_game(game: str, first: int = 0, target: int = 0) -> State:
    """The state before the first shot.

    game: "eight_ball", "nine_ball" (World Pool-Billiard Association), "three_cushion" (Union Mondiale de Billard), "snooker" (World Professional
        Billiards and Snooker Association) or "sum_to_three"
    first: the player who begins
    target: points that win a game of carom; 0: no end

    Raises ValueError for another game.
    """
    _check_whole("first", first)
    _check_whole("target", target)
    return State(*_carom.new_game(game, first, target))


@checked
def legal(state: State, balls: Scene | Sequence[str]) -> Legal:
    """What the next shot may do.

    balls: a scene, or the ids of the balls on the table. Ids are those of racks: "cue", "1" to "15"; "white", "yellow", "red"; snooker has reds
        with numbers and colours with names.

    Raises ValueError where the game is over, or has no ball left to play at.
    """
    return Legal(*_carom.legal(_fitting(state), list(balls.ids if isinstance(balls, Scene) else balls)))


@checked
def judge(state: State, record: Record, call: Call = Call()) -> Verdict:
    """What came of a shot.

    state: before the shot
    call: what the player said

    Not judged is what no record shows: feet, touched balls, double hits, pushes, time, misses of snooker.

    Raises ValueError for a record that does not end at rest, in which no cue strikes, that lacks the game's balls, and for a game that is over.
    """
    fouls, points, penalty, options, chooser = _carom.judge(_fitting(state), record._native, call)
    return Verdict([Foul(*foul) for foul in fouls], points, penalty, [_option(record.hash(), *option) for option in options], chooser)


def _option(record: str, decision: str, state: Any, respots: list[tuple[str, tuple[float, float]]]) -> Option:
    option = Option(decision, State(*state), [Respot(*respot) for respot in respots])
    option._record = record
    return option


def _check_whole(name: str, value: int) -> None:
    # The extension module takes 32 bits, and has the narrower ranges.
    if not -(2**31) <= value < 2**31:
        raise ValueError(f"{name} = {value} is out of range; it must be {'0 or 1' if name in ('first', 'turn', 'winner') else '0 to 1000000000'}")


def _fitting(state: State) -> State:
    for name in ("turn", "points", "target", "winner", "fouls"):
        value = getattr(state, name)
        for number in value if isinstance(value, tuple) else (value,):
            if isinstance(number, int):
                _check_whole(name, number)
    return state


def _check_record(option: Option, record: Record) -> None:
    if option._record not in ("", record.hash()):
        raise ValueError("the verdict is of another record; give the record that was judged")


@checked
def may_place(record: Record, option: Option, place: ArrayLike) -> bool:
    """Whether the cue ball may be placed there [m] before the next shot: it is in hand there, lies between the cushions, and overlaps no ball.

    Raises ValueError for an option of another record.
    """
    _check_record(option, record)
    _fitting(option.state)
    return _carom.may_place(record._native, option, _two(place))


@checked
def next_scene(
    record: Record, option: Option | Verdict, cue: Mapping[str, Any] | str | None = None, *, place: ArrayLike | None = None, scene: SceneLike | None = None
) -> Scene:
    """The next shot: what is gone is gone, what is respotted is back, the cue ball is placed, the cue strikes.

    option: one of the verdict's, not one that racks anew; a verdict stands for its first one
    cue: what strikes, as for Scene; without "ball" it strikes the cue ball. None: nothing does
    place: of the cue ball [m]: needed where it is gone, allowed where it is in hand
    scene: the one that was played; needed for a record that was loaded from a file

    Raises ValueError for a place that is missing or not allowed, for an option of another record, for a new rack and for a game that is over;
        SceneError where the result is no scene.
    """
    taken = option.options[0] if isinstance(option, Verdict) else option
    _check_record(taken, record)
    played, at = None if scene is None else as_scene(scene)._native, None if place is None else _two(place)
    return scene_with_cue(cue, lambda section: _carom.next_table(record._native, played, taken, at, section), ball=taken.state.cue_ball)


@checked
def spots(record: Record) -> dict[str, tuple[float, float]]:
    """The spots of a table [m]: "head", "center" and "foot", and those of the snooker colours."""
    return dict(_carom.spots(record._native))


def _two(place: ArrayLike) -> tuple[float, float]:
    x, y = np.asarray(place, np.float64).tolist()
    return x, y
