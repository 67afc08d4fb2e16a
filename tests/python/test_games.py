"""carom.games: the noise of a strike, rules, and aiming aids."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest
from conftest import SOURCE, program_sweep

import carom
from carom import games


def test_noise_has_names_and_is_reproducible_by_seed():
    assert games.Noise.named("none") == games.Noise()
    assert games.Noise.named("ai3603") == (0.1, 0.1, 0.1, 0.003, 0.003)
    assert games.Noise.named("fastfiz", 0.025)[:3] == (0.075, 0.125, 0.1)
    assert games.Noise.named("fastfiz", 0.025).side == pytest.approx(0.02)
    with pytest.raises(ValueError, match="fastfiz, ai3603"):
        games.Noise.named("human")
    cue = {"speed": 3.0, "aim_deg": 40.0, "ball": "cue"}
    struck = games.noisy(cue, "ai3603", 7, 2)
    assert struck == games.noisy(cue, "ai3603", 7, 2) != games.noisy(cue, "ai3603", 7, 3)
    assert struck["ball"] == "cue" and struck["speed"] != 3.0 and struck["elevation_deg"] >= 0.0
    assert games.noisy({}, "none", 1) == {
        "speed": 9.0, "aim_deg": 90.0, "elevation_deg": 0.0, "offset": [0.0, 0.1]}
    carom.Scene(ball=[{"id": "cue", "position": [0.5, 0.5]}], cue=struck)
    many = games.noisy(np.tile([3.0, 40.0, 0.0, 0.0, 0.1], (5, 1)), "ai3603", 7)
    assert many[2].tolist() == [
        struck["speed"], struck["aim_deg"], struck["elevation_deg"], *struck["offset"]]


def test_noise_draws_like_a_sweep(tmp_path):
    scene = carom.Scene(ball=[{"id": "cue", "position": [0.5, 0.5]}],
                        cue={"speed": 4.0, "aim_deg": 30.0, "elevation_deg": 9.0, "offset": [0.1, 0.0]})
    (tmp_path / "s.toml").write_text(scene.text())
    rules = ["cue.speed=normal(0.2)", "cue.aim_deg=normal(0.3)", "cue.elevation_deg=normal(0.4)",
             "cue.offset.side=normal(0.01)", "cue.offset.height=normal(0.02)"]
    header, rows = program_sweep(tmp_path, tmp_path / "s.toml", rules, 20, 5)
    strikes = games.noisy(
        np.tile([4.0, 30.0, 9.0, 0.1, 0.0], (20, 1)), games.Noise(0.2, 0.3, 0.4, 0.01, 0.02), 5)
    columns = [header.index(rule.split("=")[0]) for rule in rules]
    assert [[float(row[c]) for c in columns] for row in rows] == strikes.tolist()


def test_a_noisy_strike_is_always_legal():
    random = np.random.default_rng(1)
    wild = games.noisy(random.normal(0.0, 3.0, (2000, 5)), games.Noise(1.0, 500.0, 50.0, 0.3, 0.3), 3)
    assert (wild[:, 0] >= 0.0).all() and (wild[:, 2] >= 0.0).all() and (wild[:, 2] < 90.0).all()
    assert ((wild[:, 3:] ** 2).sum(axis=1) <= 0.25).all() and (wild[:, 0] == 0.0).any()
    for strike in wild[:50]:
        cue = dict(zip(games.STRIKE[:3], strike)) | {"offset": strike[3:]}
        carom.Scene(ball=[{"id": "cue", "position": [0.5, 0.5]}], cue=cue)
    for bad in ([1.0] * 4, np.zeros((2, 2, 5)), [np.nan] * 5):
        with pytest.raises(ValueError):
            games.noisy(bad, "none", 1)
    with pytest.raises(ValueError, match="at least 0"):
        games.noisy({}, games.Noise(speed=-1.0), 1)


RACKS = {
    "eight_ball": {"table": "nine_foot", "balls": "pool", "rack": "eight_ball",
                   "ball": [{"id": "cue", "position": [0.6, 0.5]}]},
    "nine_ball": {"table": "nine_foot", "balls": "pool", "rack": "nine_ball",
                  "ball": [{"id": "cue", "position": [0.6, 0.5]}]},
    "three_cushion": {"table": "carom", "balls": "carom", "rack": "three_cushion"},
    "snooker": {"table": "snooker", "balls": "snooker", "rack": "snooker",
                "ball": [{"id": "cue", "position": [0.8, 0.6]}]},
    "sum_to_three": {"table": "carom", "balls": "carom",
                     "ball": [{"id": "cue", "position": [0.5, 0.5]}, {"id": "1", "position": [0.7, 2.0]}]},
    "ten_ball": {"table": "nine_foot", "balls": "pool", "rack": "ten_ball",
                 "ball": [{"id": "cue", "position": [0.6, 0.5]}]},
    "straight_pool": {"table": "nine_foot", "balls": "pool", "rack": "triangle",
                      "ball": [{"id": "cue", "position": [0.6, 0.5]}]},
    "free_pyramid": {"table": "pyramid", "balls": "pyramid", "rack": "pyramid",
                     "ball": [{"id": "cue", "position": [0.6, 0.5]}]},
    "four_ball": {"table": "carom", "balls": "carom", "rack": "four_ball"},
}
RACKS["straight_rail"] = RACKS["one_cushion"] = RACKS["three_cushion"]


def test_a_new_game_states_what_is_legal():
    state = games.new_game("eight_ball")
    assert state == games.State("eight_ball", 0, True, "head string", (0, 0), 0, False, -1, ("open", "open"),
                                False, (0, 0), "red", False)
    assert games.legal(state, ["cue", "8", "1"]) == games.Legal(["cue"], ["8", "1"], [], "head string", False)
    later = state._replace(opening=False, in_hand="no", group=("solids", "stripes"))
    assert games.legal(later, ["cue", "8", "1", "9"]).callable == ["1"]
    assert games.legal(games.new_game("three_cushion", first=1),
                       carom.Scene(**RACKS["three_cushion"])).cue_balls == ["yellow"]
    # Only a scene shows that the 1 lies behind the head string.
    at = {"cue": [0.8, 0.3], "1": [0.5, 0.3], "9": [0.5, 1.9]}
    balls = [{"id": ball, "position": place} for ball, place in at.items()]
    behind = carom.Scene(table="nine_foot", ball=balls)
    line = state._replace(opening=False)
    assert games.legal(line, behind).first == ["9"]
    assert games.legal(line, list(at)).first == ["1", "9"]
    for bad in (
        lambda: games.new_game("pinball"), lambda: games.new_game("snooker", first=3),
        lambda: games.legal(state._replace(over=True), ["8"])
    ):
        with pytest.raises(ValueError):
            bad()
    with pytest.raises(ValueError, match="open, solids, stripes"):
        games.legal(state._replace(group=("reds", "open")), ["8"])


def test_a_shot_is_judged_and_the_next_scene_follows():
    # The 1 is potted and the cue ball follows it: a scratch in nine-ball.
    scene = carom.Scene(
        table="nine_foot",
        balls="pool",
        ball=[{"id": "cue", "position": [0.3, 0.3]}, {"id": "1", "position": [0.2, 0.2]},
              {"id": "9", "position": [0.7, 1.0]}],
        cue={"speed": 4.0, "aim_deg": 225.0, "offset": [0.0, 0.4]},
    )
    record = carom.simulate(scene)
    state = games.new_game("nine_ball")._replace(opening=False, in_hand="no")
    verdict = games.judge(state, record)
    assert verdict.fouls == [games.Foul("cue ball pocketed", "WPA 6.1")] and verdict.chooser == -1
    assert verdict.next.turn == 1 and verdict.next.in_hand == "anywhere" and verdict.next.fouls == (1, 0)
    assert [option.decision for option in verdict.options] == ["take in hand"]
    with pytest.raises(ValueError, match="give its place"):
        games.next_scene(record, verdict, {"speed": 2.0})
    table = games.next_scene(record, verdict)
    assert games.may_place(record, verdict.options[0], table.positions[table.ids.index("cue")])
    assert not games.may_place(record, verdict.options[0], (0.7, 1.02))
    with pytest.raises(ValueError, match="not free"):
        games.next_scene(record, verdict, place=(0.7, 1.02))
    after = games.next_scene(record, verdict, {"speed": 2.0, "aim_deg": 90.0}, place=(0.7, 0.5))
    assert after.ids == ("cue", "9") and after.positions.tolist() == [[0.7, 0.5], [0.7, 1.0]]
    assert games.judge(verdict.next, carom.simulate(after)).points in (0, 1)
    with pytest.raises(ValueError, match="before its balls were at rest"):
        games.judge(state, carom.simulate(scene, until=0.1))


def test_numbers_out_of_range_are_refused_with_the_range():
    places = {"cue": [0.3, 0.3], "1": [0.3, 0.6], "9": [0.7, 1.0]}
    balls = [{"id": ball, "position": place} for ball, place in places.items()]
    scene = carom.Scene(ball=balls, cue={"speed": 1.0})
    wanted = "expected a whole number from (0|-1000000000) to 1000000000"
    record, state = carom.simulate(scene), games.new_game("nine_ball")
    for number in (10**9 + 1, 2**31 - 1, 2**31, 2**63, 2**70, -1, -(2**31) - 1):
        with pytest.raises(ValueError, match=f"^state.target: {wanted}$"):
            games.new_game("three_cushion", target=number)
        for wrong in (
            {"points": (number, 0)}, {"points": (0, number)}, {"fouls": (0, number)}, {"target": number}):
            for call in (lambda state: games.judge(state, record), lambda state: games.legal(state, scene)):
                with pytest.raises(ValueError, match=rf"^state\.{next(iter(wrong))}(\[[01]\])?: {wanted}$"):
                    call(state._replace(**wrong))
    for number in (2, -1, 2**31, -(2**70)):
        with pytest.raises(ValueError, match=r"^state\.turn: expected a whole number from 0 to 1$"):
            games.new_game("snooker", first=number)
        with pytest.raises(ValueError, match=r"^state\.turn: expected a whole number from 0 to 1$"):
            games.judge(state._replace(turn=number), record)


def test_a_verdict_belongs_to_one_record():
    # The same balls, slightly slower: one shot's verdict does not describe the other.
    scene = carom.Scene(
        table="nine_foot",
        balls="pool",
        ball=[{"id": "cue", "position": [0.3, 0.3]}, {"id": "1", "position": [0.2, 0.2]},
              {"id": "9", "position": [0.7, 1.0]}],
        cue={"speed": 4.0, "aim_deg": 225.0, "offset": [0.0, 0.4]},
    )
    record, other = carom.simulate(scene), carom.simulate(scene.replace(**{"cue.speed": 3.9}))
    lone = [{"id": "x", "position": [0.5, 0.4]}]
    one = carom.simulate(carom.Scene(table="snooker", balls="snooker", ball=lone,
                                     cue={"ball": "x", "speed": 0.1}))
    verdict = games.judge(games.new_game("nine_ball")._replace(opening=False, in_hand="no"), record)
    option = verdict.options[0]
    for of_another in (other, one):
        for kept in (option, pickle.loads(pickle.dumps(option)), copy.deepcopy(verdict).options[0]):
            with pytest.raises(ValueError, match="the verdict belongs to another record; give the record"):
                games.may_place(of_another, kept, (0.7, 0.5))
            with pytest.raises(ValueError, match="the verdict belongs to another record"):
                games.next_scene(of_another, kept, place=(0.7, 0.5))
        with pytest.raises(ValueError, match="the verdict belongs to another record"):
            games.next_scene(of_another, verdict, place=(0.7, 0.5))
    assert games.may_place(record, pickle.loads(pickle.dumps(option)), (0.7, 0.5))
    # A hand-made one belongs to any record that has its balls.
    decision, state, respots, *_ = option
    mine = games.Option(decision, state, respots)
    assert mine[:3] == option[:3] and hash(mine[0]) == hash(option.decision) and mine.rerack is False
    assert games.may_place(other, mine, (0.7, 0.5))
    with pytest.raises(ValueError, match='the record has no ball "cue"; give the record that'):
        games.may_place(one, mine, (0.7, 0.5))
    with pytest.raises(ValueError, match='the record has no ball "black"'):
        games.next_scene(record, mine._replace(respots=[games.Respot("black", (0.5, 0.5))]), place=(0.7, 0.5))


def test_a_verdict_of_a_loaded_record_belongs_to_it(tmp_path):
    scene = carom.Scene(
        ball=[{"id": "cue", "position": [0.3, 0.3]}, {"id": "1", "position": [0.3, 0.6]},
              {"id": "9", "position": [0.7, 1.0]}], cue={"speed": 1.0})
    record = carom.simulate(scene)
    record.save(tmp_path / "shot.json")
    verdict = games.judge(games.new_game("nine_ball")._replace(opening=False, in_hand="no"), record)
    place = (0.5, 0.5) if verdict.next.in_hand != "no" else None
    loaded = carom.Record.load(tmp_path / "shot.json")
    assert games.next_scene(loaded, verdict, place=place, scene=scene) == games.next_scene(
        record, verdict, place=place)


def test_respotted_balls_lie_exactly_on_their_spots():
    scene = carom.Scene(
        table="snooker",
        balls="snooker",
        ball=[{"id": "cue", "position": [1.5, 3.3]}, {"id": "black", "position": [1.65, 3.45]},
              {"id": "1", "position": [0.5, 2.0]}],
        cue={"speed": 1.5, "aim_deg": 45.0, "offset": [0.0, -0.2]},
    )
    record = carom.simulate(scene)
    state = games.new_game("snooker")._replace(opening=False, in_hand="no", on="colour")
    verdict = games.judge(state, record, games.Call("black"))
    assert verdict.points == 7 and not verdict.fouls and verdict.next.on == "red"
    assert verdict.respots == [games.Respot("black", games.spots(record)["black"])]
    after = games.next_scene(record, verdict)
    assert tuple(after.positions[after.ids.index("black")]) == games.spots(record)["black"]


@pytest.mark.parametrize("game", games.GAMES)
def test_whole_games_of_random_strikes(game):
    random = np.random.default_rng(5)
    state, scene = games.new_game(game, target=3), carom.Scene(**RACKS[game])
    for _ in range(60):
        legal = games.legal(state, scene)
        struck = legal.cue_balls[0]
        cue, target = (
            scene.positions[scene.ids.index(ball)]
            for ball in (struck, str(random.choice([ball for ball in legal.first if ball != struck]))))
        aim = float(np.degrees(np.arctan2(*(target - cue)[::-1]))) + random.normal(0.0, 1.0)
        scene = scene.replace(
            cue={"ball": struck, "speed": float(random.uniform(1.0, 7.0)), "aim_deg": aim})
        record = carom.simulate(scene)
        called = games.Call(
            str(random.choice(legal.callable)) if legal.callable else "", f"p{random.integers(1, 7)}")
        if not record.table.pockets:
            with pytest.raises(ValueError, match="the table has no pocket"):
                games.judge(state, record, called)
            called = games.Call()
        verdict = games.judge(state, record, called)
        option = verdict.options[random.integers(len(verdict.options))]
        state = option.state
        if state.over:
            assert state.winner in (0, 1)
            return
        if option.rerack:
            scene = carom.Scene(**RACKS[game])
            continue
        place = None
        if state.in_hand != "no":
            while place is None or not games.may_place(record, option, place):
                place = random.uniform(0.0, 1.0, 2) * (record.table.width, record.table.length)
        scene = games.next_scene(record, option, place=place)
    assert state.game == game


def test_options_of_a_game():
    state = games.new_game("nine_ball", rules={"push_out": False, "nine_on_break": "respot"})
    assert state.rules == ("push_out=false", "nine_on_break=respot")
    assert games.new_game("nine_ball", rules={"push_out": True}).rules == ()
    options = {option.key: option for option in games.rule_options() if option.game == "snooker"}
    assert options["miss"].values == ["false", "true"] and "miss" in options["miss"].what
    assert "rule 9" in games.book_of("ten_ball")
    for rules, message in (({"cal": "all"}, "it has call, eight_on_break, in_hand, jump"),
                           ({"call": "some"}, r"expected call=all\|eight\|none")):
        with pytest.raises(ValueError, match=message):
            games.new_game("eight_ball", rules=rules)
    # An eight that falls uncalled wins only if shots are not called.
    scene = carom.Scene(
        table="nine_foot", balls="pool",
        ball=[{"id": "cue", "position": [0.3, 0.3]}, {"id": "8", "position": [0.2, 0.2]}],
        cue={"speed": 1.5, "aim_deg": 225.0, "offset": [0.0, -0.2]})
    record = carom.simulate(scene)
    for rules, winner in (({}, 1), ({"call": "eight"}, 1), ({"call": "none"}, 0)):
        state = games.new_game("eight_ball", rules=rules)._replace(
            opening=False, in_hand="no", group=("solids", "stripes"))
        assert games.judge(state, record).next.winner == winner


def test_the_route_of_a_shot_and_its_point():
    scene = carom.Scene.load(SOURCE / "scenes" / "three_cushion.toml")
    record = carom.simulate(scene)
    assert record.measure("route") == ["head", "right", "left", "foot"]
    assert record.measure("cushions_before(red)") == 4 and record.measure("cushions_before(yellow)") == 0
    assert record.measure("point", game="three_cushion") is True
    assert record.measure("points(straight_rail)") == 1
    assert record.measure("kick") is False and record.measure("carom") is True


def pool(*balls, **cue):
    return carom.Scene(
        table="nine_foot", balls="pool", ball=[{"id": ball, "position": place} for ball, place in balls],
        cue={"offset": [0.0, 0.0]} | cue)


def test_an_aim_pots_the_ball():
    scene = pool(("cue", [0.4, 0.9]), ("1", [0.8, 1.6]), speed=2.0)
    lines = {line.pocket: line for line in games.pocket_lines(scene, "1")}
    assert list(lines) == ["p1", "p2", "p3", "p4", "p5", "p6"] and lines["p4"].open
    ghost = games.ghost_ball([0.8, 1.6], lines["p4"].towards)
    aim = games.aim_pot(scene, "1", "p4")
    assert aim.aim_deg is not None and aim.why == "" and 0 < aim.shots < 30
    assert aim.geometric_deg == pytest.approx(np.degrees(np.arctan2(ghost[1] - 0.9, ghost[0] - 0.4)))
    assert aim.cut_deg == pytest.approx(games.cut_angle_deg([0.4, 0.9], ghost, lines["p4"].towards))
    events = carom.simulate(scene.replace(**{"cue.aim_deg": aim.aim_deg})).event_list()
    assert ("ball_pocket", "1", "p4") in [event[1:] for event in events]
    for route in games.bank_routes(scene.replace(**{"cue.speed": 4.0}), "1", "p1"):
        events = carom.simulate(
            scene.replace(**{"cue.speed": 4.0, "cue.aim_deg": route.aim_deg})).event_list()
        assert ("ball_pocket", "1", "p1") in [event[1:] for event in events]
        assert ("ball_cushion", "1", route.cushion) in [event[1:] for event in events]


def test_an_impossible_aim_says_why():
    scene = pool(("cue", [0.4, 0.4]), ("1", [0.7, 1.4]), ("2", [0.55, 0.9]), speed=3.0)
    assert games.aim_pot(scene, "1", "p4")[0] is None
    assert games.aim_pot(scene, "1", "p4").why == "the cue ball meets ball 2 first"
    for bad in (
        lambda: games.aim_pot(scene, "7", "p4"), lambda: games.aim_pot(scene, "1", "p9"),
        lambda: games.aim_pot(scene.replace(cue=None), "1", "p4")
    ):
        with pytest.raises(ValueError):
            bad()


def test_fields_of_the_wrong_type_are_named():
    state, scene = games.new_game("nine_ball"), carom.Scene(rack="nine_ball", ball=[{"position": [0.6, 0.5]}])
    for wrong, message in (({"turn": "x"}, "turn: expected a whole number from 0 to 1"),
                           ({"points": (1, "a")}, r"points\[1\]: expected a whole number"),
                           ({"rules": (1,)}, r"rules\[0\]: expected a text"), ({"over": scene}, "over: ")):
        with pytest.raises(ValueError, match=rf"^state\.{message}"):
            games.legal(state._replace(**wrong), scene)
    record = carom.simulate(scene.replace(cue={"speed": 1, "aim_deg": 90, "offset": [0, 0]}))
    with pytest.raises(ValueError, match=r"^call\.ball: expected a text$"):
        games.judge(state, record, games.Call(ball=3))  # type: ignore[arg-type]
