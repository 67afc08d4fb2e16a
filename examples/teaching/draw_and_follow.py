# %% [markdown]
# # Draw and follow
#
# A cue ball that hits another ball fully stops if it does not spin, follows if it has topspin, and comes back
# if it has backspin. We can compute by hand where it comes to rest. With the slip u = v - R w (w is the
# topspin):
#
# * **The cue** strikes at the height b R: v = (1 + e_t) V / (1 + m/M + (5/2) b^2) and R w = (5/2) b v.
# * **The cloth** accelerates a sliding ball by mu_s g against u, and changes R w by 5/2 of that the other
#   way. The slip ends after 2 |u| / (7 mu_s g), and the ball rolls with 5/7 v + 2/7 R w (G. Coriolis, 1835).
#   It rolls on for v^2 / (2 mu_r g).
# * **The impact** leaves the cue ball (1 - e)/2 of its speed, and its spin.
#
# So a perfect cue ball (e = 1) rolls away from the impact, forwards or backwards, with 2/7 of the speed of
# its surface.

# %%
import carom
import matplotlib.pyplot as plt
import numpy as np

G, R, M_BALL, M_CUE, TIP = 9.81, 0.028575, 0.170097, 0.567, 0.73
MU_S, MU_R, E_B = 0.2, 0.01, 0.95


def scene(speed: float, height: float, gap: float, **balls: float) -> carom.Scene:
    """The cue ball at y = 0 and another ball `gap` m away, surface to surface."""
    there = {"id": "1", "position": [0.0, gap + 2 * R]}
    cue = {"speed": speed, "aim_deg": 90, "offset": [0.0, height]}
    return carom.Scene(
        table={"cushion": []}, balls=balls, ball=[{"id": "cue", "position": [0.0, 0.0]}, there], cue=cue)


def slide(v: float, rw: float, most: float) -> tuple[float, float, float]:
    """A ball with speed v and R w = rw slides until it rolls, but at most `most` m.

    Returns the distance [m], its speed, and R w.
    """
    u = v - rw
    friction = MU_S * G * np.sign(u)
    t = 2 * abs(u) / (7 * MU_S * G)
    if v * t - friction * t * t / 2 > most:  # it arrives while it still slides
        t = (v - np.sqrt(v * v - 2 * friction * most)) / friction
    return v * t - friction * t * t / 2, v - friction * t, rw + 5 / 2 * friction * t


def formula(speed: float, height: float, gap: float) -> float:
    """Where the cue ball comes to rest, relative to the impact [m]; forward is positive."""
    v = (1 + TIP) * speed / (1 + M_BALL / M_CUE + 5 / 2 * height**2)
    path, v, rw = slide(v, 5 / 2 * height * v, gap)
    if gap - path > 1e-12:  # it rolls the rest of the gap
        v = np.sqrt(v * v - 2 * MU_R * G * (gap - path))
        rw = v
    path, v, _ = slide((1 - E_B) / 2 * v, rw, np.inf)
    return float(path + np.sign(v) * v * v / (2 * MU_R * G))


def travelled(record: carom.Record) -> float:
    """The same for a simulated shot."""
    hit = next(e.time for e in record.event_list() if e.type == "ball_ball")
    return float(record.states(record.duration)[0, 0, 1] - record.states(hit)[0, 0, 1])


# %% [markdown]
# ## The height of the tip
# The distance between the balls matters as much as the height: on its way the ball loses backspin and gains
# topspin. From far enough away, every cue ball arrives rolling, and the height no longer matters.

# %%
heights = np.linspace(-0.5, 0.5, 41)
plt.figure(figsize=(8, 4.5), layout="constrained")
worst = 0.0
for gap, color in ((0.2, "tab:blue"), (0.8, "tab:orange"), (1.6, "tab:red")):
    by_hand = np.array([formula(2.0, h, gap) for h in heights])
    simulated = np.array([travelled(carom.simulate(scene(2.0, h, gap, mu_b=0.0))) for h in heights])
    rubbing = np.array([travelled(carom.simulate(scene(2.0, h, gap))) for h in heights])
    worst = max(worst, np.abs(simulated - by_hand).max())
    plt.plot(heights, by_hand, color=color, label=f"{gap} m between the balls")
    plt.plot(heights[::2], rubbing[::2], "o", ms=4, color=color)
plt.axhline(0, color="0.7", lw=0.8)
plt.xlabel("height of the tip above the centre [ball radii]")
plt.ylabel("distance of the cue ball after the impact [m]")
plt.title("Draw and follow at 2 m/s of the cue. Lines: by hand. Dots: simulated, with ball friction")
plt.legend()
plt.show()

# %% [markdown]
# ## Checking the expectations
# The simulation agrees with the formula for balls without friction between them. Friction takes some of the
# spin.

# %%
assert worst < 1e-9, worst
draw, stun, follow = (travelled(carom.simulate(scene(2.0, h, 0.2))) for h in (-0.4, -0.06, 0.4))
assert draw < -0.3 and abs(stun) < 0.1 and follow > 0.3
far = [travelled(carom.simulate(scene(1.2, h, 1.6, mu_b=0.0))) for h in (-0.2, 0.0, 0.2)]
stops = f"draw {draw:.2f} m, stun {stun:.2f} m, follow {follow:.2f} m"
print(f"{stops}; from far away {min(far):.2f} to {max(far):.2f} m")

# %% [markdown]
# ## Speed and energy
# A draw shot over time: the cue ball loses speed while it slides, hits (the speeds jump), stops for an
# instant, and comes back. The impact left its rotation alone, and that energy brings it back.

# %%
record = carom.simulate(carom.Scene(
    ball=[{"id": "cue", "position": [0.635, 1.2]}, {"id": "1", "position": [0.635, 1.6]}],
    cue={"speed": 2.5, "aim_deg": 90, "offset": [0.0, -0.45]},
), until=3.0)
carom.plot.table(record).set_title("A draw shot")
plt.show()
figure, (above, below) = plt.subplots(2, 1, figsize=(8, 6), layout="constrained", sharex=True)
carom.plot.speeds(record, ax=above)
carom.plot.energy(record, ax=below)
plt.show()
