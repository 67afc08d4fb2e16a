#!/usr/bin/env python3
"""The room that a pocket leaves: the tables of lab/notes/2026-11-pockets.md.

A ball rolls at a corner from 0.6 m away, at several speeds and angles to the long rail; its line is shifted
sideways until it no longer drops on that visit. The window is the width [mm] of the lines that drop. The
second table is for balls along the rail: the number of 24 that drop (0 to 5 mm from the rail, from 1 degree
away from it to 2 degrees into it).

    lab/measure/pocket_windows.py [--carom build/release/carom] [--table nine_foot] [--pocket fall]
                                  [--step 1.0]
"""
import argparse
import json
import math
import pathlib
import subprocess
import tempfile

RADIUS = {"snooker": 0.02625}
SPEEDS = (0.5, 1.0, 2.0, 4.0, 7.0)


def scene(table, pocket, x, y, angle_deg, speed):
    R = RADIUS.get(table, 0.028575)
    vx, vy = -speed * math.sin(math.radians(angle_deg)), -speed * math.cos(math.radians(angle_deg))
    balls = "preset = \"snooker\"" if table == "snooker" else ""
    # A single visit: the run ends before the ball returns from another rail.
    return (f'[table]\npreset = "{table}"\n[balls]\n{balls}\n[[ball]]\nposition = [{x!r}, {y!r}]\n'
            f'velocity = [{vx!r}, {vy!r}]\n'
            f'spin = [{-vy / R!r}, {vx / R!r}, 0.0]\n[physics]\npocket = "{pocket}"\n[stop]\n'
            f'time = {1.0 / speed + 0.4!r}\n')


def drops(carom, folder, text):
    path = folder / "ball.toml"
    path.write_text(text)
    run = subprocess.run([carom, "simulate", path, "--json"], capture_output=True, text=True)
    if run.returncode != 0:  # the ball would start in a cushion
        return False
    return json.loads(run.stdout)["balls"][0]["pocket"] == "p1"


def window(args, folder, angle_deg, speed):
    """The width of the window [mm]."""
    R = RADIUS.get(args.table, 0.028575)
    a = math.radians(angle_deg)
    count = 0
    for k in range(int(240 / args.step)):
        off = (k * args.step - 120.0) * 1e-3
        x, y = 0.6 * math.sin(a) + off * math.cos(a), 0.6 * math.cos(a) - off * math.sin(a)
        if x < R or y < 0.15:
            continue
        count += drops(args.carom, folder, scene(args.table, args.pocket, x, y, angle_deg, speed))
    return count * args.step


def beside_rail(args, folder, speed):
    R = RADIUS.get(args.table, 0.028575)
    return sum(drops(args.carom, folder, scene(args.table, args.pocket, R + gap * 1e-3, 0.6, angle, speed))
               for gap in range(6) for angle in (-1.0, 0.0, 1.0, 2.0))


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--carom", default="build/release/carom")
    parser.add_argument("--table", default="nine_foot")
    parser.add_argument("--pocket", default="fall", choices=["fall", "at_once"])
    parser.add_argument(
        "--step", type=float, default=1.0, help="[mm] between neighbouring lines (default: 1.0)")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        print(f"{args.table}, pocket = \"{args.pocket}\": window in mm against the speed\n")
        print("| to the long rail | " + " | ".join(
            f"{s} m/s" for s in SPEEDS) + " |\n|" + "---|" * (1 + len(SPEEDS)))
        for angle in (45, 20, 10, 5):
            print(f"| {angle} deg | " + " | ".join(
                f"{window(args, folder, angle, s):g}" for s in SPEEDS) + " |", flush=True)
        print("| beside the rail, of 24 | " + " | ".join(
            str(beside_rail(args, folder, s)) for s in SPEEDS) + " |")


if __name__ == "__main__":
    main()
