# %% [markdown]
# # The 30-degree rule
#
# A rolling cue ball that hits another ball anywhere between a quarter and three quarters full leaves at about
# 30 degrees to its old direction. We expect 27 to 34 degrees for perfect balls, and derive the angle:
#
# * The cue ball arrives with the speed v, at the cut angle phi. With perfect balls it keeps only the
#   component across the line of centres: v sin(phi). With a restitution e it also keeps (1 - e)/2 v cos(phi)
#   along that line.
# * The impact does not change its rotation, so it still has the topspin of the old direction. While it
#   slides, the friction of the cloth mixes the two: the velocity when it rolls again is 5/7 of the velocity
#   after the impact plus 2/7 of R times the spin (G. Coriolis, Theorie mathematique des effets du jeu de
#   billard, 1835).
#
# With e = 1, the angle theta between the old and the new direction is
# tan(theta) = sin(phi) cos(phi) / (sin(phi)^2 + 2/5).

# %%
import carom
import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.float64]
R = 0.028575  # radius of a pool ball, m
SPEED = 1.5  # m/s


def scene(cut: float, **balls: float) -> carom.Scene:
    """A rolling cue ball and a ball that it hits at this cut angle [rad], on a cloth without cushions."""
    place = [2 * R * np.sin(cut), 0.3 + 2 * R * np.cos(cut)]
    rolling = {"id": "cue", "position": [0.0, 0.0], "velocity": [0.0, SPEED], "spin": [-SPEED / R, 0.0, 0.0]}
    # The derivation assumes an impact that takes no time.
    return carom.Scene(table={"cushion": []}, balls=balls, physics={"clusters": "sequential"},
                       ball=[rolling, {"id": "1", "position": place}])


def deflection(record: carom.Record) -> float:
    """The angle [degrees] between +y and the direction in which the cue ball rolls after the impact."""
    hit = next(e.time for e in record.event_list() if e.type == "ball_ball")
    rolls = next(
        e.time for e in record.event_list() if e.type == "slide_roll" and e.a == "cue" and e.time > hit)
    x, y, _ = record.states(rolls)[0, 1]
    return float(np.degrees(np.arctan2(abs(x), y)))


def formula(cut: Numbers, e: float = 1.0) -> Numbers:
    """The angle from the derivation above [degrees]."""
    across, along = np.sin(cut), (1 - e) / 2 * np.cos(cut)
    sideways = 5 / 7 * (across * np.cos(cut) - along * np.sin(cut))
    ahead = 5 / 7 * (across * np.sin(cut) + along * np.cos(cut)) + 2 / 7
    angle: Numbers = np.degrees(np.arctan2(sideways, ahead))
    return angle


# %% [markdown]
# ## One shot
# A half-ball hit: the line of aim goes through the edge of the other ball, sin(phi) = 1/2.

# %%
half = carom.simulate(scene(np.arcsin(0.5), mu_b=0.0, e_b=1.0))
carom.plot.table(half, at=1.2)
plt.title(f"Half-ball hit: {deflection(half):.1f} degrees")
plt.show()

# %% [markdown]
# ## All cuts
# The fullness of a hit is 1 - sin(phi): 1 is straight on, 0 is a miss.

# %%
fullness = np.linspace(0.03, 0.97, 48)
cut = np.arcsin(1 - fullness)
perfect = np.array([deflection(carom.simulate(scene(c, mu_b=0.0, e_b=1.0))) for c in cut])
bouncy = np.array([deflection(carom.simulate(scene(c, mu_b=0.0, e_b=0.95))) for c in cut])
real = np.array([deflection(carom.simulate(scene(c))) for c in cut])  # with friction between balls

plt.figure(figsize=(8, 4.5), layout="constrained")
plt.axhspan(27, 34, xmin=0.25, xmax=0.75, color="0.9")
plt.plot(fullness, formula(cut), "k-", label="formula, perfect balls")
plt.plot(fullness, perfect, "o", ms=4, label="simulated, perfect balls")
plt.plot(fullness, real, "s", ms=3, label="simulated, pool balls")
plt.xlim(0, 1)
plt.xlabel("fullness of the hit (1 is straight on)")
plt.ylabel("deflection of the cue ball [degrees]")
plt.title("The 30-degree rule")
plt.legend()
plt.show()

# %% [markdown]
# ## Checking the expectations

# %%
between = (fullness >= 0.25) & (fullness <= 0.75)
assert np.abs(perfect - formula(cut)).max() < 1e-9
assert np.abs(bouncy - formula(cut, 0.95)).max() < 1e-9
assert perfect[between].min() > 27 and perfect[between].max() < 34
# Real balls lose a little energy and rub against each other: they stay within 3 degrees of the perfect ball.
assert np.abs(real - perfect)[between].max() < 3
low, high = perfect[between].min(), perfect[between].max()
pool = f"pool balls: {real[between].min():.1f} to {real[between].max():.1f}"
print(f"perfect balls: {low:.1f} to {high:.1f} degrees; {pool}")
