#!/usr/bin/env python3
"""The cost of the models for several simultaneous contacts, and how much they change a break: compliant,
rigid, sequential.

    lab/measure/cluster_spread.py build/release/carom -o lab/notes/images/cluster_spread.png

Plays the same seeded breaks (aim and speed vary slightly) of racks with gaps from 0 to 1e-4 m under each
model, and stops them before the balls reach a cushion. Compares the balls' positions then with the touching
rack under the same model, and with another model. The costs come from `carom simulate --profile` for the
touching rack to rest, alternating the models. Needs python3-matplotlib.
"""

import argparse
import csv
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

MODELS = ("compliant", "rigid", "sequential")
COLOURS = {"compliant": "#1f6fb4", "rigid": "#d9822b", "sequential": "#888888"}
GAPS = [0.0] + [10.0**k for k in range(-12, -3)]
STOP = 0.16  # s: about 0.05 s after the cue ball hits the rack
SCENE = """[table]
preset = "nine_foot"
[balls]
preset = "pool_classic"
[rack]
game = "eight_ball"
gap = {gap!r}
seed = 1
[[ball]]
id = "cue"
position = [0.635, 0.50]
[cue]
preset = "lossless"
ball = "cue"
speed = 9.0
aim_deg = 90.0
[physics]
clusters = "{model}"
{stop}
"""


def run(command):
    try:
        result = subprocess.run(command, capture_output=True, text=True)
    except OSError as error:
        sys.exit(f"{command[0]}: {error.strerror}")
    if result.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: {result.stderr.strip()}")
    return result.stdout


def write_scene(folder, model, gap, stop):
    path = folder / "break.toml"
    path.write_text(SCENE.format(gap=gap, model=model, stop=f"[stop]\ntime = {STOP}" if stop else ""))
    return path


def places(carom, folder, model, gap, count):
    """For every shot the (x, y) of all balls at STOP."""
    table = folder / f"{model}_{gap}.csv"
    run([carom, "sweep", write_scene(folder, model, gap, True), "--vary", "cue.aim_deg=uniform(89.8,90.2)",
         "--vary", "cue.speed=uniform(8,10)", "--seed", "1", "--count", str(count), "-o", table])
    with open(table, newline="") as stream:
        rows = list(csv.DictReader(stream))
    balls = [name[:-2] for name in rows[0] if name.endswith(".x") and not name.startswith(("cue.", "rack."))]
    balls.append("cue")
    return [[(float(row[f"{ball}.x"]), float(row[f"{ball}.y"])) for ball in balls] for row in rows]


def farthest(one, two):
    """Per shot the largest distance of a ball between two tables [m]."""
    return [
        max(((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2) ** 0.5 for a, b in zip(p, q)) for p, q in zip(one, two)]


def costs(carom, folder, repeats):
    """Per model the times of a whole break [ms], measured in turn."""
    times = {model: [] for model in MODELS}
    for _ in range(repeats):
        for model in MODELS:
            text = run([carom, "simulate", write_scene(folder, model, 0.0, False), "--profile"])
            times[model].append(float(re.search(r"all together: ([0-9.]+) ms", text).group(1)))
    return times


def draw(plt, results, output):
    figure, axes = plt.subplots(figsize=(8, 4.5), dpi=100)
    for model in MODELS:
        moved = [farthest(results[model][gap], results[model][0.0]) for gap in GAPS[1:]]
        middle = [1e3 * statistics.median(d) for d in moved]
        axes.plot(GAPS[1:], [max(m, 1e-12) for m in middle], "o-", color=COLOURS[model],
                  label=f"{model}: against its own touching rack")
        axes.fill_between(GAPS[1:], [max(1e3 * min(d), 1e-12) for d in moved],
                          [max(1e3 * max(d), 1e-12) for d in moved], color=COLOURS[model], alpha=0.2,
                          linewidth=0)
    for other in MODELS[1:]:
        apart = [
            1e3 * statistics.median(farthest(results["compliant"][gap], results[other][gap]))
            for gap in GAPS[1:]]
        axes.plot(GAPS[1:], apart, "--", color=COLOURS[other], label=f"{other} against compliant, same gap")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("gap between neighbours (m)")
    axes.set_ylabel(f"farthest ball, {STOP} s after the strike (mm)")
    axes.grid(alpha=0.3)
    axes.legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(output, metadata={"Software": None})


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("carom", help="the program")
    parser.add_argument("-o", "--output", required=True, help="the figure, a PNG")
    parser.add_argument("--count", type=int, default=40, help="breaks per model and gap (default 40)")
    parser.add_argument("--repeats", type=int, default=15, help="timed runs per model (default 15)")
    args = parser.parse_args()
    try:
        import matplotlib
    except ImportError:
        sys.exit("needs matplotlib (Debian: python3-matplotlib)")
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        results = {
            model: {gap: places(args.carom, folder, model, gap, args.count) for gap in GAPS}
            for model in MODELS}
        times = costs(args.carom, folder, args.repeats)
    base = min(times["sequential"])
    for model in MODELS:
        print(f"{model:<11} break to rest: {min(times[model]):.3f} ms at least, "
              f"median {statistics.median(times[model]):.3f} ms, "
              f"{min(times[model]) / base:.2f} x sequential")
    for gap in GAPS[1:]:
        own = {model: statistics.median(farthest(results[model][gap], results[model][0.0]))
               for model in MODELS}
        moved = "  ".join(f"{model} {1e3 * own[model]:.2e}" for model in MODELS)
        other = {model: statistics.median(farthest(results["compliant"][gap], results[model][gap]))
                 for model in MODELS[1:]}
        apart = "  ".join(f"{model} {1e3 * other[model]:.1f}" for model in MODELS[1:])
        print(f"gap {gap:.0e} m: moved by (mm) {moved}; from compliant (mm) {apart}")
    draw(plt, results, args.output)


if __name__ == "__main__":
    main()
