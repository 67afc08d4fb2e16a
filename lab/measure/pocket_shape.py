#!/usr/bin/env python3
"""The effect of a corner pocket's shape: share of balls that drop, over its mouth and the angle of its
facings, for three speeds. The picture and the table of lab/notes/2026-11-pocket_shape.md.

A ball a metre from the corner is aimed at it along its axis, and beside the rail, with an aiming error.

    lab/measure/pocket_shape.py [--carom build/release/carom] [--count 40000] -o pocket_shape.svg

Needs python3-matplotlib.
"""
import argparse
import csv
import pathlib
import subprocess
import tempfile

SPEEDS = (1.0, 2.5, 5.0)
MOUTHS, ANGLES = (0.100, 0.130), (136.0, 150.0)
#: The ball's place, its aim, and the aiming error [degrees].
LINES = {"along the axis": ((0.7071, 0.7071), 225.0, 1.5), "beside the rail": ((0.05, 1.0), 268.5, 1.0)}
BINS = 7


def scene(place, aim_deg, speed):
    return (f"[table]\npreset = \"nine_foot\"\n[[ball]]\nposition = [{place[0]}, {place[1]}]\n"
            f"[cue]\npreset = \"lossless\"\naim_deg = {aim_deg}\nball_speed = {speed}\noffset = [0, 0.2]\n"
            f"[stop]\ntime = {1.0 / speed + 1.0}\n")


def shares(args, folder, place, aim_deg, error, speed):
    """Share of balls that drop [-], by angle and mouth."""
    path, table = folder / "ball.toml", folder / "shots.csv"
    path.write_text(scene(place, aim_deg, speed))
    vary = {"table.corner_pockets.mouth": f"uniform({MOUTHS[0]},{MOUTHS[1]})",
            "table.corner_pockets.angle_deg": f"uniform({ANGLES[0]},{ANGLES[1]})",
            "cue.aim_deg": f"normal({error})"}
    command = [args.carom, "sweep", path, "--count", str(args.count), "-o", table]
    for key, values in vary.items():
        command += ["--vary", f"{key}={values}"]
    subprocess.run(command, check=True, capture_output=True)
    shots, drops = ([[0] * BINS for _ in range(BINS)] for _ in range(2))
    with open(table, newline="") as stream:
        for row in csv.DictReader(stream):
            if row["status"] == "invalid":
                continue
            i, j = (min(BINS - 1, int(BINS * (float(row[key]) - low) / (high - low)))
                    for key, (low, high) in zip(vary, (MOUTHS, ANGLES)))
            shots[j][i] += 1
            drops[j][i] += row["cue.pocket"] == "p1"
    table.unlink()
    return [[d / n if n else float("nan") for d, n in zip(*pair)] for pair in zip(drops, shots)]


def main():
    parser = argparse.ArgumentParser(description="The share of balls that drop, over mouth and angle.")
    parser.add_argument("--carom", default="build/release/carom")
    parser.add_argument("--count", type=int, default=40000)
    parser.add_argument("-o", "--output", required=True)
    args = parser.parse_args()
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(len(LINES), len(SPEEDS), figsize=(9, 5.4), sharex=True, sharey=True,
                                layout="constrained")
    with tempfile.TemporaryDirectory() as name:
        for row, (line, (place, aim, error)) in zip(axes, LINES.items()):
            for plot, speed in zip(row, SPEEDS):
                cells = shares(args, pathlib.Path(name), place, aim, error, speed)
                image = plot.imshow(cells, origin="lower", extent=[1e3 * x for x in MOUTHS] + list(ANGLES),
                                    aspect="auto", vmin=0, vmax=1, cmap="viridis")
                plot.set_title(f"{line}, {speed:g} m/s", fontsize=9)
                print(f"{line}, {speed:g} m/s: rows of angle from {ANGLES[0]:g}, mouth from {MOUTHS[0]:g}")
                for cell in cells:
                    print("  " + " ".join(f"{100 * share:4.0f}" for share in cell))
    for plot in axes[-1]:
        plot.set_xlabel("mouth [mm]")
    for row in axes:
        row[0].set_ylabel("facing [degrees]")
    figure.colorbar(image, ax=axes, label="share of balls that drop")
    figure.savefig(args.output)


if __name__ == "__main__":
    main()
