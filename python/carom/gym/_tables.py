"""Tables side by side, shared by single and vector environments so that both give the same bits."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from carom import _carom
from carom._scene import as_scene
from carom._simulate import Shots, simulate_many
from carom.games import Noise
from carom.gym._games import Game, Judged, States, failed
from carom.gym._strikes import Strikes

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

#: Indices of tables, or all tables with `slice(None)`.
Rows = Any
#: More events than any real shot has; a shot that reaches it is truncated.
_MOST_EVENTS = 100_000


class Rollout(NamedTuple):
    """n trial shots that do not change the environment."""

    states: States  # after the shots; unchanged for a shot without an end
    reward: NDArray[np.float64]  # (n,)
    terminated: NDArray[np.bool_]  # (n,)
    truncated: NDArray[np.bool_]  # (n,) the shot has no end; `shots.status` and `shots.messages` say why
    foul: NDArray[np.object_]  # (n,) its name, or ""
    cue: NDArray[np.float64]  # (n, 5) the strikes, as for `simulate_many(cue=...)`
    shots: Shots


class Rules:
    """A game, and how actions become strikes."""

    def __init__(self, game: Game, strikes: Strikes, noise: Noise, *, threads: int, hashes: bool) -> None:
        self.game, self.strikes, self.noise = game, strikes, noise
        self.threads, self.hashes = threads, hashes

    def rollout(
        self, states: States, actions: ArrayLike, seeds: NDArray[np.uint64] | None,
        indices: NDArray[np.int64] | None = None,
    ) -> Rollout:
        """Plays one action on each table, with the errors of these seeds and shot indices, or without
        errors."""
        act = np.asarray(actions)
        wanted = (len(states.xy), self.strikes.size)
        if act.shape != wanted or not np.issubdtype(act.dtype, np.floating):
            got = f"{act.dtype} in {act.shape}"
            raise ValueError(f"actions: expected floating-point numbers in the shape {wanted}, not {got}")
        game = self.game
        legal = game.legal(states) if self.strikes.aim == "ball" else np.zeros(states.xy.shape[:2], bool)
        cue = self.strikes.cue(act, states.xy, game.cue_ball, legal, game.radii)
        if seeds is not None and any(self.noise):
            which = np.zeros(len(cue), np.int64) if indices is None else indices
            _carom.add_noise_each(cue.reshape(-1), self.noise, seeds, which)
        return self.play(states, cue)

    def play(self, states: States, cue: NDArray[np.float64]) -> Rollout:
        """Plays one strike on each table."""
        shots, judged = self.game.play(
            states, cue, max_events=_MOST_EVENTS, threads=self.threads, hashes=self.hashes)
        bad = failed(shots)
        if bad.any():
            kept = States(judged.states.xy.copy(), judged.states.extra.copy())
            kept.put(bad, states.take(bad))
            reward, foul = np.where(bad, 0.0, judged.reward), np.where(bad, "", judged.foul)
            judged = Judged(kept, reward, judged.terminated & ~bad, foul)
        return Rollout(judged.states, judged.reward, judged.terminated, bad, judged.foul, cue, shots)


class Tables:
    """n tables in the middle of their episodes, some of which `reset` and `step` change."""

    def __init__(self, n: int, rules: Rules, most_shots: int) -> None:
        balls, k = len(rules.game.ids), len(rules.game.EXTRA)
        self.rules, self.most_shots = rules, most_shots
        self.states = States(np.full((n, balls, 2), np.nan), np.zeros((n, k)))
        self.generators, self.noise_seeds = np.zeros(n, np.uint64), np.zeros(n, np.uint64)
        self.shots = np.zeros(n, np.int64)  # of this episode
        self.played = np.zeros(n, np.int64)  # since the table was seeded
        # Of this episode's last shot.
        self.before, self.cue = self.states.take(slice(None)), np.full((n, 5), np.nan)

    def seed(self, row: int, generator: np.random.Generator) -> None:
        self.generators[row], self.noise_seeds[row] = generator.integers(0, 2**64, 2, dtype=np.uint64)
        self.played[row] = 0

    def reset(self, rows: Rows, options: Mapping[str, Any] | None) -> None:
        """Starts new episodes on these tables. Raises ValueError for unknown or invalid options."""
        generators = self.generators[rows].copy()
        states = self.rules.game.start(generators)
        self.generators[rows] = generators
        if options:
            states = self._as_asked(states, options)
        self.states.put(rows, states)
        self.shots[rows] = 0
        self.cue[rows] = np.nan

    def step(self, rows: Rows, actions: NDArray[np.floating]) -> tuple[Rollout, dict[str, NDArray[Any]]]:
        """Plays one shot on each of these tables and returns the result with its info."""
        before = self.states.take(rows)
        played = self.rules.rollout(before, actions, self.noise_seeds[rows], self.played[rows])
        self.before.put(rows, before)
        self.cue[rows] = played.cue
        self.states.put(rows, played.states)
        self.shots[rows] += 1
        self.played[rows] += 1
        over = self.shots[rows] >= self.most_shots
        played = played._replace(truncated=played.truncated | (over & ~played.terminated))
        shots = played.shots
        info: dict[str, NDArray[Any]] = {
            name: getattr(shots, name)
            for name in ("status", "events", "duration", "first_hit", "pocket", "cushions", "hash")
            if getattr(shots, name) is not None}
        info |= {"cue": played.cue, "foul": played.foul}
        return played, info

    def _as_asked(self, states: States, options: Mapping[str, Any]) -> States:
        game, n = self.rules.game, len(states.xy)
        known = {"xy", "scene", *game.EXTRA}
        wrong = set(options) - known
        if wrong:
            raise ValueError(f"options: {sorted(wrong)[0]!r} is unknown; use {', '.join(sorted(known))}")
        if "scene" in options and "xy" in options:
            raise ValueError("options: both xy and scene place the balls; give one")
        xy, extra = states.xy, states.extra
        if "scene" in options:
            xy = _repeated("scene", _places_of(options["scene"], game), n)
        elif "xy" in options:
            xy = _repeated("xy", np.asarray(options["xy"], np.float64), n, (len(game.ids), 2))
        for k, name in enumerate(game.EXTRA):
            if name in options:
                extra[:, k] = _repeated(name, np.asarray(options[name], np.float64), n, ())
        trial = simulate_many(game.scene, xy=xy, until=0.0)
        for row, why in sorted(trial.messages.items()):
            raise ValueError(f"options: table {row} cannot be played: {why}")
        return States(np.array(xy), extra)


def _repeated(
    name: str, values: NDArray[np.float64], n: int, shape: tuple[int, ...] | None = None
) -> NDArray[np.float64]:
    """One value per table; a single value is repeated."""
    if shape is None or values.shape == shape:
        return np.repeat(values[None], n, axis=0)
    if values.shape == (n, *shape):
        return values
    raise ValueError(f"options: {name} has the shape {values.shape}; expected {shape} or {(n, *shape)}")


def _places_of(given: Any, game: Game) -> NDArray[np.float64]:
    try:
        scene = as_scene(given)
    except TypeError as error:
        raise ValueError(f"options: scene: {error}") from None
    stranger = [ball for ball in scene.ids if ball not in game.ids]
    if stranger:
        balls = ", ".join(game.ids)
        raise ValueError(f"options: the scene has a ball {stranger[0]!r}; this game has {balls}")
    xy = np.full((len(game.ids), 2), np.nan)
    xy[[game.ids.index(ball) for ball in scene.ids]] = scene.positions
    return xy
