#!/usr/bin/env python3
"""The cost of the contact phase of a rack: baseline impacts, steps, instructions by part, and the error of
fewer steps.

A cue ball hits a touching rack of 15 head-on at 8 m/s (pool balls, the engine's defaults). The kernel is
recompiled for each row, with other constants in its step rule or for callgrind. The baseline impact is
the published march with N = 1000 on the first of the five states, timed in the same run. The error is the
largest difference in a velocity or R w from steps of at most 1/1280 with an error of 1e-8 [V], over 20 racks
(gaps to 0.2 mm, off-axis, spin). Needs g++, and valgrind for --parts.

    lab/measure/contact_phase.py [--parts] [--isa v3] [--rounds 200]
"""
import argparse
import collections
import pathlib
import re
import shutil
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROBE = r"""
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>
#include "base/clock.h"
#include "bench/five_states.h"
#include "kernel_set.h"
#include "reference/random_impacts.h"
using namespace carom;
namespace isa = kernel::CAROM_ISA_NAMESPACE;
constexpr double kV = 8.0, kR = 0.028575;
const double kL = std::pow(kV * kV / 4.736e9, 0.4);  // kContactStiffness of the engine
struct Rack {
    std::vector<double> motion;
    std::vector<kernel::HertzContact> contacts;
};
// Ball 0 is the cue ball, in front of the apex. `gap` [m] is the largest.
Rack rack(reference::Generator& rng, double gap, double aside, double spin) {
    std::vector<double> x{-2.0 * std::sqrt(1.0 - aside * aside)}, y{2.0 * aside};
    for (int row = 0; row < 5; ++row)
        for (int k = 0; k <= row; ++k) x.push_back(row * std::sqrt(3.0)), y.push_back(2.0 * k - row);
    Rack r;
    for (std::size_t i = 0; i < x.size(); ++i)
        for (std::size_t j = i + 1; j < x.size(); ++j) {
            const double d = std::hypot(x[j] - x[i], y[j] - y[i]);
            if (d < 2.001) {
                const double apart = i == 0 ? 0.0 : -rng.uniform(0.0, gap) / kL;
                r.contacts.push_back({int(i), int(j), (x[j] - x[i]) / d, (y[j] - y[i]) / d, apart});
            }
        }
    r.motion.assign(5 * x.size(), 0.0);
    r.motion[0] = 1.0;
    for (int k = 2; k < 5; ++k) r.motion[k] = kR * rng.uniform(-spin, spin) / kV;
    return r;
}
long solve(Rack& r, double longest) {
    static std::vector<double> numbers;
    static std::vector<int> places;
    const int balls = int(r.motion.size()) / 5, contacts = int(r.contacts.size());
    numbers.resize(kernel::contact_phase_numbers(balls, contacts) + 8);
    places.resize(kernel::contact_phase_places(contacts));
    double* at = numbers.data() + (64 - reinterpret_cast<std::size_t>(numbers.data()) % 64) % 64 / 8;
    const double b = (1.0 - 0.95 * 0.95) * 0.4 / (0.4 - 1.0 / 3.5);
    return isa::contact_phase(
        {balls, contacts, r.motion.data(), r.contacts.data(), at, places.data(), kL / (2.0 * kR)},
        {1.0 - b, b, 1, 0.05, 0.2, 1.3e-3, false}, longest, 2.0, 200.0);
}
int main(int argc, char** argv) {
    reference::Generator rng(5);
    const double longest = std::atof(argv[2]);
    if (std::strcmp(argv[1], "maps") == 0) {
        const Rack head_on = rack(rng, 0.0, 0.0, 0.0);
        long steps = 0;
        for (int k = 0; k < std::atoi(argv[3]); ++k) { Rack r = head_on; steps += solve(r, longest); }
        std::printf("%ld\n", steps);
    } else if (std::strcmp(argv[1], "time") == 0) {
        const Rack head_on = rack(rng, 0.0, 0.0, 0.0);
        std::vector<double> map, impact;
        for (int k = 0; k < std::atoi(argv[3]); ++k) {
            Rack r = head_on;
            double start = tools::thread_ns();
            solve(r, longest);
            map.push_back(tools::thread_ns() - start);
            const tools::BenchImpact& s = tools::kFiveStates[0];
            kernel::ImpactResult out;
            start = tools::thread_ns();
            isa::march(s.ball1, s.ball2, s.params, 1000, out);
            impact.push_back(tools::thread_ns() - start);
        }
        std::sort(map.begin(), map.end()), std::sort(impact.begin(), impact.end());
        Rack r = head_on;
        const std::size_t half = map.size() / 2;
        const double least = map[0] / impact[0], median = map[half] / impact[half];
        std::printf("%ld %.2f %.2f %.0f\n", solve(r, longest), least, median, map[0]);
    } else {  // velocities after the racks
        for (int k = 0; k < 20; ++k) {
            Rack r = rack(rng, k % 4 == 0 ? 0.0 : 2e-4, rng.uniform(-0.3, 0.3), k % 2 == 0 ? 0.0 : 200.0);
            const long steps = solve(r, longest);
            std::printf("%ld", steps);
            for (double v : r.motion) std::printf(" %.17g", v);
            std::printf("\n");
        }
    }
}
"""
SOURCES = ["contact_phase/contact_phase.cpp", "march/march.cpp"]
# Kernel functions that only move numbers; all functions are inlined into one.
GATHER = {"load", "store", "pack", "transpose", "broadcast", "subtract_add"}


def build(folder, isa, step_error, stable, debug=False):
    src = folder / "src"
    shutil.rmtree(src, ignore_errors=True)
    shutil.copytree(ROOT / "kernel" / "src", src)
    law = src / "contact_phase" / "law.h"
    text = law.read_text()
    text, n = re.subn(r"kStepError = [0-9.e-]+", f"kStepError = {step_error}", text)
    text, m = re.subn(r"kFourReach = [0-9.]+", f"kFourReach = {stable}", text)
    assert n == 1 and m == 1, "contact_phase.py: law.h has other constants than this script expects"
    law.write_text(text)
    (folder / "probe.cpp").write_text(PROBE)
    program = folder / "probe"
    subprocess.run(["g++", "-std=c++20", "-O3", "-w", *(["-g"] if debug else []),
                    *([f"-march=x86-64-{isa}"] if isa != "scalar" else []),
                    f"-DCAROM_ISA_NAMESPACE={isa}", "-ffp-contract=off", "-fno-math-errno",
                    f"-I{ROOT}/kernel/include", f"-I{src}", f"-I{ROOT}/kernel", f"-I{ROOT}/tools/carom", "-o",
                    str(program), str(folder / "probe.cpp"),
                    *[str(src / s) for s in SOURCES]], check=True)
    return program


def run(program, *args):
    return subprocess.run([program, *map(str, args)], check=True, capture_output=True, text=True).stdout


def racks(program, longest):
    rows = [[float(x) for x in line.split()] for line in run(program, "racks", longest).splitlines()]
    return [row[0] for row in rows], [row[1:] for row in rows]


def functions(path):
    """The function of every line in a file: the last one whose head is above it."""
    names, name = {}, "other"
    for number, line in enumerate(path.read_text().splitlines(), 1):
        head = re.match(r"(?:CAROM_INLINE|inline|template|long|void|double)\b.*?(\w+)\(", line)
        if head and not line.startswith(" "):
            name = head[1]
        names[number] = name
    return names


def parts(folder, isa, longest):
    program = build(folder, isa, "1e-4", "4.8", debug=True)
    counts, steps = [], []
    for maps in (10, 20):
        out = folder / "callgrind"
        command = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", program, "maps",
                   str(longest), str(maps)]
        run_ = subprocess.run(command, check=True, capture_output=True, text=True)
        steps.append(int(run_.stdout))
        costs, file, names = collections.Counter(), None, {}
        known, calls = {}, False
        for line in out.read_text().splitlines():
            tag = re.match(r"(c?)f[lie]=\((\d+)\)(?: (.*))?", line)
            if tag:
                if tag[3]:
                    known[tag[2]] = tag[3]
                if not tag[1]:  # otherwise it is the file of a called function
                    file = pathlib.Path(known[tag[2]])
            elif line.startswith("calls="):
                calls = True
            elif re.match(r"[+\-*\d]", line) and file is not None:
                where, cost = line.split()[:2]
                number = int(where) if where.isdigit() else number + (0 if where == "*" else int(where))
                if not calls and file.exists() and file.is_relative_to(folder):
                    if file not in names:
                        names[file] = functions(file)
                    costs[names[file].get(number, "other")] += int(cost)
                calls = False
        counts.append(costs)
    per = {k: (counts[1][k] - counts[0][k]) / 10 for k in counts[1]}
    total, per_step = sum(per.values()), (steps[1] - steps[0]) / 10
    print(f"\ninstructions of one map: {total:.0f}, {total / per_step:.0f} a step")
    moved = sum(v for k, v in per.items() if k in GATHER)
    kinds = ", ".join(sorted(GATHER))
    print(f"moving numbers (loads, stores, shuffles: {kinds}): {100 * moved / total:.0f} %")
    for name, cost in sorted(per.items(), key=lambda x: -x[1]):
        if cost > 0.01 * total:
            print(f"  {name:<20}{cost / per_step:8.0f} a step {100 * cost / total:5.1f} %")


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--isa", default="v3", choices=["scalar", "v3", "v4"])
    parser.add_argument(
        "--rounds", type=int, default=200, help="maps to time, each beside one baseline impact")
    parser.add_argument(
        "--parts", action="store_true", help="count instructions by part (valgrind; not for v4)")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        _, truth = racks(build(folder, args.isa, "1e-8", "4.8"), 1 / 1280)
        print(f"{'step error [V]':>14}{'longest':>9}{'stable to':>10}{'steps':>7}{'impacts':>9}{'median':>8}"
              f"{'us':>6}{'racks: steps':>14}{'error, median':>15}{'largest':>10}")
        for step_error, longest, stable in [("1e-4", 12, "4.8"), ("1e-4", 8, "4.8"), ("1e-4", 4, "4.8"),
                                            ("1e-3", 12, "4.8"), ("1e-3", 4, "4.8"), ("1e-2", 4, "4.8"),
                                            ("1e-4", 12, "7.0"), ("1e-2", 4, "7.0")]:
            program = build(folder, args.isa, step_error, stable)
            steps, ratio, median, ns = run(program, "time", 1 / longest, args.rounds).split()
            many, motion = racks(program, 1 / longest)
            errors = sorted(max(abs(a - b) for a, b in zip(x, y)) for x, y in zip(motion, truth))
            print(f"{step_error:>14}{f'1/{longest}':>9}{stable:>10}{steps:>7}{ratio:>9}{median:>8}"
                  f"{float(ns) / 1e3:>6.0f}{sum(many) / len(many):>14.0f}"
                  f"{errors[len(errors) // 2]:>15.1e}{errors[-1]:>10.1e}")
        if args.parts:
            parts(folder, args.isa, 1 / 12)


if __name__ == "__main__":
    main()
