# %% [markdown]
# # Learn an aim by gradients
#
# How must you strike so that ball 1 falls and the cue ball comes to rest exactly *there*? Take the distance
# of the cue ball from its place, and let the derivatives of the shot say how to change aim, speed and tip.
#
# * **Gradient descent** on the square of the distance: small steps downhill. An input is measured in units
#   that move the ball about equally far, or the steps zigzag.
# * **Gauss-Newton**: solves the linear picture for the place at once, by the smallest change. The number of
#   right digits doubles with each shot (quadratic convergence), as the picture is exact near the end.

# %%
from collections.abc import Callable

import carom
import matplotlib.pyplot as plt
import numpy as np
from carom import plot

INPUTS = ["cue.aim_deg", "cue.speed", "cue.offset.height"]
UNITS = np.array([1.0, 0.2, 0.05])  # degrees, m/s, ball radii
START = np.array([135.0, 2.25, -0.4])
WANTED = np.array([0.95, 1.65])
SCENE = carom.Scene(
    table="nine_foot",
    ball=[{"id": "cue", "position": [0.6, 1.94]}, {"id": "1", "position": [0.3, 2.24]}],
    cue={"speed": START[1], "aim_deg": START[0], "offset": [0.0, START[2]]},
)


def play(x: np.ndarray) -> tuple[carom.Record, np.ndarray, np.ndarray]:
    """The shot, how far the cue ball is from its place [m], and how each unit of an input moves it."""
    record = carom.simulate(SCENE.replace(**dict(zip(INPUTS, x.tolist()))))
    off = record.states(record.duration)[0, 0, :2] - WANTED
    return record, off, record.jacobian(INPUTS)[0, 0, :2] * UNITS


# %% [markdown]
# First, are the derivatives right? Differences of two shots say so, to the digits that they have.

# %%
h = 1e-6
slopes = play(START)[2]
for k, e in enumerate(np.eye(3)):
    moved = (play(START + h * UNITS * e)[1] - play(START - h * UNITS * e)[1]) / (2 * h)
    print(f"{INPUTS[k]:18} {slopes[:, k]} m per unit; by differences {moved}")
    assert np.abs(moved - slopes[:, k]).max() < 1e-6

# %% [markdown]
# Now both methods, from the same shot.

# %%
Step = Callable[[np.ndarray, np.ndarray], np.ndarray]
RATE = 0.1 / np.linalg.norm(slopes, 2)**2


def learn(step: Step, shots: int) -> tuple[list[float], list[np.ndarray], carom.Record]:
    x, distances, places = START.copy(), [], []
    for _ in range(shots):
        record, off, slopes = play(x)
        distances.append(float(np.hypot(*off)))
        places.append(off + WANTED)
        x = x + UNITS * step(slopes, off)
    return distances, places, record


descent, walked, _ = learn(lambda slopes, off: -RATE * slopes.T @ off, 40)
newton, jumped, best = learn(lambda slopes, off: -np.linalg.pinv(slopes) @ off, 5)
print("gradient descent, mm:", [f"{1e3 * d:.3g}" for d in descent[::8]])
print("Gauss-Newton, mm:    ", [f"{1e3 * d:.3g}" for d in newton])
# Descent comes nearer with every shot, Gauss-Newton to a nanometre in five.
assert all(b < a for a, b in zip(descent, descent[1:]))
assert newton[-1] < 1e-9 < descent[-1]
assert best.measure('"1" in pocketed')

figure, axes = plt.subplots()
axes.semilogy(descent, ".-", label="gradient descent")
axes.semilogy(newton, "o-", label="Gauss-Newton")
axes.set_xlabel("shots")
axes.set_ylabel("distance from the place, m")
axes.legend()
plt.show()

# %% [markdown]
# The last shot, and where the cue ball ended while it learned.

# %%
axes = plot.table(best)
for places, color in ((walked, "tab:red"), (jumped, "tab:blue")):
    axes.plot([p[1] for p in places], [p[0] for p in places], ".-", color=color, markersize=3, linewidth=0.8)
plt.show()

# %% [markdown]
# The picture holds only while the balls meet the same things in the same order: farther away, search first
# (`carom.solve`), then refine. PyTorch and JAX learn with the same derivatives:
# `examples/learning/gradients.py`.
