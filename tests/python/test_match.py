"""Games for two players as PettingZoo environments: PettingZoo's own tests, whole games, ball in hand, calls,
and shots without an end."""

from __future__ import annotations

import warnings

import carom
import numpy as np
import pytest

pytest.importorskip("pettingzoo", reason="pettingzoo is not installed: pip install pettingzoo")
from carom.gym import match  # noqa: E402
from pettingzoo.test import api_test, seed_test  # noqa: E402

NAMES = ["EightBall", "NineBall", "TenBall", "Snooker"]


@pytest.mark.parametrize(
    "options", [{}, {"aim": "ball", "elevation_deg": (0.0, 3.0)}], ids=["plain", "options"])
@pytest.mark.parametrize("name", NAMES)
def test_pettingzoo_accepts_the_game(name, options, capsys):
    with warnings.catch_warnings():
        # PettingZoo warns that it prefers an array to a dict.
        warnings.filterwarnings("ignore", message="Observation.*")
        api_test(match.env(name, **options), num_cycles=30)
        seed_test(lambda: match.env(name, noise="ai3603", **options), num_cycles=15)


def play(env, seed, act, most=3000):
    """Plays a whole game. Returns (agent, reward, phase, info) for every turn."""
    env.reset(seed=seed)
    turns = []
    for agent in env.agent_iter(most):
        seen, reward, terminated, truncated, info = env.last()
        turns.append((agent, reward, int(seen["phase"]), info))
        assert env.observation_space(agent).contains(seen)
        env.step(None if terminated or truncated else act(agent, seen))
    return turns


@pytest.mark.parametrize("name", NAMES)
def test_games_between_random_players_end(name):
    env = match.env(name, aim="ball", noise="fastfiz")
    ends, phases, fouls = [], 0, set()
    for seed in range(4):
        random = np.random.default_rng(seed)
        turns = play(env, seed, lambda agent,
                     _: random.uniform(-1, 1, env.action_space(agent).shape).astype(np.float32))
        assert not env.agents and env.state_of_the_game.over
        last = {agent: reward for agent, reward, *_ in turns[-2:]}
        assert sorted(last.values()) == [-1.0, 1.0] and last[f"player_{env.state_of_the_game.winner}"] == 1.0
        assert all(reward == 0 for _, reward, *_ in turns[:-2])
        ends.append((len(turns), env.record().hash()))
        phases += sum(phase for *_, phase, _ in turns)
        fouls |= {info["foul"] for *_, info in turns if info.get("foul")}
        # The player who places the cue ball also strikes it.
        assert all(a[0] == b[0] for a, b in zip(turns, turns[1:]) if a[2])
    assert len(set(ends)) == 4 and phases > 0 and {"cue ball pocketed", "wrong ball first"} <= fouls
    again = np.random.default_rng(3)
    play(env, 3, lambda agent, _: again.uniform(-1, 1, env.action_space(agent).shape).astype(np.float32))
    assert env.record().hash() == ends[3][1]


def until_in_hand(env, seed):
    random = np.random.default_rng(seed)
    env.reset(seed=seed)
    while not env.observe(env.agent_selection)["phase"]:
        assert not any(env.terminations.values())
        env.step(random.uniform(-1, 1, 5).astype(np.float32))


@pytest.mark.parametrize("name", NAMES)
def test_the_cue_ball_in_hand_lies_at_the_chosen_place_or_beside_an_obstacle(name):
    env = match.env(name)
    cue = env.ids.index("cue")
    for seed in range(3):
        until_in_hand(env, seed)
        agent, area = env.agent_selection, env.state_of_the_game.in_hand
        corners = [np.array([x, y, 0, 0, 0], np.float32) for x in (-1, 0, 1) for y in (-1, 0.3, 1)]
        wanted = [env._free_place(corner[:2].astype(float)) for corner in corners]
        assert all(
            carom.games.may_place(env._record, env._option, place)
            for place in wanted) and len(set(wanted)) == 9, area
        if area == "anywhere":
            # A place on another ball becomes one just beside it.
            other = next(i for i, place in enumerate(env._xy) if i != cue and not np.isnan(place[0]))
            low, high = np.array(env._game.table.corner) + env._game.radii[cue], np.array(
                [env._game.table.width, env._game.table.length]) - 2 * env._game.radii[cue]
            place = env._free_place(2 * (env._xy[other] - low) / high - 1)
            assert np.hypot(*(place - env._xy[other])) < 4 * env._game.radii[cue]
        env.step(corners[4])
        assert env.agent_selection == agent and not env.observe(agent)["phase"]
        assert tuple(env._xy[cue]) == wanted[4]
        env.step(np.array([0.1, 1, 0, 0, 0], np.float32))
        assert np.array_equal(env.record().states(0.0)[env.record().ids.index("cue"), 0, :2], wanted[4])


def test_calls_are_part_of_the_action():
    env = match.env("EightBall", called=True)
    assert env.action_space("player_0").shape == (7,)
    # With `called`, pocketing an uncalled ball ends the turn: compare the same shots with lucky calls.
    lucky, called = match.env("EightBall", aim="ball"), match.env("EightBall", aim="ball", called=True)
    differ = 0
    for seed in range(3):
        random = np.random.default_rng(seed)
        lucky.reset(seed=seed)
        called.reset(seed=seed)
        for _ in range(40):
            act = random.uniform(-1, 1, 7).astype(np.float32)
            lucky.step(act[:5])
            called.step(act)
            if lucky.agent_selection != called.agent_selection:
                differ += 1
                break
            if not lucky.agents or any(lucky.terminations.values()) or any(called.terminations.values()):
                break
    assert differ > 0
    with pytest.raises(ValueError, match="only eight-ball and ten-ball have calls"):
        match.env("NineBall", called=True)
    with pytest.raises(ValueError, match="game='Chess'"):
        match.env("Chess")


def test_an_endless_shot_truncates_the_game():
    env = match.env("NineBall")
    env.reset(seed=1)
    before = env.observe("player_0")["balls"]
    env.step(np.array([np.nan, 0, 0, 0, 0], np.float32))
    assert all(env.truncations.values()) and not any(env.terminations.values())
    assert set(env.rewards.values()) == {0.0}
    assert env.infos["player_1"]["status"] == carom.ShotStatus.INVALID
    assert "not a number" in env.infos["player_1"]["message"]
    assert np.array_equal(env.observe("player_0")["balls"], before)
    short = match.env("NineBall", most_shots=1)
    short.reset(seed=1)
    short.step(np.array([0, 1, 0.5, 0, 0], np.float32))
    assert all(short.truncations.values())


def test_the_picture_shows_the_table():
    env = match.env("Snooker", render_mode="rgb_array", size=(64, 36))
    env.reset(seed=1)
    with pytest.raises(RuntimeError, match="no shot"):
        env.record()
    assert env.render().shape == (36, 64, 3)


def test_an_unknown_option_is_named():
    with pytest.raises(TypeError, match="observation: unknown option; expected one of aim, speed"):
        match.env("EightBall", observation="dict")
