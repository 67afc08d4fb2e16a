#!/usr/bin/env python3
"""The cost of Python on top of the engine: importing, one shot, a batch, and states, in one process,
alternating.

The engine's batch is carom_simulate_many of libcarom.so, which passes its arrays to the engine unchanged.
Both play the same shots from the same arrays on one thread. CPU time of the thread; the fastest of the rounds
and the median of the ratios.

    lab/measure/python_speed.py [--package build/release/python] [--rounds 15]
                                [--library build/release/capi/libcarom.so]
"""
import argparse
import ctypes
import os
import pathlib
import platform
import resource
import statistics
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]


def timed(work):
    start = time.thread_time()
    work()
    return time.thread_time() - start


def each(work, rounds, calls=20):
    """The fewest seconds per call, over rounds of many calls."""

    def some():
        for _ in range(calls):
            work()

    return min(timed(some) for _ in range(rounds)) / calls


def import_cost(module, rounds, package):
    """The fewest CPU seconds of a Python process that only imports a module."""
    best = 1e9
    for _ in range(rounds):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(
            [sys.executable, "-c", f"import {module}"], check=True, env={**os.environ, "PYTHONPATH": package})
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        best = min(best, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    return best


class Engine:
    """A batch through libcarom.so."""

    def __init__(self, library, scene):
        self.c = ctypes.CDLL(library)
        self.scene = ctypes.c_void_p()
        if self.c.carom_scene_parse(scene.source.encode(), b"scene", ctypes.byref(self.scene)) != 0:
            raise RuntimeError("the library refuses the scene")

    def play(self, keys, values):
        names = (ctypes.c_char_p * len(keys))(*[key.encode() for key in keys])
        batch = ctypes.c_void_p()
        pointer = values.ctypes.data_as(ctypes.POINTER(ctypes.c_double))
        if self.c.carom_simulate_many(self.scene, ctypes.c_size_t(values.shape[1]),
                                      ctypes.c_size_t(len(keys)), names, pointer,
                                      ctypes.c_double(-1.0), 1, 0, ctypes.byref(batch)) != 0:
            raise RuntimeError("the library plays no batch")
        self.c.carom_batch_free(batch)


def batches(library, rounds):
    import carom
    import numpy as np

    random = np.random.default_rng(3)
    print(f"{'batch of':<18}{'shots':>8}{'engine':>14}{'Python':>14}{'with out=':>14}   median of "
          "engine/Python, engine/out=")
    for name, n in (("draw", 20000), ("three_cushion", 20000), ("eight_ball_break", 1000)):
        scene = carom.Scene.load(ROOT / "scenes" / f"{name}.toml")
        speed = scene.to_dict()["cue"]["speed"]
        aim = scene.to_dict()["cue"].get("aim_deg", 90.0)
        mean = [speed, aim, 0.0, 0.0, 0.1]
        cue = random.normal(mean, [0.02 * speed, 0.5, 0.0, 0.02, 0.02], (n, 5))
        cue[:, 2] = 0.0
        keys = ["cue.speed", "cue.aim_deg", "cue.elevation_deg", "cue.offset.side", "cue.offset.height"]
        values = np.ascontiguousarray(cue.T)
        engine = Engine(library, scene)
        out = carom.Shots.empty(n, len(scene.ids))
        rows = []
        for _ in range(rounds):
            rows.append((timed(lambda: engine.play(keys, values)),
                         timed(lambda: carom.simulate_many(scene, cue=cue)),
                         timed(lambda: carom.simulate_many(scene, cue=cue, out=out))))
        rates = [n / min(column) for column in zip(*rows)]
        print(f"{name:<18}{n:>8}" + "".join(f"{rate:>12.0f}/s" for rate in rates)
              + f"   {statistics.median(e / p for e, p, _ in rows):.3f}, "
                f"{statistics.median(e / o for e, _, o in rows):.3f}")


def one_shot(rounds):
    import carom
    import numpy as np

    for name in ("draw", "eight_ball_break"):
        scene = carom.Scene.load(ROOT / "scenes" / f"{name}.toml")
        print(f"carom.simulate({name}): {1e6 * each(lambda: carom.simulate(scene), rounds):.0f} us")
    record = carom.simulate(scene)
    times = np.linspace(0, record.duration, 453)
    balls = len(record.ids)
    for work, words in (
        (lambda: record.states(times), "states"), (lambda: record.orientations(times), "orientations")
    ):
        print(f"{words} of {balls} balls at 453 times: {1e3 * each(work, rounds):.3f} ms")
    print(f"Scene.load: {1e6 * each(lambda: carom.Scene.load(ROOT / 'scenes/draw.toml'), rounds):.0f} us")


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--package", default=str(ROOT / "build" / "release" / "python"))
    parser.add_argument("--library", default=str(ROOT / "build" / "release" / "capi" / "libcarom.so"))
    parser.add_argument("--rounds", type=int, default=15)
    args = parser.parse_args()
    sys.path.insert(0, args.package)
    model = next(
        (line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")),
        platform.machine())
    print(f"{model}, Python {platform.python_version()}, "
          f"CAROM_ISA={os.environ.get('CAROM_ISA', '(the fastest)')}")
    for module in ("numpy", "carom"):
        print(f"import {module}: {import_cost(module, args.rounds, args.package):.3f} CPU s")
    one_shot(args.rounds)
    batches(args.library, args.rounds)


if __name__ == "__main__":
    main()
