#!/usr/bin/env python3
"""The study of a million breaks (lab/notes/2026-11-million_breaks.md): the outcome by aim and speed, as a map
and a table.

    lab/measure/million_breaks.py FOLDER -o map.png

FOLDER contains the shards of a plan with the scene, the rules, the seed, the shots and the shard size of
lab/notes/2026-11-million_breaks.json, whose own format is that of carom 0.1. Needs duckdb and matplotlib.
"""

import argparse

import duckdb
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

AIM, SPEED = (86.3, 90.9), (2.0, 11.0)
COLUMNS, ROWS = 92, 45
# Whether a ball but not the cue ball falls, whether the cue ball falls, and the number of other balls.
BREAKS = """
SELECT "cue.aim_deg" AS aim, "cue.speed" AS speed, events, duration,
       pocketed <> '' AND "cue.pocket" = '' AS success,
       "cue.pocket" <> '' AS scratch,
       len(list_filter(string_split(pocketed, ';'), lambda ball: ball NOT IN ('', 'cue'))) AS balls
FROM '{folder}/*.parquet'
"""
CELLS = """
SELECT least(floor((aim - {a0}) / ({a1} - {a0}) * {columns}), {columns} - 1)::INT AS i,
       least(floor((speed - {s0}) / ({s1} - {s0}) * {rows}), {rows} - 1)::INT AS j,
       count(*) AS n, avg(success::INT) AS success, avg(scratch::INT) AS scratch, avg(balls) AS balls
FROM breaks GROUP BY ALL
"""
BANDS = """
SELECT floor(speed)::INT AS speed, count(*) AS breaks, avg(success::INT) AS success,
       avg(scratch::INT) AS scratch, avg(balls) AS balls, avg(duration) AS duration, avg(events) AS events
FROM breaks WHERE abs(aim - {middle}) < 0.25 GROUP BY 1 ORDER BY 1
"""
BEST = """
SELECT round(aim, 1) AS aim, count(*) AS breaks, avg(success::INT) AS success,
       avg(scratch::INT) AS scratch, avg(balls) AS balls
FROM breaks WHERE speed BETWEEN 7 AND 9 GROUP BY 1 ORDER BY success DESC LIMIT 5
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", metavar="FOLDER")
    parser.add_argument("-o", "--output", required=True, metavar="FILE.png")
    args = parser.parse_args()
    base = duckdb.connect()
    base.sql(f"CREATE TABLE breaks AS {BREAKS.format(folder=args.folder)}")
    where = {"a0": AIM[0], "a1": AIM[1], "s0": SPEED[0], "s1": SPEED[1], "columns": COLUMNS, "rows": ROWS}
    maps = np.full((3, ROWS, COLUMNS), np.nan)
    fewest = None
    for i, j, n, *values in base.sql(CELLS.format(**where)).fetchall():
        maps[:, j, i] = values
        fewest = n if fewest is None else min(fewest, n)
    print("cells:", COLUMNS * ROWS, "with at least", fewest, "breaks")
    # The 1 is at (0.635, 1.905), the cue ball at (0.60, 0.50).
    middle = float(np.degrees(np.arctan2(1.905 - 0.5, 0.635 - 0.6)))
    print(f"full at {middle:.2f} degrees")
    for query in BANDS.format(middle=middle), BEST:
        relation = base.sql(query)
        print("|", " | ".join(relation.columns), "|")
        for row in relation.fetchall():
            print(
                "|", " | ".join(f"{value:.3f}" if isinstance(value, float) else str(value) for value in row),
                "|")
    titles = ["a ball falls, the cue ball stays", "the cue ball falls", "balls that fall"]
    figure, axes = plt.subplots(1, 3, figsize=(13, 4.6), dpi=100, sharey=True, layout="constrained")
    for panel, values, title in zip(axes, maps, titles):
        image = panel.imshow(values, origin="lower", extent=(*AIM, *SPEED), aspect="auto", cmap="viridis",
                             vmin=0, interpolation="nearest")
        panel.axvline(middle, color="white", linewidth=0.6, linestyle=":")
        panel.set_title(title, fontsize=10)
        panel.set_xlabel("aim [degrees]")
        figure.colorbar(image, ax=panel)
    axes[0].set_ylabel("speed of the cue [m/s]")
    figure.savefig(args.output)


if __name__ == "__main__":
    main()
