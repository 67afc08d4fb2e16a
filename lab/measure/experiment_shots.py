"""Seeded shots for the experiments of lab/notes/2026-11-accuracy_experiments.md, as scenes: straight, cut,
three cushions, break."""
import math
import random

R = 0.028575  # m, pool balls; carom balls are 0.03075
CLASSES = ("straight", "cut", "three_cushion", "break")


def ball(name, x, y):
    return f'[[ball]]\nid = "{name}"\nposition = [{x!r}, {y!r}]\n'


def cue(speed, aim_deg, side=0.0, height=0.0):
    return f'[cue]\nball = "cue"\nspeed = {speed!r}\naim_deg = {aim_deg!r}\noffset = [{side!r}, {height!r}]\n'


def aim(start, target, radius, cut_deg):
    """The direction in degrees from start that hits the target at this cut angle."""
    dx, dy = target[0] - start[0], target[1] - start[1]
    off = math.asin(2 * radius * math.sin(math.radians(cut_deg)) / math.hypot(dx, dy))
    return math.degrees(math.atan2(dy, dx) + off)


def shot(kind, seed):
    """The text of a scene file; equal arguments give equal text."""
    draw = random.Random(f"{kind} {seed}")
    uniform = draw.uniform
    if kind == "break":
        return ('[table]\npreset = "nine_foot"\n[rack]\ngame = "eight_ball"\ngap = 1e-4\njitter = 3e-5\n'
                f'seed = {seed}\n'
                + ball("cue", uniform(0.55, 0.72), 0.5) + cue(
                    uniform(6, 10), 90 + uniform(-0.3, 0.3), height=uniform(0, 0.2)))
    if kind == "three_cushion":
        start, red = (uniform(0.3, 1.1), uniform(0.4, 1.0)), (uniform(0.3, 1.1), uniform(1.6, 2.4))
        other = (uniform(0.3, 1.1), uniform(1.15, 1.45))
        return ('[table]\npreset = "carom"\n[balls]\n'
                'preset = "carom"\n' + ball("cue", *start) + ball("red", *red)
                + ball("yellow", *other)
                + cue(
                    uniform(3, 5), aim(start, red, 0.03075, uniform(-60, 60)), uniform(-0.3, 0.3),
                    uniform(0, 0.3)))
    start, target = (uniform(0.4, 0.87), uniform(0.4, 0.8)), (uniform(0.4, 0.87), uniform(1.2, 1.8))
    cut = 0.0 if kind == "straight" else draw.choice((-1, 1)) * uniform(15, 60)
    return ('[table]\npreset = "nine_foot"\n' + ball("cue", *start) + ball("1", *target)
            + cue(uniform(1.5, 4.5), aim(start, target, R, cut),
                  0.0 if kind == "straight" else uniform(-0.2, 0.2), uniform(-0.3, 0.3)))
