"""Types of the interface. tools/renew_formats.py writes the parts between the marks; methods follow them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, NamedTuple, TypeAlias

from carom import _carom

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from carom._scene import Scene

# begin GameName
GameName: TypeAlias = Literal["eight_ball", "nine_ball", "three_cushion", "snooker", "sum_to_three",
                              "ten_ball", "straight_pool", "free_pyramid", "straight_rail", "one_cushion",
                              "four_ball"]
# end GameName


# begin State
class State(NamedTuple):
    """The memory of a game between two shots. Players are 0 and 1; a pair has a value for each."""

    #: The game.
    game: GameName
    #: Whose shot it is.
    turn: int = 0
    #: The break, or the first shot of a carom game.
    opening: bool = True
    #: Of the cue ball: its area.
    in_hand: Literal["no", "anywhere", "head string", "D"] = "no"
    #: Below 0 in straight pool and four-ball.
    points: tuple[int, int] = (0, 0)
    #: Points that win; 0: no end.
    target: int = 0
    #: The game is over.
    over: bool = False
    #: -1: none, or not yet.
    winner: int = -1
    #: Eight-ball.
    group: tuple[Literal["open", "solids", "stripes"], Literal["open", "solids", "stripes"]] = ("open",
        "open")
    #: Nine-ball, ten-ball: the shot after the break.
    may_push_out: bool = False
    #: In a row; snooker: misses with a clear path to a full ball.
    fouls: tuple[int, int] = (0, 0)
    #: Snooker: the ball on; colour: any, after a red.
    on: Literal["colour", "red", "yellow", "green", "brown", "blue", "pink", "black"] = "red"
    #: Snooker: any ball may be nominated.
    free_ball: bool = False
    #: Options that are not defaults, such as "call=eight".
    rules: tuple[str, ...] = ()
# end State

    @property
    def cue_ball(self) -> str:
        """The ball that the player strikes: "cue", or in carom games "white" or "yellow". In free pyramid any
        ball may be struck."""
        return _carom.cue_ball(self)


# begin Call
class Call(NamedTuple):
    """An announcement before a shot."""

    #: Id of the called ball. Snooker: the nominated colour or free ball; if "", the ball that is hit first.
    ball: str = ""
    #: Id of the called pocket: "p1", ...
    pocket: str = ""
    #: Eight-ball, ten-ball, straight pool: the turn ends whatever falls.
    safety: bool = False
    #: Nine-ball, ten-ball: a push out.
    push_out: bool = False
# end Call


# begin Legal
class Legal(NamedTuple):
    """The rules of the next shot."""

    #: That may be struck: one, in free pyramid any.
    cue_balls: list[str]
    #: That may be hit first.
    first: list[str]
    #: That may be called.
    callable: list[str]
    #: As in the state.
    in_hand: Literal["no", "anywhere", "head string", "D"]
    #: A push out may be called.
    may_push_out: bool
# end Legal


# begin Foul
class Foul(NamedTuple):
    """A foul, and the rule that it breaks."""

    #: Its name.
    foul: Literal["cue ball pocketed", "cue ball off the table", "no ball hit", "wrong ball first",
        "no cushion after contact", "too few balls to a cushion on the break", "ball off the table",
        "cue ball placed outside its area", "ball behind the head string first", "third foul in a row",
        "wrong cue ball", "opening shot not at the red", "wrong ball pocketed", "two balls hit at once",
        "jump shot", "snooker behind the free ball", "miss", "opponent's cue ball hit",
        "touching ball played into"]
    #: "WPA 6.1"; "" if the game has no such rule.
    rule: str = ""
# end Foul

    @property
    def name(self) -> str:
        """The same as `foul`."""
        return self.foul


# begin Respot
class Respot(NamedTuple):
    """A ball that is respotted."""

    #: Its id.
    ball: str
    #: [m]
    place: tuple[float, float]
# end Respot


# begin Option
class Option(NamedTuple):
    """A possible continuation of the game."""

    #: The next step.
    decision: Literal["play on", "take in hand", "pass back", "rerack", "rerack for other", "spot the eight",
        "spot touching balls", "replace the balls", "rack fourteen"]
    #: Of the next shot.
    state: State
    #: Before it.
    respots: list[Respot]
    #: The balls are racked again.
    rerack: bool = False
    #: The next shot in words.
    text: str = ""
    #: Hash of the judged record; "": unknown.
    record: str = ""
# end Option


# begin Verdict
class Verdict(NamedTuple):
    """The outcome of a shot."""

    #: Empty for a fair shot.
    fouls: list[Foul]
    #: Scored by the shot.
    points: int
    #: Snooker: points for the other player.
    penalty: int
    #: At least one; the first applies unless the chooser picks another.
    options: list[Option]
    #: A player; -1 with one option, or if lots decide.
    chooser: int
# end Verdict

    @property
    def next(self) -> State:
        """The state of the first option."""
        return self.options[0].state

    @property
    def respots(self) -> list[Respot]:
        """The balls that return under the first option."""
        return self.options[0].respots


# begin RuleOption
class RuleOption(NamedTuple):
    """An option of a game's rules."""

    #: The game.
    game: GameName
    #: Its name.
    key: str
    #: The first one is the default.
    values: list[str]
    #: Its meaning.
    what: str = ""
# end RuleOption


# begin GameInfo
class GameInfo(NamedTuple):
    """A game."""

    #: In files.
    name: str
    #: For people.
    title: str
    #: Its published rules, with their edition.
    book: str
    #: Announcements before a shot.
    calls: str
    #: Players collect points.
    is_scored: bool
    #: Each player has a group of balls.
    has_groups: bool
    #: A safety may be called.
    has_safety: bool
    #: A push out may be called.
    has_push_out: bool
    #: Points that win, if none are given; 0: no end.
    target: int
    #: A target to offer; 0: none.
    usual_target: int
    #: Object balls of a full rack.
    balls: int
    #: A table for it: a preset.
    table: str
    #: Its first scene, without table and balls. Places are fractions of the width (w) and the length (l) of
    #: the table; SEED is of the rack.
    start: str
    #: Of its rules.
    options: list[RuleOption]
# end GameInfo


# begin Cue
class Cue(NamedTuple):
    """A strike: [cue] of a scene file."""

    #: kind of cue: its `mass`, `end_mass` and `restitution`
    preset: str
    #: id of the ball that is struck
    ball: str
    #: of the cue [m/s]
    speed: float
    #: 0 is +x, 90 is +y [degrees]
    aim_deg: float
    #: of the butt; above 0 it lifts the ball; `"auto"`: the least that clears rails and balls [degrees]
    elevation_deg: float
    #: left and up positive, together at most 0.5: farther out the tip slips off [ball radii]
    offset: tuple[float, float]
    #: of the cue [kg]
    mass: float
    #: of its end, for squirt; 0 for none, at most `mass` [kg]
    end_mass: float
    #: of the tip; 1 loses nothing
    restitution: float
# end Cue


# begin Share
class Share(NamedTuple):
    """A share of shots, with an interval that contains the true one 95 times in 100."""

    #: 0 to 1.
    value: float
    #: Of the interval.
    low: float
    #: Of the interval.
    high: float
# end Share


# begin Advice
class Advice(NamedTuple):
    """A shot to play, and its success rate."""

    #: The shot: "7 into p5 (right side pocket), half ball to the left, stun, medium".
    words: str
    #: Its result: "pots 84 % (80 to 87), wins 61 %, fouls 2 %; ...".
    result: str
    #: Its kind.
    kind: Literal["pot", "combination", "bank", "kick", "safety", "push out", "break"]
    #: The ball that it pots; "" for other kinds.
    ball: str
    #: The pocket of that ball.
    pocket: str
    #: Of a pot: how far the object ball turns to the left.
    cut_deg: float
    #: The strike.
    cue: Cue
    #: With random errors of the level.
    strike: Cue
    #: For the judge.
    call: Call
    #: Of the cue ball in hand [m].
    place: tuple[float, float] | None
    #: Of shots that the search has not used: it wins the turn or the game.
    makes: Share
    #: Of these shots: it is a foul.
    fouls: Share
    #: Mean chance to win the rack against a player of the same level, as estimated; in eight-ball only an
    #: order.
    worth: float
    #: The balls that it most often leaves as the surest pot, at most 3.
    leaves: list[str]
# end Advice


# begin Noise
class Noise(NamedTuple):
    """Standard deviations of the independent normal errors of a strike."""

    #: [m/s]
    speed: float = 0.0
    #: [degrees]
    aim_deg: float = 0.0
    #: [degrees]
    elevation_deg: float = 0.0
    #: Of the offset [ball radii].
    side: float = 0.0
    #: Of the offset [ball radii].
    height: float = 0.0
# end Noise

    @classmethod
    def named(cls, name: str, radius: float = 0.028575) -> Noise:
        """"none", "fastfiz" or "ai3603".

        "fastfiz": 0.075 m/s, aim 0.125 and elevation 0.1 degrees, offset 0.5 mm. These are the defaults of
        FastFiz, the simulator of the computational pool championships.
        "ai3603": 0.1 m/s, aim and elevation 0.1 degrees, offset 0.003 ball radii, as in the course AI3603.

        radius: of the struck ball [m]

        Raises ValueError for another name.
        """
        noise: Noise = _carom.noise_by_name(name, radius)
        return noise


# begin PocketLine
class PocketLine(NamedTuple):
    """The straight paths of a ball into a pocket that touch neither cushion noses nor jaws."""

    #: Its id.
    pocket: str
    #: Unit vector in the middle of these paths.
    towards: tuple[float, float]
    #: Centre of the cue ball that sends the ball there, without throw [m].
    ghost: tuple[float, float]
    #: Angle between the outermost paths; 0 if there is none.
    width_deg: float
    #: From the ball to the point where it begins to fall [m].
    distance: float
    #: The nearest ball on the middle path, or "".
    in_the_way: str = ""
    #: There is such a path, and no ball blocks the middle one.
    open: bool = False
# end PocketLine


# begin Aim
class Aim(NamedTuple):
    """The result of a search for an aim."""

    #: Of a strike that was played and pots the ball; null: see `why`.
    aim_deg: float | None
    #: Of a pot: at the ghost ball, without throw, squirt and swerve.
    geometric_deg: float
    #: Of a pot: the cut angle of that aim.
    cut_deg: float
    #: Of a bank: the cushion that the ball hits.
    cushion: str
    #: Played in the search.
    shots: int
    #: Why there is no aim; "" if there is one.
    why: str = ""
# end Aim
# begin Hand
class Hand(NamedTuple):
    """Standard deviations of a player's independent normal errors."""

    #: Of the aim [degrees].
    aim_deg: float = 0.2
    #: Of the cue's speed, as a fraction of it.
    speed: float = 0.03
    #: Of the tip, sideways and up [ball radii].
    tip: float = 0.02
    #: Of the elevation [degrees].
    elevation_deg: float = 0.0
# end Hand


# begin Unknown
class Unknown(NamedTuple):
    """Standard deviations of a table's properties that a player does not know, drawn anew for every trial;
    all 0 for exact tables."""

    #: Of mu_s and of mu_r, as a fraction.
    cloth: float = 0.05
    #: Of the restitution of the cushions, as a fraction.
    rails: float = 0.02
    #: Of every ball along x and y, except racked ones [m].
    places: float = 0.0001
    #: Between racked balls [m].
    gaps: float = 2e-05
# end Unknown


# begin Fall
class Fall(NamedTuple):
    """How often a ball falls into a pocket."""

    #: Its id.
    ball: str
    #: Its id.
    pocket: str
    #: Of the shots of the solution.
    share: float
# end Fall


# begin Cost
class Cost(NamedTuple):
    """The success if one input is off."""

    #: Its key, or aim.
    input: str
    #: The error.
    by: float
    #: Of the error.
    unit: str
    #: Share of successes; NaN if no scene is valid there.
    less: float
    #: The same in the other direction.
    more: float
    #: In each direction.
    shots: int
# end Cost


# begin FitResult
class FitResult(NamedTuple):
    """A fit, with the names of `scipy.optimize.least_squares` where it has them."""

    #: The fitted values, in the order of `vary`.
    x: NDArray[np.float64]
    #: Covariance of `x` if the model is right. Infinite for values that the tracks do not determine, and for
    #: all if the fit failed. Correlated errors of neighbours in time enlarge it.
    cov: NDArray[np.float64]
    #: Of every point: simulated minus tracked [m]; 0 in a pocket.
    fun: NDArray[np.float64]
    #: The fit converged, and its residuals are noise.
    success: bool
    #: Why it failed, or "converged".
    message: str
    #: Typical residual of a coordinate, without outliers [m].
    noise: float
    #: Coordinates farther off than three times the noise.
    outliers: int
    #: Shots compared with the tracks; derivatives need more.
    nfev: int
    #: On values that the tracks cannot separate, a sentence each.
    warnings: list[str]
    #: The scene with the fitted values.
    scene: Scene
    #: Standard deviations of `x`.
    std: NDArray[np.float64]
    #: The values in the given scene.
    start: NDArray[np.float64]
    #: Of all residuals [m].
    rms: float
    #: Positions that count: none of a ball in a pocket.
    points: int
# end FitResult
