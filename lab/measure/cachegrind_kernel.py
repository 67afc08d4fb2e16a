#!/usr/bin/env python3
"""Instructions, loads, stores, cache and branch misses per step, by cachegrind, for variants with one impact
per call.

Valgrind supports AVX2 but not AVX-512, so the levels are scalar and v3. Subtracting two runs of different
length removes the cost of start-up. --perf adds the hardware counters if perf can read them.

    lab/measure/cachegrind_kernel.py --one-variant build/release/lab/measure/carom_one_variant [--json FILE]
                                     [--perf]
"""
import argparse
import json
import pathlib
import re
import subprocess
import tempfile

VARIANTS = ["baseline", "fewer square roots", "rsqrt newton", "branch hints", "branch order",
         "unconditional roots", "masks", "two stages", "precomputed", "fma", "packed blocks", "simd loop",
         "simd ssa", "combined", "reduced state", "packed", "carried roots", "decoupled roots", "summed"]


def cachegrind(program, variant, isa, calls):
    with tempfile.NamedTemporaryFile() as out:
        run = subprocess.run(["valgrind", "--tool=cachegrind", "--cache-sim=yes", "--branch-sim=yes",
                              f"--cachegrind-out-file={out.name}", program, variant, isa, str(calls)],
                             capture_output=True, text=True)
        if run.returncode != 0:
            return None
        text = pathlib.Path(out.name).read_text()
    names = re.search(r"^events: (.*)$", text, re.M).group(1).split()
    totals = [int(x) for x in re.search(r"^summary: (.*)$", text, re.M).group(1).split()]
    return int(run.stdout.split()[0]), dict(zip(names, totals))


def perf(program, variant, isa, calls):
    events = ["instructions", "cycles", "branch-misses", "L1-dcache-load-misses"]
    run = subprocess.run(["perf", "stat", "-x,", "-e", ",".join(events), program, variant, isa, str(calls)],
                         capture_output=True, text=True)
    counts = {}
    for line in run.stderr.splitlines():
        parts = line.split(",")
        if len(parts) > 2 and parts[0].isdigit():
            counts[parts[2]] = int(parts[0])
    return counts


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--one-variant", required=True)
    parser.add_argument("--json")
    parser.add_argument("--perf", action="store_true")
    args = parser.parse_args()
    rows = []
    print(f"{'a step':<22}{'isa':<8}{'instr':>8}{'loads':>8}{'stores':>8}{'L1 miss':>9}"
          f"{'branches':>9}{'mispred':>9}")
    for variant in VARIANTS:
        for isa in ("scalar", "v3"):
            few, many = (cachegrind(args.one_variant, variant, isa, calls)
                         for calls in (2, 12))
            if few is None or many is None:
                continue
            steps = many[0] - few[0]
            per = {k: (many[1][k] - few[1][k]) / steps for k in many[1]}
            row = {"name": variant, "isa": isa, "instructions": per["Ir"], "loads": per["Dr"],
                   "stores": per["Dw"], "l1_misses": per["D1mr"] + per["D1mw"],
                   "last_level_misses": per["DLmr"] + per["DLmw"], "branches": per["Bc"] + per["Bi"],
                   "mispredicted": per["Bcm"] + per["Bim"]}
            if args.perf:
                row["perf"] = perf(args.one_variant, variant, isa, 2000)
            rows.append(row)
            print(f"{variant:<22}{isa:<8}{row['instructions']:>8.1f}{row['loads']:>8.2f}{row['stores']:>8.2f}"
                  f"{row['l1_misses']:>9.5f}{row['branches']:>9.2f}{row['mispredicted']:>9.4f}", flush=True)
    if args.json:
        pathlib.Path(args.json).write_text(json.dumps({"rows": rows}, indent=1) + "\n")


if __name__ == "__main__":
    main()
