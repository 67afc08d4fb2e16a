#!/usr/bin/env python3
"""Times whole shots of carom and pooltool 0.6.0 in one process, alternating shot by shot.

Makes a temporary virtual environment and installs pooltool-billiards 0.6.0 (PyPI, --no-deps: the panda3d that
it requires is not on PyPI) with its imports. Plays breaks and random positions of two, 8, 12 and 16 balls
with pooltool.simulate and, from the Python package in the build folder, with carom.simulate (plan and record
each time) and carom.simulate_many (one thread). Both play the same positions, aims and speeds on the
seven-foot table with the same coefficients and models: inelastic impacts with Alciatore's friction, Stronge's
cushion, sequential clusters. The last row compares the same breaks with each program's default models. CPU
time of the thread, median of five warm runs of either program. The first shots of pooltool, which compile it,
are not counted. FastFiz is not on PyPI (sources: github.com/ekiefl/FastFiz), so it is not compared.
Needs PyPI; neither the build nor a test needs this script.

    lab/measure/side_by_side_shots.py [--package build/release/python] [--shots 10]
"""
import argparse
import contextlib
import json
import os
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
NEEDED = ["numba<0.63", "numpy", "scipy", "attrs", "cattrs", "msgpack", "msgpack-numpy", "pyyaml", "panda3d",
          "h5py", "pillow", "rich", "click", "numpy-quaternion"]
ALONE = ["pooltool-billiards==0.6.0", "panda3d-simplepbr", "panda3d-gltf", "h11"]
RUNS = 5
DEFAULTS = """[table]
preset = "seven_foot"
[cue]
speed = {speed!r}
aim_deg = {aim!r}
offset = [0.0, 0.0]
"""
SCENE = """[table]
preset = "seven_foot"
[balls]
preset = "pool_classic"
mu_b_fit = [0.009951, 0.108, 1.088]
[physics]
ball_ball = "inelastic"
cushion = "stronge"
clusters = "sequential"
[cue]
preset = "lossless"
end_mass = 0.0
speed = {speed!r}
aim_deg = {aim!r}
offset = [0.0, 0.0]
"""
R = 0.028575


def positions(count, rng, width, length):
    """Balls anywhere on the table, without contact."""
    places = []
    while len(places) < count:
        p = (rng.uniform(2 * R, width - 2 * R), rng.uniform(2 * R, length - 2 * R))
        if all((p[0] - q[0]) ** 2 + (p[1] - q[1]) ** 2 > (2.1 * R) ** 2 for q in places):
            places.append(p)
    return {"cue" if i == 0 else str(i): p for i, p in enumerate(places)}


def scene_of(shot, text):
    import carom

    balls = "".join(
        f"[[ball]]\nid = \"{name}\"\nposition = [{x!r}, {y!r}]\n" for name, (x, y) in shot["balls"].items())
    return carom.Scene.loads(text.format(**shot) + balls, "shot")


def warm(run):
    """Median seconds of the warm runs, and the last result."""
    times = []
    for i in range(RUNS + 1):
        start = time.thread_time()
        result = run()
        if i > 0:
            times.append(time.thread_time() - start)
    return statistics.median(times), result


def one(shot, text):
    """Seconds and events."""
    import carom

    scene = scene_of(shot, text)
    seconds, record = warm(lambda: carom.simulate(scene))
    return seconds, len(record.events)


def many(shots, text):
    """Seconds per shot of a batch with all of them, repeated forty times."""
    import carom
    import numpy as np

    scene = scene_of(shots[0], text)
    xy = np.tile([[place for place in s["balls"].values()] for s in shots], (40, 1, 1))
    params = {key: np.tile([s[name] for s in shots], 40) for key,
              name in (("cue.speed", "speed"), ("cue.aim_deg", "aim"))}
    seconds, batch = warm(lambda: carom.simulate_many(scene, xy=xy, params=params))
    if batch.status.max() > carom.ShotStatus.ENDLESS:
        raise RuntimeError("a shot of the batch has no result")
    return seconds / len(xy)


def compare(count):
    """Runs inside the environment."""
    import pooltool as pt

    table = pt.Table.default()
    rng = random.Random(1)
    kinds = {}
    for balls in (2, 8, 12, 16):
        kinds[f"{balls} balls"] = [{"balls": positions(balls, rng, float(table.w), float(table.l)),
                                    "speed": rng.uniform(1, 6),
                                    "aim": rng.uniform(0, 360)} for _ in range(count)]
    kinds["eight-ball break"] = []
    for _ in range(count):
        rack = pt.get_rack(pt.GameType.EIGHTBALL, table)
        balls = {name: (float(b.xyz[0]), float(b.xyz[1])) for name, b in rack.items()}
        kinds["eight-ball break"].append(
            {"balls": balls, "speed": rng.uniform(6, 8), "aim": 90.0 + rng.uniform(-0.5, 0.5)})

    def theirs(shot):
        def system():
            balls = {name: pt.Ball.create(name, xy=xy) for name, xy in shot["balls"].items()}
            made = pt.System(cue=pt.Cue(cue_ball_id="cue"), table=pt.Table.default(), balls=balls)
            made.cue.set_state(V0=shot["speed"], phi=shot["aim"])
            return made

        # A copy made by pooltool would count.
        systems = [system() for _ in range(RUNS + 1)]
        seconds, played = warm(lambda: pt.simulate(systems.pop(), inplace=True))
        return seconds, len(played.events)

    for shots in kinds.values():
        theirs(shots[0])  # compiles
    out = []
    rows_of = [(kind, shots, SCENE) for kind, shots in kinds.items()]
    rows_of.append(("break, default models", kinds["eight-ball break"], DEFAULTS))
    for kind, shots, text in rows_of:
        rows = [(theirs(shot), one(shot, text)) for shot in shots]
        out.append({"kind": kind, "theirs_ms": 1e3 * statistics.median(t[0] for t, _ in rows),
                    "ours_ms": 1e3 * statistics.median(o[0] for _, o in rows),
                    "ratio": statistics.median(t[0] / o[0] for t, o in rows),
                    "many_ms": 1e3 * many(shots, text),
                    "theirs_events": statistics.median(t[1] for t, _ in rows),
                    "ours_events": statistics.median(o[1] for _, o in rows)})
    print(json.dumps(out))


@contextlib.contextmanager
def pooltool_environment():
    """The Python of a throw-away environment with pooltool 0.6.0."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["/usr/bin/python3", "-m", "venv", folder], check=True)
        python = os.path.join(folder, "bin", "python")
        pip = [python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
        subprocess.run(pip + NEEDED, check=True)
        subprocess.run(pip + ["--no-deps"] + ALONE, check=True)
        yield python


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "--package", default=str(ROOT / "build" / "release" / "python"), help="folder of the built package")
    parser.add_argument("--shots", type=int, default=10, help="of each kind (default: 10)")
    parser.add_argument("--inside", action="store_true", help=argparse.SUPPRESS)
    args = parser.parse_args()
    if args.inside:
        compare(args.shots)
        return
    with pooltool_environment() as python:
        out = subprocess.run([python, __file__, "--inside", "--shots", str(args.shots)], check=True,
                             capture_output=True, text=True, env={
                                 **os.environ, "PYTHONPATH": args.package,
                                 "CAROM_ISA": os.environ.get("CAROM_ISA", "v3")}).stdout
    print(f"{'':<23}{'pooltool':>12}{'carom':>12}{'ratio':>8}{'in a batch':>12}   events, "
          "theirs and ours (medians)")
    for row in json.loads(out.strip().splitlines()[-1]):
        print(f"{row['kind']:<23}{row['theirs_ms']:>9.2f} ms{row['ours_ms']:>9.4f} "
              f"ms{row['ratio']:>8.0f}{row['many_ms']:>9.4f} ms"
              f"   {row['theirs_events']:.0f}, {row['ours_events']:.0f}")


if __name__ == "__main__":
    main()
