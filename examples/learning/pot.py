#!/usr/bin/env python3
"""Trains an agent to pot a ball, with PPO from stable-baselines3, and compares its pots with a random
player's.

    pip install stable-baselines3
    python examples/learning/pot.py [--steps 400000] [--seed 1] [--shots 4000] [--model pot_model]
                                    [--report pot.json] [--picture pot.png]

It takes a minute on one core. docs/guide/learning.md explains it.
"""

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Callable, Sequence
from typing import Any

import carom.gym
import numpy as np
from numpy.typing import NDArray

try:
    import torch  # type: ignore[import-not-found, unused-ignore]
    from stable_baselines3 import PPO  # type: ignore[import-not-found, unused-ignore]
    from stable_baselines3.common.vec_env import VecEnv  # type: ignore[import-not-found, unused-ignore]
except ImportError as missing:
    raise SystemExit(f"{missing}: pip install stable-baselines3") from missing

Actions = NDArray[np.float32]
#: How actions become strikes: aimed at the ball, so that the agent learns how full to hit it, and at moderate
#: speed.
OPTIONS: dict[str, Any] = {"aim": "ball", "speed": (1.0, 4.0)}


class Tables(VecEnv):  # type: ignore[misc, unused-ignore]  # without stable-baselines3 it has no type
    """A batch of tables in the form that stable-baselines3 needs, which does not accept Gymnasium's
    vectors."""

    def __init__(self, tables: int, seed: int) -> None:
        self.env = carom.gym.make_vector_env("Pot", tables, autoreset_mode="SameStep", **OPTIONS)
        super().__init__(tables, self.env.single_observation_space, self.env.single_action_space)
        self.first_seed: int | None = seed
        self.actions = np.empty(0, np.float32)

    def reset(self) -> NDArray[np.float32]:
        observations, _ = self.env.reset(seed=self.first_seed)
        self.first_seed = None
        return np.asarray(observations)

    def step_async(self, actions: Actions) -> None:
        self.actions = actions

    def step_wait(
        self
    ) -> tuple[NDArray[np.float32], NDArray[np.float64], NDArray[np.bool_], list[dict[str, Any]]]:
        observations, rewards, terminated, truncated, infos = self.env.step(self.actions)
        over = terminated | truncated
        rows: list[dict[str, Any]] = [{} for _ in over]
        for row in np.flatnonzero(over).tolist():
            rows[row] = {
                "terminal_observation": infos["final_obs"][row], "TimeLimit.truncated": bool(truncated[row])}
        return observations, rewards, over, rows

    def close(self) -> None:
        self.env.close()

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        return [getattr(self.env, attr_name)] * self.num_envs

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        setattr(self.env, attr_name, value)

    def env_method(self, method_name: str, *arguments: Any, indices: Any = None, **named: Any) -> list[Any]:
        return [getattr(self.env, method_name)(*arguments, **named)] * self.num_envs

    def env_is_wrapped(self, wrapper_class: Any, indices: Any = None) -> list[bool]:
        return [False] * self.num_envs


def score(act: Callable[[NDArray[np.float32]], Actions], shots: int, seed: int) -> dict[str, float]:
    """The fraction of `shots` layouts that a player pots, and its 95 % confidence interval (Wilson)."""
    env = carom.gym.make_vector_env("Pot", shots, autoreset_mode="Disabled", **OPTIONS)
    observations, _ = env.reset(seed=seed)
    _, rewards, *_ = env.step(act(observations))
    part, z = float((rewards > 0).mean()), 1.96
    middle = (part + z * z / (2 * shots)) / (1 + z * z / shots)
    wide = z * math.sqrt(part * (1 - part) / shots + z * z / (4 * shots * shots)) / (1 + z * z / shots)
    return {"potted": part, "low": middle - wide, "high": middle + wide, "reward": float(rewards.mean()),
            "shots": shots}


def train(steps: int, seed: int) -> Any:
    """The model. An episode is one shot, so nothing is discounted."""
    torch.set_num_threads(1)
    model = PPO(
        "MlpPolicy",
        Tables(256, seed),
        n_steps=16,
        batch_size=512,
        n_epochs=8,
        learning_rate=3e-4,
        ent_coef=0.0,
        policy_kwargs={"net_arch": [128, 128], "log_std_init": -0.7},
        seed=seed,
        device="cpu",
        verbose=1,
    )
    return model.learn(steps, log_interval=10)


def picture(model: Any, path: str) -> None:
    """Draws nine new layouts, one after the other, and the agent's shots on them."""
    import carom.plot
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(3, 3, figsize=(12, 7.5))
    env = carom.gym.make_env("Pot", **OPTIONS)
    for seed, axis in enumerate(axes.flat):
        observation, _ = env.reset(seed=1000 + seed)
        _, reward, *_ = env.step(model.predict(observation, deterministic=True)[0])
        carom.plot.table(env.record(), ax=axis)
        axis.set_title({1.0: "potted", 0.0: "missed"}.get(reward, "foul"))
        axis.set_axis_off()
    figure.tight_layout()
    figure.savefig(path, dpi=80, metadata={"Software": None})


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--steps", type=int, default=400_000, help="shots to learn from")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--shots", type=int, default=4000,
                        help="shots to count pots in, on layouts not used for learning")
    parser.add_argument("--model", help="write the model to this .zip file")
    parser.add_argument("--report", help="write the figures to this .json file")
    parser.add_argument("--picture", help="draw nine shots to this file; needs matplotlib")
    asked = parser.parse_args(arguments)
    random = np.random.default_rng(asked.seed)
    unseen = 2**31 + asked.seed
    by_chance = score(
        lambda seen: random.uniform(-1, 1, (len(seen), 5)).astype(np.float32), asked.shots, unseen)
    print(f"random:  {by_chance['potted']:.3f} potted", flush=True)
    model = train(asked.steps, asked.seed)
    trained = score(lambda seen: np.asarray(model.predict(seen, deterministic=True)[0]), asked.shots, unseen)
    print(f"trained: {trained['potted']:.3f} potted, between {trained['low']:.3f} and {trained['high']:.3f}")
    if asked.model:
        model.save(asked.model)
    if asked.report:
        report = {"random": by_chance, "trained": trained, "steps": asked.steps, "seed": asked.seed}
        with open(asked.report, "w", encoding="utf-8") as file:
            json.dump(report, file, indent=1)
    if asked.picture:
        picture(model, asked.picture)


if __name__ == "__main__":
    main()
