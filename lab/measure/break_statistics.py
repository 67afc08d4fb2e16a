#!/usr/bin/env python3
"""The outcomes of breaks compared with tournament counts: the table of lab/notes/2026-11-breaks.md.

Plays every kind of break with `carom sweep`, varying aim, speed, tip height and rack. Prints a Markdown
table: the shares of breaks in which a ball falls, in which the cue ball falls and which succeed, with 95 %
intervals (Wilson), and the number of balls that fall. The numbers are the same on every machine.

    lab/measure/break_statistics.py [--carom build/release/carom] [--count 2000]
                                    [-o lab/notes/2026-11-breaks.md]

-o rewrites the table between the marks <!-- begin breaks --> and <!-- end breaks --> of that page.
"""
import argparse
import csv
import math
import pathlib
import re
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]

# [m/s] of the cue; 8.1 to 11.2 m/s of the ball, as players reach (D. Alciatore: powerful breaks 11 to 13,
# professionals 9.8 to 11.6).
SPEED = "uniform(6.1,8.4)"
VARY = ["cue.aim_deg=normal(0.15)", "cue.offset.height=normal(0.05)", "rack.seed=integer(1,1000000)"]


def scene(game, table, gap, position, aim, extra="", cloth="tournament"):
    return (f'[table]\npreset = "{table}"\ncloth = "{cloth}"\n[rack]\ngame = "{game}"\ngap = {gap}\n'
            f'jitter = {gap}\n{extra}'
            f'[[ball]]\nid = "cue"\nposition = [{position[0]}, {position[1]}]\n'
            f'[cue]\nspeed = 7.0\naim_deg = {aim}\noffset = [0.0, 0.1]\n')


def straight_at(target, position):
    return round(math.degrees(math.atan2(target[1] - position[1], target[0] - position[0])), 4)


def breaks():
    """(name, scene, speed, money ball, the tournament count as (what, hits, games, event) or None)"""
    foot = (0.635, 1.905)
    nine_apex = (0.635, 1.905 - math.sqrt(3) * (0.05715 + 1e-5))
    side, rail = (0.45, 0.55), (0.12, 0.55)
    soft, second = (0.10, 0.55), (0.12, 0.55)
    # The ball behind the apex, on the breaker's side, as full as the apex allows: 16 mm beside its centre.
    second_ball = (foot[0] - 0.028585 - 0.0151, foot[1] + 0.028585 * math.sqrt(3) + 0.0052)
    bar_foot, bar_middle = (0.508, 1.524), (0.508, 0.40)
    return [
        ("eight-ball, bar table, middle, 50 um",
         scene("eight_ball", "seven_foot_bar", 5e-5, bar_middle, 90.0), SPEED, "8",
         ("success", 82, 124, "Ultimate Pool Colorado 2024, 7 ft")),
        ("eight-ball, bar table, side, 20 um",
         scene("eight_ball", "seven_foot_bar", 2e-5, (0.28, 0.40), straight_at(bar_foot, (0.28, 0.40))),
         SPEED, "8", ("success", 82, 124, "the same")),
        ("eight-ball, 9 ft, middle, 50 um", scene("eight_ball", "nine_foot", 5e-5, (0.635, 0.55), 90.0),
         SPEED, "8", None),
        *((
            f"eight-ball, 9 ft, middle, {name}", scene("eight_ball", "nine_foot", gap, (0.635, 0.55), 90.0),
            SPEED, "8", None)
          for name, gap in (("touching", 0.0), ("10 um", 1e-5), ("100 um", 1e-4), ("300 um", 3e-4))),
        ("eight-ball, 9 ft, side, 20 um",
         scene("eight_ball", "nine_foot", 2e-5, (0.35, 0.55), straight_at(foot, (0.35, 0.55))),
         SPEED, "8", None),
        ("eight-ball, 9 ft, second ball, 20 um",
         scene("eight_ball", "nine_foot", 2e-5, second, straight_at(second_ball, second)), SPEED, "8", None),
        ("nine-ball, 9 on the spot, break box, 10 um",
         scene("nine_ball", "nine_foot", 1e-5, side, straight_at(nine_apex, side), "spot_ball = 9\n"), SPEED,
         "9", ("success", 75, 105, "WPA World 9-Ball 2016")),
        ("nine-ball, 1 on the spot, beside the rail, 10 um",
         scene("nine_ball", "nine_foot", 1e-5, rail, straight_at(foot, rail)),
         SPEED, "9", None),
        ("nine-ball, 1 on the spot, beside the rail, soft",
         scene("nine_ball", "nine_foot", 0.0, soft, straight_at(foot, soft)),
         "uniform(3.0,4.0)", "9", None),
        ("nine-ball, 1 on the spot, break box, 50 um",
         scene("nine_ball", "nine_foot", 5e-5, side, straight_at(foot, side)), SPEED, "9",
         None),
        ("ten-ball, middle, touching", scene("ten_ball", "nine_foot", 0.0, (0.635, 0.55), 90.0), SPEED, "10",
         ("a ball falls", 87, 99, "TAR, Van Boening; his opponent 63 of 85")),
        ("ten-ball, side, 10 um",
         scene("ten_ball", "nine_foot", 1e-5, (0.4, 0.55), straight_at(foot, (0.4, 0.55))), SPEED, "10",
         ("a ball falls", 87, 99, "the same")),
        ("ten-ball, farther to the side, hard, 10 um",
         scene("ten_ball", "nine_foot", 1e-5, (0.3, 0.55), straight_at(foot, (0.3, 0.55))),
         "uniform(8.1,10.4)", "10", None),
    ]


def wilson(hits, games):
    z, p = 1.959964, hits / games
    middle = (p + z * z / (2 * games)) / (1 + z * z / games)
    half = z / (1 + z * z / games) * math.sqrt(p * (1 - p) / games + z * z / (4 * games * games))
    return middle - half, middle + half


def share(hits, games):
    low, high = wilson(hits, games)
    return f"{hits / games:.3f} ({low:.3f}-{high:.3f})"


def row(carom, name, text, speed, money, real, count):
    with tempfile.TemporaryDirectory() as folder:
        path, out = pathlib.Path(folder, "break.toml"), pathlib.Path(folder, "out.csv")
        path.write_text(text)
        vary = [f"--vary={v}" for v in VARY + [f"cue.speed={speed}"]]
        subprocess.run([carom, "sweep", path, *vary, "--count", str(count), "--seed", "1", "-o", out],
                       check=True, capture_output=True)
        with open(out, newline="") as table:
            shots = [r for r in csv.DictReader(table) if r["status"] == "at_rest"]
    fallen = [[b for b in r["pocketed"].split(";") if b] for r in shots]
    balls = [[b for b in f if b != "cue"] for f in fallen]
    games = len(shots)
    any_ball, scratch = sum(map(bool, balls)), sum("cue" in f for f in fallen)
    success = sum(bool(b) and "cue" not in f for b, f in zip(balls, fallen))
    seconds = sum(float(r["duration"]) for r in shots) / games
    counted = ""
    if real:
        what, hits, of, event = real
        counted = f"{what} {share(hits, of)}, {event}"
    return (f"| {name} | {share(any_ball, games)} | {sum(map(len, balls)) / games:.2f} | "
            f"{scratch / games:.3f} | {share(success, games)} | "
            f"{sum(money in b for b in balls) / games:.3f} | {seconds:.1f} | {counted} |")


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--carom", default=str(ROOT / "build" / "release" / "carom"))
    parser.add_argument("--count", type=int, default=2000, help="breaks of a kind (default: 2000)")
    parser.add_argument(
        "-o", "--output", type=pathlib.Path, help="page whose table is written anew (default: print)")
    args = parser.parse_args()
    lines = ["| break | a ball falls | balls | cue ball falls | success | 8, 9 or 10 falls | s | counted |",
             "|---|---|---|---|---|---|---|---|"]
    lines += [row(args.carom, *each, args.count) for each in breaks()]
    table = "\n".join(lines) + "\n"
    if not args.output:
        print(table, end="")
        return
    page = args.output.read_text()
    new, found = re.subn(
        r"(<!-- begin breaks -->\n).*?(<!-- end breaks -->)", lambda m: m[1] + table + m[2], page, flags=re.S)
    if not found:
        raise SystemExit(f"{args.output}: there are no marks <!-- begin breaks --> and <!-- end breaks -->")
    args.output.write_text(new)


if __name__ == "__main__":
    main()
