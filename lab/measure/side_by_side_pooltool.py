#!/usr/bin/env python3
"""Times the numba original and carom's impact in one run.

Makes a temporary virtual environment, installs pooltool-billiards 0.6.0 (PyPI, --no-deps) with the imports of
its impact function, and times pooltool.physics.resolve.ball_ball.frictional_mathavan.collide_balls on the
paper's five states, alternating with `carom-lab bench kernel`. Needs PyPI; neither the build nor a test needs
this script.

    lab/measure/side_by_side_pooltool.py [--carom build/release/carom-lab] [--rounds 3]
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
STATES = ROOT / "tests" / "data" / "kernel" / "paper_states.json"
NEEDED = ["numba<0.63", "numpy", "scipy", "attrs"]


def time_original():
    """Runs inside the environment: ns per impact, and the largest difference from the published results."""
    import importlib.util
    import time
    import types

    # The package imports its graphical interface, which this module does not need. So packages are imported
    # without their __init__, and dummies replace names used only by the classes around the function.
    class Name(type):
        def __getattr__(cls, name):
            if name.startswith("__"):
                raise AttributeError(name)
            return name

    class Absent(types.ModuleType):
        def __getattr__(self, name):
            if name.startswith("__"):
                raise AttributeError(name)
            return Name(name, (), {"__init__": lambda self, *args, **named: None})

    base = pathlib.Path(importlib.util.find_spec("pooltool").submodule_search_locations[0])
    for package in (
        "pooltool", "pooltool.physics", "pooltool.physics.resolve", "pooltool.physics.resolve.ball_ball"
    ):
        module = types.ModuleType(package)
        module.__path__ = [str(base.joinpath(*package.split(".")[1:]))]
        sys.modules[package] = module
    for name in ("pooltool.objects", "pooltool.objects.ball", "pooltool.objects.ball.datatypes",
                 "pooltool.physics.resolve.models", "pooltool.physics.resolve.ball_ball.core",
                 "pooltool.physics.resolve.ball_ball.friction"):
        sys.modules[name] = Absent(name)
    import numpy as np
    from pooltool.physics.resolve.ball_ball import frictional_mathavan as original

    cases = json.loads(STATES.read_text())["cases"]
    calls = []
    for case in cases:
        i, p = case["in"], case["params"]
        rvw1, rvw2 = (np.array([i[f"r{b}"], i[f"v{b}"], i[f"w{b}"]]) for b in (1, 2))
        calls.append(
            (rvw1, rvw2, p["R"], p["m"], p["u_s1"], p["u_s2"], p["u_b"], p["e_b"], case["out_N1000"]))

    def run(call):
        return original.collide_balls(*[a.copy() if hasattr(a, "copy") else a for a in call[:8]], None, 1000)

    worst = 0.0
    for call in calls:
        after1, after2 = run(call)[:2]
        for after, b in ((after1, 1), (after2, 2)):
            worst = max(worst, float(np.abs(after[1] - np.array(call[8][f"v{b}"])).max()))
    best = []
    for call in calls:
        times = []
        for _ in range(30):
            start = time.thread_time_ns()
            for _ in range(5):
                run(call)
            times.append((time.thread_time_ns() - start) / 5)
        best.append(min(times))
    print(json.dumps({"ns": sum(best) / len(best), "difference": worst}))


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--carom", default=str(ROOT / "build" / "release" / "carom-lab"))
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--inside", action="store_true", help=argparse.SUPPRESS)
    args = parser.parse_args()
    if args.inside:
        time_original()
        return
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.executable, "-m", "venv", folder], check=True)
        python = os.path.join(folder, "bin", "python")
        pip = [python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
        subprocess.run(pip + ["--no-deps", "pooltool-billiards==0.6.0"], check=True)
        subprocess.run(pip + NEEDED, check=True)
        theirs, ours = [], []
        for _ in range(args.rounds):
            out = subprocess.run(
                [python, __file__, "--inside"], check=True, capture_output=True, text=True).stdout
            theirs.append(json.loads(out.strip().splitlines()[-1]))
            bench = subprocess.run([args.carom, "bench", "kernel", "--json", "--cloth-slip", "as_published",
                                    "--random", "50", "--repeat", "3",
                                    "--no-growth"], check=True, capture_output=True, text=True).stdout
            ours.append(json.loads(bench))
    original = min(t["ns"] for t in theirs)
    print(f"numba original: {original:.0f} ns an impact; "
          f"off the published results by {theirs[0]['difference']:.1e} m/s")
    best = {}
    for bench in ours:
        for row in bench["rows"]:
            key = (row["name"], row["isa"], row["kind"])
            best[key] = min(best.get(key, row["ns_min"]), row["ns_min"])
    for (name, isa, kind), ns in best.items():
        print(f"{name:<26}{isa:<8}{kind:<8}{ns:>9.0f} ns {original / ns:>8.1f}x")


if __name__ == "__main__":
    main()
