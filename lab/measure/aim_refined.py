#!/usr/bin/env python3
"""Compares two methods of aiming a pot: carom.games.aim_pot, which plays aims between two that bracket the
right one, and Newton's method with the shot's derivative. The table of lab/notes/2026-11-tangents.md.

Random places of two balls, speeds and tips; every pocket open within 70 degrees of cut is a pot. Newton
starts at the ghost ball, like aim_pot, and stops at the same distance from the middle of the paths. A third
method then turns the aim to the middle of the window in which the ball still falls.

    PYTHONPATH=build/release/python lab/measure/aim_refined.py [--pots 200] [--noisy 400] [--seed 1]
"""
import argparse

import carom
import numpy as np
from carom import games

NEAR = 1e-3  # of the paths' width, as in games/src/aim_play.cpp
STEPS = 12


def layout(random):
    while True:
        place = lambda: [0.05 + 1.17 * random.uniform(), 0.05 + 2.44 * random.uniform()]
        cue, one = place(), place()
        if np.hypot(cue[0] - one[0], cue[1] - one[1]) > 0.15:
            break
    strike = {"ball": "cue", "speed": 2.5 + 2.0 * random.uniform(),
              "offset": [0.5 * (random.uniform() - 0.5), 0.5 * (random.uniform() - 0.5)]}
    return {"table": "nine_foot", "ball": [{"id": "cue", "position": cue}, {"id": "1", "position": one}],
            "cue": strike}


def scene_at(base, aim_deg):
    return carom.Scene(**{**base, "cue": {**base["cue"], "aim_deg": aim_deg}})


def falls(base, aims, pocket):
    cue = base["cue"]
    rows = np.array([[cue["speed"], aim, 0.0, *cue["offset"]] for aim in np.atleast_1d(aims)])
    return carom.simulate_many(scene_at(base, 0.0), cue=rows).pocket[:, 1] == int(pocket[1:]) - 1


def newton(base, line, start):
    """The aim that sends ball 1 down the middle of its paths, or None; and the number of shots played."""
    towards, middle = np.array(line.towards), np.array(base["ball"][1]["position"])
    aim, near = start, NEAR * np.radians(line.width_deg)
    for shots in range(1, STEPS + 1):
        record = carom.simulate(scene_at(base, aim))
        met = [event.time for event in record.event_list() if event.type == "ball_ball"]
        if not met:
            return None, shots, "misses the ball"
        stops = [event.time for event in record.event_list()
                 if event.time > met[0] and "1" in (event.a, event.b) and event.type.startswith("ball_")]
        # Just before its next contact.
        time = met[0] + 0.999 * ((stops[0] if stops else record.duration) - met[0])
        way = record.states(time)[1, 0, :2] - middle
        off = (towards[0] * way[1] - towards[1] * way[0]) / np.hypot(*way)
        if abs(off) <= near:
            return aim, shots, ""
        try:
            slope = record.jacobian(["cue.aim_deg"], time)[1, 0, :2, 0]
        except ValueError as error:
            return None, shots, str(error)
        by = (towards[0] * slope[1] - towards[1] * slope[0]) / np.hypot(*way)
        aim -= np.clip(off / by, -2.0, 2.0)
    return None, STEPS, "no end"


def middle_of_window(base, aim, pocket):
    """The middle of the potting aims, by bisection outwards from `aim`."""
    ends = []
    for side in (-1.0, 1.0):
        inside, outside = 0.0, 0.02
        while outside < 10.0 and falls(base, aim + side * outside, pocket)[0]:
            inside, outside = outside, 2.0 * outside
        for _ in range(8):
            half = 0.5 * (inside + outside)
            inside, outside = (half, outside) if falls(base, aim + side * half, pocket)[0] else (inside, half)
        ends.append(side * inside)
    return aim + 0.5 * sum(ends)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pots", type=int, default=200)
    parser.add_argument("--noisy", type=int, default=400)
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()
    random = np.random.default_rng(args.seed)
    names = ("aim_pot", "Newton", "window")
    found, shots = dict.fromkeys(names, 0), dict.fromkeys(names, 0)
    potted, both, whys, pots = {name: [] for name in names}, 0, {}, 0
    hand = carom.Hand()
    while pots < args.pots:
        base = layout(random)
        played = scene_at(base, 0.0)
        for line in games.pocket_lines(played, "1"):
            helped = games.aim_pot(played, "1", line.pocket)
            if not line.open or helped.cut_deg > 70.0 or line.distance > 1.8 or pots == args.pots:
                continue
            pots += 1
            refined, steps, why = newton(base, line, helped.geometric_deg)
            if refined is not None and not falls(base, refined, line.pocket)[0]:
                refined, why = None, "runs towards the pocket but does not fall"
            if why:
                whys[why] = whys.get(why, 0) + 1
            best = None if helped.aim_deg is None else middle_of_window(base, helped.aim_deg, line.pocket)
            for name, aim, count in (("aim_pot", helped.aim_deg, helped.shots), ("Newton", refined, steps),
                                     ("window", best, 0)):
                found[name] += aim is not None
                shots[name] += count if aim is not None else 0
            if helped.aim_deg is None or refined is None:
                continue
            both += 1
            n, cue = args.noisy, base["cue"]
            error = random.standard_normal((n, 4))
            for name, aim in (("aim_pot", helped.aim_deg), ("Newton", refined), ("window", best)):
                rows = np.column_stack([cue["speed"] * (1 + hand.speed * error[:, 0]),
                                        aim + hand.aim_deg * error[:, 1], np.zeros(n),
                                        cue["offset"][0] + hand.tip * error[:, 2],
                                        cue["offset"][1] + hand.tip * error[:, 3]])
                result = carom.simulate_many(played, cue=rows, threads=2)
                potted[name].append((result.pocket[:, 1] == int(line.pocket[1:]) - 1).mean())
    print(f"{pots} pots; {both} found by both, each played {args.noisy} times with {hand}")
    for name in names:
        each = shots[name] / max(1, found[name])
        print(f"{name:8} found {found[name]}, {each:.1f} shots each, potted under noise "
              f"{np.mean(potted[name]):.4f}")
    for name in names[1:]:
        apart = np.array(potted[name]) - np.array(potted["aim_pot"])
        print(f"{name} minus aim_pot: {apart.mean():+.5f} +- {apart.std() / np.sqrt(both):.5f}, "
              f"better in {int((apart > 0).sum())}, worse in {int((apart < 0).sum())}")
    print("Newton found none:", whys)


if __name__ == "__main__":
    main()
