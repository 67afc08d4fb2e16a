#!/usr/bin/env python3
"""The same variants built with several compilers and flags, interleaved in one run.

    lab/measure/compilers_kernel.py gcc=BUILD/carom_one_variant clang=OTHER/carom_one_variant [--json FILE]
"""
import argparse
import json
import pathlib
import subprocess

VARIANTS = ["baseline", "rsqrt newton", "branch hints", "masks", "precomputed", "fma", "packed blocks",
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
        for variant in VARIANTS:
            for name, path in programs.items():
                out = subprocess.run(
                    [path, variant, args.isa, "40"], check=True, capture_output=True, text=True).stdout
                key = (variant, name)
                least[key] = min(least.get(key, 1e30), float(out.split()[1]))
    rows = [{"name": variant, "compiler": name, "ns": ns} for (variant, name), ns in least.items()]
    for variant in VARIANTS:
        print(f"{variant:<22}" + "".join(f"{name:>10}{least[variant, name]:>9.0f}" for name in programs))
    if args.json:
        pathlib.Path(args.json).write_text(json.dumps({"isa": args.isa, "rows": rows}, indent=1) + "\n")


if __name__ == "__main__":
    main()
