#!/usr/bin/env python3
"""Draws the figures of lab/notes/2026-11-ladder.md (matplotlib).

    carom-lab bench kernel --json > bench.json
    lab/measure/mca_kernel.py --cxx g++ clang++ --json mca.json
    lab/measure/cachegrind_kernel.py --one-variant .../carom_one_variant --json cachegrind.json
    lab/measure/compilers_kernel.py gcc=... clang=... --json compilers.json
    carom_count_operations > counts.json
    lab/measure/kernel_figures.py DIRECTORY_WITH_THE_FIVE lab/notes/images
"""
import json
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

FLOPS = ("add", "mul", "fma", "div", "sqrt", "rsqrt")
COLOURS = {"scalar": "#888888", "v3": "#1f6fb4", "v4": "#d9822b"}


def short(name):
    return name.replace("march ", "")


def save(figure, folder, name):
    figure.tight_layout()
    figure.savefig(folder / f"kernel_{name}.png", dpi=90, metadata={"Software": None})
    plt.close(figure)


def bars(folder, name, title, rows, label, log=False, line=None):
    """Horizontal bars of rows: {group: {key: value}}, one colour per key."""
    groups = list(rows)
    keys = []
    for values in rows.values():
        keys += [k for k in values if k not in keys]
    figure, axes = plt.subplots(figsize=(8, 1.2 + 0.12 * len(groups) * (len(keys) + 0.8)))
    height = 0.8 / len(keys)
    for j, key in enumerate(keys):
        axes.barh([i + j * height for i in range(len(groups))], [rows[g].get(key, 0) for g in groups], height,
                  label=key, color=COLOURS.get(key))
    axes.set_yticks([i + 0.4 - height / 2 for i in range(len(groups))])
    axes.set_yticklabels(groups, fontsize=8)
    axes.invert_yaxis()
    axes.set_xlabel(label)
    axes.set_title(title, fontsize=10)
    if log:
        axes.set_xscale("log")
    if line is not None:
        axes.axvline(line, color="black", linewidth=0.8)
    axes.legend(fontsize=8)
    axes.grid(axis="x", alpha=0.3)
    save(figure, folder, name)


def by(rows, key, value, group="name", want=lambda r: True):
    table = {}
    for r in rows:
        if want(r):
            table.setdefault(short(r[group]), {})[r[key]] = r[value] if isinstance(value, str) else value(r)
    return table


def main():
    source, folder = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    data = {p.stem: json.loads(p.read_text()) for p in source.glob("*.json")}
    bench = data["bench"]["rows"]
    march = [r for r in bench if r["name"].startswith("march")]
    single = [r for r in march if r["kind"] == "single"]
    counts = {r["name"]: r for r in data["counts"]["per_step"]}
    bars(folder, "ratio", "One impact, N = 1000: times faster than the plain march (five states)",
         by(single, "isa", "ratio"), "ratio", log=True, line=1.0)
    bars(folder, "lanes", "Batches, per impact: times faster than the plain march (2000 random impacts)",
         by([r for r in march if r["kind"] == "batch"], "isa", "ratio_random"), "ratio", line=1.0)
    bars(folder, "cycles", "Cycles a step, measured", by(single, "isa", "cycles_per_step"), "cycles")
    bars(folder, "operations", "Operations a step (counting number type)",
         {n: {k: r[k] for k in FLOPS} for n, r in counts.items()}, "operations")
    cycles = {(short(r["name"]), r["isa"]): r["cycles_per_step"] for r in single}
    flops = {}
    for name, r in counts.items():
        for isa in ("scalar", "v3"):
            if (name, isa) in cycles:
                flops.setdefault(name, {})[isa] = (sum(r[k] for k in FLOPS) + r["fma"]) / cycles[name, isa]
    bars(folder, "flops", "Floating-point operations a cycle (an fma is two)", flops, "flops a cycle")
    grind = data["cachegrind"]["rows"]
    bars(folder, "memory", "Loads and stores a step (cachegrind, v3)",
         {r["name"]: {"loads": r["loads"], "stores": r["stores"]} for r in grind if r["isa"] == "v3"},
         "references")
    bars(folder, "branches", "Mispredicted branches a step (cachegrind)", by(grind, "isa", "mispredicted"),
         "branches")
    bars(folder, "cache", "First-level cache misses in 1000 steps (cachegrind)",
         by(grind, "isa", lambda r: max(0.0, 1000 * r["l1_misses"])), "misses")
    mca = data["mca"]["rows"]
    bars(folder, "mca", "Cycles a step, llvm-mca for Zen 3",
         by(
             mca, "compiler", lambda r: r["cycles"] / r["steps"], group="loop",
             want=lambda r: r["cpu"] == "znver3"), "cycles")
    bars(folder, "registers", "Vector registers of 160 in use at most, llvm-mca for Zen 3",
         by(mca, "compiler", "fp_registers_used", group="loop", want=lambda r: r["cpu"] == "znver3"),
         "registers")
    bars(folder, "compilers", "gcc 12 against clang 14, v3", by(data["compilers"]["rows"], "compiler", "ns"),
         "ns an impact", log=True)
    figure, axes = plt.subplots(figsize=(8, 5))
    wanted = ("march baseline", "march combined", "march decoupled roots", "march summed",
              "march summed batch", "march 2x4 lanes")
    for name in wanted:
        points = sorted(
            (g["n"], g["ns_min"]) for g in data["bench"]["growth"] if g["name"] == name and g["isa"] == "v3")
        axes.plot([p[0] for p in points], [p[1] for p in points], marker="o", label=short(name))
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("N")
    axes.set_ylabel("ns an impact")
    axes.set_title("Growth with N, v3", fontsize=10)
    axes.legend(fontsize=8)
    axes.grid(alpha=0.3)
    save(figure, folder, "growth")


if __name__ == "__main__":
    main()
