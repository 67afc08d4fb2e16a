#!/usr/bin/env python3
"""Measures the agreement of carom and pooltool 0.6.0 on the same Systems, and whether pooltool plays files
written by carom.io.pooltool.save.

Plays random shots of two and three balls with pooltool and saves them as JSON. Then compares, with the Python
package in the build folder, single impacts (the file has the states before and after each), whole shots after
carom.io.pooltool.load, and pooltool's continuize() of every scene in scenes/ that save writes with the states
of the record. Needs PyPI, or with --python an interpreter that has pooltool; neither the build nor a test
needs this script.

    lab/measure/pooltool_parity.py [--package build/release/python] [--shots 20] [--python PYTHON]
"""
import argparse
import glob
import json
import os
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile

from side_by_side_shots import ALONE, NEEDED, positions

ROOT = pathlib.Path(__file__).resolve().parents[2]
R = 0.028575


def play(folder, count):
    """Runs with pooltool: plays the shots and saves them."""
    import pooltool as pt

    rng = random.Random(1)
    table = pt.Table.default()
    for i in range(count):
        places = positions(2 + i % 2, rng, float(table.w), float(table.l))
        balls = {name: pt.Ball.create(name, xy=xy) for name, xy in places.items()}
        # Aimed straight enough to hit the first ball.
        to = [b - a for a, b in zip(places["cue"], places["1"])]
        system = pt.System(cue=pt.Cue(cue_ball_id="cue"), table=pt.Table.default(), balls=balls)
        aim = pt.ptmath.angle(__import__("numpy").array([*to, 0.0])) * 180 / 3.141592653589793
        system.cue.set_state(V0=rng.uniform(0.8, 3.0), phi=aim + rng.uniform(-2, 2), a=rng.uniform(-0.3, 0.3),
                             b=rng.uniform(-0.3, 0.3), theta=0)
        pt.simulate(system, inplace=True)
        system.save(os.path.join(folder, f"shot{i:03d}.json"))


def continuize(folder):
    """Runs with pooltool: the largest distance between its dense history and the states written by carom."""
    import numpy as np
    import pooltool as pt

    out = {}
    for path in sorted(glob.glob(os.path.join(folder, "system_*.json"))):
        states = np.load(path.replace(".json", ".npz"))
        system = pt.continuize(pt.System.load(path), dt=0.01)
        worst = {"planar": 0.0, "flying or falling": 0.0}
        for i, ball in enumerate(system.balls.values()):
            for k in range(min(len(ball.history_cts), len(states["rvw"]))):
                off = float(np.linalg.norm(ball.history_cts[k].rvw[0] - states["rvw"][k, i, 0]))
                kind = "flying or falling" if states["beyond"][k, i] else "planar"
                worst[kind] = max(worst[kind], off)
        out[os.path.basename(path)[7:-5]] = worst
    print(json.dumps(out))


def impacts(system):
    """The differences between carom's and pooltool's impacts, in m/s, of velocities and R times spin, by kind
    of impact."""
    import carom
    import numpy as np

    found = {"two balls": [], "two balls, friction as in carom": [], "two balls, where they were before": [],
             "cushion": [], "cushion, normal as in pooltool": [], "jaw": [], "jaw, normal as in pooltool": []}
    for event in system["events"]:
        agents = [agent for agent in event["agents"] if agent["agent_type"] == "ball"]
        before, after = (
            np.array([agent[which]["state"]["rvw"] for agent in agents]) for which in ("initial", "final"))
        if event["event_type"] == "ball_ball":
            e = agents[0]["initial"]["params"]["e_b"]
            for name, places, scale in (("two balls", after, 2 * e / (1 + e)),
                                        ("two balls, friction as in carom", after, 1.0),
                                        ("two balls, where they were before", before, 2 * e / (1 + e))):
                states = before.copy()
                states[:, 0] = places[:, 0]
                n = states[1, 0] - states[0, 0]
                n /= np.linalg.norm(n)
                slip = states[0, 1] - states[1, 1] + np.cross(R * (states[0, 2] + states[1, 2]), n)
                slip = np.linalg.norm(slip - n * (slip @ n))
                ours = carom.kernel.ball_ball(
                    states, model="inelastic", mu_b=scale * (0.009951 + 0.108 * np.exp(-1.088 * slip)), e_b=e)
                found[name].append(
                    float(max(np.abs(ours - after)[:, 1, :2].max(), R * np.abs(ours - after)[:, 2].max())))
        elif event["event_type"] in ("ball_linear_cushion", "ball_circular_cushion"):
            nose = event["agents"][1]["initial"]
            straight = "p1" in nose
            x1, y1, height = nose["p1"] if straight else nose["center"]
            normal = before[0, 0, :2] - [x1, y1]
            if straight:
                normal = np.array([nose["p2"][1] - y1, x1 - nose["p2"][0]])
            normal /= np.linalg.norm(normal)
            normal *= np.sign(normal @ (before[0, 0, :2] - [x1, y1]))
            params = agents[0]["initial"]["params"]
            # pooltool's normal at a jaw points from the centre of its circle, and its ball is 1e-6 m away.
            lever = R + 1e-6 + (0.0 if straight else nose["radius"])
            for name, nose_height in (
                ("cushion", height), ("cushion, normal as in pooltool", R + (height - R) * R / lever)
            ):
                ours = carom.kernel.ball_cushion(before[0], normal, model="stronge", e_c=params["e_c"],
                                                 f_c=params["f_c"], height=nose_height)
                name = name if straight else name.replace("cushion", "jaw")
                found[name].append(
                    float(max(np.abs(ours - after[0])[1, :2].max(), R * np.abs(ours - after[0])[2].max())))
    return found


def compare(folder):
    """Differences of the files: impacts, event times, ends."""
    import carom
    import numpy as np
    from carom.io import pooltool

    all_impacts, rows = {}, []
    for path in sorted(glob.glob(os.path.join(folder, "shot*.json"))):
        with open(path) as file:
            system = json.load(file)
        for name, values in impacts(system).items():
            all_impacts.setdefault(name, []).extend(values)
        record = carom.simulate(pooltool.load(path))
        theirs = [event for event in system["events"] if event["event_type"] != "none"]
        ours = record.event_list()
        end = record.states(record.duration)
        ends = np.array([system["balls"][name]["state"]["rvw"][0] for name in record.ids])
        off = float(np.linalg.norm((end[:, 0] - ends)[:, :2], axis=1).max())
        same = [len(a.b) == 0 or a.type[:5] == b["event_type"][:5] for a, b in zip(ours, theirs)]
        later = max((abs(a.time - b["time"]) for a, b in zip(ours, theirs)), default=0.0)
        jaws = any(event["event_type"] == "ball_circular_cushion" for event in theirs)
        rows.append((len(ours) == len(theirs) and all(same), later, off, jaws))
    print(f"{'an impact by itself':<36}{'number':>8}{'median m/s':>12}{'largest':>12}")
    for name, values in all_impacts.items():
        print(f"{name:<36}{len(values):>8}{statistics.median(values):>12.1e}{max(values):>12.1e}")
    print(f"\n{len(rows)} shots; the same events in {sum(row[0] for row in rows)}")
    for name, part in (
        ("without a jaw", [r for r in rows if not r[3]]), ("with a jaw", [r for r in rows if r[3]])
    ):
        if part:
            print(f"{name}: {len(part)} shots; ends apart by {statistics.median(r[2] for r in part):.1e} m "
                  f"(median), {max(r[2] for r in part):.1e} m (most); "
                  f"event times by {statistics.median(r[1] for r in part):.1e} s (median)")


def write_records(folder):
    import carom
    import numpy as np
    from carom.io import pooltool

    for path in sorted((ROOT / "scenes").glob("*.toml")):
        record = carom.simulate(carom.Scene.load(path))
        try:
            pooltool.save(record, os.path.join(folder, f"system_{path.stem}.json"))
        except ValueError as error:
            print(error)
            continue
        times = np.arange(0.0, record.duration, 0.01)
        beyond = np.isin(
            record.motion(times), [record.MOTIONS.index(name) for name in ("falling", "airborne", "out")])
        np.savez(os.path.join(folder, f"system_{path.stem}.npz"), rvw=record.states(times), beyond=beyond)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "--package", default=str(ROOT / "build" / "release" / "python"), help="folder of the built package")
    parser.add_argument("--shots", type=int, default=20, help="default: 20")
    parser.add_argument(
        "--python", help="an interpreter that has pooltool; else a throw-away environment is made")
    parser.add_argument("--inside", nargs=2, help=argparse.SUPPRESS)
    args = parser.parse_args()
    if args.inside:
        play(args.inside[1], args.shots) if args.inside[0] == "play" else continuize(args.inside[1])
        return
    sys.path.insert(0, args.package)
    with tempfile.TemporaryDirectory() as folder:
        python = args.python
        if python is None:
            subprocess.run(["/usr/bin/python3", "-m", "venv", f"{folder}/env"], check=True)
            python = f"{folder}/env/bin/python"
            pip = [python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
            subprocess.run(pip + NEEDED, check=True)
            subprocess.run(pip + ["--no-deps"] + ALONE, check=True)
        inside = [python, __file__, "--shots", str(args.shots), "--inside"]
        subprocess.run([*inside, "play", folder], check=True)
        compare(folder)
        write_records(folder)
        out = subprocess.run(
            [*inside, "continuize", folder], check=True, capture_output=True, text=True).stdout
        print(f"\n{'pooltool beside the record, m':<32}{'planar':>10}{'flying or falling':>20}")
        for name, worst in json.loads(out.strip().splitlines()[-1]).items():
            print(f"{name:<32}{worst['planar']:>10.1e}{worst['flying or falling']:>20.1e}")


if __name__ == "__main__":
    main()
