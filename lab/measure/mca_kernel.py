#!/usr/bin/env python3
"""Cycles, bottlenecks and register use of the kernel's loops by llvm-mca.

Compiles one loop per file with gcc (and clang if given), cuts its body out of the assembly at the marks of
kernel/src/loop_marks.h, and simulates it with the jump back to its start. Only the fall-through path is
simulated: code that the compiler moved out of line (a step that falls back, a lane that flips) is excluded.
llvm-mca 14 supports znver1 to znver3 and, for AArch64, apple-m1.

    lab/measure/mca_kernel.py [--cxx g++] [--json FILE]
"""
import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SINGLE = """#include "{header}"
namespace carom::kernel {{
void probe(const Ball& a, const Ball& b, const ImpactParams& p, int n, ImpactResult& out) noexcept {{
    Frame frame; FrameState s;
    if (enter_frame(a, b, p, frame, s, out) != ImpactStatus::kOk) return;
    const long steps = {loop}::loop<-1>(s, p, n);
    leave_frame(a, b, frame, s, steps, out);
}} }}
"""
BATCH = """#include "ladder/batch_driver.h"
namespace carom::kernel {{
void probe(const ImpactBatch& b, int n, const ImpactBatchResult& r) noexcept {{
    BatchMarch<{arguments}, -1>(b, n, r).run();
}} }}
"""
PLAIN = """#include "march/drive.h"
#include "march/loop.h"
namespace carom::kernel {
void probe(const Ball& a, const Ball& b, const ImpactParams& p, int n, ImpactResult& out) noexcept {
    drive<PublishedMarch>(a, b, p, n, out);
} }
"""
SWEEP = """#include "tolerance/single.h"
namespace carom::kernel {{
__attribute__((used)) static bool
probe(const Model& m, State& s, Impulses& t, Stretch& stretch, double root_s) {{
    Stretch asked = stretch;
    asked.given = true;
    const bool ok = collocate<{nodes}, End::{end}>(m, s, t, asked, root_s, false);
    stretch = asked;
    return ok;
}} }}
"""
SHORTEST = 15  # instructions; the shortest complete body, of the packed march, has 17
# name, source, level, and the steps of one impact in a pass of the loop
LOOPS = [
    ("baseline", PLAIN, "v3", 1),
    ("packed", SINGLE.format(header="ladder/packed_march.h", loop="PackedExact"), "v3", 1),
    ("extrapolated seed", SINGLE.format(header="ladder/packed_march.h", loop="ExtrapolatedSeed"), "v3", 1),
    ("pipelined", SINGLE.format(header="ladder/packed_march.h", loop="Pipelined"), "v3", 1),
    ("carried roots", SINGLE.format(header="ladder/packed_march.h", loop="CarriedRoots"), "v3", 1),
    ("decoupled roots", SINGLE.format(header="ladder/decoupled.h", loop="Decoupled"), "v3", 3),
    ("summed, one sweep", SINGLE.format(header="march/summed.h", loop="Summed"), "v3", 1),
    ("tolerance, 4 nodes", SWEEP.format(nodes=4, end="kWhole"), "v3", 1),
    ("tolerance, 8 nodes", SWEEP.format(nodes=8, end="kWhole"), "v3", 1),
    ("tolerance, stretch", SWEEP.format(nodes=8, end="kStretch"), "v3", 1),
    ("four lanes", BATCH.format(arguments="4, 1, LaneExactRoots, SeparateArithmetic"), "v3", 4),
    ("four lanes carried", BATCH.format(arguments="4, 1, LaneCarriedRoots, FusedArithmetic"), "v3", 4),
    ("2x4 lanes", BATCH.format(arguments="4, 2, LaneCarriedRoots, FusedArithmetic"), "v3", 8),
]


def assembly(cxx, source, level, folder):
    path = pathlib.Path(folder) / "probe.cpp"
    path.write_text(source)
    command = [cxx, "-std=c++20", "-O3", f"-march=x86-64-{level}", "-ffp-contract=off", "-DCAROM_LOOP_MARKS",
               "-w", f"-I{ROOT}/kernel/include", f"-I{ROOT}/kernel/src", f"-I{ROOT}/kernel",
               f"-I{ROOT}/lab", "-S", "-o", "-", str(path)]
    if source != PLAIN:  # as lab/ladder/CMakeLists.txt builds it
        command.append("-fno-math-errno")
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()


def arm_assembly(source, folder):
    path = pathlib.Path(folder) / "probe.cpp"
    path.write_text(source)
    command = ["clang++", "--target=aarch64-linux-gnu", "-mcpu=apple-m1", "-std=c++20", "-O3",
               "-ffp-contract=off", "-w", "-DCAROM_LOOP_MARKS", f"-I{ROOT}/kernel/include",
               f"-I{ROOT}/kernel/src", f"-I{ROOT}/kernel", f"-I{ROOT}/lab", "-S", "-o", "-", str(path)]
    run = subprocess.run(command, capture_output=True, text=True)
    return [line.replace("//", "#") if "LLVM-MCA" in line else line for line in run.stdout.splitlines()]


def instructions(lines):
    """The lines without labels, marks and assembler directives."""
    return [line for line in lines if re.match(r"\s+[a-z]", line) and not re.match(r"\s+\.", line)]


def way_back(lines, labels, at, begin, budget=80):
    """The instructions from line `at` to the mark at `begin`, following jumps; None if no short path leads
    there.

    They contain the loop's test, and the register moves that carry a step's result into the next; without
    these, simulated steps would not wait for each other.
    """
    path = []
    while at != begin:
        if at >= len(lines) or len(path) > budget or re.match(r"\s+ret", lines[at]):
            return None
        jump = re.match(r"\s+(j[a-z]+)\s+(\S+)", lines[at])
        path += instructions(lines[at:at + 1])
        if jump and jump[2] in labels:
            taken = way_back(lines, labels, labels[jump[2]], begin, budget - len(path))
            if taken is not None or jump[1] == "jmp":
                return None if taken is None else path + taken
        at += 1
    return path


def body(lines):
    """The longest marked section, and the path back from its end to its start."""
    labels = {line.split(":")[0]: i for i, line in enumerate(lines) if re.match(r"\.?\w+:", line)}
    best, begin, back = [], None, []
    for i, line in enumerate(lines):
        if "LLVM-MCA-BEGIN" in line:
            begin = i
        elif "LLVM-MCA-END" in line and begin is not None:
            code = instructions(lines[begin:i])
            if len(code) > len(best):
                best, back = code, way_back(lines, labels, i, begin) or []
            begin = None
    return best + back


def simulate(code, cpu, triple="x86_64-linux-gnu"):
    command = ["llvm-mca", f"-mtriple={triple}", f"-mcpu={cpu}", "-iterations=300", "-bottleneck-analysis",
               "-register-file-stats"]
    run = subprocess.run(command, input="\n".join(code) + "\n", capture_output=True, text=True)
    if run.returncode != 0:
        return None
    text = run.stdout

    def number(pattern, default=0.0):
        match = re.search(pattern, text)
        return float(match.group(1)) if match else default

    return {
        "instructions": len(code),
        "cycles": number(r"Total Cycles:\s+(\d+)") / 300,
        "throughput_bound": number(r"Block RThroughput:\s+([\d.]+)"),
        "resource_pressure": number(r"Resource Pressure\s+\[ ([\d.]+)%"),
        "data_dependencies": number(r"Data Dependencies:\s+\[ ([\d.]+)%"),
        "fp_registers_used": number(
            r"JFPRegisterFile.*|Zn3FpPRF[\s\S]*?Max number of mappings used:\s+(\d+)"),
    }


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cxx", nargs="+", default=["g++"])
    parser.add_argument("--cpu", nargs="+", default=["znver3"])
    parser.add_argument("--json")
    args = parser.parse_args()
    rows = []
    print(f"{'loop':<22}{'compiler':<12}{'cpu':<9}{'instr':>6}{'cycles':>8}{'/step':>8}{'bound':>7}"
          f"{'data dep':>9}{'fp regs':>8}")
    with tempfile.TemporaryDirectory() as folder:
        for cxx in args.cxx:
            for name, source, level, steps in LOOPS:
                code = body(assembly(cxx, source, level, folder))
                if len(code) < SHORTEST:
                    print(f"{name:<22}{cxx:<12} left out: the compiler moved most of the loop out of line",
                          file=sys.stderr)
                    continue
                for cpu in args.cpu:
                    r = simulate(code, cpu)
                    if r is None:
                        print(f"{name:<22}{cxx:<12}{cpu:<9} llvm-mca cannot simulate it", file=sys.stderr)
                        continue
                    rows.append({"loop": name, "compiler": cxx, "cpu": cpu, "steps": steps, **r})
                    print(f"{name:<22}{cxx:<12}{cpu:<9}{r['instructions']:>6}{r['cycles']:>8.1f}"
                          f"{r['cycles'] / steps:>8.1f}{r['throughput_bound']:>7.1f}"
                          f"{r['data_dependencies']:>8.1f}%{r['fp_registers_used']:>8.0f}")
        code = body(arm_assembly(PLAIN, folder))
        r = simulate(code, "apple-m1", "aarch64-linux-gnu") if code else None
        if r is None:
            print("baseline on apple-m1: clang++ or llvm-mca does not support it", file=sys.stderr)
        else:
            rows.append({"loop": "baseline", "compiler": "clang++", "cpu": "apple-m1", "steps": 1, **r})
            print(f"{'baseline':<22}{'clang++':<12}{'apple-m1':<9}{r['instructions']:>6}{r['cycles']:>8.1f}"
                  f"{r['cycles']:>8.1f}{r['throughput_bound']:>7.1f}{r['data_dependencies']:>8.1f}%")
    if args.json:
        pathlib.Path(args.json).write_text(json.dumps({"rows": rows}, indent=1) + "\n")


if __name__ == "__main__":
    main()
