# %% [markdown]
# # Cushions
#
# A ball does not leave a cushion like light from a mirror. The cushion removes speed, its nose rubs, and the
# spin that the ball brings or picks up there bends its path until it rolls. We expect
#
# * a rolling ball that comes straight in to have about 0.55 of its speed when it rolls again (W. Marlow, The
#   Physics of Pocket Billiards, 1995, as quoted by D. Alciatore);
# * running english to open the angle, and reverse english to close it, for angles up to 30 degrees. At larger
#   angles the nose's friction is at its limit with and without english, so english mainly changes its
#   direction;
# * the equations of I. Han, "Dynamics in carom and three cushion billiards", J. Mech. Sci. Tech. 19 (2005),
#   to the last digits. They are written out below, independently and in the paper's quantities, to check the
#   simulator.

# %%
import carom
import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.float64]
R, MASS, E_C, F_C, NOSE = 0.028575, 0.170097, 0.85, 0.2, 1.28  # a pool ball; the height of the nose in radii


def han(v: Numbers, w: Numbers) -> tuple[Numbers, Numbers]:
    """Velocity and spin after the impact with a cushion whose nose line is in the direction +x: (n, 3)
    each."""
    sine = NOSE - 1
    cosine = np.sqrt(1 - sine**2)
    slip_x = v[:, 0] * sine + R * w[:, 1]
    slip_y = -v[:, 1] - R * w[:, 2] * cosine + R * w[:, 0] * sine
    normal = (1 + E_C) * v[:, 0] * cosine
    slip = np.hypot(slip_x, slip_y)
    share = np.minimum(2 / 7, F_C * normal / slip)
    px, py = share * slip_x, share * slip_y
    change = np.stack([-px * sine - normal * cosine, py, np.zeros_like(px)], axis=-1)
    pz = px * cosine - normal * sine
    torque = np.stack([-py * sine, change[:, 0] * sine - pz * cosine, py * cosine], axis=-1)
    return v + change, w + 5 / (2 * R) * torque


def rolling(speed: float, angle: Numbers, side: float) -> Numbers:
    """States of balls that roll at this angle [rad] to +x, towards the cushion.

    side: R w_z over the speed, positive for counter-clockwise
    """
    states = np.zeros((len(angle), 3, 3))
    states[:, 1, 0], states[:, 1, 1] = speed * np.cos(angle), speed * np.sin(angle)
    states[:, 2, 0], states[:, 2, 1] = -states[:, 1, 1] / R, states[:, 1, 0] / R
    states[:, 2, 2] = side * speed / R
    return states


def rolls_again(states: Numbers) -> Numbers:
    """The velocity (n, 2) of a sliding ball once it rolls: 5/7 v + 2/7 R (w_y, -w_x) (G. Coriolis, 1835)."""
    v, w = states[:, 1], states[:, 2]
    final: Numbers = 5 / 7 * v[:, :2] + 2 / 7 * R * np.stack([w[:, 1], -w[:, 0]], axis=-1)
    return final


def rebound(speed: float, angle: Numbers, side: float) -> Numbers:
    """The angle to the cushion's normal [degrees] at which the ball rolls away."""
    after = carom.kernel.ball_cushion(
        rolling(speed, angle, side), [-1.0, 0.0], e_c=E_C, f_c=F_C, height=NOSE * R)
    x, y = rolls_again(after).T
    out: Numbers = np.degrees(np.arctan2(y, -x))
    return out


# %% [markdown]
# ## Angle out against angle in

# %%
angle = np.radians(np.linspace(0, 75, 76))
plt.figure(figsize=(8, 5), layout="constrained")
plt.plot([0, 75], [0, 75], "k:", label="mirror")
for side, name in ((-0.8, "running english"), (0.0, "none"), (0.8, "reverse english")):
    plt.plot(np.degrees(angle), rebound(2.0, angle, side), label=name)
plt.xlabel("angle in, from the cushion's normal [degrees]")
plt.ylabel("angle out, rolling again [degrees]")
plt.title("A rolling ball and a cushion, 2 m/s")
plt.legend()
plt.show()

# %% [markdown]
# ## Checking the expectations

# %%
for side in (-0.8, 0.0, 0.8):
    states = rolling(2.0, angle, side)
    after = carom.kernel.ball_cushion(states, [-1.0, 0.0], e_c=E_C, f_c=F_C, height=NOSE * R)
    v, w = han(states[:, 1], states[:, 2])
    assert np.abs(after[:, 1] - v).max() < 1e-12 and np.abs(after[:, 2] - w).max() < 1e-9
straight = rolls_again(
    carom.kernel.ball_cushion(rolling(2.0, np.zeros(1), 0.0), [-1.0, 0.0], e_c=E_C, f_c=F_C, height=NOSE * R))
kept = float(-straight[0, 0] / 2.0)
assert abs(kept - 0.55) < 0.02
running, none, reverse = (rebound(2.0, angle[:31], side) for side in (-0.8, 0.0, 0.8))
assert (running > none).all() and (none > reverse).all()
half = rebound(2.0, np.radians([45.0]), 0.0)[0]
print(f"straight in: {kept:.3f} of the speed; 45 degrees in: {half:.1f} degrees out")

# %% [markdown]
# ## A bank shot
# The mirror rule: aim at the target's image behind the cushion. Here are three shots, aimed by that rule,
# with different english.

# %%
start, target = np.array([0.9, 0.3]), np.array([0.9, 1.2])
surface = R  # the centre turns round one radius before the nose line x = 0
image = np.array([2 * surface - target[0], target[1]])
aim = float(np.degrees(np.arctan2(*(image - start)[::-1])))
figure, axes = plt.subplots(figsize=(9, 5), layout="constrained")
ends: dict[str, float] = {}
for side, name, color in ((0.4, "left", "tab:red"), (0.0, "none", "white"), (-0.4, "right", "tab:blue")):
    record = carom.simulate(carom.Scene(
        ball=[{"id": "cue", "position": start.tolist()}],
        cue={"speed": 2.5, "aim_deg": aim, "offset": [side, 0.1], "end_mass": 0}))
    if side == 0:
        carom.plot.table(record, trails=False, at=0.0, ax=axes)
    times = np.linspace(0, record.duration, 4000)
    x, y = record.states(times)[:, 0, 0, :2].T
    turn = next(e.time for e in record.event_list() if e.type == "ball_cushion")
    stop = np.flatnonzero((times > turn) & (x >= target[0]))[0]
    axes.plot(y[: stop + 1], x[: stop + 1], color=color, label=f"english: {name}")
    ends[name] = float(y[stop])
axes.plot(*target[::-1], "kx", label="target of the mirror rule")
axes.legend(loc="upper right")
plt.show()
# Left english is reverse here and right english is running, so one ball lands short and the other long.
assert ends["left"] < ends["none"] < ends["right"]
y = [f"{ends[name]:.2f}" for name in ("left", "none", "right")]
print(f"lands at y = {', '.join(y)} m; the mirror says {target[1]}")
