#!/usr/bin/env python3
"""Instructions per event of a shot, by kind of event and by part of the loop, counted by callgrind.

Callgrind dumps its counters at the start of every round of the event loop, so every round is counted
separately. The counts are the same on every machine with the same build. Valgrind supports AVX2 but not
AVX-512: set CAROM_ISA to v3 or scalar. Needs valgrind. Builds the target carom_shot_probe in the folder
--build (default build/release).

    lab/measure/callgrind_shot.py                              the eight-ball break, with sequential clusters
    lab/measure/callgrind_shot.py two_ball_shot --seed 3 --functions 20
    lab/measure/callgrind_shot.py gas --balls 100 --events 500
    lab/measure/callgrind_shot.py --branches --functions 10    mispredicted branches instead of instructions
"""
import argparse
import collections
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

# The first match applies.
PARTS = [
    ("cluster", r"carom::Cluster(s|Map)::"),
    ("kernel", r"carom::kernel::"),
    ("queue", r"EventQueue|Detector::(next|before|closing|place|requeue|first_of)"),
    ("detect", r"Detector::|BoxSearch|b2|time_to_|time_along|stays_|first_descent|bracketed_root|"
               r"closing_speed|refine|along_line|brought_near|first_touch|Descent|unit_roots"),
    ("memory", r"^(_int_malloc|_int_free|malloc|free|operator new|operator delete|malloc_consolidate|"
               r"unlink_chunk|_int_realloc|sysmalloc|memcpy|memset|__mem)|_M_realloc"),
    ("resolve", r""),
]


def part_of(function):
    return next(name for name, pattern in PARTS if re.search(pattern, function))


def self_costs(path, counted):
    """The self cost of every function in one callgrind file, summed over the counted events."""
    costs, names, function, called, columns = collections.Counter(), {}, None, False, []
    for line in path.read_text().splitlines():
        if line.startswith("events:"):
            events = line.split()[1:]
            columns = [1 + events.index(e) for e in counted]
        elif line.startswith("fn="):
            match = re.match(r"fn=(\(\d+\))?\s*(.*)", line)
            key, name = match.group(1), match.group(2)
            if name:
                names[key] = name
            function = names.get(key, name)
        elif line.startswith(("cfn=", "cfni=")):
            match = re.match(r"cfni?=(\(\d+\))?\s*(.*)", line)
            if match.group(2):
                names[match.group(1)] = match.group(2)
        elif line.startswith("calls="):
            called = True
        elif function and re.match(r"[+\-*\d]", line):
            if called:
                called = False  # this line has the call's inclusive cost
            else:
                fields = line.split()
                costs[function] += sum(int(fields[c]) for c in columns if c < len(fields))
    return costs


def measure(probe, args, folder):
    command = ["valgrind", "--tool=callgrind", "--toggle-collect=carom::simulate(*",
               "--dump-before=*carom::Resolver::resolve(*", "--compress-strings=no",
               f"--branch-sim={'yes' if args.branches else 'no'}", f"--callgrind-out-file={folder}/out",
               str(probe)]
    gas = args.shot in ("gas", "gas compliant")
    command += ["gas", str(args.balls), str(args.events)] if gas else [args.shot, str(args.seed)]
    env = dict(os.environ)
    env.setdefault("CAROM_ISA", "v3")
    run = subprocess.run(command, capture_output=True, text=True, env=env)
    if run.returncode != 0:
        sys.exit(f"callgrind_shot.py: {' '.join(command)} failed:\n{run.stderr[-2000:]}")
    files = sorted(folder.glob("out*"), key=lambda f: int(f.suffix[1:] or 0) if f.suffix else 1 << 30)
    return run.stdout.split("\n")[:-1], [
        self_costs(f, ["Bcm", "Bim"] if args.branches else ["Ir"]) for f in files]


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("shot", nargs="?", default="eight_ball_break",
                        help="a shot of carom-lab bench shot, or gas (default: eight_ball_break)")
    parser.add_argument("--seed", type=int, default=0, help="seed of the shot (default: 0, as in scenes/)")
    parser.add_argument("--balls", type=int, default=16, help="balls of the gas (default: 16)")
    parser.add_argument("--events", type=int, default=300, help="events of the gas (default: 300)")
    parser.add_argument(
        "--functions", type=int, default=0, metavar="N", help="also print the N most costly functions")
    parser.add_argument(
        "--branches", action="store_true", help="count mispredicted branches (default: instructions)")
    parser.add_argument("--build", default="build/release", help="build folder (default: build/release)")
    parser.add_argument("--json", metavar="FILE", help="write the counts")
    args = parser.parse_args()
    if shutil.which("valgrind") is None:
        sys.exit("callgrind_shot.py: valgrind is not installed; run apt-get install valgrind")
    build = pathlib.Path(args.build)
    if not (build / "CMakeCache.txt").exists():
        sys.exit(f"callgrind_shot.py: {build} is not a build folder; run cmake --preset release first")
    subprocess.run(["cmake", "--build", str(build), "--target", "carom_shot_probe"], check=True,
                   stdout=subprocess.DEVNULL)
    with tempfile.TemporaryDirectory() as folder:
        kinds, dumps = measure(build / "tools" / "measure" / "carom_shot_probe", args, pathlib.Path(folder))
    # One dump precedes the first round (set-up, first detection), then one follows per round; the last also
    # has the end of the run.
    if len(dumps) < len(kinds) + 1:
        sys.exit(
            f"callgrind_shot.py: {len(kinds)} rounds but {len(dumps)} dumps; is it still Resolver::resolve?")
    dumps = [d for d in dumps if sum(d.values())]
    rows = collections.defaultdict(lambda: [0, collections.Counter()])
    total = collections.Counter()
    for kind, dump in zip(["(set-up)"] + kinds, dumps):
        rows[kind][0] += 1
        for function, cost in dump.items():
            rows[kind][1][part_of(function)] += cost
            total[function] += cost
    names = [name for name, _ in PARTS]
    what = "mispredicted branches" if args.branches else "instructions"
    print(f"{args.shot}: {len(kinds)} events, {sum(total.values())} {what}; mean {what} of an event\n")
    print(f"{'':<22}{'count':>6}{'all':>9}" + "".join(f"{n:>9}" for n in names))
    for kind, (count, parts) in sorted(rows.items(), key=lambda r: -sum(r[1][1].values())):
        print(f"{kind:<22}{count:>6}{sum(parts.values()) / count:>9.0f}"
              + "".join(f"{parts[n] / count:>9.0f}" for n in names))
    if args.functions:
        print(f"\n{'count':>12}  share  part      function")
        for function, cost in total.most_common(args.functions):
            print(f"{cost:>12}{100 * cost / sum(total.values()):>6.1f}%  {part_of(function):<9} "
                  f"{function[:110]}")
    if args.json:
        pathlib.Path(args.json).write_text(json.dumps({
            "shot": args.shot, "seed": args.seed, "total": sum(total.values()),
            "kinds": {k: {"count": c, "parts": dict(p)} for k, (c, p) in rows.items()},
            "functions": dict(total.most_common(100))}, indent=1) + "\n")


if __name__ == "__main__":
    main()
