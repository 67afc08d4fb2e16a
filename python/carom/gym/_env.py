"""One table as an environment of Gymnasium."""

from __future__ import annotations

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


def rules_of(
    game: Game,
    aim: str,
    speed: tuple[float, float],
    elevation_deg: float | tuple[float, float],
    noise: str | Sequence[float],
    threads: int,
    hashes: bool,
) -> Rules:
    """Checked options of an environment as what plays. Lists are taken as pairs, as specs of JSON have them."""
    pair = elevation_deg if isinstance(elevation_deg, (int, float)) else (float(elevation_deg[0]), float(elevation_deg[1]))
    strikes = Strikes(aim, (float(speed[0]), float(speed[1])), pair)
    if threads < 0:
        raise ValueError(f"threads={threads}: expected at least 0")
    return Rules(game, strikes, noise_of(noise, game), threads=threads, hashes=hashes)


def noise_of(noise: str | Sequence[float], game: Game) -> Noise:
    """A name of `carom.games.Noise.named`, or five standard deviations."""
    if isinstance(noise, str):
        return Noise.named(noise, float(game.radii[game.cue_ball]))
    if len(noise) != len(Noise._fields) or not all(0 <= sd < np.inf for sd in noise):
        raise ValueError(f"noise={noise!r}: expected a name, or standard deviations of {', '.join(Noise._fields)}, at least 0")
    return Noise(*map(float, noise))


def check_render_mode(mode: str | None) -> None:
    if mode not in (None, "rgb_array"):
        raise ValueError(f"render_mode={mode!r}: expected 'rgb_array' or None")


def spaces_of(rules: Rules, observation: str) -> tuple[spaces.Space[Any], spaces.Box]:
    """What is observed, and what is done."""
    game = rules.game
    places = len(game.ids) + len(game.points(States(np.empty((1, len(game.ids), 2)), np.zeros((1, len(game.EXTRA)))))[0])
    balls: spaces.Space[Any] = spaces.Box(-1.0, 1.0, (places, 3), np.float32)
    if observation == "dict":
        balls = spaces.Dict({"balls": balls, "legal": spaces.MultiBinary(len(game.ids))})
    elif observation != "box":
        raise ValueError(f"observation={observation!r}: expected 'box' or 'dict'")
    return balls, spaces.Box(-1.0, 1.0, (rules.strikes.size,), np.float32)


def observed(game: Game, states: States, observation: str) -> Observation:
    """Of all tables, in arrays of their own."""
    balls = game.observe(states)
    return balls if observation == "box" else {"balls": balls, "legal": game.legal(states).astype(np.int8)}


def plain(value: Any) -> Any:
    """A value of one table out of an array of many: of the types that Gymnasium's own vectors put together again."""
    return bool(value) if isinstance(value, np.bool_) else value.copy() if isinstance(value, np.ndarray) else value


def searched(rules: Rules, states: States, actions: ArrayLike, noise_seed: int | None, threads: int) -> Rollout:
    """Shots of a search, on threads of its own."""
    n = len(states.xy)
    seeds = None if noise_seed is None else np.full(n, noise_seed, np.uint64)
    search = Rules(rules.game, rules.strikes, rules.noise, threads=threads, hashes=rules.hashes)
    return search.rollout(states, actions, seeds, np.arange(n))


@checked
class TableEnv(gymnasium.Env[Observation, Any]):
    """One table. The subclasses in carom.gym say which game.

    aim, speed, elevation_deg: how an action is a strike (`carom.gym.Strikes`)
    noise: errors of the strike: "fastfiz", "ai3603" (`carom.games.Noise.named`) or five standard deviations
    observation: "box", or "dict" with the mask of the balls that may be hit first beside it
    most_shots: an episode with as many shots is truncated; None leaves it to the game
    hashes: info["hash"] is that of the shot's record
    render_mode: "rgb_array" or None
    size: width and height of pictures [pixels]

    Info of a step: "status" (a number of `carom.ShotStatus`), "events", "duration" [s], "first_hit" (a ball's place in `ids`, or -1), "pocket"
    and "cushions" of every ball, "cue" (the strike that was made: speed, aim_deg, elevation_deg, side, height), "foul" (its name, or ""), and "message" for a shot
    without an end, which is truncated.

    Options of reset: "xy" (balls, 2) [m], NaN for a ball that is not there; or "scene", a `carom.Scene` with these places; and what the game
    remembers, by name.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 1}

    def __init__(
        self,
        game: Game,
        *,
        aim: str = "angle",
        speed: tuple[float, float] = (0.3, 6.0),
        elevation_deg: float | tuple[float, float] = 0.0,
        noise: str | Sequence[float] = "none",
        observation: str = "box",
        most_shots: int | None = None,
        hashes: bool = False,
        render_mode: str | None = None,
        size: tuple[int, int] = (640, 360),
    ) -> None:
        check_render_mode(render_mode)
        self._rules = rules_of(game, aim, speed, elevation_deg, noise, 1, hashes)
        self.observation_space, self.action_space = spaces_of(self._rules, observation)
        self.render_mode, self._observation, self._size = render_mode, observation, (int(size[0]), int(size[1]))
        self._tables = Tables(1, self._rules, game.SHOTS if most_shots is None else most_shots)
        self._seeded = False

    @property
    def ids(self) -> tuple[str, ...]:
        """The balls, in the order of every array's ball axis."""
        return self._rules.game.ids

    @property
    def states(self) -> States:
        """The table as it is, a copy with one row."""
        return self._tables.states.take(slice(None))

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

    def rollout(self, states: States, actions: ArrayLike, *, noise_seed: int | None = None, threads: int = 1) -> Rollout:
        """Plays n actions on n tables at once, for search; this environment does not change. `env.states.take([0] * n)` is this table n times.

        noise_seed: None plays the strikes as they are meant; otherwise shot i has the errors of shot i of this seed
        """
        return searched(self._rules, states, actions, noise_seed, threads)

    def record(self) -> Record:
        """The last shot with everything that happened, for pictures and pages. Raises RuntimeError before the first shot."""
        if np.isnan(self._tables.cue[0, 0]):
            raise RuntimeError("there was no shot since reset")
        return self._rules.game.record(self._tables.before.xy[0], self._tables.cue[0])

    def render(self) -> NDArray[np.uint8] | None:
        """The table as it is, from above: (height, width, 3) bytes."""
        if self.render_mode is None:
            return None
        return next(render(self._rules.game.scene_of(self._tables.states.xy[0]), camera="top", size=self._size, times=[0.0]))

    def _observe(self) -> Observation:
        all_of = observed(self._rules.game, self._tables.states, self._observation)
        return {key: values[0] for key, values in all_of.items()} if isinstance(all_of, dict) else all_of[0]


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
