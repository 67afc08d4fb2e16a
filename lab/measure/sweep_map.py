#!/usr/bin/env python3
"""A map of a sweep: the share of shots for which a condition holds, over two of the varied values.

    lab/measure/sweep_map.py bank.csv cue.aim_deg cue.speed 1.pocket=p2 -o map.png

Reads the table of carom sweep; needs python3-matplotlib.
"""

import argparse
import csv
import sys


def read_rows(path, columns):
    try:
        with open(path, newline="") as stream:
            reader = csv.DictReader(stream)
            for column in columns:
                if column not in (reader.fieldnames or []):
                    sys.exit(f"{path}: there is no column {column}; "
                             f"there are {', '.join(reader.fieldnames or [])}")
            return [[row[column] for column in columns] for row in reader]
    except OSError as error:
        sys.exit(f"{path}: {error.strerror}")


def share_map(rows, wanted, bins):
    """Limits of x and y, and the fraction of hits per cell, rows of y from below; None for a cell without
    shots."""
    xs, ys = [float(row[0]) for row in rows], [float(row[1]) for row in rows]
    limits = [min(xs), max(xs), min(ys), max(ys)]
    shots = [[0] * bins for _ in range(bins)]
    hits = [[0] * bins for _ in range(bins)]
    for x, y, row in zip(xs, ys, rows):
        i = min(bins - 1, int(bins * (x - limits[0]) / (limits[1] - limits[0])))
        j = min(bins - 1, int(bins * (y - limits[2]) / (limits[3] - limits[2])))
        shots[j][i] += 1
        hits[j][i] += row[2] == wanted
    return limits, [[h / n if n else None for h, n in zip(*pair)] for pair in zip(hits, shots)]


def main():
    parser = argparse.ArgumentParser(description="How often a condition holds over two values of a sweep.")
    parser.add_argument("table", metavar="SWEEP.csv")
    parser.add_argument("x", metavar="X", help="column across")
    parser.add_argument("y", metavar="Y", help="column upwards")
    parser.add_argument("condition", metavar="COLUMN=VALUE", help="what counts, such as 1.pocket=p2")
    parser.add_argument("--bins", type=int, default=60, metavar="N", help="cells per side (default: 60)")
    parser.add_argument("-o", "--output", required=True, metavar="FILE.png")
    args = parser.parse_args()
    column, equals, wanted = args.condition.partition("=")
    if not equals:
        parser.error(f"expected COLUMN=VALUE, not {args.condition}")
    if args.bins < 1:
        parser.error("--bins: expected at least 1")
    try:
        import matplotlib
    except ImportError:
        sys.exit("matplotlib is missing; install the package python3-matplotlib")
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    rows = read_rows(args.table, [args.x, args.y, column])
    if len(rows) < 2:
        sys.exit(f"{args.table}: too few shots for a map")
    limits, shares = share_map(rows, wanted, args.bins)
    if limits[0] == limits[1] or limits[2] == limits[3]:
        sys.exit("one of the two columns does not vary")
    figure, axes = plt.subplots(figsize=(8, 4.5), dpi=100)
    cells = [[float("nan") if share is None else share for share in row] for row in shares]
    image = axes.imshow(cells, origin="lower", extent=limits, aspect="auto", vmin=0, vmax=1, cmap="viridis",
                        interpolation="nearest")
    axes.set_xlabel(args.x)
    axes.set_ylabel(args.y)
    figure.colorbar(image, label=f"share of shots with {args.condition}")
    figure.tight_layout()
    figure.savefig(args.output)
    hits = sum(row[2] == wanted for row in rows)
    print(f"{args.output}: {hits} of {len(rows)} shots have {args.condition}")


if __name__ == "__main__":
    main()
