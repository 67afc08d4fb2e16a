# %% [markdown]
# # What accuracy costs, and what a margin is
#
# A simulator solves equations with an error. Three questions decide whether that matters:
#
# 1. How does the error of one impact fall with the effort? Euler's method is the published way to solve the
#    equation of two balls (Mathavan, Jackson, Parkin, Sports Engineering 17, 2014). We expect it to be of
#    first order: ten times the steps, a tenth of the error. A method with a tolerance must keep its
#    tolerance.
# 2. What does a shot do with a small error? We expect the error to grow in proportion, by a factor called the
#    *gain* of the shot.
# 3. Is it fast enough? A film has 1/60 s per frame. The rest of that time is the *margin*.

# %%
import carom
import matplotlib.pyplot as plt
import numpy as np

# %% [markdown]
# ## 1. One impact
# A cut has a single impact of two balls. `carom.accuracy` plays it with every setting and compares where the
# balls end with a converged result. The times are those of your machine.

# %%
shots = {
    "a cut": carom.Scene(
        ball=[{"id": "cue", "position": [0.635, 0.6]}, {"id": "1", "position": [0.66, 1.4]}],
        cue={"speed": 2, "aim_deg": 90, "offset": [0, 0]}
    ),
    "eight-ball break": carom.Scene(
        ball=[{"id": "cue", "position": [0.6, 0.5]}], rack={"game": "eight_ball"},
        cue={"speed": 8, "aim_deg": 90.1}
    ),
}
report = carom.accuracy(shots["a cut"], march=(100, 1000, 10000, 100000), runs=1)
plt.figure(figsize=(8, 4.5), layout="constrained")
for method in ("march", "tolerance"):
    rows = [row for row in report["rows"] if row["method"] == method]
    plt.loglog([row["ns"] for row in rows], [row["error_max"] for row in rows], "o-", label=method)
plt.xlabel("time of the shot [ns]")
plt.ylabel("error of the worst ball at the end [m]")
plt.title("What accuracy costs")
plt.legend()
plt.show()

# %%
march = {int(row["setting"][2:]): row["error_max"] for row in report["rows"] if row["method"] == "march"}
steps = np.array(sorted(march))
order = -np.polyfit(np.log(steps), np.log([march[n] for n in steps]), 1)[0]
assert abs(order - 1) < 0.1  # first order
for row in report["rows"]:
    if row["method"] == "tolerance":
        # A speed error in the impact moves a ball by that fraction of its remaining path, a metre or two
        # here. Rounding comes on top.
        assert row["error_max"] <= 2.0 * float(row["setting"]) + 1e-12
print(f"the error of the march falls with the power {order:.2f} of its steps")

# %% [markdown]
# ## 2. One shot
# Move the cue ball by a hair and look where the balls end. A cut has one impact. In a break, errors meet
# balls again and again, and each impact multiplies them by about the free path over the radius.

# %%
hairs = np.logspace(-13, -8, 21)  # m
plt.figure(figsize=(8, 4.5), layout="constrained")
slopes, gains = {}, {}
for name, scene in shots.items():
    places = np.repeat(scene.positions[None], len(hairs) + 1, axis=0)
    places[1:, 0, 0] += hairs
    ends = carom.simulate_many(scene, xy=places).xy
    off = np.linalg.norm(ends[1:] - ends[0], axis=-1).max(axis=-1)
    # Larger hairs change which balls meet; for smaller ones the result is a straight line.
    straight = off < 1e-3
    slopes[name] = np.polyfit(np.log(hairs[straight]), np.log(off[straight]), 1)[0]
    gains[name] = float(np.median(off[straight] / hairs[straight]))
    plt.loglog(hairs, off, "o-", label=f"{name}: gain {gains[name]:.1e}")
plt.xlabel("displacement of the cue ball [m]")
plt.ylabel("error of the worst ball at the end [m]")
plt.title("The gain of a shot")
plt.legend()
plt.show()

# %%
assert abs(slopes["a cut"] - 1) < 0.02  # in proportion
assert gains["eight-ball break"] > 100 * gains["a cut"]
advice = carom.accuracy(shots["a cut"], runs=1, target=1e-3)
assert advice["recommended_tolerance"] * advice["gain"] <= 1e-3
needed = f"{advice['recommended_tolerance']:g}"
print(f"the cut: gain {gains['a cut']:.0f}; a tolerance of {needed} is enough for a millimetre")

# %% [markdown]
# ## 3. The margin
# `carom.margin` measures every frame of a film; here it measures only the simulation. The slack is what is
# left of 1/60 s.

# %%
margin = carom.margin(shots["eight-ball break"], runs=3, render=False)
frames = margin["table"]
plt.figure(figsize=(8, 4), layout="constrained")
plt.bar(frames["time"], frames["simulate_ms"], width=1 / margin["fps"], label="simulation")
plt.axhline(margin["budget_ms"], color="tab:red", label="1/60 s")
plt.yscale("log")
plt.ylim(1e-4, 50)
plt.xlim(0, 3)
plt.xlabel("time in the shot [s]")
plt.ylabel("time for the frame [ms]")
plt.title(f"Least slack: {margin['slack_percent']['least']:.1f} %")
plt.legend()
plt.show()

# %%
assert abs(margin["budget_ms"] - 1000 / 60) < 1e-9
assert np.allclose(frames["slack_percent"], 100 * (1 - frames["total_ms"] / margin["budget_ms"]), atol=1e-3)
assert margin["frames"] == len(frames["frame"])
print(f"{margin['missed']} of {margin['frames']} frames missed")
