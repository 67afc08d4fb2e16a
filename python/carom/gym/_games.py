"""Games of one player, on any number of tables at once: arrays in, arrays out. The environments are made of them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from carom import _carom
from carom._arguments import checked
from carom._record import Record
from carom._scene import Scene, SceneLike, as_scene
from carom._simulate import Shots, ShotStatus, _columns_of, simulate, simulate_many

if TYPE_CHECKING:
    from numpy.typing import NDArray

#: [m] The least room between balls, and between a ball and a cushion, in a random layout.
_ROOM = 1e-3
#: Random layouts that are tried before something must be wrong with the table.
_TRIES = 1000


@checked
class States(NamedTuple):
    """n tables between two shots. Copy it, cut it, repeat it: `states.take([0] * 1000)`."""

    xy: NDArray[np.float64]  # (n, balls, 2) [m]; NaN for a ball that is not on the table
    extra: NDArray[np.float64]  # (n, k) what the game remembers beside: `Game.EXTRA` names the columns

    def take(self, rows: Any) -> States:
        """The tables with these numbers, as a copy."""
        return States(self.xy[rows].copy(), self.extra[rows].copy())

    def put(self, rows: Any, others: States) -> None:
        """Replaces the tables with these numbers."""
        self.xy[rows], self.extra[rows] = others.xy, others.extra


class Judged(NamedTuple):
    """What n shots were worth."""

    states: States  # behind the shots
    reward: NDArray[np.float64]  # (n,)
    terminated: NDArray[np.bool_]  # (n,)
    foul: NDArray[np.object_]  # (n,) its name, or ""


@checked
class Game:
    """A game of one player. The subclasses say what stands on the table and what a shot is worth."""

    #: Names of the columns of `States.extra`.
    EXTRA: tuple[str, ...] = ()
    #: An episode with as many shots is truncated, unless the environment's option says otherwise.
    SHOTS = 1000

    def __init__(self, scene: SceneLike) -> None:
        scene = as_scene(scene)
        record = simulate(scene, until=0.0)
        self.scene, self.ids, self.radii = scene, scene.ids, record.radii
        self.table, self.colors = record.table, record.colors
        if min(self.table.width, self.table.length) <= 0:
            raise ValueError("scene: its table has no cushions, and so no size to place balls in")
        self._tree = Scene.loads(scene.text()).to_dict()
        if "cue" not in self._tree:
            raise ValueError("scene: it has no [cue], and so no ball to strike")
        self.cue_ball = self.ids.index(self._tree["cue"].get("ball", "cue"))
        self._half = 0.5 * np.array([self.table.width, self.table.length])
        self._middle = np.array(self.table.corner) + self._half
        # Where a random layout may have the centres of its balls.
        largest = self.radii.max()
        self._low = np.array(self.table.corner) + largest + _ROOM
        self._room = np.array([self.table.width, self.table.length]) - 2 * (largest + _ROOM)
        mouths = np.array([pocket[1:4] for pocket in self.table.pockets]).reshape(-1, 3)
        mouths[:, 2] += largest
        mouths[:, 2] *= mouths[:, 2]
        self._mouths = mouths.reshape(-1)
        self._apart2 = float((2 * largest + _ROOM) ** 2)

    # What subclasses say.

    def start(self, states: NDArray[np.uint64]) -> States:
        """New tables, one for each of the generators, which move on: random layouts, unless a subclass says otherwise."""
        xy = self.random_places(states, len(self.ids))
        return States(xy, self.no_extra(len(xy)))

    def legal(self, states: States) -> NDArray[np.bool_]:
        """(n, balls) which balls may be hit first."""
        legal = ~np.isnan(states.xy[:, :, 0])
        legal[:, self.cue_ball] = False
        return legal

    def judge(self, states: States, cue: NDArray[np.float64], shots: Shots) -> Judged:
        """What shots were worth that began with `states` and these strikes. What is said of a shot without an end counts for nothing."""
        raise NotImplementedError

    def play(self, states: States, cue: NDArray[np.float64], *, max_events: int | None, threads: int, hashes: bool) -> tuple[Shots, Judged]:
        """Plays one strike on each of the tables, and judges it."""
        shots = simulate_many(self.scene, cue=cue, xy=states.xy, max_events=max_events, threads=threads, hashes=hashes)
        return shots, self.judge(states, cue, shots)

    def points(self, states: States) -> NDArray[np.float64]:
        """(n, places, 2) what an observation shows beside the balls [m]."""
        return np.empty((len(states.xy), 0, 2))

    # What all share.

    def observe(self, states: States) -> NDArray[np.float32]:
        """(n, balls + places, 3): x and y from -1 to 1 across the table, and 1. All three are 0 for a ball that is not on the table."""
        balls, marks = np.ascontiguousarray(states.xy), np.ascontiguousarray(self.points(states))
        out = np.empty((len(balls), balls.shape[1] + marks.shape[1], 3), np.float32)
        _carom.observe(len(balls), balls.reshape(-1), marks.reshape(-1), self._middle, self._half, out.reshape(-1))
        return out

    def scene_of(self, xy: NDArray[np.float64], cue: NDArray[np.float64] | None = None) -> Scene:
        """One table as a scene, with the strike or without one. Raises SceneError where the balls cannot stand so."""
        tree: dict[str, Any] = {key: part for key, part in self._tree.items() if key not in ("ball", "cue")}
        tree["ball"] = [ball | {"position": place} for ball, place in zip(self._tree["ball"], xy.tolist()) if place[0] == place[0]]
        if cue is not None:
            speed, aim, elevation, side, height = cue.tolist()
            tree["cue"] = self._tree["cue"] | {"speed": speed, "aim_deg": aim, "elevation_deg": elevation, "offset": [side, height]}
        return Scene.from_dict(tree)

    def record(self, xy: NDArray[np.float64], cue: NDArray[np.float64]) -> Record:
        """One shot with everything that happened. Raises SimulationError for one that cannot go on."""
        return simulate(self.scene_of(xy, cue))

    def no_extra(self, n: int) -> NDArray[np.float64]:
        return np.zeros((n, len(self.EXTRA)))

    def scratch(self, shots: Shots) -> NDArray[np.object_]:
        """Fouls of every game: the name, or ""."""
        foul = np.full(len(shots.status), "", object)
        foul[(shots.pocket == -2).any(1)] = "ball off the table"
        foul[shots.pocket[:, self.cue_ball] >= 0] = "scratch"
        return foul

    def random_places(self, states: NDArray[np.uint64], balls: int) -> NDArray[np.float64]:
        """(n, balls, 2) places that leave room between each other and to cushions and pockets, uniform among all such."""
        xy = np.empty((len(states), balls, 2))
        if not _carom.random_places(states, self._low, self._room, self._mouths, self._apart2, _TRIES, xy.reshape(-1)):
            raise ValueError("no random layout fits this table: it is too small for its balls")
        return xy


def _placed(ids: Mapping[str, tuple[float, float]]) -> list[dict[str, Any]]:
    return [{"id": ball, "position": list(place)} for ball, place in ids.items()]


@checked
class Pot(Game):
    """One object ball and one shot, from a random layout: 1 for the ball in any pocket, -1 for a foul (the cue ball in a pocket, a ball off the
    table), 0 otherwise."""

    def __init__(self, *, table: str = "nine_foot", scene: SceneLike | None = None) -> None:
        super().__init__(scene or Scene(table=table, ball=_placed({"cue": (0.4, 0.5), "1": (0.5, 1.2)}), cue={"speed": 2.0, "aim_deg": 90.0}))

    def judge(self, states: States, cue: NDArray[np.float64], shots: Shots) -> Judged:
        foul = self.scratch(shots)
        potted = shots.pocket >= 0
        potted[:, self.cue_ball] = False
        reward = np.asarray(potted.any(1), np.float64)
        reward[foul != ""] = -1.0
        behind = States(shots.places, states.extra.copy())
        return Judged(behind, reward, np.ones(len(reward), bool), foul)


@checked
class Position(Pot):
    """As Pot, and the cue ball should come to rest at a target: the reward is less by the distance to it, in diagonals of the table. A foul is -1."""

    EXTRA = ("target x", "target y")

    def start(self, states: NDArray[np.uint64]) -> States:
        xy = self.random_places(states, len(self.ids))
        return States(xy, self.random_places(states, 1)[:, 0])

    def judge(self, states: States, cue: NDArray[np.float64], shots: Shots) -> Judged:
        judged = super().judge(states, cue, shots)
        to = shots.xy[:, self.cue_ball] - states.extra
        diagonal = np.sqrt(self.table.width**2 + self.table.length**2)
        far = np.sqrt((to * to).sum(-1)) / diagonal
        return judged._replace(reward=np.where(judged.foul != "", -1.0, judged.reward - far))

    def points(self, states: States) -> NDArray[np.float64]:
        return states.extra[:, None]


@checked
class _Ruled(Game):
    """A game whose shots are judged by `carom.games`. An episode is a player's turn."""

    #: The name of the game in `carom.games`.
    RULES = ""

    def __init__(self, scene: SceneLike) -> None:
        super().__init__(scene)
        self._fouls = np.array([*_carom.foul_names(), ""], object)

    def legal(self, states: States) -> NDArray[np.bool_]:
        out = np.empty(states.xy.shape[:2], np.uint8)
        _carom.legal_many(self.scene._native, self.RULES, np.ascontiguousarray(states.xy).reshape(-1), self._group(states), out.reshape(-1))
        return out.astype(bool)

    def judge(self, states: States, cue: NDArray[np.float64], shots: Shots) -> Judged:
        # An outcome does not have all that rules ask, so the shots are played once more.
        return self._played(states, cue, None, 1, False)[1]

    def play(self, states: States, cue: NDArray[np.float64], *, max_events: int | None, threads: int, hashes: bool) -> tuple[Shots, Judged]:
        if type(self).judge is not _Ruled.judge:  # a subclass has a judge of its own
            return super().play(states, cue, max_events=max_events, threads=threads, hashes=hashes)
        return self._played(states, cue, max_events, threads, hashes)

    def _played(self, states: States, cue: NDArray[np.float64], max_events: int | None, threads: int, hashes: bool) -> tuple[Shots, Judged]:
        """Plays and judges in one pass."""
        n, columns, absent = _columns_of(self.scene, cue, states.xy)
        shots = Shots.empty(n, len(self.ids), hashes=hashes)
        xy, group = states.xy.copy(), self._group(states)
        foul, points, goes_on = np.full(n, -1, np.int32), np.zeros(n, np.int32), np.zeros(n, np.uint8)
        failures = _carom.judge_many(
            self.scene._native, self.RULES, n, columns, absent, max_events, threads, shots._native(), xy.reshape(-1), group, foul, points, goes_on
        )
        extra = states.extra.copy()
        if self.EXTRA:
            extra[:, 0] = group
        judged = self.worth(States(xy, extra), points, goes_on != 0, self._fouls[foul])
        return shots._replace(messages=dict(failures)), judged

    def worth(self, behind: States, points: NDArray[np.int32], goes_on: NDArray[np.bool_], foul: NDArray[np.object_]) -> Judged:
        """Rewards: the points, until the turn is over."""
        return Judged(behind, points.astype(np.float64), ~goes_on, foul)

    def _group(self, states: States) -> NDArray[np.int32]:
        return states.extra[:, 0].astype(np.int32) if self.EXTRA else np.zeros(len(states.xy), np.int32)


@checked
class ThreeCushion(_Ruled):
    """Three-cushion from a random layout, for as long as you score: 1 for a point. The cue ball is the white one."""

    RULES = "three_cushion"

    def __init__(self, *, table: str = "carom", scene: SceneLike | None = None) -> None:
        places = {"white": (0.5, 0.7), "yellow": (0.7, 0.7), "red": (0.7, 2.1)}
        super().__init__(scene or Scene(table=table, balls="carom", ball=_placed(places), cue={"ball": "white", "speed": 4.0, "aim_deg": 0.0}))


@checked
class SumToThree(_Ruled):
    """Two balls on a table without pockets, ten shots: 1 for a shot that hits the other ball, and in which the two meet three cushions together."""

    RULES = "sum_to_three"
    SHOTS = 10

    def __init__(self, *, table: str = "carom", scene: SceneLike | None = None) -> None:
        places = {"cue": (0.5, 0.7), "object": (0.7, 2.1)}
        super().__init__(scene or Scene(table=table, balls="carom", ball=_placed(places), cue={"speed": 4.0, "aim_deg": 0.0}))

    def worth(self, behind: States, points: NDArray[np.int32], goes_on: NDArray[np.bool_], foul: NDArray[np.object_]) -> Judged:
        return Judged(behind, points.astype(np.float64), np.zeros(len(points), bool), foul)


def _pool(table: str, rack: str) -> Scene:
    cue = {"id": "cue", "position": [0.6, 0.5]}
    return Scene(table=table, rack=rack, ball=[cue], cue={"speed": 4.0, "aim_deg": 90.0})


@checked
class NineBallRun(_Ruled):
    """Nine-ball from a random layout of all balls, for as long as you stay at the table: 1 for every ball that falls in a fair shot. The episode ends with a
    miss, a foul, or the nine."""

    RULES = "nine_ball"

    def __init__(self, *, table: str = "nine_foot", scene: SceneLike | None = None) -> None:
        super().__init__(scene or _pool(table, "nine_ball"))


@checked
class EightBallRun(_Ruled):
    """Eight-ball from a random layout on an open table, for as long as you stay at the table: 1 for every ball that falls in a fair shot. The first of your balls
    that falls is taken as called, so luck counts. The episode ends with a miss, a foul, or the eight."""

    RULES = "eight_ball"
    EXTRA = ("group",)  # 0: the table is open, 1: solids, 2: stripes

    def __init__(self, *, table: str = "nine_foot", scene: SceneLike | None = None) -> None:
        super().__init__(scene or _pool(table, "eight_ball"))


def failed(shots: Shots) -> NDArray[np.bool_]:
    """(n,) the shots without an end: invalid, failed, or stopped by a limit."""
    return np.asarray(shots.status != ShotStatus.AT_REST)
