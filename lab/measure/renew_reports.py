#!/usr/bin/env python3
"""Repeats the measurements of the lab notes about accuracy and margins: their figures, and the tables between
the marks <!-- begin NAME --> and <!-- end NAME -->.

Writes only notes of lab/notes/. A note is never changed later: for new notes, copy the old ones and name the
copies with --accuracy and --margins. Best run on an idle machine.

    cmake --build --preset release --target carom_lab_program carom_detectors
    lab/measure/renew_reports.py [--quick] [--only NAME ...]

Runs for about a quarter of an hour, or about three minutes with --quick, which measures less. Needs
python3-matplotlib.
"""
import argparse
import datetime
import json
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
DOC_IMAGES = ROOT / "docs/images"
NOTE_IMAGES = ROOT / "lab/notes/images"


def image(name):
    """The path of a figure, which is among the images of docs if a page there also shows it."""
    folder = DOC_IMAGES if (DOC_IMAGES / name).exists() else NOTE_IMAGES
    return folder / name

BREAK = "scenes/eight_ball_break.toml"
THROW = "scenes/half_ball_throw.toml"


class Renewal:
    def __init__(self, build, quick):
        self.build, self.quick = build, quick

    def call(self, *command, status=(0,)):
        print("renew_reports:", *command, file=sys.stderr)
        done = subprocess.run([str(c) for c in command], cwd=ROOT, capture_output=True, text=True)
        if done.returncode not in status:
            sys.exit(f"renew_reports: exit status {done.returncode}\n{done.stderr}")
        return done.stdout

    def carom(self, *arguments):
        return self.call(self.build / "carom-lab", *arguments)

    def machine(self):
        commit = self.call("git", "describe", "--always", "--dirty").strip()
        cpu = next(
            (line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")),
            "unknown")
        compiler = self.call("c++", "--version").split("\n")[0]
        load, cores = os.getloadavg()[0], os.cpu_count()
        text = (f"{datetime.date.today()}, commit {commit}, {cpu}, {cores} cores, {compiler}; "
                f"load when this began: {load:.1f}.")
        if load > 0.75 * cores:
            text += (" **Other work ran beside it.** Wall times (every figure of a frame) are then far too "
                     "long, processor times somewhat: read them as ratios, or measure again.")
        return text

    def kernel(self):
        result = json.loads(self.carom("accuracy", "kernel", "--json", "--count", 200 if self.quick else 2000,
                                       "--plot", image("accuracy_kernel.svg")))
        ns = lambda x: "-" if x is None else f"{x:.0f}"  # noqa: E731
        text = "| method | kind | 1e-3 | 1e-6 | 1e-9 | 1e-12 |\n|---|---|---|---|---|---|\n"
        reach = result["reach"]
        for i in range(0, len(reach), 4):
            cells = " | ".join(f"{ns(r['ns_median'])} / {ns(r['ns_all'])}" for r in reach[i:i + 4])
            text += f"| {reach[i]['method']} | {reach[i]['kind']} | {cells} |\n"
        text += (f"\n{result['impacts']} random impacts, {result['isa']}; "
                 f"the two converged methods agree within {result['agreement']:.1e} on all "
                 f"of these and disagree on {result['disagreeing']} more. "
                 f"Slope of the march's median error over N: {result['slope']:.2f}.\n")
        text += ("\n| method | setting | ns (minimum) | median error | 99 % | worst |\n"
                 "|---|---|---|---|---|---|\n")
        for r in result["rows"]:
            if r["kind"] == "single" and not re.match("march .", r["method"]):
                text += (f"| {r['method']} | {r['setting']} | {r['ns']:.0f} | {r['error_median']:.1e} | "
                         f"{r['error_p99']:.1e} | {r['error_max']:.1e} |\n")
        return text

    def scene(self, path, figure, *more):
        result = json.loads(self.carom("accuracy", path, "--box2d", "--json", "--plot", image(figure), *more))
        text = ("| method | setting | us (minimum, median) | kernel | clusters | final error (m) | "
                "outcome |\n|---|---|---|---|---|---|---|\n")
        for r in result["rows"]:
            share = lambda x: "" if x is None else f"{100 * x:.0f} %"  # noqa: E731
            kinds = (("order", "same_order"), ("first contact", "same_first_contact"),
                     ("pockets", "same_pocketed"))
            same = [w for w, k in kinds if r[k] is False]
            error = "-" if r["error_max"] is None else f"{r['error_max']:.1e}"
            text += (f"| {r['method']} | {r['setting']} | {r['ns'] / 1e3:.1f}, {r['ns_median'] / 1e3:.1f} | "
                     f"{share(r['kernel_share'])} | {share(r['cluster_share'])} | {error} | "
                     f"{'same' if not same else 'other ' + ', '.join(same)} |\n")
        ends = f"the two converged runs end {result['agreement']:.1e} m apart"
        return text + f"\nGain {result['gain']:.1e}; {ends}.\n\n> " + result["recommendation"] + "\n"

    def break_(self):
        return self.scene(BREAK, "accuracy_break.svg")

    def throw(self):
        return self.scene(THROW, "accuracy_throw.svg")

    def experiments(self):
        out = self.call(sys.executable, ROOT / "lab/measure/accuracy_experiments.py", "--program",
                        self.build / "carom", "--count", 20 if self.quick else 100, "--noise-count",
                        5 if self.quick else 25, "--images", NOTE_IMAGES)
        return re.sub("^### ", "#### ", out.strip(), flags=re.M) + "\n"

    def detectors(self):
        return self.call(self.build / "lab/measure/carom_detectors", 2000 if self.quick else 20000)

    def margin(self):
        text = ("| size | fps | budget | p50 | p99 | worst | missed | without files | simulate p99 | "
                "draw p50 | read p50 | encode p50 | write p50 | parts / process |\n"
                "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n")
        for size in ("1280x720", "1920x1080"):
            for fps in (60, 120, 240):
                plot = ["--plot", image("margin_break.svg")] if (size, fps) == ("1280x720", 60) else []
                m = json.loads(self.carom("margin", BREAK, "--json", "--fps", fps, "--size", size, "--repeat",
                                          1 if self.quick else 3, *plot))
                s = m["stages"]
                text += (f"| {size} | {fps} | {m['budget_ms']:.2f} | {m['total']['p50']:.2f} | "
                         f"{m['total']['p99']:.2f} | {m['worst']['ms']:.2f} | "
                         f"{m['missed']} of {m['frames']} | {m['missed_without_files']} | "
                         f"{s['simulate']['p99']:.3f} | {s['draw']['p50']:.2f} | "
                         f"{s['readback']['p50']:.2f} | {s['encode']['p50']:.2f} | "
                         f"{s['write']['p50']:.2f} | {100 * m['process']['share']:.1f} % |\n")
        m = json.loads(self.carom("margin", BREAK, "--json", "--no-render", "--repeat", 9, "--plot",
                                  image("margin_simulation.svg")))
        t, s = m["timing"], m["stages"]["simulate"]
        return (f"{text}\nms. Simulation alone (`--no-render --repeat 9`): its worst frame takes "
                f"{s['max']:.3f} ms, p99 {s['p99']:.3f} ms. "
                f"Timing itself: {t['simulate_timed_ms']:.3f} ms with, "
                f"{t['simulate_ms']:.3f} ms without ({100 * t['share']:+.1f} %), "
                f"{t['clock_ns']:.0f} ns a look at the clock.\n")

    def sweep(self):
        text = ""
        for more, figure, title in ((["--no-render"], "margin_sweep.svg", "Simulation only"),
                                    ([], "margin_sweep_drawn.svg", "Drawn at 720p")):
            result = json.loads(self.carom("margin", BREAK, "--sweep", "--json", "--repeat",
                                           1 if self.quick else 3, "--plot", image(figure), *more))
            rates = sorted({r["fps"] for r in result["rows"]})
            text += f"{title}: frames missed (worst frame in % of its time)\n\n| setting | "
            text += " | ".join(f"{f:g} fps" for f in rates)
            text += " | real time up to |\n|---" + "|---" * (len(rates) + 1) + "|\n"
            for f in result["frontier"]:
                rows = [
                    r for r in result["rows"] if (r["method"], r["setting"]) == (f["method"], f["setting"])]
                cells = " | ".join(
                    f"{r['missed']} ({100 * r['worst_ms'] / r['budget_ms']:.0f} %)" for r in rows)
                fastest = "-" if f["fps"] is None else f"{f['fps']:g} fps"
                text += f"| {f['method']} {f['setting']} | {cells} | {fastest} |\n"
            text += "\n"
        return text


ACCURACY = ("machine", "kernel", "break", "throw", "experiments", "detectors")
MARGINS = ("machine", "margin", "sweep")


def lab_note(name):
    path = (ROOT / name).resolve()
    if path.parent != ROOT / "lab/notes" or not path.is_file():
        raise argparse.ArgumentTypeError(f"{name} is no note of lab/notes/")
    return path


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default=str(ROOT / "build/release"))
    parser.add_argument("--quick", action="store_true", help="fewer impacts, shots and repeats")
    parser.add_argument("--accuracy", type=lab_note, default="lab/notes/2026-11-accuracy_experiments.md",
                        help="note to write (%(default)s)")
    parser.add_argument("--margins", type=lab_note, default="lab/notes/2026-11-margins.md",
                        help="note to write (%(default)s)")
    names = sorted({*ACCURACY, *MARGINS})
    parser.add_argument("--only", nargs="+", choices=names, help="renew these only (default: all)")
    options = parser.parse_args()
    renewal = Renewal(pathlib.Path(options.build).resolve(), options.quick)
    for page, parts in ((options.accuracy, ACCURACY), (options.margins, MARGINS)):
        for name in parts:
            if options.only and name not in options.only:
                continue
            new = getattr(renewal, "break_" if name == "break" else name)()
            text = page.read_text()
            begin, end = f"<!-- begin {name} -->\n", f"<!-- end {name} -->"
            if begin not in text or end not in text:
                sys.exit(f"renew_reports: {page}: the marks of {name} are missing")
            head, rest = text.split(begin, 1)
            page.write_text(head + begin + new.strip() + "\n" + end + rest.split(end, 1)[1])


if __name__ == "__main__":
    main()
