#!/usr/bin/env python3
"""Fits numbers of the preset `carom` to measured paths with carom.fit, for lab/notes/2026-11-tangents.md.

V7 of lab/data/validation states decelerations and V2 speeds right after a snooker cushion, from which places
follow. V8 to V16 state places of object balls; their times count from the first cushion, whose time is
simulated. A place at rest has no time.

    PYTHONPATH=build/release/python lab/measure/fit_measured.py
"""
import pathlib
import tomllib
import warnings

import carom
import numpy as np

DATA = pathlib.Path(__file__).resolve().parents[2] / "lab/data/validation"
G = 9.81


def scene_of(case, shot, preset="carom", keys=""):
    text = case["scene"].replace("{preset}", preset).replace("{keys}", keys).replace("{physics}", "")
    for key, value in shot.get("values", {}).items():
        text = text.replace("{" + key + "}", repr(value))
    return carom.Scene.loads(text)


def read(name):
    return tomllib.loads(next(DATA.glob(f"{name}_*.toml")).read_text())


def rolling():
    print(f"{'speed, m/s':>10}{'measured mu_r':>15}{'interval':>10}{'fitted':>10}{'+-':>10}")
    case = read("V07")
    for shot in case["shot"]:
        told = shot["measured"][0]
        if told["quantity"] != "deceleration":
            continue
        speed, slows = shot["values"]["v"], told["value"]
        t = np.linspace(0.0, 0.9 * speed / slows, 60)
        # Places are known to 0.3 mm.
        noise = 3e-4 * np.random.default_rng(1).standard_normal((60, 2))
        xy = np.column_stack([speed * t - 0.5 * slows * t * t, 0.0 * t]) + noise
        scene = scene_of(case, shot)
        found = carom.fit(scene, t, [scene.ids[0]] * len(t), xy, vary=["balls.mu_r"])
        within = abs(found.x[0] - slows / G) <= told["uncertainty"] / G
        print(f"{speed:10.3f}{slows / G:15.5f}{told['uncertainty'] / G:10.5f}{found.x[0]:10.5f}"
              f"{found.std[0]:10.1g}  {'within' if within and found.success else 'off'}")


def first_cushion(record):
    return next(e.time for e in record.event_list() if e.type in ("ball_cushion", "ball_jaw"))


def snooker():
    """The variant's `e_c_fit` was fitted by hand to the same speeds, as a function of the impact speed."""
    print(f"{'speed, m/s':>10}{'measured at once':>18}{'fitted':>8}{'e_c':>8}{'low':>8}{'high':>8}"
          f"{'by hand':>9}")
    case = read("V02")
    for shot in case["shot"]:
        told, speed = shot["measured"][0], shot["values"]["v"]
        scene = scene_of(case, shot, "snooker", "e_c = 0.9")
        met = first_cushion(carom.simulate(scene))
        start = carom.simulate(scene).states(met)[0, 0, :2]
        t = np.linspace(0.0, 0.005, 20)  # friction costs less than 0.01 m/s
        fits = []
        for off in (0.0, -told["uncertainty"], told["uncertainty"]):
            xy = np.column_stack([start[0] + (told["value"] + off) * t, start[1] + 0.0 * t])
            fits.append(carom.fit(scene, met + t, [scene.ids[0]] * 20, xy, vary=["balls.e_c"]))
        played = carom.simulate(fits[0].scene).states(met + 1e-6)[0, 1, 0]
        print(f"{speed:10.1f}{told['value']:18.3f}{played:8.3f}" + "".join(f"{f.x[0]:8.3f}" for f in fits)
              + f"{1.0 - 0.08 * max(0.0, speed - 1.7):9.3f}")


def paths():
    keys = ["balls.e_c", "balls.mu_r"]
    print(f"{'path':8}{'rms before':>12}{'after, mm':>10}" + "".join(f"{key:>22}" for key in keys))
    each = []
    for number in range(8, 17):
        case = read(f"V{number:02}")
        for shot in case["shot"]:
            scene = scene_of(case, shot)
            record = carom.simulate(scene)
            first = first_cushion(record)
            places = [m for m in shot["measured"] if m["quantity"] == "place" and "after" in m]
            t = np.array([first + m["after"] for m in places])
            xy = np.array([m["place"] for m in places])
            before = record.states(t)[:, 0, 0, :2] - xy
            try:
                with warnings.catch_warnings(record=True) as told:
                    warnings.simplefilter("always")
                    found = carom.fit(scene, t, [scene.ids[0]] * len(t), xy, vary=keys)
            except ValueError as error:
                print(f"V{number:<7}{error}")
                continue
            rms = lambda off: 1e3 * np.sqrt(np.mean(off**2))
            print(f"V{number:<7}{rms(before):12.1f}{rms(found.fun):10.2f}"
                  + "".join(f"{x:12.4f} +-{s:7.4f}" for x, s in zip(found.x, found.std))
                  + ("" if found.success else f"  {found.message}")
                  + "".join(f"  ({w.message})" for w in told))
            if found.success:
                each.append(found.x)
    print("median of the paths", dict(zip(keys, np.round(np.median(each, axis=0), 4).tolist())))


if __name__ == "__main__":
    rolling()
    snooker()
    paths()
