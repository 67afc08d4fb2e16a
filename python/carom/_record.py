"""Records."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np

from carom import _carom
from carom._arguments import checked
from carom._errors import check_exists
from carom._names import GameName
from carom._scene import Scene, SceneLike, as_scene, scene_with_cue

if TYPE_CHECKING:
    from typing import Self

    import pandas
    from numpy.typing import ArrayLike, NDArray


def _dtype(members: list[tuple[str, str, int]], size: int) -> np.dtype[np.void]:
    names, formats, offsets = zip(*members)
    return np.dtype({"names": names, "formats": formats, "offsets": offsets, "itemsize": size})


_EVENT = _dtype(_carom.event_members(), _carom.EVENT_SIZE)
_SEGMENT = _dtype(_carom.segment_members(), _carom.SEGMENT_SIZE)
_DETAILS = np.dtype([(name, np.float64) for name, _, _ in _carom.event_columns()])
_NO_NUMBERS = np.empty(0)
_NO_KINDS = np.empty(0, np.uint8)


class Event(NamedTuple):
    """One event with names: its time [s], its type, the ball, and its partner ("" for none)."""

    time: float
    type: str
    a: str
    b: str


class Hit(NamedTuple):
    """A contact that pushed: the time [s] of its first touch, the ball, its partner ("": the cloth), and the
    impulse along the normal [N s], 0 unless it belongs to a cluster."""

    time: float
    a: str
    b: str
    impulse: float


class EventColumn(NamedTuple):
    """A column of `Record.event_details`: its name, its unit or "", and its meaning ("": as before)."""

    name: str
    unit: str
    what: str


def event_columns() -> list[EventColumn]:
    """The columns of `Record.event_details`, as in `carom describe events`."""
    return [EventColumn(*row) for row in _carom.event_columns()]


class TablePlan(NamedTuple):
    """The table as seen from above, for drawing; lengths in m."""

    preset: str
    corner: tuple[float, float]  # the smallest x and y
    width: float  # along x, between the nose lines
    length: float  # along y
    cushions: list[tuple[str, float, float, float, float]]  # id, x and y of one end, x and y of the other
    jaws: list[tuple[str, float, float, float]]  # id, x and y of the centre, radius
    pockets: list[tuple[str, float, float, float]]


@checked
class Record:
    """A simulated shot: motion segments in closed form, and events. Immutable.

    Arrays described as views share the record's memory, are read-only, and keep it alive. Balls are in the
    order of `ids`. A pickled record contains the data that `save` writes, and its scene. Records with equal
    data are equal.
    """

    __slots__ = ("_native", "__weakref__")
    _native: _carom.Record

    #: The names of `events["type"]`, by number.
    EVENT_TYPES: tuple[str, ...] = tuple(_carom.event_names())
    #: The names of `segments[i]["state"]` and of `motion()`, by number.
    MOTIONS: tuple[str, ...] = tuple(_carom.motion_names())

    def __init__(self) -> None:
        raise TypeError("a Record comes from carom.simulate or Record.load")

    @classmethod
    def _of(cls, native: _carom.Record) -> Self:
        record = cls.__new__(cls)
        record._native = native
        return record

    @property
    def duration(self) -> float:
        """How long the shot lasted [s]."""
        return self._native.duration

    @property
    def stopped(self) -> str:
        """Why it ended: "at_rest", "time", "events", or "endless" (balls move for ever, and nothing more
        happens)."""
        return self._native.stopped

    @property
    def ids(self) -> tuple[str, ...]:
        """The balls, in the order of every array's ball axis."""
        return tuple(self._native.ids)

    @property
    def radii(self) -> NDArray[np.float64]:
        """Radius of every ball [m]: (balls,)."""
        return np.array([self._native.radius(i) for i in range(self._native.balls)])

    @property
    def masses(self) -> NDArray[np.float64]:
        """Mass of every ball [kg]: (balls,)."""
        return np.array([self._native.mass(i) for i in range(self._native.balls)])

    @property
    def colors(self) -> NDArray[np.float64]:
        """The colour of every ball in pictures, sRGB from 0 to 1: (balls, 3)."""
        return np.array([self._native.color(i) for i in range(self._native.balls)])

    @property
    def table(self) -> TablePlan:
        """The table, for drawing."""
        return TablePlan(**self._native.table)

    @property
    def fps(self) -> float:
        """Frames per second from the scene's [render] section."""
        return self._native.fps

    @property
    def picture_size(self) -> tuple[int, int]:
        """Width and height from the scene's [render] section [pixels]."""
        return self._native.picture_size

    @property
    def events(self) -> NDArray[np.void]:
        """The events in order, as a structured view without a copy; `events["time"]` is one column.

        time [s]; type (`EVENT_TYPES`); a, a ball; b, the other ball or the number of the cushion, jaw or
        pocket, -1 for none; detail; slow, true for a slow contact in the air.
        """
        return _carom.events_of(self._native).view(_EVENT)

    @property
    def event_details(self) -> NDArray[np.void]:
        """Details of every event beyond `events`: a new structured array with one row per event.

        The columns are those of `carom simulate --events`, and `carom.event_columns()` lists them: position,
        velocity and spin of both balls before and after [m, m/s, rad/s], the point of contact and the normal,
        cut_deg, closing [m/s], impulse [N s], lost [J], diamond. NaN if an event has no such number.
        """
        details = np.empty((len(self.events), len(_DETAILS.names or ())))
        _carom.event_details(self._native, details.reshape(-1))
        return details.view(_DETAILS).reshape(-1)

    @property
    def met(self) -> list[str]:
        """The partner of ball a in every event, by the name that people use: "left rail, head half", "corner
        pocket, foot left", the id of a ball, "" for nothing."""
        return _carom.met_names(self._native)

    def measure(
        self, measure: str, *, game: GameName | None = None, scene: SceneLike | None = None
    ) -> float | bool | list[str]:
        """The value of a measure or expression (`carom.measures()`): `record.measure("travel(cue)")`.

        game: the rules for measures such as "foul" without an argument
        scene: the scene that was played; needed if the record was loaded from a file

        Returns a number (NaN if there is none), True or False, or a list of texts. Raises ValueError for an
        expression that cannot be read, or a shot that the game cannot judge.
        """
        played = None if scene is None else as_scene(scene)._native
        value, truth = _carom.measured(self._native, played, measure, game)
        return bool(value) if truth and value == value else value

    def event_list(self) -> list[Event]:
        """The events with names instead of numbers."""
        return [Event(*event) for event in self._native.event_list()]

    def hit_list(self) -> list[Hit]:
        """Who pushed whom, in order of the events: the pair of an impact, and every contact of a cluster."""
        return [Hit(*hit) for hit in self._native.hit_list()]

    @property
    def segments(self) -> tuple[NDArray[np.void], ...]:
        """The motion segments of every ball in order, as structured views without a copy.

        start [s]; r [m], v [m/s] and w [rad/s] at the start; a [m/s^2] and dw [rad/s^2], the constant x and y
        components; spin_decay [rad/s^2]; duration [s] until the ball's own transition; state (`MOTIONS`);
        held, in a resting contact; ends, whether the transition comes. If several segments have the same
        start, the last one counts. For a falling ball, r_z is the height where the fall began, and v_z its
        falling speed.
        """
        return tuple(_carom.segments_of(self._native, i).view(_SEGMENT) for i in range(self._native.balls))

    @property
    def clusters(self) -> list[list[int]]:
        """The balls of every "ball_cluster" event; `events["detail"]` is the index into this list."""
        return self._native.clusters

    def states(self, t: ArrayLike, *, out: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
        """Position [m], velocity [m/s] and spin [rad/s] of every ball, exact at any time.

        t: times [s] of any shape; earlier than 0 gives the start, later than the end gives the end
        out: a contiguous array to fill, instead of a new one

        Returns t.shape + (balls, 3, 3). Raises ValueError if a time is NaN or `out` has another shape.
        """
        times, shape = self._times(t)
        states = _output(out, (*shape, self._native.balls, 3, 3))
        self._native.states(times, states.reshape(-1), _NO_KINDS)
        return states

    def motion(self, t: ArrayLike) -> NDArray[np.uint8]:
        """How every ball moves, as an index into `MOTIONS`: t.shape + (balls,). Raises ValueError if a time
        is NaN."""
        times, shape = self._times(t)
        kinds = np.empty((*shape, self._native.balls), np.uint8)
        self._native.states(times, _NO_NUMBERS, kinds.reshape(-1))
        return kinds

    def orientations(self, t: ArrayLike) -> NDArray[np.float64]:
        """How every ball has turned since the start: t.shape + (balls, 4).

        Quaternions x, y, z, w from the ball's frame to the table's. Raises ValueError if a time is NaN.
        """
        times, shape = self._times(t)
        turned = np.empty((*shape, self._native.balls, 4))
        self._native.orientations(times, turned.reshape(-1))
        return turned

    def jacobian(
        self, inputs: Sequence[str], t: ArrayLike | None = None, *, scene: SceneLike | None = None
    ) -> NDArray[np.float64]:
        """How the states of the balls depend on numbers of the scene, by differences of whole shots.

        inputs: keys as in a sweep: "cue.speed", "ball.1.position.x", "balls.mu_s"
        t: times [s] of any shape; None for the end, at rest
        scene: the scene that was played; needed if the record was loaded from a file, which holds no physics

        Returns t.shape + (balls, 3, 3, inputs): position, velocity and spin as in `states`, by each input in
        its own unit, for the shot with a tolerance of 1e-12. A ball that is out of play has zeros.

        Raises ValueError for an input that is not a number of the scene, and for one whose derivatives may be
        wrong by more than 1e-3 of the largest, because an event begins or ends there.
        """
        times, shape = self._times(self.duration if t is None else t)
        slopes = np.empty((*shape, self._native.balls, 3, 3, len(inputs)))
        played = None if scene is None else as_scene(scene)._native
        _carom.jacobian(self._native, played, list(inputs), times, slopes.reshape(-1))
        return slopes

    def final_scene(self, *, scene: SceneLike | None = None, cue: Any = None) -> Scene:
        """The scene for the next shot: the balls as they are at the end, without those in pockets.

        scene: the scene that was played; needed if the record was loaded from a file, which holds no physics
        cue: the next strike, as for Scene; None for none

        Raises ValueError if the scene is missing, and SceneError if no valid scene results: no ball is left,
        or the struck ball is gone or still moves.
        """
        played = None if scene is None else as_scene(scene)._native
        return scene_with_cue(cue, lambda section: self._native.scene_after(played, section))

    def to_pandas(self, what: Literal["events", "segments"] = "events") -> pandas.DataFrame:
        """The events, or the motion segments of all balls, as a DataFrame; a copy. Needs pandas (extra
        [notebook]).

        "events": time [s], type, a and b (ids; "" for nothing), detail, slow, met, and the columns of
            `event_details`
        "segments": ball and the columns of `segments`, with vectors split: rx, ry, rz, vx, ..., ax, ay, dwx,
            dwy

        Raises ValueError for any other `what`.
        """
        if what not in ("events", "segments"):
            raise ValueError(f"what={what!r}: expected events or segments")
        try:
            import pandas
        except ImportError as error:
            raise ImportError("to_pandas needs pandas: pip install pandas") from error

        def named(numbers: NDArray[Any], names: tuple[str, ...]) -> pandas.Categorical:
            return pandas.Categorical.from_codes(numbers.astype(np.int16), list(names))

        if what == "events":
            view, listed = self.events, self.event_list()
            columns: dict[str, Any] = {"time": view["time"], "type": named(view["type"], self.EVENT_TYPES)}
            columns |= {"a": [event.a for event in listed], "b": [event.b for event in listed]}
            columns |= {name: view[name] for name in ("detail", "slow")} | {"met": self.met}
            details = self.event_details
            return pandas.DataFrame(columns | {name: details[name] for name in details.dtype.names or ()})
        segments = np.concatenate(self.segments)
        balls = np.array(self.ids, dtype=object)
        columns = {"ball": np.repeat(balls, [len(of_ball) for of_ball in self.segments])}
        for name in _SEGMENT.names or ():
            values = segments[name]
            if name == "state":
                columns[name] = named(values, self.MOTIONS)
            elif values.ndim == 1:
                columns[name] = values
            else:
                columns |= zip((name + axis for axis in "xyz"), values.T)
        return pandas.DataFrame(columns)

    def page(self, second: Record | None = None) -> str:
        """The page of `carom view` as self-contained HTML: it plays the shot with events, trails and charts.

        second: another record, played over the first or beside it
        """
        return self._native.page(None if second is None else second._native)

    def hash(self) -> str:
        """A 64-bit hash over all bits of segments and events, as 16 hexadecimal digits: equal on every
        machine."""
        return self._native.hash()

    def verify(self, scene: SceneLike | None = None) -> str | None:
        """Checks the laws of mechanics, as `carom simulate --verify` does: None, or the first law that is
        broken, with the event and a residual.

        scene: of the record; a record from `simulate` knows its own, one from a file needs it

        Raises SceneError if the record is of another scene, and names the first difference.
        """
        return self._native.verify(None if scene is None else as_scene(scene)._native)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the record as JSON, as `carom simulate -o` does; the file appears complete or not at all.

        Raises ValueError if the name does not end in .json, and OSError if the file cannot be written.
        """
        name = os.fspath(path)
        if not name.endswith(".json"):
            raise ValueError(f"{name}: a record is saved as .json; use a name that ends in .json")
        try:
            self._native.save(name)
        except RuntimeError as error:
            raise OSError(str(error)) from None

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Self:
        """Loads a record that `save` or `carom simulate -o` wrote. Raises SceneError if the file is not one;
        it is a FileNotFoundError, too, if there is no such file."""
        name = os.fspath(path)
        check_exists(name)
        return cls._of(_carom.load_record(name))

    def __eq__(self, other: object) -> bool:
        """Whether all data that `save` writes are equal."""
        if not isinstance(other, Record):
            return NotImplemented
        return self.hash() == other.hash() and self._native.text() == other._native.text()

    def __hash__(self) -> int:
        return hash(self.hash())

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (self._native.text(), self._scene())

    def _scene(self) -> Scene | None:
        """The scene that was played; None for a record from a file."""
        return None if self._native.scene is None else Scene._of(self._native.scene)

    def __repr__(self) -> str:
        counts = f"{self._native.balls} balls ({_some(self.ids)}), {len(self.events)} events"
        return f"<carom.Record: {counts}, {self.duration:.3f} s, {self.stopped}>"

    @staticmethod
    def _times(t: ArrayLike) -> tuple[NDArray[np.float64], tuple[int, ...]]:
        times = np.asarray(t, np.float64)
        if np.isnan(times).any():
            raise ValueError("a time is not a number; leave NaN out")
        return np.ascontiguousarray(times).reshape(-1), times.shape


def _some(ids: tuple[str, ...]) -> str:
    return ", ".join(ids[:4]) + (", ..." if len(ids) > 4 else "")


def _again(text: str, scene: Scene | None) -> Record:
    """Restores a pickled record."""
    return Record._of(_carom.parse_record(text, None if scene is None else scene._native))


def _output(out: NDArray[np.float64] | None, shape: tuple[int, ...]) -> NDArray[np.float64]:
    if out is None:
        return np.empty(shape)
    check_output("out", out, shape, np.dtype(np.float64))
    return out


def check_output(name: str, out: Any, shape: tuple[int, ...], dtype: np.dtype[Any]) -> None:
    """Raises ValueError unless a caller's array can be filled."""
    fits = isinstance(out, np.ndarray) and out.shape == shape and out.dtype == dtype
    if not fits or not out.flags.c_contiguous or not out.flags.writeable:
        raise ValueError(f"{name}: expected a writable contiguous array of {dtype} with the shape {shape}")
