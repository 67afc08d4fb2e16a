# %% [markdown]
# # Throw
#
# Balls rub against each other. An object ball does not leave a cut along the line of centres: it is thrown a
# little in the direction in which the cue ball's surface moves across it. We expect
#
# * more throw for slow shots than for fast ones, because friction falls with the sliding speed;
# * no throw with *gearing* outside english, R w_z = v sin(phi), where the surfaces do not slide;
# * the formula of D. Alciatore's Technical Proof A.14 (billiards.colostate.edu) for balls that touch freely:
#
#   tan(throw) = min(mu, (1/7) 2/(1+e) u / (v cos(phi))) * (slip along the cloth) / u
#
# Here u is the slip between the two surfaces; only its component along the cloth throws the ball. The first
# value in min() is sliding friction, the second is the friction that just stops the slip. With e = 1 it is
# the proof's 1/7 u / (v cos(phi)).

# %%
import carom
import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.float64]
R, E_B = 0.028575, 0.95


def friction(slip: Numbers) -> Numbers:
    """Friction between two pool balls, fitted to Marlow's measurements in the same proof; slip in m/s."""
    return 0.009951 + 0.108 * np.exp(-1.088 * slip)


def slips(v: float, cut: Numbers, roll: float, side: Numbers) -> tuple[Numbers, Numbers]:
    """The slip of the surfaces along the cloth and upwards [m/s].

    roll: R times the topspin over v
    side: R w_z over v sin(phi)
    """
    return v * np.sin(cut) * (1 - side), -v * roll * np.cos(cut)


def formula(v: float, cut: Numbers, roll: float, side: Numbers) -> Numbers:
    """Throw [degrees]."""
    along, upward = slips(v, cut, roll, side)
    u = np.maximum(np.hypot(along, upward), 1e-12)
    limit = 2 / (1 + E_B) / 7 * u / (v * np.cos(cut))
    return np.degrees(np.arctan(np.minimum(friction(u), limit) * along / u))


def thrown(v: float, cut: Numbers, roll: float, side: Numbers, model: carom.kernel.BallBallModel) -> Numbers:
    """Throw [degrees] of the object ball. The cue ball comes along +y; the cut turns the line of centres
    right."""
    cut, side = np.broadcast_arrays(np.atleast_1d(cut), side)
    line = np.stack([np.sin(cut), np.cos(cut)], axis=-1)
    states = np.zeros((len(cut), 2, 3, 3))
    states[:, 1, 0, :2] = 2 * R * line
    states[:, 0, 1, 1] = v
    states[:, 0, 2, 0] = -roll * v / R
    states[:, 0, 2, 2] = -side * v * np.sin(cut) / R  # outside english turns clockwise here
    slip = np.hypot(*slips(v, cut, roll, side))
    after = carom.kernel.ball_ball(
        states, model=model, mu_b=friction(slip), e_b=E_B, mu_s=0.2, tolerance=1e-9)
    x, y = after[:, 1, 1, 0], after[:, 1, 1, 1]
    return np.degrees(np.arctan2(line[:, 0] * y - line[:, 1] * x, line[:, 0] * x + line[:, 1] * y))


# %% [markdown]
# ## Throw by cut angle and by english
# Lines are the formula. Dots are the impact solved as a differential equation, with the cloth under the balls
# (`mathavan`), as a simulation does by default.
#
# On the left are stun shots: the cue ball has no spin when it hits. On the right is a cut of 30 degrees.
# Inside english (left half) increases the sliding, outside english reduces it. At 1 the balls are geared, and
# beyond that the throw is reversed.

# %%
cut = np.radians(np.linspace(1, 80, 80))
none = np.zeros(1)
side = np.linspace(-2, 3, 101)
thirty = np.full_like(side, np.radians(30))
figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4.5), layout="constrained", sharey=True)
for v, color in ((0.5, "tab:blue"), (1.5, "tab:orange"), (4.0, "tab:red")):
    left.plot(np.degrees(cut), formula(v, cut, 0.0, none), color=color, label=f"{v} m/s")
    left.plot(np.degrees(cut[::5]), thrown(v, cut[::5], 0.0, none, "mathavan"), "o", ms=4, color=color)
    right.plot(side, formula(v, thirty, 0.0, side), color=color)
    right.plot(side[::5], thrown(v, thirty[::5], 0.0, side[::5], "mathavan"), "o", ms=4, color=color)
left.set_xlabel("cut angle [degrees]")
left.set_ylabel("throw [degrees]")
left.set_title("Stun shots")
left.legend()
right.axhline(0, color="0.7", lw=0.8)
right.axvline(1, color="0.7", lw=0.8)
right.set_xlabel("english: R w_z / (v sin(phi))")
right.set_title("Cut of 30 degrees")
plt.show()

# %% [markdown]
# ## Checking the expectations

# %%
for v in (0.5, 1.5, 4.0):
    for roll in (0.0, 1.0):
        # The free impact is the formula; the equation with the cloth differs from it by less than a degree.
        assert np.abs(thrown(v, cut, roll, none, "inelastic") - formula(v, cut, roll, none)).max() < 1e-9
        assert np.abs(thrown(v, cut, roll, none, "mathavan") - formula(v, cut, roll, none)).max() < 1
    assert abs(thrown(v, thirty[:1], 0.0, np.ones(1), "mathavan")[0]) < 1e-6  # geared
most = [thrown(v, cut, 0.0, none, "mathavan").max() for v in (0.5, 1.5, 4.0)]
assert most[0] > most[1] > most[2]
print("most throw of a stun shot:", ", ".join(f"{throw:.1f} degrees" for throw in most))

# %% [markdown]
# ## On the table
# The same in a whole shot. The cue ball is aimed so that the line of centres points at the middle of the
# corner pocket, but the ball goes wide.

# %%
pocket = np.array([1.27, 2.54])
target = np.array([0.9, 1.9])
line = (pocket - target) / np.linalg.norm(pocket - target)
ghost = target - 2 * R * line
start = np.array([0.9, 1.5])
aim = np.degrees(np.arctan2(*(ghost - start)[::-1]))
shot = carom.Scene(
    ball=[{"id": "cue", "position": start.tolist()}, {"id": "1", "position": target.tolist()}],
    cue={"speed": 0.9, "aim_deg": float(aim), "offset": [0.0, 0.0]},
)
record = carom.simulate(shot)
hit = next(e.time for e in record.event_list() if e.type == "ball_ball")
before, after = record.states([np.nextafter(hit, 0), hit])
went = after[1, 1, :2]
throw = np.degrees(np.arctan2(line[0] * went[1] - line[1] * went[0], line @ went))
axes = carom.plot.table(record)
axes.plot([target[1], pocket[1]], [target[0], pocket[0]], "k:", lw=1)
axes.set_title(f"Dotted: the line of centres. The ball leaves at {abs(throw):.1f} degrees to it")
plt.show()
v = float(np.linalg.norm(before[0, 1]))
phi = float(np.arccos(line @ before[0, 1, :2] / v))
roll = float(-before[0, 2] @ np.array([before[0, 1, 1], -before[0, 1, 0], 0]) * R / v**2)
expected = float(formula(v, np.array([phi]), roll, none)[0])
assert abs(abs(throw) - expected) < 1
print(f"thrown by {abs(throw):.2f} degrees; the formula for a free impact gives {expected:.2f}")
