#!/usr/bin/env python3
"""Steps of the environments per CPU second compared with plain batches of the same shots, in one process,
alternating.

A step of a vector with the autoreset mode SameStep plays a shot on every table, judges it, and draws and
observes a new layout. The plain batch is only `simulate_many` with arrays of the same strikes and positions.
The judged batch adds the game's judgement. All are CPU times of one thread. The rates are from the fastest
round. The ratios of the judged batch and of a step to the plain batch are medians over the rounds. --pooltool
adds an environment over pooltool 0.6.0 with the same actions and layouts on its own table and models, in a
temporary virtual environment (PyPI; see side_by_side_shots.py). Neither the build nor a test needs this
script.

    lab/measure/gym_speed.py [--package build/release/python] [--rounds 15] [--pooltool]

Needs gymnasium: run it with build/python-env/bin/python, created by tools/test.
"""
import argparse
import json
import os
import pathlib
import platform
import statistics
import subprocess
import sys
import time

import side_by_side_shots

ROOT = pathlib.Path(__file__).resolve().parents[2]
STEPS = 8
#: Shots of pooltool before the measurement.
WARM = 300


def timed(work):
    start = time.thread_time()
    work()
    return time.thread_time() - start


def vector(game, tables, rounds):
    """Steps of the vector and shots of the plain and the judged batch, per second; then two median ratios to
    the plain batch: the judged batch's and the vector's."""
    import carom
    import carom.gym

    env = carom.gym.make_vector_env(game, tables, autoreset_mode="SameStep")
    env.reset(seed=1)
    env.action_space.seed(1)
    game = env._rules.game
    rows = []
    for _ in range(rounds):
        actions = [env.action_space.sample() for _ in range(STEPS)]
        ours = plain = judged = 0.0
        for act in actions:
            states = env.states
            cue = env.rollout(states, act).cue
            ours += timed(lambda: env.step(act))
            plain += timed(lambda: carom.simulate_many(game.scene, cue=cue, xy=states.xy))
            judged += timed(lambda: game.play(states, cue, max_events=None, threads=1, hashes=False))
        rows.append((ours, plain, judged))
    count = tables * STEPS
    rates = [count / min(column) for column in zip(*rows)]
    of_judged = statistics.median(plain / judged for _, plain, judged in rows)
    return *rates, of_judged, statistics.median(plain / ours for ours, plain, _ in rows)


def single(game, rounds):
    """Steps per second of one environment, each including the reset after it."""
    import carom.gym

    env = carom.gym.make_env(game)
    env.reset(seed=1)
    env.action_space.seed(1)
    actions = [env.action_space.sample() for _ in range(200)]

    def play():
        for action in actions:
            _, _, terminated, truncated, _ = env.step(action)
            if terminated or truncated:
                env.reset()

    return len(actions) / min(timed(play) for _ in range(rounds))


def over_pooltool(shots):
    """Runs inside the environment: prints steps per second of a pooltool environment equivalent to Pot, after
    a warm-up that compiles it."""
    import numpy as np
    import pooltool as pt

    table = pt.Table.default()
    random = np.random.default_rng(1)
    width, length = float(table.w), float(table.l)

    def layout():
        while True:
            places = random.uniform([0.05, 0.05], [width - 0.05, length - 0.05], (2, 2))
            if np.hypot(*(places[0] - places[1])) > 0.06:
                return places

    def step(places, action):
        balls = {name: pt.Ball.create(name, xy=tuple(place)) for name, place in zip(("cue", "1"), places)}
        system = pt.System(cue=pt.Cue(cue_ball_id="cue"), table=pt.Table.default(), balls=balls)
        side, height = 0.5 * action[3:] / np.sqrt(2)
        system.cue.set_state(V0=3.15 + 2.85 * action[2],
                             phi=np.degrees(np.arctan2(action[1], action[0])) % 360, a=side, b=height)
        pt.simulate(system, inplace=True)
        fallen = [name for name, ball in system.balls.items() if ball.state.s == pt.constants.pocketed]
        reward = -1.0 if "cue" in fallen else float("1" in fallen)
        observed = np.array([ball.state.rvw[0, :2] for ball in system.balls.values()], np.float32)
        return observed, reward

    for _ in range(WARM):  # rare events, such as a pocketed ball, are compiled on their first occurrence
        step(layout(), random.uniform(-1, 1, 5))
    cpu = timed(lambda: [step(layout(), random.uniform(-1, 1, 5)) for _ in range(shots)])
    print(json.dumps(shots / cpu))


def pooltool_rate(shots):
    with side_by_side_shots.pooltool_environment() as python:
        out = subprocess.run([python, __file__, "--inside", "--shots", str(shots)], check=True,
                             capture_output=True, text=True).stdout
    return json.loads(out.strip().splitlines()[-1])


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "--package", default=str(ROOT / "build" / "release" / "python"), help="folder of the built package")
    parser.add_argument("--games", nargs="*", help="names of games to measure (default: all)")
    parser.add_argument("--rounds", type=int, default=15)
    parser.add_argument(
        "--pooltool", action="store_true",
        help="also measure an environment over pooltool 0.6.0; downloads some hundred megabytes")
    parser.add_argument("--shots", type=int, default=300, help="shots of pooltool (default: 300)")
    parser.add_argument("--inside", action="store_true", help=argparse.SUPPRESS)
    args = parser.parse_args()
    if args.inside:
        over_pooltool(args.shots)
        return
    sys.path.insert(0, args.package)
    model = next(
        (line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")),
        platform.machine())
    print(f"{model}, Python {platform.python_version()}, "
          f"CAROM_ISA={os.environ.get('CAROM_ISA', '(the widest)')}")
    print(f"{'game':<16}{'tables':>7}{'steps/s':>12}{'plain batch':>14}{'judged batch':>14}"
          "   medians of the ratios")
    import carom.gym

    for game in args.games or carom.gym.GAMES:
        for tables in (64, 256, 1024):
            ours, plain, judged, of_judged, of_step = vector(game, tables, args.rounds)
            print(f"{game:<16}{tables:>7}{ours:>10.0f}/s{plain:>12.0f}/s{judged:>12.0f}/s"
                  f"   {of_judged:.2f} {of_step:.2f}")
        print(f"{game:<16}{'one':>7}{single(game, args.rounds):>10.0f}/s")
    if args.pooltool:
        print(f"{'over pooltool':<16}{'one':>7}{pooltool_rate(args.shots):>10.0f}/s")


if __name__ == "__main__":
    main()
