#!/usr/bin/env python3
"""The same rungs built with several compilers and flags, interleaved in one run.

    lab/measure/compilers_kernel.py gcc=BUILD/carom_one_rung clang=OTHER/carom_one_rung [--json FILE]
"""
import argparse
import json
import pathlib
import subprocess

RUNGS = ["baseline", "rsqrt newton", "branch hints", "masks", "precomputed", "fma", "packed blocks",
         "simd loop", "simd ssa", "combined", "paper flags", "reduced state", "packed", "carried roots",
         "decoupled roots", "summed"]


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", nargs="+", help="name=path")
    parser.add_argument("--isa", default="v3")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--json")
    args = parser.parse_args()
    programs = dict(p.split("=", 1) for p in args.programs)
    least = {}
    for _ in range(args.rounds):
        for rung in RUNGS:
            for name, path in programs.items():
                out = subprocess.run(
                    [path, rung, args.isa, "40"], check=True, capture_output=True, text=True).stdout
                key = (rung, name)
                least[key] = min(least.get(key, 1e30), float(out.split()[1]))
    rows = [{"name": rung, "compiler": name, "ns": ns} for (rung, name), ns in least.items()]
    for rung in RUNGS:
        print(f"{rung:<22}" + "".join(f"{name:>10}{least[rung, name]:>9.0f}" for name in programs))
    if args.json:
        pathlib.Path(args.json).write_text(json.dumps({"isa": args.isa, "rows": rows}, indent=1) + "\n")


if __name__ == "__main__":
    main()
