"""Pictures as arrays."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Literal, get_args

import numpy as np

from carom import _carom
from carom._arguments import checked
from carom._names import CameraName, OverlayName
from carom._record import Record
from carom._scene import SceneLike
from carom._simulate import simulate

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


@checked
def render(
    shot: SceneLike | Record,
    *,
    camera: CameraName = "scene",
    size: tuple[int, int] | None = None,
    fps: float | None = None,
    times: ArrayLike | None = None,
    overlays: Sequence[OverlayName] = (),
    backend: Literal["auto", "egl", "osmesa"] = "auto",
) -> Iterator[NDArray[np.uint8]]:
    """Draws a shot without a display. Returns an iterator of frames.

    A frame is (height, width, 3), sRGB, with the top row first; it belongs to the caller.

    shot: a record, or a scene as for `simulate`, which is then simulated
    camera: "top", "rail", "player", "follow", or "scene" for the one in the scene's [render] section
    size: (width, height) in pixels; from [render] if it is left out
    fps: frames per second of the shot, from its start to its end; from [render] if it is left out
    times: the times [s] to draw instead of fps, in any order
    overlays: any of "trails", "events", "spin", "ghost" and "clock"
    backend: the drawing library; "auto" tries EGL first, then OSMesa

    Memory does not grow with the number of frames. The first frame takes longest because the table is drawn
    once. All frames are drawn by the thread that requests the first.

    Raises RuntimeError if no library can draw, with the packages to install. Raises ValueError for an unknown
    option or an invalid number.
    """
    record = shot if isinstance(shot, Record) else simulate(shot)
    width, height = record.picture_size if size is None else size
    most = _carom.MAX_IMAGE_SIZE
    if not (1 <= width <= most and 1 <= height <= most):
        raise ValueError(f"size={size}: expected 1 to {most} pixels on each side")
    rate = record.fps if fps is None else fps
    if not (0 < rate < np.inf):
        raise ValueError(f"fps={fps}: expected a number greater than 0")
    moments = None if times is None else np.asarray(times, np.float64).reshape(-1)
    if moments is not None and np.isnan(moments).any():
        raise ValueError("a time is not a number; leave NaN out")
    unknown = set(overlays) - set(get_args(OverlayName))
    if unknown:
        names = "trails, events, spin, ghost and clock"
        raise ValueError(f"overlays: expected a list of {names}, not {overlays!r}")
    if camera not in get_args(CameraName):
        raise ValueError(f"camera={camera!r}: expected scene, top, rail, player or follow")
    if backend not in ("auto", "egl", "osmesa"):
        raise ValueError(f"backend={backend!r}: expected auto, egl or osmesa")
    return _frames(record, camera, int(width), int(height), float(rate), moments, ",".join(overlays), backend)


def _frames(
    record: Record, camera: str, width: int, height: int, fps: float, times: NDArray[np.float64] | None,
    overlays: str, backend: str,
) -> Iterator[NDArray[np.uint8]]:
    drawing = _open(record, camera, width, height, backend, overlays)
    if times is None:
        count = _carom.frame_count(0.0, record.duration, fps)
        moments: Iterator[float] = (_carom.frame_time(0.0, k, fps) for k in range(count))
    else:
        moments = iter(times.tolist())
    for time in moments:
        frame = np.empty((height, width, 3), np.uint8)
        drawing.draw(time, frame.reshape(-1))
        yield frame


def _open(record: Record, camera: str, width: int, height: int, backend: str, overlays: str) -> _carom.Frames:
    problems = []
    # EGL first, unlike the program: OSMesa hangs or crashes if several threads draw.
    for name in ("egl", "osmesa") if backend == "auto" else (backend,):
        try:
            return _carom.Frames(record._native, camera, width, height, name, overlays)
        except RuntimeError as error:
            problems.append(str(error))
    raise RuntimeError("; ".join(problems))
