#!/usr/bin/env python3
"""Learns eight numbers of a simple player of eight-ball from games against a level of `carom advise`.

    python examples/learning/opponent.py [--level beginner] [--rounds 4] [--seed 1]

The learner aims at a ghost ball. The numbers say which pot it prefers, how hard it strikes, and where it
places a cue ball in hand. They come from the cross-entropy method: draw them, keep the best, draw anew around
these. It takes two minutes on one core.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from typing import Any

import numpy as np
from carom.gym import match
from numpy.typing import NDArray

Array = NDArray[np.float64]
#: [m] From the middle of the table to its rails, the pockets, and the diameter of a ball.
HALF = np.array([0.635, 1.27])
POCKETS = HALF * [(x, y) for x in (-1, 1) for y in (-1, 0, 1)]
DIAMETER = 0.05715
#: Candidates of a round, and how many of them the next round is drawn around.
CANDIDATES, BEST = 40, 10


def blocked(start: Array, ends: Array, others: Array) -> Array:
    """How many of the other balls a ball would touch from `start` to each of the ends."""
    ways = ends - start
    to = others - start
    share = np.clip(to @ ways.T / np.sum(ways**2, axis=1), 0, 1)
    apart = np.linalg.norm(to[:, None] - share[:, :, None] * ways, axis=2)
    return np.asarray(np.sum(apart < 0.95 * DIAMETER, axis=0))


def act(seen: dict[str, Any], numbers: Array) -> NDArray[np.float32]:
    """The action of the learner: the easiest pot, as its numbers judge."""
    if seen["phase"] == 1:
        return np.tanh([*numbers[6:8], 0, 0, 0]).astype(np.float32)
    places, legal = seen["balls"][:, :2] * HALF, np.flatnonzero(seen["legal"])
    there = np.flatnonzero(seen["balls"][1:, 2]) + 1
    best, easiest = np.zeros(5), -np.inf
    for k, ball in enumerate(legal):
        to_pocket = POCKETS - places[ball]
        far = np.linalg.norm(to_pocket, axis=1)
        ghosts = places[ball] - DIAMETER * to_pocket / far[:, None]
        to_ghost = ghosts - places[0]
        near = np.linalg.norm(to_ghost, axis=1)
        straight = np.sum(to_pocket * to_ghost, axis=1) / (far * near)
        others = places[there[there != ball]]
        ways = blocked(places[0], ghosts, others) + blocked(places[ball], POCKETS, others)
        ease = numbers[:4] @ [straight, -far, -near, -ways]
        ease[straight < 0.2] = -np.inf
        pocket = int(np.argmax(ease))
        if ease[pocket] > easiest:
            easiest = ease[pocket]
            to_ball = places[ball] - places[0]
            cross = to_ball[0] * to_ghost[pocket, 1] - to_ball[1] * to_ghost[pocket, 0]
            aside = cross / (near[pocket] * DIAMETER)
            speed = numbers[4] + numbers[5] * (far[pocket] + near[pocket])
            best = np.array([2 * (k + 0.5) / len(legal) - 1, aside, speed, 0, 0])
    return np.clip(best, -1, 1).astype(np.float32)


def play(level: str, numbers: Array, seed: int) -> tuple[bool, float]:
    """Whether the learner wins, and a score: 1 for the game and up to 1 for the balls that are left."""
    env = match.env("EightBall", opponent=level, aim="ball", noise="fastfiz", most_shots=120)
    env.reset(seed=seed)
    while not any(env.terminations.values()) and not any(env.truncations.values()):
        env.step(act(env.observe("player_0"), numbers))
    state = env.state_of_the_game
    left = np.array([np.sum(env.observe("player_0")["balls"][n : n + 7, 2]) for n in (1, 9)])
    if state.group[0] == "stripes":
        left = left[::-1]
    return state.winner == 0, float(state.winner == 0) + (left[1] - left[0]) / 14 + 0.5


def won(level: str, numbers: Array, games: int, seed: int) -> float:
    return float(np.mean([play(level, numbers, seed + k)[0] for k in range(games)]))


def learn(level: str, rounds: int, seed: int) -> Array:
    random = np.random.default_rng(seed)
    mean, spread = np.zeros(8), np.full(8, 0.7)
    for n in range(rounds):
        drawn = mean + spread * random.standard_normal((CANDIDATES, 8))
        # One game says little of a candidate, but the mean of the best forgets most of the luck.
        scores = [play(level, numbers, seed + CANDIDATES * n + k)[1] for k, numbers in enumerate(drawn)]
        kept = drawn[np.argsort(scores)[-BEST:]]
        mean, spread = kept.mean(0), kept.std(0) + 0.1
        print(f"round {n + 1}: score {np.mean(scores):.2f}", flush=True)
    return mean


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--level", default="beginner", help="the opponent")
    parser.add_argument("--rounds", type=int, default=4)
    parser.add_argument("--test", type=int, default=40, help="games of the test, on racks not used to learn")
    parser.add_argument("--seed", type=int, default=1)
    asked = parser.parse_args(arguments)
    unseen = 2**31 + asked.seed
    before = won(asked.level, np.zeros(8), asked.test, unseen)
    numbers = learn(asked.level, asked.rounds, asked.seed)
    after = won(asked.level, numbers, asked.test, unseen)
    print(f"won against {asked.level}: {before:.2f} at first, {after:.2f} after {asked.rounds} rounds")


if __name__ == "__main__":
    main()
