"""A cut shot built in code, without a scene file: plays it, prints its events, and searches for a better aim.

python3 shot.py      # needs the package: pip install carom-billiards, or pip install . in a clone
"""

import sys

import carom
import numpy as np


def cut_shot() -> carom.Scene:
    return carom.Scene(
        table="nine_foot",
        balls="pool",
        ball=[{"id": "cue", "position": [0.635, 0.60]}, {"id": "1", "position": [0.65, 1.40]}],  # m
        cue={"speed": 3.0, "aim_deg": 90.0, "offset": [0.1, 0.0]},  # m/s; left of the centre, in ball radii
    )


def best_aim(scene: carom.Scene, ball: str) -> tuple[float, float]:
    """The aim [degrees] in the middle of the widest range that pots the ball, and the width of that range."""
    aims = np.linspace(80.0, 100.0, 20_001)
    shots = carom.simulate_many(scene, params={"cue.aim_deg": aims}, threads=0)
    potted = shots.pocket[:, scene.ids.index(ball)] >= 0
    edges = np.flatnonzero(np.diff(np.concatenate([[False], potted, [False]])))
    if len(edges) == 0:
        raise ValueError(f"no aim pots ball {ball}")
    starts, ends = edges[::2], edges[1::2] - 1
    widest = int(np.argmax(ends - starts))
    low, high = float(aims[starts[widest]]), float(aims[ends[widest]])
    return (low + high) / 2, high - low


def main() -> int:
    try:
        scene = cut_shot()
        record = carom.simulate(scene)
        for event in record.event_list():
            print(f"{event.time:9.6f} s  {event.type:<14} {event.a} {event.b}")
        for ball, state in zip(record.ids, record.states(record.duration)):
            print(f"{ball} ends at ({state[0, 0]:.4f}, {state[0, 1]:.4f}) m")
        aim, width = best_aim(scene, "1")
        print(f"aim at {aim:.3f} degrees to pot ball 1; {width:.3f} degrees wide")
    except (carom.SceneError, carom.SimulationError) as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
