"""Gymnasium environments: Gymnasium's own checks, legal strikes for every action, vectors that equal single
environments, repeatable bits."""

from __future__ import annotations

import functools
import itertools
import warnings

import carom
import numpy as np
import pytest
from conftest import SOURCE, refused

gymnasium = pytest.importorskip(
    "gymnasium", reason="gymnasium is not installed: pip install gymnasium")
import carom.gym  # noqa: E402
from gymnasium.utils.env_checker import check_env, data_equivalence  # noqa: E402
from gymnasium.vector import AutoresetMode, SyncVectorEnv  # noqa: E402

NAMES = sorted(carom.gym.GAMES)
#: Options that reach every part of observations, actions and info.
OPTIONS = [
    {},
    {"aim": "ball", "observation": "dict", "elevation_deg": (0.0, 5.0), "hashes": True, "noise": "fastfiz"}]


def same_bits(a, b):
    """data_equivalence without its tolerance of 1e-5; NaN equals NaN."""
    if isinstance(a, dict):
        return data_equivalence(a, b) and all(same_bits(a[key], b[key]) for key in a)
    if isinstance(a, np.ndarray) and a.dtype != object:
        return a.dtype == b.dtype and np.array_equal(a, b, equal_nan=a.dtype.kind == "f")
    if isinstance(a, (np.ndarray, tuple)):
        return len(a) == len(b) and all(same_bits(x, y) for x, y in zip(a, b))
    return type(a) is type(b) and a == b


@pytest.mark.parametrize("options", OPTIONS, ids=["box", "dict"])
@pytest.mark.parametrize("name", NAMES)
def test_gymnasium_accepts_the_environment(name, options):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env = gymnasium.make(f"carom/{name}-v0", **options).unwrapped
        check_env(env)
        assert same_bits(gymnasium.make(env.spec).reset(seed=1), env.reset(seed=1))


@pytest.mark.parametrize("mode", list(AutoresetMode))
@pytest.mark.parametrize(("name", "options"), list(itertools.product(NAMES, OPTIONS)))
def test_the_vector_equals_single_environments(name, options, mode):
    n, steps = 5, 12 if name == "SumToThree" else 6
    single = SyncVectorEnv([lambda: gymnasium.make(f"carom/{name}-v0", **options)] * n, autoreset_mode=mode)
    many = gymnasium.make_vec(f"carom/{name}-v0", num_envs=n, autoreset_mode=mode.value, **options)
    assert isinstance(many.unwrapped, carom.gym.TableVectorEnv) and many.metadata["autoreset_mode"] is mode
    assert many.observation_space == single.observation_space and many.action_space == single.action_space
    seeds = [3, 1, 4, 1, 5]
    assert same_bits(many.reset(seed=seeds), single.reset(seed=seeds))
    single.action_space.seed(7)
    over = 0
    for _ in range(steps):
        actions = single.action_space.sample()
        a, b = many.step(actions), single.step(actions)
        assert same_bits(a, b), (a, b)
        space = many.observation_space
        assert a[0] in space if isinstance(a[0], dict) else space.contains(a[0])
        ended = a[2] | a[3]
        over += ended.sum()
        if mode == AutoresetMode.DISABLED and ended.any():
            with pytest.raises(gymnasium.error.ResetNeeded, match="is over"):
                many.step(actions)
            # Reset some tables, as Gymnasium's own vector does, and seed one.
            again = [None, 9, None, None, None]
            assert same_bits(many.reset(seed=again, options={"reset_mask": ended.copy()}),
                             single.reset(seed=again, options={"reset_mask": ended.copy()}))
    assert over > 0 and same_bits(many.reset(seed=8), single.reset(seed=8))
    assert same_bits(many.reset(), single.reset())


@pytest.mark.parametrize("name", NAMES)
def test_a_seed_repeats_bit_for_bit_on_any_threads(name):
    def run(threads):
        env = carom.gym.make_vector_env(name, 40, threads=threads, hashes=True, autoreset_mode="SameStep")
        env.action_space.seed(2)
        first = env.reset(seed=11)
        return [first, *(env.step(env.action_space.sample()) for _ in range(4))]

    one, two = run(1), run(3)
    assert all(same_bits(a, b) for a, b in zip(one, two))
    hashes = np.concatenate([
        (step[4]["final_info"] if step[2][row] else step[4])["hash"][[row]] for step in one[1:]
        for row in range(40)])
    assert len(set(hashes.tolist())) == len(hashes) == 160


def test_returned_arrays_are_not_shared():
    env = carom.gym.make_vector_env("Pot", 3, observation="dict")
    kept = [env.reset(seed=1)[0]]
    copies = [{key: values.copy() for key, values in kept[0].items()}]
    for _ in range(3):
        step = env.step(env.action_space.sample())
        kept.append(step[0])
        copies.append({key: values.copy() for key, values in step[0].items()})
        for values in (*step[1:4], *(v for v in step[4].values())):
            values[...] = 0
        env.states.xy[...] = 0
        kept[-1]["legal"][...] = copies[-1]["legal"][...] = 1
    assert all(same_bits(a, b) for a, b in zip(kept, copies))
    assert env.states.xy.any()


# Strikes.


def corners(size):
    """Actions with numbers at the ends, in the middle, or close to zero."""
    tiny = np.array([-1.0, 0.0, 1.0, 1e-45, -1e-30, 0.5])
    few = np.array(list(itertools.product([-1.0, 0.0, 1.0], repeat=size)))
    random = np.random.default_rng(5)
    return np.concatenate((few, random.choice(tiny, (300, size)), random.uniform(-1, 1, (700, size)),
                           random.uniform(-3, 3, (200, size))))


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("aim", ["angle", "ball"])
@pytest.mark.parametrize("elevation", [0.0, (0.0, 60.0)], ids=["level", "raised"])
def test_every_action_is_a_legal_strike(aim, elevation, dtype):
    env = carom.gym.make_env("Pot", aim=aim, elevation_deg=elevation, speed=(0.3, 5.0))
    env.reset(seed=4)
    actions = corners(env.action_space.shape[0]).astype(dtype)
    played = env.rollout(env.states.take(np.zeros(len(actions), int)), actions)
        # The scene's own check decides legality: no shot is invalid.
    assert not played.shots.messages and (played.shots.status == carom.ShotStatus.AT_REST).all()
    speed, aim_deg, raised, side, height = played.cue.T
    assert (speed >= 0.3).all() and (speed <= 5.0).all() and {0.3, 5.0} <= set(speed.tolist())
    assert (np.abs(aim_deg) <= 180).all() and (side**2 + height**2).max() <= 0.25
    assert raised.min() == 0.0 and raised.max() == (60.0 if isinstance(elevation, tuple) else 0.0)


def test_the_square_of_offsets_maps_onto_the_whole_disc():
    ends = np.array([[1, 0, 0, x, y] for x, y in [(1, 0), (0, 1), (1, 1), (-1, 1), (0.01, 0)]], float)
    env = carom.gym.make_env("Pot")
    env.reset(seed=1)
    side, height = env.rollout(env.states.take([0] * 5), ends).cue.T[3:]
    half = np.sqrt(0.125)
    assert np.allclose(np.column_stack((side, height)),
                       [[0.5, 0], [0, 0.5], [half, half], [-half, half], [0.005, 0]], atol=1e-9)


def test_directions_match_numpy():
    def directions_deg(along):
        actions = np.column_stack((along, np.zeros((len(along), 3))))
        return carom.gym.Strikes().cue(
            actions, np.empty((len(along), 0, 2)), 0, np.empty((len(along), 0), bool), np.empty(0))[:, 1]

    scales = 10.0 ** np.random.default_rng(2).uniform(-40, 0, (1000, 1))
    along = np.random.default_rng(1).uniform(-1, 1, (1000, 2)) * scales
    assert np.abs(directions_deg(along) - np.degrees(np.arctan2(along[:, 1], along[:, 0]))).max() < 1e-13
    ends = np.array([[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1], [1e-170, 1e-160], [np.nan, 1]], float)
    assert np.allclose(directions_deg(ends)[:5], [0, 0, 180, 90, -90], rtol=0, atol=1e-13)
    assert np.isfinite(directions_deg(ends)[:6]).all() and np.isnan(directions_deg(ends)[6])


def test_an_aim_at_a_ball_has_its_stated_fullness():
    env = carom.gym.make_env("Pot", aim="ball")
    env.reset(seed=1)
    # Straight up the table, so that left and right show in x.
    states = carom.gym.States(np.array([[[0.6, 0.6], [0.6, 1.6]]] * 5), np.empty((5, 0)))
    full = np.array([0.0, 0.5, -0.5, 0.98, -0.98])
    actions = np.column_stack((np.zeros(5), full, np.full(5, -0.2), np.zeros((5, 2))))
    played = env.rollout(states, actions)
    radius = 0.028575
    line = np.radians(played.cue[:, 1])
    # Distance of the other ball to the right of the line of aim.
    right = (1.0 * np.cos(line)) * -1.0
    assert np.allclose(right, full * 2 * radius, atol=1e-12)
    assert (played.shots.first_hit == 1).all()


def test_noise_depends_on_the_seed():
    env = carom.gym.make_env("Pot", noise="fastfiz", hashes=True)
    meant = np.array([0.3, 0.9, 0.2, 0.1, -0.2], np.float32)

    def strikes(seed):
        made = []
        for k in range(3):
            env.reset(seed=seed if k == 0 else None)
            made.append(env.step(meant)[4]["cue"])
        return np.array(made)

    made = strikes(5)
    assert np.array_equal(made, strikes(5)) and len(np.unique(made[:, 1])) == 3
    assert not np.isin(strikes(6)[:, 1], made[:, 1]).any()
    n = 2000
    many = env.states.take([0] * n)
    exact = env.rollout(many, np.tile(meant, (n, 1))).cue
    assert (exact == exact[0]).all()
    noisy = env.rollout(many, np.tile(meant, (n, 1)), noise_seed=3)
    assert np.array_equal(noisy.cue, carom.games.noisy(exact, "fastfiz", 3))
    # An elevation below 0 becomes a level cue, so half of the elevation errors vanish.
    level = [0, 1, 3, 4]
    assert np.allclose(
        (noisy.cue - exact).std(0)[level], np.array(carom.games.Noise.named("fastfiz"))[level], rtol=0.1)
    assert (noisy.cue[:, 2] == 0).mean() == pytest.approx(0.5, abs=0.05)
    own = carom.gym.make_env("Pot", noise=[0, 0.5, 0, 0, 0])
    own.reset(seed=1)
    cue = own.rollout(many, np.tile(meant, (n, 1)), noise_seed=3).cue
    assert cue[:, 1].std() > 0.4 and (cue[:, [0, 2, 3, 4]] == exact[0, [0, 2, 3, 4]]).all()


# Layouts and observations.


def uniforms(states, draws):
    """SplitMix64 in Python's integers; advances the generators."""
    bits, out = (1 << 64) - 1, np.empty((len(states), draws))
    for row in range(len(states)):
        state = int(states[row])
        for k in range(draws):
            state = (state + 0x9E3779B97F4A7C15) & bits
            z = ((state ^ (state >> 30)) * 0xBF58476D1CE4E5B9) & bits
            z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & bits
            out[row, k] = ((z ^ (z >> 31)) >> 11) * 2.0**-53
        states[row] = state
    return out


@pytest.mark.parametrize("name", ["EightBallRun", "SumToThree"])
def test_layouts_are_redrawn_until_their_balls_fit(name):
    game = carom.gym.GAMES[name]()
    table, R, b, n = game.table, game.radii.max(), len(game.ids), 300
    states = np.random.default_rng(8).integers(0, 2**64, n, dtype=np.uint64)
    expected, left, rounds = states.copy(), np.arange(n), 0
    wanted = np.empty((n, b, 2))
    low, size = np.array(table.corner) + R + 1e-3, np.array([table.width, table.length]) - 2 * (R + 1e-3)
    while len(left):
        moved = expected[left]
        xy = wanted[left] = low + size * uniforms(moved, 2 * b).reshape(-1, b, 2)
        expected[left] = moved
        fits = np.ones(len(left), bool)
        for i in range(b):
            for _, x, y, radius, *_ in table.pockets:
                fits &= ((xy[:, i] - [x, y]) ** 2).sum(-1) > (radius + R) ** 2
            for k in range(i):
                fits &= ((xy[:, i] - xy[:, k]) ** 2).sum(-1) > (2 * R + 1e-3) ** 2
        left = left[~fits]
        rounds += 1
    assert rounds > 1 or name == "SumToThree"
    made = game.start(states)
    assert np.array_equal(made.xy, wanted) and np.array_equal(states, expected)


def test_a_table_without_room_for_a_layout_is_refused():
    places = [{"id": f"b{i}", "position": [0.1 + 0.1 * (i % 10), 0.2 + 0.1 * (i // 10)]} for i in range(120)]
    full = carom.Scene(ball=places, cue={"ball": "b0", "speed": 2.0, "aim_deg": 0.0})
    with pytest.raises(ValueError, match="no random layout fits"):
        carom.gym.make_env("Pot", scene=full).reset(seed=1)


def test_an_observation_scales_the_table_to_minus_one_to_one():
    game = carom.gym.Position()
    random = np.random.default_rng(3)
    xy = random.uniform([-0.3, -0.3], [1.6, 2.9], (200, 2, 2))
    xy[::7, 1] = np.nan
    states = carom.gym.States(xy, random.uniform([0, 0], [1.27, 2.54], (200, 2)))
    half = 0.5 * np.array([game.table.width, game.table.length])
    places = np.concatenate((xy, states.extra[:, None]), axis=1)
    wanted = np.ones((200, 3, 3), np.float32)
    wanted[:, :, :2] = (places - (np.array(game.table.corner) + half)) / half
    wanted[np.isnan(places[:, :, 0])] = 0.0
    wanted = np.clip(wanted, -1.0, 1.0)
    assert same_bits(game.observe(states), wanted) and (np.abs(wanted) == 1).any()
    # Also for slices of larger arrays.
    assert same_bits(game.observe(carom.gym.States(xy[::-2], states.extra[::-2])), wanted[::-2].copy())


# Games, and shots without an end.


def play_one(game, xy, cue, **extra):
    env = carom.gym.make_env(game)
    env.reset(seed=1, options={"xy": xy, **extra})
    return env._rules.play(env.states, np.array([cue], float))


def test_pot_rewards_the_ball_and_penalises_fouls():
    # A straight shot into the corner (0, 0) from the diagonal of the table.
    straight = [[0.6, 0.6], [0.3, 0.3]]
    for speed, height, reward, foul in (
        (1.0, -0.3, 1.0, ""), (2.0, 0.45, -1.0, "scratch"), (0.3, 0.0, 0.0, "")
    ):
        played = play_one("Pot", straight, [speed, -135, 0, 0, height])
        case = speed, height
        assert played.reward.tolist() == [reward] and played.foul.tolist() == [foul], case
        assert played.terminated.all(), case


def test_position_subtracts_the_distance_to_the_target():
    target = {"target x": 0.9, "target y": 1.5}
    played = play_one("Position", [[0.6, 0.6], [0.3, 0.3]], [1.0, -135, 0, 0, -0.3], **target)
    far = np.hypot(*(played.shots.xy[0, 0] - [0.9, 1.5])) / np.hypot(1.27, 2.54)
    assert played.shots.pocket[0, 1] >= 0 and abs(played.reward[0] - (1 - far)) < 1e-12


@pytest.mark.parametrize("name", ["ThreeCushion", "SumToThree", "NineBallRun", "EightBallRun"])
def test_rewards_follow_the_rules(name):
    """Replays every shot as its own scene and judges its record by carom.games."""
    env = carom.gym.make_vector_env(
        name, 60, autoreset_mode="SameStep", aim="ball", speed=(2.0, 6.0), hashes=True)
    game = carom.gym.GAMES[name]()
    env.reset(seed=2)
    env.action_space.seed(3)
    seen = {"goes on": 0, "foul": 0, "fair": 0}
    for _ in range(3):
        states, actions = env.states, env.action_space.sample()
        played = env.rollout(states, actions)
        legal = game.legal(states)
        env.step(actions)
        for row in range(60):
            if name == "EightBallRun":
                group = ("open", "solids", "stripes")[int(states.extra[row, 0])]
                other = {"open": "open", "solids": "stripes", "stripes": "solids"}[group]
                state = carom.games.new_game(game.RULES)._replace(
                    opening=False, in_hand="no", group=(group, other))
            else:
                state = carom.games.new_game(game.RULES)._replace(opening=False, in_hand="no")
            scene = game.scene_of(states.xy[row], played.cue[row])
            may = carom.games.legal(state, scene)
            assert set(may.first) == {ball for ball, is_legal in zip(game.ids, legal[row]) if is_legal}
            record = carom.simulate(scene)
            assert f"{played.shots.hash[row]:016x}" == record.hash()
            fallen = [(event.a, event.b) for event in record.event_list() if event.type == "ball_pocket"]
            call = next(
                (carom.games.Call(*fell) for fell in fallen if fell[0] in may.callable), carom.games.Call())
            verdict = carom.games.judge(state, record, call)
            fair = not verdict.fouls
            assert played.foul[row] == ("" if fair else verdict.fouls[0].name)
            goes_on = verdict.next.turn == 0 and not verdict.next.over
            assert played.terminated[row] == (not goes_on and name != "SumToThree")
            points = verdict.points if "Run" not in name else sum(ball != "cue" for ball, _ in fallen) * fair
            assert played.reward[row] == points
            if goes_on:
                there = {ball: place for ball,
                         place in zip(game.ids, played.states.xy[row]) if place[0] == place[0]}
                # After a foul, the next scene needs a place for the cue ball; these games end instead.
                after = carom.games.next_scene(record, verdict)
                assert sorted(there) == sorted(after.ids)
                assert all(np.array_equal(there[ball], xy) for ball, xy in zip(after.ids, after.positions))
            seen["goes on"] += goes_on
            seen["fair" if fair else "foul"] += 1
    assert seen["goes on"] > 0 and seen["fair"] > 0 and (
        seen["foul"] > 0 or name in ("ThreeCushion", "SumToThree")), seen


@pytest.mark.parametrize("name", NAMES)
def test_judging_during_or_after_play_is_the_same(name):
    env = carom.gym.make_vector_env(name, 50, speed=(3.0, 8.0), elevation_deg=(0.0, 30.0), hashes=True)
    env.reset(seed=5)
    env.action_space.seed(6)
    states = env.states
    states.xy[3] = np.nan  # no balls, so no shot
    played = env.rollout(states, env.action_space.sample())
    assert played.truncated[3] and played.shots.messages[3] and played.foul[3] == ""
    assert np.isnan(played.states.xy[3]).all()
    game = env._rules.game
    judged = game.judge(states, played.cue, played.shots)
    whole = ~played.truncated
    for field in ("reward", "terminated", "foul"):
        assert same_bits(getattr(judged, field)[whole], getattr(played, field)[whole])
    assert same_bits(judged.states.take(whole), played.states.take(whole))
    for threads in (1, 2):
        shots, again = game.play(states, played.cue, max_events=None, threads=threads, hashes=True)
        assert all(same_bits(a, b) for a, b in zip(shots, played.shots))
        assert same_bits(again.reward[whole], played.reward[whole])
        assert same_bits(again.states.xy[whole], played.states.xy[whole])


def test_a_subclass_may_judge_by_itself():
    class Strict(carom.gym.NineBallRun):
        def judge(self, states, cue, shots):
            judged = super().judge(states, cue, shots)
            return judged._replace(reward=judged.reward - (judged.foul != ""))

    env = carom.gym.TableVectorEnv(Strict(), 30, autoreset_mode="SameStep", aim="ball")
    plain = carom.gym.make_vector_env("NineBallRun", 30, autoreset_mode="SameStep", aim="ball")
    env.reset(seed=1)
    plain.reset(seed=1)
    actions = np.random.default_rng(1).uniform(-1, 1, (30, 5)).astype(np.float32)
    strict, usual = env.step(actions), plain.step(actions)
    fouls = usual[4]["final_info"]["foul"][usual[2]] != ""
    assert fouls.any() and np.array_equal(strict[1][usual[2]], usual[1][usual[2]] - fouls)
    assert same_bits(strict[0], usual[0])


def test_the_scene_of_a_point_scores_again():
    scene = carom.Scene.load(SOURCE / "scenes/three_cushion.toml")
    cue = scene.to_dict()["cue"]
    played = play_one("ThreeCushion", scene.positions, [cue["speed"], cue["aim_deg"], 0, *cue["offset"]])
    assert played.reward.tolist() == [1.0] and not played.terminated[0] and played.foul[0] == ""


def test_the_last_ball_ends_the_run():
    env = carom.gym.make_env("NineBallRun")
    xy = np.full((10, 2), np.nan)
    cue, nine = env.ids.index("cue"), env.ids.index("9")
    xy[[cue, nine]] = [0.6, 0.6], [0.3, 0.3]
    env.reset(seed=1, options={"xy": xy})
    assert env._rules.game.legal(env.states)[0].nonzero()[0].tolist() == [nine]
    played = env._rules.play(env.states, np.array([[1.0, -135, 0, 0, -0.3]]))
    assert played.reward[0] == 1 and played.terminated[0] and played.foul[0] == ""
    assert np.isnan(played.states.xy[0, nine]).all()
    assert not env._rules.game.legal(played.states).any()


def test_an_endless_shot_is_truncated_and_says_why():
    env = carom.gym.make_env("Pot")
    before, _ = env.reset(seed=1)
    observation, reward, terminated, truncated, info = env.step(np.array([np.nan, 0, 0, 0, 0], np.float32))
    assert (reward, terminated, truncated) == (0.0, False, True) and same_bits(observation, before)
    assert info["status"] == carom.ShotStatus.INVALID and "aim_deg" in info["message"]
    many = carom.gym.make_vector_env("Pot", 3)
    many.reset(seed=1)
    actions = np.zeros((3, 5), np.float32)
    actions[1, 2] = np.nan
    _, reward, terminated, truncated, infos = many.step(actions)
    assert truncated.tolist() == [False, True, False] and terminated.tolist() == [True, False, True]
    assert reward[1] == 0
    assert infos["status"][1] == carom.ShotStatus.INVALID
    assert infos["_message"].tolist() == [False, True, False] and "speed" in infos["message"][1]


def test_a_table_without_cushions_is_refused():
    balls = [{"id": "cue", "position": [0.4, 0.4]}, {"id": "b", "position": [0.6, 0.4]}]
    scene = carom.Scene(ball=balls, cue={"speed": 1.0, "aim_deg": 0.0})
    # A table without cushions has no area for a random layout.
    with pytest.raises(ValueError, match="no cushions"):
        carom.gym.make_env("Pot", scene=scene.replace(table={"cushion": []}))


def test_the_record_shows_the_shot_and_the_picture_the_table():
    env = carom.gym.make_env("Position", hashes=True, render_mode="rgb_array", size=(64, 36))
    env.reset(seed=3)
    with pytest.raises(RuntimeError, match="no shot since reset"):
        env.record()
    *_, info = env.step(np.array([0.3, 0.8, 0.1, 0.2, -0.4], np.float32))
    record = env.record()
    assert record.hash() == f"{info['hash']:016x}" and len(record.events) == info["events"]
    assert record.duration == info["duration"]
    picture = env.render()
    assert picture.shape == (36, 64, 3) and picture.std() > 0
    assert carom.gym.make_env("Pot").render() is None


def test_a_rollout_equals_a_step():
    env = carom.gym.make_env("Pot", hashes=True)
    env.reset(seed=6)
    env.action_space.seed(1)
    actions = np.array([env.action_space.sample() for _ in range(20)])
    tried = env.rollout(env.states.take([0] * 20), actions, threads=2)
    assert np.array_equal(env.states.xy[0], tried.states.xy[0] * 0 + env.states.xy[0], equal_nan=True)
    for k in (0, 7, 19):
        env.reset(options={"xy": env.states.xy[0] if k == 0 else places})
        places = env.states.xy[0]
        _, reward, terminated, truncated, info = env.step(actions[k])
        assert (reward, terminated, truncated) == (tried.reward[k], tried.terminated[k], tried.truncated[k])
        assert info["hash"] == tried.shots.hash[k]
        assert np.array_equal(env.states.xy[0], tried.states.xy[k], equal_nan=True)
        env.reset(options={"xy": places})


def test_reset_accepts_a_scene_and_explains_errors():
    env = carom.gym.make_env("Pot")
    path = SOURCE / "scenes/draw.toml"
    scene = carom.Scene.load(path)
    for same in (scene, path, str(path), scene.to_dict()):
        env.reset(options={"scene": same})
        assert np.array_equal(env.states.xy[0], scene.positions)
    many = carom.gym.make_vector_env("Pot", 3)
    each = np.array([[[0.5, 0.5], [0.5, 0.9 + 0.1 * i]] for i in range(3)])
    many.reset(options={"xy": each})
    assert np.array_equal(many.states.xy, each)
    refused(
        ValueError,
        lambda **options: env.reset(options=options),
        ({"xz": 1}, "'xz' is unknown; use scene, xy"),
        ({"xy": np.zeros((3, 2))}, r"xy has the shape \(3, 2\)"),
        ({"xy": [[0.5, 0.5], [0.5, 0.51]]}, "table 0 cannot be played: "),
        ({"xy": each[0], "scene": scene}, "give one"),
        ({"scene": "none.toml"}, "none.toml: cannot be read"),
        ({"scene": 5}, "scene: "),
        ({"scene": carom.Scene.load(SOURCE / "scenes/eight_ball_break.toml")}, "the scene has a ball"),
    )
    wrong = [
        ({"aim": "up"}, "aim='up'"),
        ({"speed": (2, 1)}, "speed="),
        ({"elevation_deg": 90}, "elevation_deg=90"),
        ({"observation": "pixels"}, "observation='pixels'"),
        ({"render_mode": "human"}, "render_mode='human'"),
        ({"noise": "loud"}, "loud"),
        ({"noise": [0, -1, 0, 0, 0]}, "noise="),
    ]
    for make in (carom.gym.make_env, carom.gym.make_vector_env):
        refused(ValueError, functools.partial(make, "Pot"), *wrong)
        games = "Pot, Position, ThreeCushion, SumToThree, NineBallRun, EightBallRun"
        refused(ValueError, make, ("pot", f"game: expected {games}, not 'pot'"))
    with pytest.raises(ValueError, match="expected the shape"):
        many.step(np.zeros((2, 5), np.float32))
    with pytest.raises(ValueError, match="reset_mask"):
        many.reset(options={"reset_mask": [True, False, True]})
    with pytest.raises(gymnasium.error.ResetNeeded):
        carom.gym.make_env("Pot").step(np.zeros(5, np.float32))


def test_places_mark_balls_off_the_table():
    scene = carom.Scene.load(SOURCE / "scenes/jump.toml")
    shots = carom.simulate_many(
        scene, params={"cue.speed": np.linspace(1, 12, 60), "cue.elevation_deg": np.full(60, 40.0)})
    out = shots.pocket == -2
    assert out.any() and np.isnan(shots.places[out]).all()


def test_planes_show_the_balls_at_their_places():
    env = carom.gym.FeaturePlanes(carom.gym.make_env("NineBallRun"), 30, 60)
    seen, _ = env.reset(seed=3)
    assert env.observation_space.contains(seen)
    states, table, ids = env.unwrapped.states, env.unwrapped._rules.game.table, env.unwrapped.ids
    assert seen.shape == (4, 30, 60) and same_bits(env.planes(states)[0], seen)
    for ball, (x, y) in zip(ids, states.xy[0]):
        plane = {"cue": 0, "1": 1}.get(ball, 2)
        at = seen[:, int(30 * (x - table.corner[0]) / table.width), int(
            60 * (y - table.corner[1]) / table.length)]
        assert at[plane] > 0.6
    # One cone per ball; the plane of targets is empty, except in Position.
    assert seen[0].sum() == pytest.approx(seen[1].sum(), rel=0.1) and seen[2].sum() > 5 * seen[1].sum()
    assert (seen[3] == 0).all()
    other = carom.gym.FeaturePlanes(carom.gym.make_env("Position"))
    assert other.reset(seed=1)[0][3].max() > 0.6
    gone = states.take([0, 0])
    gone.xy[1, ids.index("cue")] = np.nan
    assert (env.planes(gone)[1, 0] == 0).all() and env.planes(gone)[0, 0].any()
    with pytest.raises(ValueError, match="height=0"):
        carom.gym.FeaturePlanes(carom.gym.make_env("Pot"), 0)


def test_pixels_match_gymnasiums_wrapper():
    from gymnasium.wrappers import AddRenderObservation

    env = AddRenderObservation(
        gymnasium.make("carom/Pot-v0", render_mode="rgb_array", size=(64, 36)), render_only=True)
    seen, _ = env.reset(seed=1)
    assert seen.shape == (36, 64, 3) and seen.dtype == np.uint8 and env.observation_space.contains(seen)
