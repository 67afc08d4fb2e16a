"""Rules: legal shots, and verdicts on shots."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, get_args

import numpy as np

from carom import _carom
from carom._arguments import check_fields, checked
from carom._names import GameName
from carom._record import Record
from carom._scene import Scene, SceneLike, as_scene, scene_with_cue

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

GAMES: tuple[GameName, ...] = get_args(GameName)


class State(NamedTuple):
    """Everything a game remembers between shots, except the positions of the balls.

    Players are 0 and 1. Immutable; `_replace` makes a changed copy.
    """

    game: str  # one of GAMES
    turn: int  # whose shot it is
    opening: bool  # this is the break, or the first shot of a carom game
    in_hand: str  # the cue ball: "no", "anywhere", "head string" (behind it) or "D"
    points: tuple[int, int]
    target: int  # points that win; 0: no end
    over: bool
    winner: int  # -1: none, or not yet
    group: tuple[str, str]  # eight-ball, for each player: "open", "solids" or "stripes"
    may_push_out: bool  # nine-ball, ten-ball: this is the shot after the break
    # nine-ball, ten-ball, straight pool, for each player: consecutive fouls; snooker: misses in a row
    fouls: tuple[int, int]
    on: str  # snooker: "red", "colour" (any), "yellow", ..., "black"
    free_ball: bool  # snooker: any ball may be nominated as the ball on
    rules: tuple[str, ...] = ()  # options that are not defaults: "call=eight" (`rule_options`)

    @property
    def cue_ball(self) -> str:
        """The ball that the player strikes: "cue", or in carom games "white" or "yellow". In free pyramid any
        ball may be struck."""
        return _carom.cue_ball(_fitting(self))


class Call(NamedTuple):
    """A player's calls before a shot."""

    # eight-ball, ten-ball, straight pool: the ball that will fall; snooker: the nominated colour or free
    # ball, "" for the ball hit first
    ball: str = ""
    pocket: str = ""  # the pocket that the ball will fall into: "p1", ...
    safety: bool = False  # the turn ends whatever falls
    push_out: bool = False  # nine-ball, ten-ball


class Legal(NamedTuple):
    """The shots that the rules allow next."""

    cue_balls: list[str]  # the balls that may be struck: one id, in free pyramid any
    first: list[str]  # the balls that the cue ball may meet first
    callable: list[str]  # the balls that may be called; empty if the game has no calls
    in_hand: str  # as State.in_hand
    may_push_out: bool


class Foul(NamedTuple):
    """A foul, and the rule it breaks, such as "WPA 6.1"."""

    name: str
    rule: str


class Respot(NamedTuple):
    """A ball that returns to the table, and its place [m]."""

    ball: str
    place: tuple[float, float]


class _OptionFields(NamedTuple):
    # "play on", "take in hand", "pass back", "rerack", "rerack for other", "spot the eight", "spot touching
    # balls"
    decision: str
    state: State  # for the next shot
    respots: list[Respot]  # the balls that return before it


class Option(_OptionFields):
    """A possible continuation of the game."""

    # The hash of the judged record; "" for an option made by hand.
    _record: str = ""

    @property
    def rerack(self) -> bool:
        """Whether the balls are racked again."""
        return self.decision.startswith("rerack")


class Verdict(NamedTuple):
    """The verdict on a shot."""

    fouls: list[Foul]  # empty for a fair shot
    points: int  # scored by the shot
    penalty: int  # snooker: the points that the other player receives
    options: list[Option]  # at least one; the first applies unless `chooser` picks another
    chooser: int  # the player who chooses; -1 if there is only one option, or if lots are drawn (snooker)

    @property
    def next(self) -> State:
        """The state of the first option."""
        return self.options[0].state

    @property
    def respots(self) -> list[Respot]:
        """The balls that return under the first option."""
        return self.options[0].respots


class RuleOption(NamedTuple):
    """An option of a game's rules: the first value is the default."""

    game: str
    key: str
    values: list[str]
    what: str


def rule_options() -> list[RuleOption]:
    """The options of the games, as `carom describe games` prints them."""
    return [RuleOption(*row) for row in _carom.rule_options()]


@checked
def book_of(game: GameName) -> str:
    """The published rules of a game, with their edition."""
    return _carom.book_of(game)


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
    _check_whole("first", first)
    _check_whole("target", target)
    chosen = [f"{key}={str(value).lower()}" for key, value in (rules or {}).items()]
    return _state(_carom.new_game(game, first, target, chosen))


@checked
def legal(state: State, balls: Scene | Sequence[str]) -> Legal:
    """Returns the legal choices for the next shot.

    balls: a scene, or the ids of the balls on the table, named as in racks: "cue", "1" to "15"; "white",
        "yellow", "red" (four-ball: "red1", "red2"); in snooker, numbered reds and colours by name. Only a
        scene shows which balls lie behind the head string, for a cue ball in hand there

    Raises ValueError if the game is over or no ball is left to play at.
    """
    if isinstance(balls, Scene):
        return Legal(*_carom.legal_on(_fitting(state), balls._native))
    return Legal(*_carom.legal(_fitting(state), list(balls)))


@checked
def judge(state: State, record: Record, call: Call = Call()) -> Verdict:
    """Judges a shot.

    state: before the shot
    call: the player's call

    Facts that no record contains are not judged: feet on the floor, touched balls, double hits, pushes, time.

    Raises ValueError if the game is over, or the record does not end at rest, has no cue strike, or lacks the
    game's balls.
    """
    check_fields(call)
    fouls, points, penalty, options, chooser = _carom.judge(_fitting(state), record._native, call)
    listed = [_option(record.hash(), *option) for option in options]
    return Verdict([Foul(*foul) for foul in fouls], points, penalty, listed, chooser)


def _state(row: tuple[Any, ...]) -> State:
    return State(*row)._replace(rules=tuple(row[-1]))


def _option(record: str, decision: str, state: Any, respots: list[tuple[str, tuple[float, float]]]) -> Option:
    option = Option(decision, _state(state), [Respot(*respot) for respot in respots])
    option._record = record
    return option


def _check_whole(name: str, value: int) -> None:
    # The extension module accepts 32 bits, and has the narrower ranges.
    if not -(2**31) <= value < 2**31:
        wanted = "0 or 1" if name in ("first", "turn", "winner") else "0 to 1000000000"
        raise ValueError(f"{name} = {value} is out of range; it must be {wanted}")


def _fitting(state: State) -> State:
    check_fields(state)
    for name in ("turn", "points", "target", "winner", "fouls"):
        value = getattr(state, name)
        for number in value if isinstance(value, tuple) else (value,):
            if isinstance(number, int):
                _check_whole(name, number)
    return state


def _check_record(option: Option, record: Record) -> None:
    if option._record not in ("", record.hash()):
        raise ValueError("the verdict belongs to another record; give the record that was judged")


@checked
def may_place(record: Record, option: Option, place: ArrayLike) -> bool:
    """Whether the cue ball may be placed there [m] before the next shot.

    It must be in hand there, lie between the cushions, and overlap no ball.

    Raises ValueError for an option of another record.
    """
    _check_record(option, record)
    _fitting(option.state)
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
    _check_record(taken, record)
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
