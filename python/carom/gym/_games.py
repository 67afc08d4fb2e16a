"""Games for one player on any number of tables at once, arrays in and arrays out; the base of the
environments."""

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

#: [m] The smallest gap between balls, and between a ball and a cushion, in a random layout.
_ROOM = 1e-3
#: The number of random layouts to try before the table is reported as too small.
_TRIES = 1000


@checked
class States(NamedTuple):
    """n tables between two shots. Copy, slice or repeat them: `states.take([0] * 1000)`."""

    xy: NDArray[np.float64]  # (n, balls, 2) [m]; NaN for a ball that is not on the table
    extra: NDArray[np.float64]  # (n, k) other data of the game; `Game.EXTRA` names the columns

    def take(self, rows: Any) -> States:
        """A copy of the tables with these indices."""
        return States(self.xy[rows].copy(), self.extra[rows].copy())

    def put(self, rows: Any, others: States) -> None:
        """Replaces the tables with these indices."""
        self.xy[rows], self.extra[rows] = others.xy, others.extra


class Judged(NamedTuple):
    """The results of n shots."""

    states: States  # after the shots
    reward: NDArray[np.float64]  # (n,)
    terminated: NDArray[np.bool_]  # (n,)
    foul: NDArray[np.object_]  # (n,) its name, or ""


@checked
class Game:
    """A game for one player. Subclasses choose the balls on the table and the reward of a shot."""

    #: Names of the columns of `States.extra`.
    EXTRA: tuple[str, ...] = ()
    #: An episode with this many shots is truncated, unless the environment's option says otherwise.
    SHOTS = 1000

    def __init__(self, scene: SceneLike) -> None:
        scene = as_scene(scene)
        record = simulate(scene, until=0.0)
        self.scene, self.ids, self.radii = scene, scene.ids, record.radii
        self.table, self.colors = record.table, record.colors
        if min(self.table.width, self.table.length) <= 0:
            raise ValueError("scene: its table has no cushions to limit it; choose a table with cushions")
        self._tree = Scene.loads(scene.text()).to_dict()
        if "cue" not in self._tree:
            raise ValueError("scene: it has no [cue]; add one so that a ball can be struck")
        self.cue_ball = self.ids.index(self._tree["cue"].get("ball", "cue"))
        self._half = 0.5 * np.array([self.table.width, self.table.length])
        self._middle = np.array(self.table.corner) + self._half
        # The area in which a random layout places the centres of its balls.
        largest = self.radii.max()
        self._low = np.array(self.table.corner) + largest + _ROOM
        self._room = np.array([self.table.width, self.table.length]) - 2 * (largest + _ROOM)
        mouths = np.array([pocket[1:4] for pocket in self.table.pockets]).reshape(-1, 3)
        mouths[:, 2] += largest
        mouths[:, 2] *= mouths[:, 2]
        self._mouths = mouths.reshape(-1)
        self._apart2 = float((2 * largest + _ROOM) ** 2)

    # For subclasses to replace.

    def start(self, states: NDArray[np.uint64]) -> States:
        """New tables, one per generator, which advance. The default is random layouts."""
        xy = self.random_places(states, len(self.ids))
        return States(xy, self.no_extra(len(xy)))

    def legal(self, states: States) -> NDArray[np.bool_]:
        """Which balls may be hit first: (n, balls)."""
        legal = ~np.isnan(states.xy[:, :, 0])
        legal[:, self.cue_ball] = False
        return legal

    def judge(self, states: States, cue: NDArray[np.float64], shots: Shots) -> Judged:
        """The rewards of the shots that began with `states` and these strikes.

        Results for shots without an end are ignored.
        """
        raise NotImplementedError

    def play(
        self, states: States, cue: NDArray[np.float64], *, max_events: int | None, threads: int, hashes: bool
    ) -> tuple[Shots, Judged]:
        """Plays one strike on each table and judges it."""
        shots = simulate_many(
            self.scene, cue=cue, xy=states.xy, max_events=max_events, threads=threads, hashes=hashes)
        return shots, self.judge(states, cue, shots)

    def points(self, states: States) -> NDArray[np.float64]:
        """Places that an observation shows besides the balls [m]: (n, places, 2)."""
        return np.empty((len(states.xy), 0, 2))

    # Common to all games.

    def observe(self, states: States) -> NDArray[np.float32]:
        """x and y from -1 to 1 across the table, and 1; or three zeros for a ball not on the table.

        The shape is (n, balls + places, 3).
        """
        balls, marks = np.ascontiguousarray(states.xy), np.ascontiguousarray(self.points(states))
        out = np.empty((len(balls), balls.shape[1] + marks.shape[1], 3), np.float32)
        xy, marked = balls.reshape(-1), marks.reshape(-1)
        _carom.observe(len(balls), xy, marked, self._middle, self._half, out.reshape(-1))
        return out

    def scene_of(self, xy: NDArray[np.float64], cue: NDArray[np.float64] | None = None) -> Scene:
        """One table as a scene, with or without the strike. Raises SceneError if the balls cannot lie like
        this."""
        tree: dict[str, Any] = {key: part for key, part in self._tree.items() if key not in ("ball", "cue")}
        placed = zip(self._tree["ball"], xy.tolist())
        tree["ball"] = [ball | {"position": place} for ball, place in placed if place[0] == place[0]]
        if cue is not None:
            strike = dict(zip(("speed", "aim_deg", "elevation_deg"), cue.tolist()))
            tree["cue"] = self._tree["cue"] | strike | {"offset": cue[3:].tolist()}
        return Scene.from_dict(tree)

    def record(self, xy: NDArray[np.float64], cue: NDArray[np.float64]) -> Record:
        """The record of one shot. Raises SimulationError if it cannot continue."""
        return simulate(self.scene_of(xy, cue))

    def no_extra(self, n: int) -> NDArray[np.float64]:
        return np.zeros((n, len(self.EXTRA)))

    def scratch(self, shots: Shots) -> NDArray[np.object_]:
        """The fouls that every game has: the name, or ""."""
        foul = np.full(len(shots.status), "", object)
        foul[(shots.pocket == -2).any(1)] = "ball off the table"
        foul[shots.pocket[:, self.cue_ball] >= 0] = "scratch"
        return foul

    def random_places(self, states: NDArray[np.uint64], balls: int) -> NDArray[np.float64]:
        """Random places (n, balls, 2) with gaps between each other and to cushions and pockets.

        Uniform among all such layouts.
        """
        xy = np.empty((len(states), balls, 2))
        out = xy.reshape(-1)
        if not _carom.random_places(states, self._low, self._room, self._mouths, self._apart2, _TRIES, out):
            raise ValueError("no random layout fits this table: it is too small for its balls")
        return xy


def _placed(ids: Mapping[str, tuple[float, float]]) -> list[dict[str, Any]]:
    return [{"id": ball, "position": list(place)} for ball, place in ids.items()]


@checked
class Pot(Game):
    """One object ball and one shot, from a random layout.

    1 if the ball falls into any pocket, -1 for a foul (the cue ball in a pocket, a ball off the table), 0
    otherwise.
    """

    def __init__(self, *, table: str = "nine_foot", scene: SceneLike | None = None) -> None:
        places, cue = {"cue": (0.4, 0.5), "1": (0.5, 1.2)}, {"speed": 2.0, "aim_deg": 90.0}
        super().__init__(scene or Scene(table=table, ball=_placed(places), cue=cue))

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
    """Pot, with a target where the cue ball should come to rest.

    The reward of Pot, less the distance to the target in diagonals of the table; -1 for a foul.
    """

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
    """A game judged by `carom.games`. An episode is one turn of a player."""

    #: The game's name in `carom.games`.
    RULES = ""

    def __init__(self, scene: SceneLike) -> None:
        super().__init__(scene)
        self._fouls = np.array([*_carom.foul_names(), ""], object)

    def legal(self, states: States) -> NDArray[np.bool_]:
        out, xy = np.empty(states.xy.shape[:2], np.uint8), np.ascontiguousarray(states.xy).reshape(-1)
        _carom.legal_many(self.scene._native, self.RULES, xy, self._group(states), out.reshape(-1))
        return out.astype(bool)

    def judge(self, states: States, cue: NDArray[np.float64], shots: Shots) -> Judged:
        # The rules need more data than `shots` contains, so the shots are played again.
        return self._played(states, cue, None, 1, False)[1]

    def play(
        self, states: States, cue: NDArray[np.float64], *, max_events: int | None, threads: int, hashes: bool
    ) -> tuple[Shots, Judged]:
        if type(self).judge is not _Ruled.judge:  # a subclass has its own judge
            return super().play(states, cue, max_events=max_events, threads=threads, hashes=hashes)
        return self._played(states, cue, max_events, threads, hashes)

    def _played(
        self, states: States, cue: NDArray[np.float64], max_events: int | None, threads: int, hashes: bool
    ) -> tuple[Shots, Judged]:
        """Plays and judges in one pass."""
        n, columns, absent = _columns_of(self.scene, cue, states.xy)
        shots = Shots.empty(n, len(self.ids), hashes=hashes)
        xy, group = states.xy.copy(), self._group(states)
        foul, points, goes_on = np.full(n, -1, np.int32), np.zeros(n, np.int32), np.zeros(n, np.uint8)
        failures = _carom.judge_many(
            self.scene._native, self.RULES, n, columns, absent, max_events, threads, shots._native(),
            xy.reshape(-1), group, foul, points, goes_on)
        extra = states.extra.copy()
        if self.EXTRA:
            extra[:, 0] = group
        judged = self.worth(States(xy, extra), points, goes_on != 0, self._fouls[foul])
        return shots._replace(messages=dict(failures)), judged

    def worth(
        self, behind: States, points: NDArray[np.int32], goes_on: NDArray[np.bool_], foul: NDArray[np.object_]
    ) -> Judged:
        """The rewards: points until the turn ends."""
        return Judged(behind, points.astype(np.float64), ~goes_on, foul)

    def _group(self, states: States) -> NDArray[np.int32]:
        return states.extra[:, 0].astype(np.int32) if self.EXTRA else np.zeros(len(states.xy), np.int32)


@checked
class ThreeCushion(_Ruled):
    """Three-cushion from a random layout until you miss: 1 for each point. The cue ball is the white one."""

    RULES = "three_cushion"

    def __init__(self, *, table: str = "carom", scene: SceneLike | None = None) -> None:
        places = {"white": (0.5, 0.7), "yellow": (0.7, 0.7), "red": (0.7, 2.1)}
        cue = {"ball": "white", "speed": 4.0, "aim_deg": 0.0}
        super().__init__(scene or Scene(table=table, balls="carom", ball=_placed(places), cue=cue))


@checked
class SumToThree(_Ruled):
    """Two balls on a table without pockets, ten shots.

    1 for a shot that hits the other ball and in which the two balls together meet three cushions.
    """

    RULES = "sum_to_three"
    SHOTS = 10

    def __init__(self, *, table: str = "carom", scene: SceneLike | None = None) -> None:
        places = {"cue": (0.5, 0.7), "object": (0.7, 2.1)}
        cue = {"speed": 4.0, "aim_deg": 0.0}
        super().__init__(scene or Scene(table=table, balls="carom", ball=_placed(places), cue=cue))

    def worth(
        self, behind: States, points: NDArray[np.int32], goes_on: NDArray[np.bool_], foul: NDArray[np.object_]
    ) -> Judged:
        return Judged(behind, points.astype(np.float64), np.zeros(len(points), bool), foul)


def _pool(table: str, rack: str) -> Scene:
    cue = {"id": "cue", "position": [0.6, 0.5]}
    return Scene(table=table, rack=rack, ball=[cue], cue={"speed": 4.0, "aim_deg": 90.0})


@checked
class NineBallRun(_Ruled):
    """Nine-ball from a random layout of all balls, for as long as you stay at the table.

    1 for every ball pocketed in a fair shot. The episode ends with a miss, a foul, or the nine.
    """

    RULES = "nine_ball"

    def __init__(self, *, table: str = "nine_foot", scene: SceneLike | None = None) -> None:
        super().__init__(scene or _pool(table, "nine_ball"))


@checked
class EightBallRun(_Ruled):
    """Eight-ball from a random layout on an open table, for as long as you stay at the table.

    1 for every ball pocketed in a fair shot. Your first ball to fall counts as called, so luck helps. The
    episode ends with a miss, a foul, or the eight.
    """

    RULES = "eight_ball"
    EXTRA = ("group",)  # 0: the table is open, 1: solids, 2: stripes

    def __init__(self, *, table: str = "nine_foot", scene: SceneLike | None = None) -> None:
        super().__init__(scene or _pool(table, "eight_ball"))


def failed(shots: Shots) -> NDArray[np.bool_]:
    """The shots without an end: invalid, failed, or stopped by a limit: (n,)."""
    return np.asarray(shots.status != ShotStatus.AT_REST)
