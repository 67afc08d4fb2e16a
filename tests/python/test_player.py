"""The player: advice, a player for whole games, and an opponent in matches."""

import pytest

import carom
from carom import games

BALLS = [
    {"id": "cue", "position": [0.6, 0.6]}, {"id": "3", "position": [0.3, 0.3]},
    {"id": "8", "position": [1.0, 2.3]}, {"id": "9", "position": [0.2, 2.0]},
]
TABLE = carom.Scene(table="nine_foot", balls="pool", ball=BALLS)
TURN = games.new_game("eight_ball")._replace(opening=False, in_hand="no", group=("solids", "stripes"))


def test_advice_pots_the_open_ball_and_can_be_played():
    best = games.advise(TURN, TABLE, "league")[0]
    assert (best.kind, best.ball, best.call.pocket) == ("pot", "3", best.pocket)
    assert best.makes[1] <= best.makes[0] <= best.makes[2] and best.makes[0] > 0.9
    shot = carom.Scene(table="nine_foot", balls="pool", ball=BALLS, cue=best.cue._asdict())
    verdict = games.judge(TURN, carom.simulate(shot), best.call)
    assert verdict.points == 1
    assert best.words.startswith("3 into ")


def test_advice_does_not_depend_on_threads():
    one, four = (games.advise(TURN, TABLE, "club", threads=n) for n in (1, 4))
    assert one == four


def test_a_ball_in_hand_is_placed():
    scene = carom.Scene(table="nine_foot", balls="pool", ball=BALLS[1:])
    best = games.advise(TURN._replace(in_hand="anywhere"), scene, "club")[0]
    assert best.place is not None and best.ball == "3"


@pytest.mark.parametrize(
    ("state", "scene", "why"),
    [
        (games.new_game("snooker"), TABLE, "carom does not play snooker"),
        (TURN._replace(over=True), TABLE, "the game is over"),
        (TURN, carom.Scene(table="nine_foot", balls="pool", ball=BALLS[1:]), "no cue ball"),
    ],
)
def test_refusals(state, scene, why):
    with pytest.raises(ValueError, match=why):
        games.advise(state, scene)


def test_unknown_levels_name_the_known_ones():
    with pytest.raises(ValueError, match="beginner, club"):
        games.Player("wizard")


def test_an_opponent_plays_its_turns_until_the_game_ends():
    match = pytest.importorskip("carom.gym.match")
    env = match.env("EightBall", opponent="club")
    env.reset(seed=3)
    env.action_space("player_0").seed(3)
    mine = 0
    while not any(env.terminations.values()) and mine < 200:
        assert env.agent_selection == "player_0"
        env.step(env.action_space("player_0").sample())
        mine += 1
    assert env.terminations["player_0"]
    assert env.rewards["player_0"] == -1.0


def test_an_opponent_of_snooker_is_refused():
    match = pytest.importorskip("carom.gym.match")
    with pytest.raises(ValueError, match="carom does not play snooker"):
        match.env("Snooker", opponent="club")
