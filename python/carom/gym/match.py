"""Games for two players as PettingZoo environments (AEC): `carom.gym.match.env("EightBall")`.

They need pettingzoo, which is part of the extra [gym].
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from gymnasium import spaces
from gymnasium.utils import seeding

try:
    from pettingzoo import AECEnv
except ImportError as error:
    raise ImportError("carom.gym.match needs PettingZoo: pip install pettingzoo") from error

from carom import _carom, games
from carom._arguments import checked
from carom._names import GameName, TableName
from carom._record import Record
from carom._scene import Scene
from carom._simulate import ShotStatus, SimulationError, simulate
from carom.gym._env import Options
from carom.gym._games import Game, States

if TYPE_CHECKING:
    from numpy.typing import NDArray

#: By the game's name here: its rules, its table, and the cue ball's place at the break in fractions of width
#: and length.
_GAMES: dict[str, tuple[GameName, TableName, tuple[float, float]]] = {
    "EightBall": ("eight_ball", "nine_foot", (0.5, 0.2)),
    "NineBall": ("nine_ball", "nine_foot", (0.35, 0.2)),
    "TenBall": ("ten_ball", "nine_foot", (0.35, 0.2)),
    "Snooker": ("snooker", "snooker", (0.43, 0.19)),
}
#: The rules that have calls.
_CALLED = ("eight_ball", "ten_ball")
_MOST_EVENTS = 1_000_000
#: The values of observation["phase"].
_PHASES = ("strike", "place")


@checked
def env(game: str, **options: Any) -> MatchEnv:
    """A game by name: "EightBall", "NineBall", "TenBall" or "Snooker". Raises ValueError for any other."""
    return MatchEnv(game, **options)


@checked
class MatchEnv(AECEnv[str, Any, Any]):  # type: ignore[misc, unused-ignore]  # PettingZoo has no types
    """A game for two players under the rules of `carom.games`, from the break to the end.

    The winner gets 1, the loser -1.

    aim, speed, elevation_deg, noise: as for `carom.gym.TableEnv`, except that speed is (0.3, 8.0)
    called=False: eight-ball and ten-ball: two more numbers of an action call the ball, among those that may
        be called, and the pocket. Otherwise your first ball to fall counts as called, so luck helps
    opponent: a level of `carom.games.SKILLS` that plays player_1 inside `step`; None: you play both
    most_shots=1000: a game with this many shots is truncated
    render_mode, size: as for `carom.gym.TableEnv`

    An action is Box(-1, 1): a strike, as for the other environments. Placing a cue ball in hand is a separate
    action: while observation["phase"] is 1, the first two numbers are its place across the allowed area, or
    the nearest free place if a ball blocks it. The same player strikes next. The break is played from a fixed
    place. If the rules offer a choice, the first of `carom.games.Verdict.options` is taken.

    An observation is a dict: "balls" as in the other environments, "legal" (which balls may be hit first),
    "phase", and "points" (the observer's and the opponent's). Info: "status", "foul", "message", and the last
    shot's "cue".

    A shot without an end truncates the game; it never raises.
    """

    metadata: dict[str, Any] = {
        "render_modes": ["rgb_array"], "render_fps": 1, "is_parallelizable": False, "name": "carom_match_v0"}

    def __init__(
        self,
        game: str,
        *,
        called: bool = False,
        opponent: str | None = None,
        most_shots: int = 1000,
        **options: Any,
    ) -> None:
        super().__init__()
        if game not in _GAMES:
            raise ValueError(f"game={game!r}: expected {', '.join(_GAMES)}")
        if called and _GAMES[game][0] not in _CALLED:
            raise ValueError("called: only eight-ball and ten-ball have calls; leave it out")
        if opponent is not None and game == "Snooker":
            raise ValueError("opponent: carom does not play snooker; leave it out")
        self._player = None if opponent is None else games.Player(opponent)
        self._rules, self._table, self._break_from = _GAMES[game]
        self._options = Options.of({"speed": (0.3, 8.0)} | options)
        self._strikes = self._options.strikes()
        self._called, self._most_shots = called, most_shots
        self.render_mode = self._options.render_mode
        self._game = Game(self._rack(1))
        self._noise = self._options.noise_in(self._game)
        self.possible_agents = ["player_0", "player_1"]
        balls = len(self._game.ids)
        self._observation_space = spaces.Dict(
            {
                "balls": spaces.Box(-1.0, 1.0, (balls, 3), np.float32),
                "legal": spaces.MultiBinary(balls),
                "phase": spaces.Discrete(len(_PHASES)),
                "points": spaces.Box(0.0, np.inf, (2,), np.float32),
            }
        )
        shape = (self._strikes.size + 2 * called,)
        self._action_spaces = {
            agent: spaces.Box(-1.0, 1.0, shape, np.float32) for agent in self.possible_agents}
        self.agents = self.possible_agents[:]
        self.np_random: np.random.Generator | None = None

    @property
    def ids(self) -> tuple[str, ...]:
        """The balls, in the order of every array's ball axis."""
        return self._game.ids

    @property
    def state_of_the_game(self) -> games.State:
        """The state that the rules keep between shots."""
        return self._state

    def observation_space(self, agent: str) -> spaces.Space[Any]:
        return self._observation_space

    def action_space(self, agent: str) -> spaces.Space[Any]:
        return self._action_spaces[agent]

    def reset(self, seed: int | None = None, options: dict[str, Any] | None = None) -> None:
        if seed is not None or self.np_random is None:
            self.np_random, _ = seeding.np_random(seed)
        self._noise_seed = int(self.np_random.integers(0, 2**63))
        self.agents = self.possible_agents[:]
        self.rewards = dict.fromkeys(self.agents, 0.0)
        self._cumulative_rewards = dict.fromkeys(self.agents, 0.0)
        self.terminations = dict.fromkeys(self.agents, False)
        self.truncations = dict.fromkeys(self.agents, False)
        self.infos: dict[str, dict[str, Any]] = {agent: {} for agent in self.agents}
        self._shots = 0
        if self._player is not None:
            self._player = games.Player(self._player.skill, self._noise_seed)
        self._begin(games.new_game(self._rules))

    def observe(self, agent: str) -> dict[str, Any]:
        states = States(self._xy[None], np.empty((1, 0)))
        me = self.possible_agents.index(agent)
        mine, others = self._state.points[me], self._state.points[1 - me]
        return {
            "balls": self._game.observe(states)[0],
            "legal": self._legal().astype(np.int8),
            "phase": np.int64(self._placing),
            "points": np.array([mine, others], np.float32),
        }

    def step(self, action: Any) -> None:
        agent = self.agent_selection
        if self.terminations[agent] or self.truncations[agent]:
            self._was_dead_step(action)
            return
        act = np.asarray(action, np.float64)
        if act.shape != self._action_spaces[agent].shape:
            wanted = self._action_spaces[agent].shape
            raise ValueError(f"action: expected the shape {wanted}, not {act.shape}")
        self._cumulative_rewards[agent] = 0.0
        self._clear_rewards()
        self.infos = {name: {} for name in self.agents}
        if self._placing:
            self._place(act)
        else:
            self._strike(act)
        self._let_opponent_play()
        self._accumulate_rewards()

    def render(self) -> NDArray[np.uint8] | None:
        """The table as it is, from above: (height, width, 3) bytes."""
        return None if self.render_mode is None else self._options.picture(self._game, self._xy)

    def record(self) -> Record:
        """The record of the last shot. Raises RuntimeError before the first shot of a rack."""
        if self._record is None:
            raise RuntimeError("there has been no shot since the balls were racked; call step first")
        return self._record

    def close(self) -> None:
        pass

    # From one shot to the next.

    def _begin(self, state: games.State) -> None:
        """Racks the balls for a break."""
        assert self.np_random is not None
        scene = self._rack(int(self.np_random.integers(1, 2**31)))
        self._state = state
        self._option: games.Option | None = None
        self._place_at: tuple[float, float] | None = None
        self._record: Record | None = None
        self._xy = np.array(scene.positions)
        self._set_turn()

    def _set_turn(self) -> None:
        # The rack has already placed the cue ball for the break.
        self._placing = self._record is not None and self._state.in_hand != "no" and self._place_at is None
        self.agent_selection = self.possible_agents[self._state.turn]

    def _place(self, act: NDArray[np.float64]) -> None:
        assert self._record is not None and self._option is not None
        self._place_at = self._free_place(np.nan_to_num(np.clip(act[:2], -1, 1)))
        self._xy[self._game.cue_ball] = self._place_at
        self._set_turn()

    def _strike(self, act: NDArray[np.float64]) -> None:
        legal = self._legal()
        struck, act_cue = self._game.cue_ball, act[None, : self._strikes.size]
        cue = self._strikes.cue(act_cue, self._xy[None], struck, legal[None], self._game.radii)[0]
        call = self._call(act) if self._called else None
        if not np.isfinite(cue).all():
            return self._stop(ShotStatus.INVALID, "the action is not a number")
        self._play(games.noisy(cue, self._noise, self._noise_seed, self._shots + 1), call)

    def _let_opponent_play(self) -> None:
        """While it is the opponent's turn, it plays."""
        while (
            self._player is not None and self._state.turn == 1
            and not any(self.terminations.values()) and not any(self.truncations.values())
        ):
            shot = self._player.shot(self._state, self._game.scene_of(self._xy))
            if shot.place is not None:
                self._place_at = self._xy[self._game.cue_ball] = shot.place
            cue = shot.cue
            strike = [cue["speed"], cue["aim_deg"], cue["elevation_deg"], *cue["offset"]]
            self._play(np.array(strike), shot.call)

    def _play(self, cue: NDArray[np.float64], call: games.Call | None) -> None:
        """Plays and judges a strike: an array of `carom.games.STRIKE`."""
        self._shots += 1
        speed, aim, elevation, side, height = cue.tolist()
        strike = {"speed": speed, "aim_deg": aim, "elevation_deg": elevation, "offset": [side, height]}
        try:
            if self._record is None or self._option is None:
                scene = self._game.scene_of(self._xy, cue)
            else:
                scene = games.next_scene(self._record, self._option, strike, place=self._place_at)
            record = simulate(scene, max_events=_MOST_EVENTS)
        except SimulationError as error:
            return self._stop(ShotStatus.FAILED, str(error))
        if record.stopped != "at_rest":
            return self._stop(ShotStatus.EVENTS, f"the shot ended by {record.stopped}")
        verdict = games.judge(self._state, record, call or self._lucky_call(scene, record))
        foul = verdict.fouls[0].name if verdict.fouls else ""
        for agent in self.agents:
            self.infos[agent] = {"status": int(ShotStatus.AT_REST), "cue": cue.copy(), "foul": foul}
        self._go_on(record, verdict)

    def _go_on(self, record: Record, verdict: games.Verdict) -> None:
        option = verdict.options[0]
        if option.rerack:
            self._begin(option.state)
        else:
            self._record, self._option, self._state, self._place_at = record, option, option.state, None
            self._xy = self._places_behind(record, option)
            self._set_turn()
        if self._state.over:
            for k, agent in enumerate(self.possible_agents):
                self.terminations[agent] = True
                won = 1.0 if self._state.winner == k else -1.0
                self.rewards[agent] = 0.0 if self._state.winner < 0 else won
        elif self._shots >= self._most_shots:
            self.truncations = dict.fromkeys(self.agents, True)

    def _stop(self, status: ShotStatus, why: str) -> None:
        """Ends a game after a shot without an end: the game is truncated, and the table stays as it was."""
        for agent in self.agents:
            self.truncations[agent] = True
            self.infos[agent] = {"status": int(status), "message": why, "foul": ""}

    def _places_behind(self, record: Record, option: games.Option) -> NDArray[np.float64]:
        xy = np.full((len(self.ids), 2), np.nan)
        gone = {event.a for event in record.event_list() if event.type in ("ball_pocket", "ball_out")}
        ends = record.states(record.duration)[:, 0, :2]
        for ball, place in zip(record.ids, ends):
            if ball not in gone:
                xy[self.ids.index(ball)] = place
        for back in option.respots:
            xy[self.ids.index(back.ball)] = back.place
        return xy

    def _legal(self) -> NDArray[np.bool_]:
        on_table = [ball for ball, place in zip(self.ids, self._xy) if place[0] == place[0]]
        out = np.zeros(len(self.ids), bool)
        if not self._state.over:
            out[[self.ids.index(ball) for ball in games.legal(self._state, on_table).first]] = True
        return out

    def _call(self, act: NDArray[np.float64]) -> games.Call:
        on_table = [ball for ball, place in zip(self.ids, self._xy) if place[0] == place[0]]
        may = games.legal(self._state, on_table).callable
        pockets = [pocket[0] for pocket in self._game.table.pockets]
        part = np.nan_to_num(np.clip(0.5 * (act[-2:] + 1), 0, 1 - 1e-9))
        return games.Call(may[int(part[0] * len(may))] if may else "", pockets[int(part[1] * len(pockets))])

    def _lucky_call(self, scene: Scene, record: Record) -> games.Call:
        if self._rules not in _CALLED:
            return games.Call()
        may = games.legal(self._state, scene).callable
        down = (event for event in record.event_list() if event.type == "ball_pocket")
        fell = ((event.a, event.b) for event in down if event.a in may)
        return games.Call(*next(fell, ("", "")))

    def _free_place(self, part: NDArray[np.float64]) -> tuple[float, float]:
        """The free place nearest to the one the action wants."""
        assert self._record is not None and self._option is not None
        table, radius = self._game.table, float(self._game.radii[self._game.cue_ball])
        low = np.array(table.corner) + radius
        high = np.array(table.corner) + [table.width - radius, table.length - radius]
        if self._state.in_hand == "head string":
            high[1] = games.spots(self._record)["head"][1]
        elif self._state.in_hand == "D":
            brown = np.array(games.spots(self._record)["brown"])
            reach = table.width / 6
            low, high = brown - reach, brown + [reach, 0.0]
        wanted = low + (high - low) * 0.5 * (part + 1)
        return _carom.free_place(self._record._native, self._option, tuple(wanted.tolist()))

    def _rack(self, seed: int) -> Scene:
        balls = "snooker" if self._rules == "snooker" else "pool"
        anywhere = Scene(table=self._table, balls=balls, ball=[{"id": "cue", "position": [0.5, 0.5]}])
        plain, (x, y) = simulate(anywhere, until=0.0).table, self._break_from
        place = [plain.corner[0] + x * plain.width, plain.corner[1] + y * plain.length]
        rack = {"game": self._rules} | ({} if self._rules == "snooker" else {"seed": seed})
        cue = {"speed": 4.0, "aim_deg": 90.0}
        return Scene(
            table=self._table, balls=balls, rack=rack, ball=[{"id": "cue", "position": place}], cue=cue)
