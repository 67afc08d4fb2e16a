#!/usr/bin/env python3
"""Experiments E2 to E5 of lab/notes/2026-11-accuracy_experiments.md over seeded shots of four classes.

    lab/measure/accuracy_experiments.py [--count 100] [--program build/release/carom] [--data FILE.json]
                                        [--images FOLDER]
    lab/measure/accuracy_experiments.py --from FILE.json        # prints the tables from stored measurements

Prints the tables as Markdown. --data stores all measurements, --images draws the figures
(python3-matplotlib).
"""
import argparse
import json
import math
import pathlib
import statistics
import subprocess
import sys
import tempfile

from experiment_shots import CLASSES, shot

TARGET = 1e-3
MARCH = (100, 1000, 10000, 100000)
TOLERANCES = ("0.001", "1e-05", "1e-06", "1e-08", "1e-10", "1e-12")
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7")


def run(program, *arguments):
    done = subprocess.run([program, *arguments], capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"accuracy_experiments: {' '.join(arguments)}: {done.stderr}")
    return done.stdout


def progress(title, done, total):
    if sys.stderr.isatty():
        print(f"\r\033[K{title} {done} of {total}" + ("\n" if done == total else ""), end="", file=sys.stderr)


def measure_shots(program, folder, count):
    """Runs `carom accuracy` on every shot, for E2, E3 and E4."""
    shots = []
    for kind in CLASSES:
        for seed in range(1, count + 1):
            scene = folder / "shot.toml"
            scene.write_text(shot(kind, seed))
            result = json.loads(run(program, "accuracy", str(scene), "--json", "--repeat", "3", "--target",
                                    str(TARGET), "--march", ",".join(map(str, MARCH)), "--tolerance",
                                    ",".join(TOLERANCES)))
            shots.append({"class": kind, "seed": seed, **result})
            progress(kind, seed, count)
    return shots


def final(program, scene, text):
    """The final (x, y) of every ball, or None if the scene cannot be run."""
    scene.write_text(text)
    result = json.loads(run(program, "simulate", str(scene), "--json", "--profile"))
    balls = {b["id"]: tuple(b["position"][:2]) for b in result["balls"]}
    kinds = result["profile"]["kinds"]
    ns = result["profile"]["setup_detect_ns"] + sum(k["detect_ns"] + k["resolve_ns"] for k in kinds)
    cluster = sum(k["kernel_ns"] for k in kinds if k["type"] == "ball_cluster")
    return balls, ns, cluster, result["events"]


def apart(a, b):
    return max(math.dist(a[k], b[k]) for k in a)


def moved(text, step):
    """The scene with the cue ball `step` further to the right."""
    lines = text.split("\n")
    at = next(i for i, line in enumerate(lines) if line == 'id = "cue"') + 1
    x, y = json.loads(lines[at].split("=")[1])
    lines[at] = f"position = [{x + step!r}, {y!r}]"
    return "\n".join(lines)


def physics(text, line):
    return text + f"[physics]\n{line}\n"


def balls(text, line):
    return text + f"[balls]\n{line}\n"


# Disturbances of a shot, compared with the result at the tolerance TIGHT.
TIGHT = "tolerance = 1e-13"
NOISE = (
    ("last bit of one coordinate", lambda t: physics(moved(t, 1.2e-16), TIGHT)),
    ("impact by tolerance 1e-12", lambda t: physics(t, "tolerance = 1e-12")),
    ("impact by tolerance 1e-9", lambda t: physics(t, "tolerance = 1e-9")),
    ("impact by tolerance 1e-6", lambda t: physics(t, "tolerance = 1e-6")),
    ("impact by tolerance 1e-3", lambda t: physics(t, "tolerance = 1e-3")),
    ("cue ball 3e-8 m off (float32 coordinates)", lambda t: physics(moved(t, 3e-8), TIGHT)),
    ("cue ball 1e-6 m off (a spacer between touching balls)", lambda t: physics(moved(t, 1e-6), TIGHT)),
    ("march N=10000", lambda t: physics(t, "substeps = 10000")),
    ("march N=1000", lambda t: physics(t, "substeps = 1000")),
    ("cue ball 1e-4 m off (a very good camera)", lambda t: physics(moved(t, 1e-4), TIGHT)),
    ("ball-ball friction a tenth more",
     lambda t: physics(balls(t, "mu_b_fit = [0.0109461, 0.1188, 1.088]"), TIGHT)),
    ("restitution 0.95 -> 0.94", lambda t: physics(balls(t, "e_b = 0.94"), TIGHT)),
    ("model inelastic (closed form)", lambda t: physics(t, 'ball_ball = "inelastic"')),
)
CLUSTERS = ("compliant", "sequential", "rigid")


def measure_noise(program, folder, count):
    """E5: the final distance caused by each disturbance in a cut and in a break; also compares the cluster
    models."""
    scene = folder / "noise.toml"
    rows, clusters = [], []
    for kind in ("cut", "break"):
        for seed in range(1, count + 1):
            text = shot(kind, seed)
            reference = final(program, scene, physics(text, TIGHT))[0]
            for title, change in NOISE:
                rows.append({"class": kind, "seed": seed, "noise": title,
                             "apart": apart(reference, final(program, scene, change(text))[0])})
            progress(f"noise, {kind}", seed, count)
            if kind != "break":
                continue
            for model in CLUSTERS:
                best = min((final(program, scene, physics(text, f'clusters = "{model}"')) for _ in range(3)),
                           key=lambda r: r[1])
                near = final(program, scene, physics(moved(text, 1e-9), f'clusters = "{model}"'))[0]
                clusters.append({"seed": seed, "model": model, "ns": best[1], "cluster_ns": best[2],
                                 "events": best[3], "apart": apart(reference, best[0]),
                                 "twin": apart(best[0], near) / 1e-9})
    return rows, clusters


def median(values):
    values = [v for v in values if v is not None]
    return statistics.median(values) if values else float("nan")


def settings(shots):
    return [(r["method"], r["setting"]) for r in shots[0]["rows"]
            if r["method"] == "march" or r["setting"] in TOLERANCES]


def rows_of(shots, setting):
    return [next(r for r in s["rows"] if (r["method"], r["setting"]) == setting) for s in shots]


def same(row):
    return row["same_order"] and row["same_first_contact"] and row["same_pocketed"]


def e2(shots):
    print("\n### E2: cost and outcome by class\n")
    print("| class | setting | us a shot | outcome the same | median final error (m) | "
          "worst (m) |\n|---|---|---|---|---|---|")
    for kind in CLASSES:
        judged = [s for s in shots if s["class"] == kind and s["converged"]]
        for setting in settings(judged):
            rows = [r for r in rows_of(judged, setting) if "failed" not in r]
            print(f"| {kind} | {' '.join(setting)} | {median(r['ns'] for r in rows) / 1e3:.1f} | "
                  f"{100 * sum(map(same, rows)) / len(rows):.0f} % | "
                  f"{median(r['error_max'] for r in rows):.1e} | "
                  f"{max(r['error_max'] for r in rows):.1e} |")
    lost = sum(not s["converged"] for s in shots)
    print(f"\n{len(shots)} shots; on {lost} of them the two converged methods do not agree, "
          "and nothing is said about those.")


def line_fit(x, y):
    mx, my = statistics.mean(x), statistics.mean(y)
    slope = sum((a - mx) * (b - my) for a, b in zip(x, y)) / sum((a - mx) ** 2 for a in x)
    return slope, my - slope * mx


def amplifying(shots):
    """The shots with a gain above 0; in the others all balls are pocketed anyway."""
    return [s for s in shots if s["gain"] > 0]


def fit_of_gain(shots):
    own = amplifying(shots)
    return line_fit([s["ball_hits"] for s in own], [math.log10(s["gain"]) for s in own])


def collapse(shots):
    """(gain, tolerance, error / (gain x tolerance x 1 m)) for every resolved error."""
    points = []
    for s in amplifying(shots):
        for r in s["rows"]:
            judged = s["converged"] and r["method"] == "tolerance"
            if not judged or r["error_max"] <= 10 * s["agreement"] or not r["error_max"]:
                continue
            points.append(
                (s["gain"], float(r["setting"]), r["error_max"] / (s["gain"] * float(r["setting"]))))
    return points


def e3(shots):
    print("\n### E3: gain\n\n| class | median gain | largest | median hits |\n|---|---|---|---|")
    for kind in CLASSES:
        own = [s for s in shots if s["class"] == kind]
        print(f"| {kind} | {median(s['gain'] for s in own):.1e} | {max(s['gain'] for s in own):.1e} | "
              f"{median(s['ball_hits'] for s in own):.0f} |")
    slope, start = fit_of_gain(shots)
    ratios = sorted(p[2] for p in collapse(shots))
    print(f"\nlog10 gain = {start:.2f} + {slope:.3f} x hits. "
          f"error / (gain x tolerance x 1 m): median {median(ratios):.1e}, "
          f"90 % between {ratios[len(ratios) // 20]:.1e} and {ratios[-len(ratios) // 20]:.1e}, "
          f"largest {ratios[-1]:.1e}.")


def adaptive_rows(shots):
    """The recommended setting of every shot that has one."""
    pairs = []
    for s in shots:
        if s["recommended_tolerance"] is not None:
            pairs.append((s, next(r for r in s["rows"] if r["method"] == "tolerance"
                                  and float(r["setting"]) == s["recommended_tolerance"])))
    return pairs


def e4(shots):
    print("\n### E4: by the gain of the shot against fixed settings\n")
    print("| setting | mean us | within 1 mm | worst (m) |\n|---|---|---|---|")
    pairs = adaptive_rows(shots)
    judged = [s for s, _ in pairs]
    fixed = [(" ".join(k), rows_of(judged, k)) for k in (("march", "N=1000"), ("march", "N=10000"),
                                                        ("tolerance", "0.001"),
                                                        ("tolerance", "1e-06"), ("tolerance", "1e-12"))]
    for title, rows in fixed + [("tolerance by gain", [r for _, r in pairs])]:
        print(f"| {title} | {statistics.mean(r['ns'] for r in rows) / 1e3:.1f} | "
              f"{100 * sum(r['error_max'] <= TARGET for r in rows) / len(rows):.1f} % | "
              f"{max(r['error_max'] for r in rows):.1e} |")
    print(f"\n{len(judged)} of {len(shots)} shots; the others do not allow 1 mm in double precision. "
          "Finding the gain takes three runs "
          "of the shot more.\n\n| class | shots | allow 1 mm | "
          "met by the recommended tolerance |\n|---|---|---|---|")
    for kind in CLASSES:
        own = [(s, r) for s, r in pairs if s["class"] == kind]
        print(f"| {kind} | {sum(s['class'] == kind for s in shots)} | {len(own)} | "
              f"{sum(r['error_max'] <= TARGET for _, r in own)} |")


def e5(noise, clusters):
    print("\n### E5: what disturbs a shot, by its final distance (median, largest; m)\n")
    print("| disturbance | cut | break |\n|---|---|---|")
    cells = {title: {
        k: [r["apart"] for r in noise if r["class"] == k and r["noise"] == title] for k in ("cut", "break")}
             for title, _ in NOISE}
    for title in sorted(cells, key=lambda t: median(cells[t]["break"])):
        print(f"| {title} | " + " | ".join(
            f"{median(v):.1e}, {max(v):.1e}" for v in cells[title].values()) + " |")
    print("\n### The cluster models on the same breaks\n")
    print("| model | us a break | of it in the map | events | final distance from compliant (m) | "
          "gain |\n|---|---|---|---|---|---|")
    for model in CLUSTERS:
        own = [c for c in clusters if c["model"] == model]
        print(f"| {model} | {median(c['ns'] for c in own) / 1e3:.0f} | "
              f"{median(c['cluster_ns'] for c in own) / 1e3:.0f} | "
              f"{median(c['events'] for c in own):.0f} | {median(c['apart'] for c in own):.2g} | "
              f"{median(c['twin'] for c in own):.1e} |")


def draw_pareto(plt, shots, folder):
    figure, axes = plt.subplots(2, 4, figsize=(13, 6), sharex=False)
    for column, kind in enumerate(CLASSES):
        judged = [s for s in shots if s["class"] == kind and s["converged"]]
        for method, colour in (("march", COLOURS[0]), ("tolerance", COLOURS[1])):
            points = []
            for setting in settings(judged):
                if setting[0] == method:
                    rows = rows_of(judged, setting)
                    points.append((median(r["ns"] for r in rows) / 1e3,
                                   100 * sum(map(same, rows)) / len(rows),
                                   max(median(r["error_max"] for r in rows), 1e-16)))
            x = [p[0] for p in points]
            axes[0][column].plot(x, [p[1] for p in points], "o-", color=colour, label=method)
            axes[1][column].plot(x, [p[2] for p in points], "o-", color=colour)
        axes[0][column].set_title(kind)
        axes[0][column].set_xscale("log")
        axes[0][column].set_ylim(-3, 103)
        axes[1][column].set_xscale("log")
        axes[1][column].set_yscale("log")
        axes[1][column].axhline(TARGET, color="#444444", linestyle="--", linewidth=0.8)
        axes[1][column].set_xlabel("us a shot")
    axes[0][0].set_ylabel("% with the converged outcome")
    axes[1][0].set_ylabel("median final error, m")
    axes[0][0].legend()
    save(plt, figure, folder / "accuracy_shots.png")


def draw_gain(plt, shots, folder):
    figure, (left, right) = plt.subplots(1, 2, figsize=(12, 4.5))
    for kind, colour in zip(CLASSES, COLOURS):
        own = [s for s in shots if s["class"] == kind]
        left.plot([s["ball_hits"] for s in own], [s["gain"] for s in own], ".", color=colour, label=kind)
        points = collapse(own)
        right.plot([p[0] * p[1] for p in points], [p[0] * p[1] * p[2] for p in points], ".", markersize=3,
                   color=colour)
    slope, start = fit_of_gain(shots)
    most = max(s["ball_hits"] for s in shots)
    left.plot([0, most], [10 ** start, 10 ** (start + slope * most)], "k--", linewidth=0.8)
    left.set_yscale("log")
    left.set_xlabel("ball-ball hits")
    left.set_ylabel("gain")
    left.legend()
    ends = [1e-12, 1e4]
    right.plot(ends, ends, "k--", linewidth=0.8, label="error = gain x tolerance x 1 m")
    right.set_xscale("log")
    right.set_yscale("log")
    right.set_xlabel("gain x tolerance")
    right.set_ylabel("final error, m")
    right.legend()
    save(plt, figure, folder / "accuracy_gain.png")


def draw_noise(plt, noise, folder):
    figure, axes = plt.subplots(figsize=(9, 5))
    title_of = sorted(
        {r["noise"] for r in noise},
        key=lambda t: median(r["apart"] for r in noise if r["noise"] == t and r["class"] == "break"))
    for kind, colour, shift in (("cut", COLOURS[1], -0.15), ("break", COLOURS[0], 0.15)):
        for i, title in enumerate(title_of):
            values = sorted(
                max(r["apart"], 1e-17) for r in noise if r["noise"] == title and r["class"] == kind)
            axes.plot([values[0], values[-1]], [i + shift] * 2, color=colour, linewidth=1)
            axes.plot(median(values), i + shift, "o", color=colour, label=kind if i == 0 else None)
    axes.set_yticks(range(len(title_of)))
    axes.set_yticklabels(title_of, fontsize=8)
    axes.set_xscale("log")
    axes.set_xlabel("final distance, m: median, least to largest")
    axes.legend()
    axes.grid(axis="x", alpha=0.3)
    save(plt, figure, folder / "accuracy_noise.png")


def save(plt, figure, path):
    for axes in figure.axes:
        axes.grid(alpha=0.3)
    figure.tight_layout()
    figure.savefig(path, dpi=90, metadata={"Software": None})
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=100, help="shots of each class (default: 100)")
    parser.add_argument("--noise-count", type=int, default=25, help="shots of E5 (default: 25)")
    parser.add_argument("--program", default="build/release/carom")
    parser.add_argument("--data", help="keep all measurements here")
    parser.add_argument("--from", dest="source", help="read the measurements instead of making them")
    parser.add_argument("--images", help="draw the figures into this folder")
    options = parser.parse_args()
    if options.count < 2 or options.noise_count < 1:
        parser.error("--count: expected at least 2, --noise-count at least 1")
    if options.source:
        data = json.loads(pathlib.Path(options.source).read_text())
    else:
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            shots = measure_shots(options.program, folder, options.count)
            noise, clusters = measure_noise(options.program, folder, options.noise_count)
        data = {"shots": shots, "noise": noise, "clusters": clusters}
        if options.data:
            pathlib.Path(options.data).write_text(json.dumps(data))
    e2(data["shots"])
    e3(data["shots"])
    e4(data["shots"])
    e5(data["noise"], data["clusters"])
    if options.images:
        import matplotlib
        matplotlib.use("Agg")
        import matplotlib.pyplot as plt
        folder = pathlib.Path(options.images)
        folder.mkdir(parents=True, exist_ok=True)
        draw_pareto(plt, data["shots"], folder)
        draw_gain(plt, data["shots"], folder)
        draw_noise(plt, data["noise"], folder)


if __name__ == "__main__":
    main()
