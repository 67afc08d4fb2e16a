"""One table as a Gymnasium environment."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

import gymnasium
import numpy as np
from gymnasium import spaces

from carom._arguments import ArgumentError, checked
from carom._record import Record
from carom._render import render
from carom.games import Noise
from carom.gym._games import Game, States
from carom.gym._strikes import Strikes
from carom.gym._tables import Rollout, Rules, Tables

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from typing import Self

    from numpy.typing import ArrayLike, NDArray

Observation = Any  # an array, or a dict of two arrays with observation="dict"


@checked
@dataclasses.dataclass(frozen=True, kw_only=True)
class Options:
    """Options of all environments: how actions become strikes, and how tables are drawn."""

    aim: str = "angle"
    speed: tuple[float, float] = (0.3, 6.0)
    elevation_deg: float | tuple[float, float] = 0.0
    noise: str | Sequence[float] = "none"
    render_mode: str | None = None
    size: tuple[int, int] = (640, 360)

    @classmethod
    def of(cls, options: Mapping[str, Any]) -> Self:
        """Raises ArgumentError for an unknown option."""
        known = [field.name for field in dataclasses.fields(cls)]
        for name in options:
            if name not in known:
                raise ArgumentError(f"{name}: unknown option; expected one of {', '.join(known)}")
        return cls(**options)

    def __post_init__(self) -> None:
        if self.render_mode not in (None, "rgb_array"):
            raise ValueError(f"render_mode={self.render_mode!r}: expected 'rgb_array' or None")

    def strikes(self) -> Strikes:
        """The strikes of these options. Pairs may be lists, as they are in JSON specs."""
        one = isinstance(self.elevation_deg, (int, float))
        return Strikes(self.aim, _pair(self.speed), self.elevation_deg if one else _pair(self.elevation_deg))

    def noise_in(self, game: Game) -> Noise:
        """The noise: a name for `carom.games.Noise.named`, or five standard deviations."""
        if isinstance(self.noise, str):
            return Noise.named(self.noise, float(game.radii[game.cue_ball]))
        if len(self.noise) != len(Noise._fields) or not all(0 <= sd < np.inf for sd in self.noise):
            wanted = f"a name, or standard deviations of {', '.join(Noise._fields)}, at least 0"
            raise ValueError(f"noise={self.noise!r}: expected {wanted}")
        return Noise(*map(float, self.noise))

    def picture(self, game: Game, xy: NDArray[np.float64]) -> NDArray[np.uint8]:
        """A table from above: (height, width, 3) bytes."""
        return next(render(game.scene_of(xy), camera="top", size=self.size, times=[0.0]))


def _pair(numbers: Any) -> tuple[float, float]:
    low, high = numbers
    return float(low), float(high)


@checked
@dataclasses.dataclass(frozen=True, kw_only=True)
class TableOptions(Options):
    """`Options`, and those of games for one player."""

    observation: str = "box"
    most_shots: int | None = None
    hashes: bool = False


@checked
class TablesEnv:
    """Shared by the environments of one table and of many."""

    _rules: Rules
    _options: TableOptions
    _tables: Tables

    def _open(
        self, game: Game, tables: int, threads: int, options: dict[str, Any]
    ) -> tuple[spaces.Space[Any], spaces.Box]:
        """The observation and action spaces of one table."""
        self._options = own = TableOptions.of(options)
        if threads < 0:
            raise ValueError(f"threads={threads}: expected at least 0")
        self._rules = Rules(game, own.strikes(), own.noise_in(game), threads=threads, hashes=own.hashes)
        self._tables = Tables(tables, self._rules, game.SHOTS if own.most_shots is None else own.most_shots)
        places = len(game.ids) + game.points(self._tables.states).shape[1]
        balls: spaces.Space[Any] = spaces.Box(-1.0, 1.0, (places, 3), np.float32)
        if own.observation == "dict":
            balls = spaces.Dict({"balls": balls, "legal": spaces.MultiBinary(len(game.ids))})
        elif own.observation != "box":
            raise ValueError(f"observation={own.observation!r}: expected 'box' or 'dict'")
        return balls, spaces.Box(-1.0, 1.0, (self._rules.strikes.size,), np.float32)

    @property
    def ids(self) -> tuple[str, ...]:
        """The balls, in the order of every array's ball axis."""
        return self._rules.game.ids

    @property
    def states(self) -> States:
        """The tables as they are, a copy; one row for a `TableEnv`."""
        return self._tables.states.take(slice(None))

    def rollout(
        self, states: States, actions: ArrayLike, *, noise_seed: int | None = None, threads: int = 1
    ) -> Rollout:
        """Plays n actions on n tables at once, for search; this environment does not change.

        n is any number; `env.states.take([0] * n)` repeats the first table n times.

        noise_seed: None plays the strikes without errors; otherwise shot i has the errors of shot i under
            this seed
        """
        n, rules = len(states.xy), self._rules
        seeds = None if noise_seed is None else np.full(n, noise_seed, np.uint64)
        search = Rules(rules.game, rules.strikes, rules.noise, threads=threads, hashes=rules.hashes)
        return search.rollout(states, actions, seeds, np.arange(n))

    def _observe_all(self) -> Observation:
        """The observations of all tables, in new arrays."""
        game, states = self._rules.game, self._tables.states
        balls = game.observe(states)
        if self._options.observation == "box":
            return balls
        return {"balls": balls, "legal": game.legal(states).astype(np.int8)}


def row(observation: Observation, table: int) -> Observation:
    """The observation of one table."""
    if isinstance(observation, dict):
        return {key: values[table] for key, values in observation.items()}
    return observation[table]


def plain(value: Any) -> Any:
    """One table's value from an array of many, as a type that Gymnasium's own vectors can combine again."""
    if isinstance(value, np.bool_):
        return bool(value)
    return value.copy() if isinstance(value, np.ndarray) else value


@checked
class TableEnv(TablesEnv, gymnasium.Env[Observation, Any]):
    """One table with a game.

    aim="angle", speed=(0.3, 6.0), elevation_deg=0.0: how an action becomes a strike (`carom.gym.Strikes`)
    noise="none": errors of the strike: "fastfiz", "ai3603" (`carom.games.Noise.named`) or five standard
    deviations observation="box": or "dict", which adds the mask of the balls that may be hit first
    most_shots=None: an episode with this many shots is truncated; None leaves the number to the game
    hashes=False: put the hash of the shot's record into info["hash"] render_mode=None: or "rgb_array"
    size=(640, 360): width and height of pictures [pixels]

    Info of a step: "status" (a number of `carom.ShotStatus`), "events", "duration" [s], "first_hit" (the
    ball's index in `ids`, or -1), "pocket" and "cushions" of every ball, "cue" (the strike that was made:
    speed, aim_deg, elevation_deg, side, height), and "foul" (its name, or ""). A shot that does not end is
    truncated and also has "message".

    Options of reset: "xy" (balls, 2) [m], NaN for an absent ball, or "scene", a `carom.Scene` with these
    positions; and the columns of the game's `EXTRA`, by name.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 1}

    def __init__(self, game: Game, **options: Any) -> None:
        self.observation_space, self.action_space = self._open(game, 1, 1, options)
        self.render_mode = self._options.render_mode
        self._seeded = False

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        super().reset(seed=seed)
        if seed is not None or not self._seeded:
            self._tables.seed(0, self.np_random)
            self._seeded = True
        self._tables.reset(slice(None), options)
        return self._observe(), {}

    def step(self, action: Any) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        if not self._seeded:
            raise gymnasium.error.ResetNeeded("call reset before step")
        played, info = self._tables.step(slice(None), np.asarray(action)[None])
        said = {key: plain(values[0]) for key, values in info.items()}
        said |= {"message": text for text in played.shots.messages.values()}
        ended = bool(played.terminated[0]), bool(played.truncated[0])
        return self._observe(), float(played.reward[0]), *ended, said

    def record(self) -> Record:
        """The record of the last shot, for pictures and pages. Raises RuntimeError before the first shot."""
        if np.isnan(self._tables.cue[0, 0]):
            raise RuntimeError("there has been no shot since reset; call step first")
        return self._rules.game.record(self._tables.before.xy[0], self._tables.cue[0])

    def render(self) -> NDArray[np.uint8] | None:
        """The table as it is, from above: (height, width, 3) bytes."""
        if self.render_mode is None:
            return None
        return self._options.picture(self._rules.game, self._tables.states.xy[0])

    def _observe(self) -> Observation:
        return row(self._observe_all(), 0)


@checked
class FeaturePlanes(gymnasium.ObservationWrapper[Any, Any, Any]):
    """Observes a `TableEnv` as planes for a convolution: float32 (4, height, width), with the table's y along
    the width.

    The planes show the cue ball, the balls that may be hit first, the other balls, and the game's own points
    (a target). A ball is a cone with a radius of two ball radii.

    `planes(env.states)` makes the planes of any number of tables: (n, 4, height, width). For pixels, use
    Gymnasium's own wrapper AddRenderObservation.
    """

    def __init__(self, env: gymnasium.Env[Any, Any], height: int = 32, width: int = 64) -> None:
        super().__init__(env)
        table = env.unwrapped
        if not isinstance(table, TableEnv):
            raise ValueError(f"FeaturePlanes: expected a carom.gym environment, not {table!r}")
        if height < 1 or width < 1:
            raise ValueError(f"FeaturePlanes: height={height}, width={width}: expected at least 1")
        self._table, self._game = table, table._rules.game
        self.observation_space = spaces.Box(0.0, 1.0, (4, height, width), np.float32)
        corner = self._game.table.corner
        self._x = corner[0] + self._game.table.width * (np.arange(height) + 0.5) / height
        self._y = corner[1] + self._game.table.length * (np.arange(width) + 0.5) / width

    def observation(self, observation: Any) -> NDArray[np.float32]:
        return np.asarray(self.planes(self._table.states)[0])

    def planes(self, states: States) -> NDArray[np.float32]:
        game = self._game
        out = np.zeros((len(states.xy), 4, len(self._x), len(self._y)), np.float32)
        kind = np.where(game.legal(states), 1, 2)
        kind[:, game.cue_ball] = 0
        marks = game.points(states)
        kind = np.concatenate((kind, np.full(marks.shape[:2], 3)), axis=1)
        # At least as wide as two pixels, so that no ball falls between them.
        pixel = max(game.table.width / len(self._x), game.table.length / len(self._y))
        reach = 2 * max(float(game.radii.max()), pixel)
        for ball, place in enumerate(np.moveaxis(np.concatenate((states.xy, marks), axis=1), 1, 0)):
            across, along = self._x[:, None] - place[:, 0, None, None], self._y - place[:, 1, None, None]
            far = np.sqrt(across**2 + along**2)
            cone = np.nan_to_num(np.maximum(1.0 - far / reach, 0.0)).astype(np.float32)
            rows = np.arange(len(cone))
            out[rows, kind[:, ball]] = np.maximum(out[rows, kind[:, ball]], cone)
        return out
