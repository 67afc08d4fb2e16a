"""One shot, and batches of shots."""

from __future__ import annotations

import enum
import importlib
import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from carom import _carom
from carom._arguments import checked
from carom._record import Record, check_output
from carom._scene import Scene, SceneLike, as_scene

if TYPE_CHECKING:
    import pandas
    import polars
    import pyarrow
    from numpy.typing import ArrayLike, NDArray

#: The columns of `simulate_many(cue=...)`.
_CUE_KEYS = ("cue.speed", "cue.aim_deg", "cue.elevation_deg", "cue.offset.side", "cue.offset.height")


def _limits(until: float | None, max_events: int | None) -> None:
    if until is not None and not (until >= 0 and math.isfinite(until)):
        raise ValueError(f"until={until}: expected a time in seconds of at least 0")
    if max_events is not None and max_events < 0:
        raise ValueError(f"max_events={max_events}: expected at least 0")


@checked
def simulate(
    scene: SceneLike, *, until: float | None = None, max_events: int | None = None, verify: bool = False
) -> Record:
    """Plays one shot to rest, to a time [s], or for a number of events.

    scene: a Scene, the path of its file, or its tree as for `Scene.from_dict`
    verify: check the laws of mechanics after every event

    Raises SimulationError, with the record so far, if the run cannot continue or breaks a law; it never
    hangs. Raises SceneError if [effects] switches off something the scene needs, and ValueError for an
    invalid limit.
    """
    _limits(until, max_events)
    return Record._of(_carom.simulate(as_scene(scene)._native, until, max_events, verify))


class SimulationError(RuntimeError):
    """A run that cannot continue, or one whose record breaks a law (`verify=True`). `str()` says why.

    record: the shot until then, or None if nothing was kept
    """

    record: Record | None

    def __init__(self, message: str, record: Record | None = None) -> None:
        super().__init__(message, record)
        self.record = record

    def __str__(self) -> str:
        return str(self.args[0])


def simulation_error(message: str, native: _carom.Record | None) -> SimulationError:
    """Called by the extension module."""
    return SimulationError(message, None if native is None else Record._of(native))


class ShotStatus(enum.IntEnum):
    """How a shot of a batch ended. From INVALID on, it has no result."""

    AT_REST = 0
    TIME = 1
    EVENTS = 2
    ENDLESS = 3  # balls move for ever, and nothing more happens
    INVALID = 4  # its values do not make a valid scene
    FAILED = 5  # the simulation could not continue


#: The names of a shot's status, by number.
_STATUS = tuple(_carom.status_names())
#: Of outcomes: name, type, numbers of each ball (0: one of the shot), unit, whether it is on request.
_COLUMNS = _carom.outcome_columns()


@checked
class Shots(NamedTuple):
    """n shots of b balls, in the order of `scene.ids`.

    A shot without a result has its status and a message. Its duration and positions are NaN, and everything
    else is -1 or 0.
    """

    # begin outcomes
    #: (n) index of the status at the end
    status: NDArray[np.uint8]
    #: (n) [s] until its end
    duration: NDArray[np.float64]
    #: (n) in its record
    events: NDArray[np.int64]
    #: (n) index of the ball that the struck ball hits first, or -1
    first_hit: NDArray[np.int32]
    #: (n) balls that it hits
    contacts: NDArray[np.int32]
    #: (n) cushions that it hits before its second ball, or in all; one that it touches at the start counts
    #: after it has left it
    approach_cushions: NDArray[np.int32]
    #: (n, b, 2) [m] at the end; of a pocketed ball, its pocket; NaN if it was left out
    xy: NDArray[np.float64]
    #: (n, b) index of the pocket that holds it; -1: none; -2: it has left the table
    pocket: NDArray[np.int32]
    #: (n, b) 0 for the first ball that falls, 1 for the next, ..., or -1
    fell: NDArray[np.int32]
    #: (n, b) how often it hits a cushion or a jaw
    cushions: NDArray[np.int32]
    #: (n) of the record, on request
    hash: NDArray[np.uint64] | None
    # end outcomes

    messages: dict[int, str]  # by shot: why it has no result
    ids: tuple[str, ...] = ()  # the balls
    paths: NDArray[np.float64] | None = None  # (n, times, b, 3) [m], if times were given
    pockets: tuple[str, ...] = ()  # the pockets

    @property
    def places(self) -> NDArray[np.float64]:
        """Positions [m] of the balls still on the table, NaN for the others: (n, b, 2).

        A copy, suitable for `simulate_many(xy=...)`.
        """
        return np.where((self.pocket != -1)[:, :, None], np.nan, self.xy)

    def to_arrow(self) -> pyarrow.Table:
        """The shots as a pyarrow Table with one row per shot; a copy. Needs pyarrow (extra [sweep]).

        The columns are the arrays, for every ball ID.x, ID.y, ID.pocket, ..., with names and ids (null for no
        ball, "out" for a ball off the table, "" for no pocket) instead of numbers, and message ("" for a shot
        with a result). `paths` is left out.
        """
        return _optional("pyarrow").table(self._columns())

    def to_pandas(self) -> pandas.DataFrame:
        """The columns of `to_arrow` as a DataFrame. Needs pandas (extra [notebook])."""
        return _optional("pandas").DataFrame(self._columns())

    def to_polars(self) -> polars.DataFrame:
        """The columns of `to_arrow` as a polars DataFrame. Needs polars."""
        return _optional("polars").DataFrame(self._columns())

    def _columns(self) -> dict[str, Any]:
        n, balls = self.pocket.shape
        ids = self.ids or tuple(map(str, range(balls)))
        pockets = self.pockets or tuple(map(str, range(self.pocket.max(initial=-1) + 1)))
        # The index -1 is the last one.
        names = {"status": _STATUS, "ball": (*ids, None), "pocket": (*pockets, "out", "")}

        def column(values: NDArray[Any], unit: str) -> Any:
            return [names[unit][i] for i in values.tolist()] if unit in names else values.copy()

        columns = {name: column(getattr(self, name), unit) for name, _, each, unit, _ in _COLUMNS
                   if each == 0 and getattr(self, name) is not None}
        for ball, id in enumerate(ids):
            for name, _, each, unit, _ in _COLUMNS:
                for k, part in enumerate(name if each > 1 else [name] * each):  # "x" and "y" of "xy"
                    values = getattr(self, name).reshape(n, balls, each)[:, ball, k]
                    columns[f"{id}.{part}"] = column(values, unit)
        return columns | {"message": [self.messages.get(shot, "") for shot in range(n)]}

    def __repr__(self) -> str:
        n, balls = self.pocket.shape
        counts = zip(_STATUS, np.bincount(self.status, minlength=len(_STATUS)).tolist())
        ended = ", ".join(f"{count} {name}" for name, count in counts if count > 0)
        units = {name: f" [{unit}]" for name, _, _, unit, _ in _COLUMNS if unit in ("s", "m")}
        units["paths"] = " [m]"
        shapes: dict[tuple[int, ...], list[str]] = {}
        for name, array in self._asdict().items():
            if isinstance(array, np.ndarray):
                shapes.setdefault(array.shape, []).append(name + units.get(name, ""))
        arrays = ",\n".join(f" {', '.join(names)} {shape}" for shape, names in shapes.items())
        return f"<carom.Shots: {n} shots of {balls} balls: {ended or 'none'};\n{arrays}>"

    def _native(self) -> list[NDArray[Any] | None]:
        """The arrays as the extension module accepts them."""
        return [getattr(self, row[0]) for row in _COLUMNS]

    @classmethod
    def empty(cls, shots: int, balls: int, *, hashes: bool = False, times: int | None = None) -> Shots:
        """Arrays for `simulate_many(out=...)`; `times` is the number of its times."""
        arrays: dict[str, Any] = {
            name: np.empty((shots, balls, each)[: 1 + each], type) if hashes or not on_request else None
            for name, type, each, _, on_request in _COLUMNS}
        return cls(**arrays, messages={}, paths=None if times is None else np.empty((shots, times, balls, 3)))


def _array(name: str, values: ArrayLike, shape: tuple[int, ...], words: str) -> NDArray[np.float64]:
    array = np.asarray(values, np.float64)
    if array.ndim != len(shape) + 1 or array.shape[1:] != shape:
        raise ValueError(f"{name}: expected the shape {words}, not {array.shape}")
    return array


@checked
def simulate_many(
    scene: SceneLike,
    *,
    cue: ArrayLike | None = None,
    xy: ArrayLike | None = None,
    params: Mapping[str, ArrayLike] | None = None,
    shots: int | None = None,
    until: float | None = None,
    max_events: int | None = None,
    threads: int = 1,
    hashes: bool = False,
    times: ArrayLike | None = None,
    out: Shots | None = None,
) -> Shots:
    """Plays n shots that differ in numbers.

    Shot i has the same bits as `simulate` for the scene with these numbers, whatever the number of threads. A
    shot that fails gets a status and a message; the others are still played.

    scene: as for `simulate`
    cue: (n, 5): speed [m/s], aim_deg, elevation_deg, side, height; the scene must have a cue
    xy: (n, balls, 2) starting positions [m]; a ball with two NaN is left out of its shot
    params: (n,) for each key, such as "balls.mu_s", "physics.gravity", "ball.cue.velocity.y",
        "cue.offset.side"
    shots: n, if nothing else gives it
    until, max_events: limits of every shot, as for `simulate`
    threads: 0 uses every core available to the process
    hashes: fill `Shots.hash`
    times: (t,) times [s]: fill `Shots.paths`, the positions of all balls at these times; earlier than 0 gives
        the start, later than the end gives the end, and a shot without a result has NaN
    out: arrays from an earlier call or from `Shots.empty`, to fill and return instead of new ones

    Raises ValueError if a key does not name a number or an array does not fit. Ctrl-C ends the batch between
    two shots; the contents of `out` are then unspecified.
    """
    _limits(until, max_events)
    if threads < 0:
        raise ValueError(f"threads={threads}: expected at least 0")
    scene = as_scene(scene)
    ids = scene.ids
    n, columns, absent = _columns_of(scene, cue, xy, params, shots)
    moments = np.empty(0) if times is None else np.ascontiguousarray(_array("times", times, (), "(t,)"))
    if np.isnan(moments).any():
        raise ValueError("times: a time is not a number; leave NaN out")
    number = None if times is None else len(moments)
    wanted = Shots.empty(0, len(ids), hashes=hashes, times=number)
    into = _checked(out, wanted, n, hashes) if out else Shots.empty(n, len(ids), hashes=hashes, times=number)
    paths = np.empty(0) if into.paths is None else into.paths
    paths.fill(np.nan)
    failures = _carom.simulate_many(scene._native, n, columns, absent, until, max_events, threads,
                                    into._native(), moments, paths.reshape(-1))
    return into._replace(messages=dict(failures), ids=ids, pockets=tuple(scene._native.pockets))


def _columns_of(
    scene: Scene, cue: ArrayLike | None, xy: ArrayLike | None,
    params: Mapping[str, ArrayLike] | None = None, shots: int | None = None,
) -> tuple[int, list[tuple[str, NDArray[np.float64]]], NDArray[np.uint8]]:
    """For the extension module: the number of shots, the values that differ between them, and the absent
    balls."""
    ids = scene.ids
    absent = np.empty(0, np.uint8)
    given = [] if cue is None else [("cue", [*_CUE_KEYS], _array("cue", cue, (5,), "(n, 5)"))]
    if xy is not None:
        places = _array("xy", xy, (len(ids), 2), f"(n, {len(ids)}, 2)")
        given.append(("xy", [f"ball.{ball}.position.{axis}" for ball in ids for axis in "xy"], places))
        gone = np.isnan(places).all(axis=2)
        if gone.any():
            absent = gone.astype(np.uint8).reshape(-1)
    given += [(key, [key], _array(key, values, (), "(n,)")) for key, values in (params or {}).items()]
    n = next((len(values) for _, _, values in given), None) if shots is None else shots
    if n is None:
        raise ValueError("the number of shots is unknown: give cue, xy, params or shots")
    if n < 0:
        raise ValueError(f"shots={n}: expected at least 0")
    if n > 2**31:
        raise ValueError(f"shots = {n} is out of range; it must be at most {2**31}")
    columns: list[tuple[str, NDArray[np.float64]]] = []
    for name, keys, values in given:
        if len(values) != n:
            raise ValueError(f"{name}: {len(values)} values for {n} shots; give one for each")
        columns += zip(keys, np.ascontiguousarray(values.reshape(n, len(keys)).T))
    return n, columns, absent


def _checked(out: Shots, like: Shots, n: int, hashes: bool) -> Shots:
    for name, wanted in like._asdict().items():
        if isinstance(wanted, np.ndarray):
            check_output(f"out.{name}", getattr(out, name), (n, *wanted.shape[1:]), wanted.dtype)
    return out._replace(hash=out.hash if hashes else None, paths=None if like.paths is None else out.paths)


def _optional(module: str) -> Any:
    """A package that need not be installed. Raises ImportError with the way to install it."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        raise ImportError(f"{module} is missing ({error}): pip install {module}", name=module) from None
