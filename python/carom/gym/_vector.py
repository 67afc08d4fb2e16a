"""Many tables as one Gymnasium vector environment; all shots of a step are one batch."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import gymnasium
import numpy as np
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from carom._arguments import checked
from carom.gym._env import Observation, TablesEnv, row
from carom.gym._games import Game
from carom.gym._tables import Rollout

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

_Step = tuple[Observation, "NDArray[np.float64]", "NDArray[np.bool_]", "NDArray[np.bool_]", dict[str, Any]]


@checked
class TableVectorEnv(TablesEnv, VectorEnv[Observation, Any, "NDArray[Any]"]):
    """n tables. Table i gives the same bits as a `TableEnv` with its seed. Other options are those of
    `TableEnv`.

    autoreset_mode: when to reset a table whose episode is over: at its next step, which then plays no shot
        ("NextStep"); in the same step ("SameStep", with the end of the episode in info["final_obs"] and
        info["final_info"]); or by `reset(options={"reset_mask": ...})` ("Disabled")
    threads: the number of threads that play a step's shots; 0 uses every core available to the process
    """

    metadata: dict[str, Any] = {
        "render_modes": ["rgb_array"], "render_fps": 1, "autoreset_mode": AutoresetMode.NEXT_STEP}

    def __init__(
        self,
        game: Game,
        num_envs: int = 1,
        *,
        autoreset_mode: str | AutoresetMode = AutoresetMode.NEXT_STEP,
        threads: int = 1,
        **options: Any,
    ) -> None:
        super().__init__()
        if num_envs < 1:
            raise ValueError(f"num_envs={num_envs}: expected at least 1")
        self.num_envs = num_envs
        self.autoreset_mode = AutoresetMode(autoreset_mode)
        self.metadata = {**type(self).metadata, "autoreset_mode": self.autoreset_mode}
        self.single_observation_space, self.single_action_space = self._open(game, num_envs, threads, options)
        self.render_mode = self._options.render_mode
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._seeded = np.zeros(num_envs, bool)
        self._over = np.zeros(num_envs, bool)

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        n = self.num_envs
        if isinstance(seed, (int, np.integer)):
            seed = [seed + i for i in range(n)]
        seeds = [None] * n if seed is None else list(seed)
        if len(seeds) != n:
            raise ValueError(f"seed: {len(seeds)} seeds for {n} environments; give one for each")
        rest: dict[str, Any] = dict(options or {})
        mask = _mask(rest.pop("reset_mask"), n) if "reset_mask" in rest else np.ones(n, bool)
        rows = np.flatnonzero(mask)
        for row in rows.tolist():
            if seeds[row] is not None or not self._seeded[row]:
                generator, used = seeding.np_random(seeds[row])
                self._tables.seed(row, generator)
                if row == 0:
                    self._np_random, self._np_random_seed = generator, used
        self._seeded[rows] = True
        self._tables.reset(rows, _cut(rest, mask))
        self._over[rows] = False
        return self._observe_all(), {}

    def step(self, actions: Any) -> _Step:
        if not self._seeded.all():
            raise gymnasium.error.ResetNeeded("call reset before step")
        over, mode = self._over, self.autoreset_mode
        if mode == AutoresetMode.DISABLED and over.any():
            again = 'call reset(options={"reset_mask": ...})'
            which = np.argmax(over)
            raise gymnasium.error.ResetNeeded(f"the episode of environment {which} is over; {again}")
        act = np.asarray(actions)
        if act.shape != self.action_space.shape:
            raise ValueError(f"actions: expected the shape {self.action_space.shape}, not {act.shape}")
        some_over = over.any()  # only with NEXT_STEP, which resets them here
        rows = np.flatnonzero(~over) if some_over else slice(None)
        reward = np.zeros(self.num_envs)
        terminated, truncated = np.zeros(self.num_envs, bool), np.zeros(self.num_envs, bool)
        infos: dict[str, Any] = {}
        if some_over:
            self._tables.reset(np.flatnonzero(over), None)
        if not over.all():
            played, info = self._tables.step(rows, act[rows])
            reward[rows], terminated[rows] = played.reward, played.terminated
            truncated[rows] = played.truncated
            ended = terminated | truncated
            if mode == AutoresetMode.SAME_STEP and ended.any():
                infos = self._same_step(played, info, ended)
            else:
                whole = {key: self._whole(rows, values) for key, values in info.items()}
                infos = self._infos(~over, whole, self._messages(rows, played))
        same_step = mode == AutoresetMode.SAME_STEP
        self._over = np.zeros(self.num_envs, bool) if same_step else terminated | truncated
        return self._observe_all(), reward, terminated, truncated, infos

    def render(self) -> tuple[Any, ...] | None:
        """The tables as they are, from above."""
        if self.render_mode is None:
            return None
        return tuple(self._options.picture(self._rules.game, xy) for xy in self._tables.states.xy)

    def _same_step(self, played: Rollout, info: dict[str, Any], ended: NDArray[np.bool_]) -> dict[str, Any]:
        """Resets the tables whose episode is over. Returns the info of the others, and how these ended."""
        said = played.shots.messages
        infos = {} if ended.all() else self._infos(~ended, info, said)
        last = self._observe_all()  # new arrays, so their rows need no copies
        final = np.full(self.num_envs, None, object)
        which = np.flatnonzero(ended)
        for table in which.tolist():
            final[table] = row(last, table)
        infos["final_obs"], infos["_final_obs"] = final, ended.copy()
        infos["final_info"], infos["_final_info"] = self._infos(ended, info, said), ended.copy()
        self._tables.reset(slice(None) if len(which) == self.num_envs else which, None)
        return infos

    def _infos(
        self, mask: NDArray[np.bool_], info: Mapping[str, NDArray[Any]], messages: Mapping[int, str]
    ) -> dict[str, Any]:
        """The info of the masked environments, in the form of `VectorEnv._add_info`.

        `info` and `messages` are those of all tables.
        """
        infos: dict[str, Any] = {}
        others = ~mask
        some = others.any()
        for key, values in info.items():
            if some:
                values = values.copy()
                values[others] = None if values.dtype == object else 0
            infos[key], infos[f"_{key}"] = values, mask.copy()
        told = [row for row in messages if mask[row]]
        if told:
            infos["message"] = np.full(self.num_envs, None, object)
            infos["_message"] = np.zeros(self.num_envs, bool)
            for row in told:
                infos["message"][row], infos["_message"][row] = messages[row], True
        return infos

    def _whole(self, rows: Any, values: NDArray[Any]) -> NDArray[Any]:
        """Spreads the values of some tables over an array for all of them."""
        if isinstance(rows, slice):
            return values
        whole = np.empty((self.num_envs, *values.shape[1:]), values.dtype)
        whole[rows] = values
        return whole

    def _messages(self, rows: Any, played: Rollout) -> dict[int, str]:
        """The shots' messages by table."""
        said = played.shots.messages
        return said if isinstance(rows, slice) else {int(rows[shot]): text for shot, text in said.items()}


def _mask(mask: Any, n: int) -> NDArray[np.bool_]:
    if not isinstance(mask, np.ndarray) or mask.dtype != np.bool_ or mask.shape != (n,) or not mask.any():
        wanted = f"an array of {n} bools with at least one True"
        raise ValueError(f"options: expected reset_mask to be {wanted}, not {mask!r}")
    return mask


def _cut(options: Mapping[str, Any], mask: NDArray[np.bool_]) -> dict[str, Any]:
    """Selects, from options with one value per environment, the values of those that are reset."""

    def each(key: str, value: Any) -> bool:
        return key != "scene" and np.ndim(value) == (3 if key == "xy" else 1)

    return {key: np.asarray(value)[mask] if each(key, value) else value for key, value in options.items()}
