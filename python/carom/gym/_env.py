"""One table as an environment of Gymnasium."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

import gymnasium
import numpy as np
from gymnasium import spaces

from carom._arguments import checked
from carom._record import Record
from carom._render import render
from carom.games import Noise
from carom.gym._games import Game, States
from carom.gym._strikes import Strikes
from carom.gym._tables import Rollout, Rules, Tables

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

Observation = Any  # an array, or with observation="dict" a dict of two


@checked
@dataclasses.dataclass(frozen=True, kw_only=True)
class Options:
    """What all environments have: how strikes are made, and how tables are drawn."""

    aim: str = "angle"
    speed: tuple[float, float] = (0.3, 6.0)
    elevation_deg: float | tuple[float, float] = 0.0
    noise: str | Sequence[float] = "none"
    render_mode: str | None = None
    size: tuple[int, int] = (640, 360)

    def __post_init__(self) -> None:
        if self.render_mode not in (None, "rgb_array"):
            raise ValueError(f"render_mode={self.render_mode!r}: expected 'rgb_array' or None")

    def strikes(self) -> Strikes:
        """Lists are taken as pairs, as specs of JSON have them."""
        one = isinstance(self.elevation_deg, (int, float))
        return Strikes(self.aim, _pair(self.speed), self.elevation_deg if one else _pair(self.elevation_deg))

    def noise_in(self, game: Game) -> Noise:
        """A name of `carom.games.Noise.named`, or five standard deviations."""
        if isinstance(self.noise, str):
            return Noise.named(self.noise, float(game.radii[game.cue_ball]))
        if len(self.noise) != len(Noise._fields) or not all(0 <= sd < np.inf for sd in self.noise):
            raise ValueError(f"noise={self.noise!r}: expected a name, or standard deviations of {', '.join(Noise._fields)}, at least 0")
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
    """And those of one player's games."""

    observation: str = "box"
    most_shots: int | None = None
    hashes: bool = False


@checked
class TablesEnv:
    """What one table and many of them share as environments."""

    _rules: Rules
    _options: TableOptions
    _tables: Tables

    def _open(self, game: Game, tables: int, threads: int, options: dict[str, Any]) -> tuple[spaces.Space[Any], spaces.Box]:
        """What is observed of each table, and what is done."""
        self._options = TableOptions(**options)
        if threads < 0:
            raise ValueError(f"threads={threads}: expected at least 0")
        self._rules = Rules(game, self._options.strikes(), self._options.noise_in(game), threads=threads, hashes=self._options.hashes)
        self._tables = Tables(tables, self._rules, game.SHOTS if self._options.most_shots is None else self._options.most_shots)
        places = len(game.ids) + game.points(self._tables.states).shape[1]
        balls: spaces.Space[Any] = spaces.Box(-1.0, 1.0, (places, 3), np.float32)
        if self._options.observation == "dict":
            balls = spaces.Dict({"balls": balls, "legal": spaces.MultiBinary(len(game.ids))})
        elif self._options.observation != "box":
            raise ValueError(f"observation={self._options.observation!r}: expected 'box' or 'dict'")
        return balls, spaces.Box(-1.0, 1.0, (self._rules.strikes.size,), np.float32)

    @property
    def ids(self) -> tuple[str, ...]:
        """The balls, in the order of every array's ball axis."""
        return self._rules.game.ids

    @property
    def states(self) -> States:
        """The tables as they are, a copy; of a `TableEnv` one row."""
        return self._tables.states.take(slice(None))

    def rollout(self, states: States, actions: ArrayLike, *, noise_seed: int | None = None, threads: int = 1) -> Rollout:
        """Plays n actions on n tables at once, as many as you like, for search; this environment does not change. `env.states.take([0] * n)` is the
        first table n times.

        noise_seed: None plays the strikes as they are meant; otherwise shot i has the errors of shot i of this seed
        """
        n, rules = len(states.xy), self._rules
        seeds = None if noise_seed is None else np.full(n, noise_seed, np.uint64)
        search = Rules(rules.game, rules.strikes, rules.noise, threads=threads, hashes=rules.hashes)
        return search.rollout(states, actions, seeds, np.arange(n))

    def _observe_all(self) -> Observation:
        """Of all tables, in arrays of their own."""
        game, states = self._rules.game, self._tables.states
        balls = game.observe(states)
        return balls if self._options.observation == "box" else {"balls": balls, "legal": game.legal(states).astype(np.int8)}


def row(observation: Observation, table: int) -> Observation:
    """What is observed of one of the tables."""
    return {key: values[table] for key, values in observation.items()} if isinstance(observation, dict) else observation[table]


def plain(value: Any) -> Any:
    """A value of one table out of an array of many: of the types that Gymnasium's own vectors put together again."""
    return bool(value) if isinstance(value, np.bool_) else value.copy() if isinstance(value, np.ndarray) else value


@checked
class TableEnv(TablesEnv, gymnasium.Env[Observation, Any]):
    """One table. The subclasses in carom.gym say which game.

    aim="angle", speed=(0.3, 6.0), elevation_deg=0.0: how an action is a strike (`carom.gym.Strikes`)
    noise="none": errors of the strike: "fastfiz", "ai3603" (`carom.games.Noise.named`) or five standard deviations
    observation="box": or "dict" with the mask of the balls that may be hit first beside it
    most_shots=None: an episode with as many shots is truncated; None leaves it to the game
    hashes=False: info["hash"] is that of the shot's record
    render_mode=None: or "rgb_array"
    size=(640, 360): width and height of pictures [pixels]

    Info of a step: "status" (a number of `carom.ShotStatus`), "events", "duration" [s], "first_hit" (a ball's place in `ids`, or -1), "pocket"
    and "cushions" of every ball, "cue" (the strike that was made: speed, aim_deg, elevation_deg, side, height), "foul" (its name, or ""), and "message" for a shot
    without an end, which is truncated.

    Options of reset: "xy" (balls, 2) [m], NaN for a ball that is not there; or "scene", a `carom.Scene` with these places; and what the game
    remembers, by name.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 1}

    def __init__(self, game: Game, **options: Any) -> None:
        self.observation_space, self.action_space = self._open(game, 1, 1, options)
        self.render_mode = self._options.render_mode
        self._seeded = False

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Observation, dict[str, Any]]:
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
        return self._observe(), float(played.reward[0]), bool(played.terminated[0]), bool(played.truncated[0]), said

    def record(self) -> Record:
        """The last shot with everything that happened, for pictures and pages. Raises RuntimeError before the first shot."""
        if np.isnan(self._tables.cue[0, 0]):
            raise RuntimeError("there was no shot since reset")
        return self._rules.game.record(self._tables.before.xy[0], self._tables.cue[0])

    def render(self) -> NDArray[np.uint8] | None:
        """The table as it is, from above: (height, width, 3) bytes."""
        return None if self.render_mode is None else self._options.picture(self._rules.game, self._tables.states.xy[0])

    def _observe(self) -> Observation:
        return row(self._observe_all(), 0)


@checked
class FeaturePlanes(gymnasium.ObservationWrapper[Any, Any, Any]):
    """Observes a `TableEnv` as planes for a convolution: float32 (4, height, width), y of the table along the width. One each for the cue ball, the balls that may be hit
    first, the other balls, and what the game shows beside them (a target). A ball is a cone over two radii.

    `planes(env.states)` makes those of any number of tables: (n, 4, height, width). For pixels there is Gymnasium's own wrapper AddRenderObservation.
    """

    def __init__(self, env: gymnasium.Env[Any, Any], height: int = 32, width: int = 64) -> None:
        super().__init__(env)
        table = env.unwrapped
        if not isinstance(table, TableEnv):
            raise ValueError(f"FeaturePlanes: expected an environment of carom.gym, not {table!r}")
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
        # As wide as two pixels at least, so that no ball falls between them.
        reach = max(2 * float(game.radii.max()), 2 * game.table.width / len(self._x), 2 * game.table.length / len(self._y))
        for ball, place in enumerate(np.moveaxis(np.concatenate((states.xy, marks), axis=1), 1, 0)):
            far = np.sqrt((self._x[:, None] - place[:, 0, None, None]) ** 2 + (self._y - place[:, 1, None, None]) ** 2)
            cone = np.nan_to_num(np.maximum(1.0 - far / reach, 0.0)).astype(np.float32)
            rows = np.arange(len(cone))
            out[rows, kind[:, ball]] = np.maximum(out[rows, kind[:, ball]], cone)
        return out
