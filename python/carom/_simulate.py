"""One shot, and many."""

from __future__ import annotations

import enum
import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from carom import _carom
from carom._arguments import checked
from carom._record import Record
from carom._scene import Scene, SceneLike, as_scene

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

#: The columns of `simulate_many(cue=...)`.
_CUE_KEYS = ("cue.speed", "cue.aim_deg", "cue.elevation_deg", "cue.offset.side", "cue.offset.height")


def _limits(until: float | None, max_events: int | None) -> None:
    if until is not None and not (until >= 0 and math.isfinite(until)):
        raise ValueError(f"until={until}: expected a number of seconds of at least 0")
    if max_events is not None and max_events < 0:
        raise ValueError(f"max_events={max_events}: expected at least 0")


@checked
def simulate(scene: SceneLike, *, until: float | None = None, max_events: int | None = None, verify: bool = False) -> Record:
    """Plays one shot to rest, to a time [s] or to a number of events.

    scene: or the path of its file, or its tree as for `Scene.from_dict`
    verify: check the laws of mechanics after every event

    Raises SimulationError, with the record so far, for a run that cannot go on or breaks a law; never hangs. Raises SceneError
    where [effects] leaves out what the scene needs, and ValueError for a limit that is none.
    """
    _limits(until, max_events)
    return Record._of(_carom.simulate(as_scene(scene)._native, until, max_events, verify))


class SimulationError(RuntimeError):
    """A run that cannot go on, or one whose record breaks a law (`verify=True`). `str()` says why.

    record: what happened until then, or None where nothing was kept
    """

    record: Record | None

    def __init__(self, message: str, record: Record | None = None) -> None:
        super().__init__(message, record)
        self.record = record

    def __str__(self) -> str:
        return str(self.args[0])


def simulation_error(message: str, native: _carom.Record | None) -> SimulationError:
    """For the extension module."""
    return SimulationError(message, None if native is None else Record._of(native))


class ShotStatus(enum.IntEnum):
    """How a shot of a batch ended. From INVALID on it has no result."""

    AT_REST = 0
    TIME = 1
    EVENTS = 2
    ENDLESS = 3  # balls move for ever, and nothing more happens
    INVALID = 4  # its values make no valid scene
    FAILED = 5  # the simulation could not go on


@checked
class Shots(NamedTuple):
    """n shots of b balls, in the order of `scene.ids`. A shot without a result has its status, NaN as duration and places, 0 events,
    -1 and 0 elsewhere, and a message."""

    status: NDArray[np.uint8]  # (n,) ShotStatus
    duration: NDArray[np.float64]  # (n,) [s]
    events: NDArray[np.int64]  # (n,)
    first_hit: NDArray[np.int32]  # (n,) the ball that the struck ball met first, or -1
    contacts: NDArray[np.int32]  # (n,) how many balls it met, each counted once
    approach_cushions: NDArray[np.int32]  # (n,) how many cushions it met before the second of them, or at all
    xy: NDArray[np.float64]  # (n, b, 2) [m] at the end; of a pocketed ball the pocket, NaN for one that was left out
    pocket: NDArray[np.int32]  # (n, b) the pocket that holds the ball, -2 for one that has left the table, or -1
    fell: NDArray[np.int32]  # (n, b) 0 for the ball that fell first, 1, ..., or -1
    cushions: NDArray[np.int32]  # (n, b) how often the ball met a cushion or a jaw
    hash: NDArray[np.uint64] | None  # (n,) int(record.hash(), 16), where it was asked for
    messages: dict[int, str]  # shot: why it has no result

    @property
    def places(self) -> NDArray[np.float64]:
        """Where balls are that are still on the table: (n, b, 2) [m], NaN for the others; a copy, for `simulate_many(xy=...)`."""
        return np.where((self.pocket != -1)[:, :, None], np.nan, self.xy)

    def _native(self) -> _carom.ShotArrays:
        return _carom.ShotArrays(
            self.status,
            self.duration,
            self.events,
            self.first_hit,
            self.contacts,
            self.approach_cushions,
            self.xy.reshape(-1),
            self.pocket.reshape(-1),
            self.fell.reshape(-1),
            self.cushions.reshape(-1),
            np.empty(0, np.uint64) if self.hash is None else self.hash,
        )

    @classmethod
    def empty(cls, shots: int, balls: int, *, hashes: bool = False) -> Shots:
        """Arrays for `simulate_many(out=...)`."""
        n, b = shots, balls
        return cls(
            np.empty(n, np.uint8),
            np.empty(n),
            np.empty(n, np.int64),
            np.empty(n, np.int32),
            np.empty(n, np.int32),
            np.empty(n, np.int32),
            np.empty((n, b, 2)),
            np.empty((n, b), np.int32),
            np.empty((n, b), np.int32),
            np.empty((n, b), np.int32),
            np.empty(n, np.uint64) if hashes else None,
            {},
        )


class _Columns:
    """The values that differ from shot to shot; all lists have one length."""

    def __init__(self, shots: int | None) -> None:
        self.shots = shots
        self.columns: list[tuple[str, NDArray[np.float64]]] = []

    def count(self, name: str, n: int) -> None:
        if self.shots is None:
            self.shots = n
        if self.shots != n:
            raise ValueError(f"{name}: {n} values for {self.shots} shots; give one for each")

    def add(self, name: str, keys: list[str], values: NDArray[np.float64]) -> None:
        self.count(name, len(values))
        turned = np.ascontiguousarray(values.reshape(len(values), len(keys)).T)
        self.columns += zip(keys, turned)


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
    out: Shots | None = None,
) -> Shots:
    """Plays n shots that differ in numbers. Shot i has the bits of `simulate` for the scene with these numbers, whatever the number
    of threads; one that fails has its status and does not raise for the others.

    scene: as for `simulate`
    cue: (n, 5): speed [m/s], aim_deg, elevation_deg, side, height; the scene has to have a cue
    xy: (n, balls, 2) places at the start [m]; a ball with NaN twice is left out of its shot
    params: (n,) for each key, such as "balls.mu_s", "physics.gravity", "ball.cue.velocity.y", "cue.offset.side"
    shots: n, where nothing else says it
    until, max_events: limits of every shot, as for `simulate`
    threads: 0 takes one for each core that the process may use
    hashes: fill `Shots.hash`
    out: arrays of an earlier call, or of `Shots.empty`, that are filled and returned; no others are made

    Raises ValueError for a key that names no number, or arrays that do not fit. Ctrl-C ends the batch between two shots; what `out` then
    holds is not specified.
    """
    _limits(until, max_events)
    if threads < 0:
        raise ValueError(f"threads={threads}: expected at least 0")
    scene = as_scene(scene)
    ids = scene.ids
    n, columns, absent = _columns_of(scene, cue, xy, params, shots)
    into = Shots.empty(n, len(ids), hashes=hashes) if out is None else _checked(out, n, len(ids), hashes)
    failures = _carom.simulate_many(scene._native, n, columns, absent, until, max_events, threads, into._native())
    return into._replace(messages=dict(failures))


def _columns_of(
    scene: Scene, cue: ArrayLike | None, xy: ArrayLike | None, params: Mapping[str, ArrayLike] | None = None, shots: int | None = None
) -> tuple[int, list[tuple[str, NDArray[np.float64]]], NDArray[np.uint8]]:
    """How many shots, the values that differ from shot to shot, and which balls are left out: as the extension module takes them."""
    ids = scene.ids
    columns = _Columns(shots)
    absent = np.empty(0, np.uint8)
    if cue is not None:
        columns.add("cue", list(_CUE_KEYS), _array("cue", cue, (5,), "(n, 5)"))
    if xy is not None:
        keys = [f"ball.{ball}.position.{axis}" for ball in ids for axis in "xy"]
        places = _array("xy", xy, (len(ids), 2), f"(n, {len(ids)}, 2)")
        columns.add("xy", keys, places)
        gone = np.isnan(places).all(axis=2)
        if gone.any():
            absent = gone.astype(np.uint8).reshape(-1)
    for key, values in (params or {}).items():
        columns.add(key, [key], _array(key, values, (), "(n,)"))
    n = columns.shots
    if n is None:
        raise ValueError("there is nothing that says how many shots: give cue, xy, params or shots")
    if n < 0:
        raise ValueError(f"shots={n}: expected at least 0")
    return n, columns.columns, absent


def _checked(out: Shots, n: int, balls: int, hashes: bool) -> Shots:
    for name, wanted in Shots.empty(0, balls, hashes=hashes)._asdict().items():
        if name == "messages":
            continue
        given = getattr(out, name)
        if wanted is None:
            out = out._replace(hash=None)
            continue
        shape = (n, *wanted.shape[1:])
        if (
            given is None
            or given.shape != shape
            or given.dtype != wanted.dtype
            or not given.flags.c_contiguous
            or not given.flags.writeable
        ):
            raise ValueError(f"out.{name}: expected a writable contiguous array of {wanted.dtype} with the shape {shape}")
    return out
