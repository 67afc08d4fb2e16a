"""Pictures of records with matplotlib (extra [plot]).

Every function draws into `ax`, or into new pyplot axes, and returns the axes. The first call imports
matplotlib.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from carom._arguments import checked
from carom._record import Record

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

__all__ = ["energy", "speeds", "table"]

_CLOTH = "#86b39c"
_RAIL = "#6b4a2f"
_HOLE = "#26221f"
#: Points of a trail in one motion segment: enough for a smooth parabola.
_POINTS = 13


@checked
def table(record: Record, *, at: float | None = None, trails: bool = True, ax: Axes | None = None) -> Axes:
    """The table from above, as the camera "top" sees it: y to the right, x downwards, both in m.

    at: the time [s] to show, with the trails until then; None for the whole shot, with rings at the start
    trails: draw the paths of the centres in the colours of the balls, dotted while a ball is in the air

    Pocketed balls have a trail but no disc. Raises ValueError if the time is NaN.
    """
    axes: Axes = _axes(ax, (9.0, 5.0))
    end = record.duration if at is None else min(float(at), record.duration)
    states = record.states(end)
    _outline(record, axes, end)
    motions = record.motion(end)
    for ball, color in enumerate(record.colors):
        path = _path(record, ball, end) if trails else []
        if path:
            _trail(axes, path, color)
        if at is None and path:
            _disc(axes, record.states(0.0)[ball, 0], record.radii[ball], "none", color)
        if record.MOTIONS[motions[ball]] not in ("pocketed", "out"):
            _disc(axes, states[ball, 0], record.radii[ball], color, "black")
            _name(axes, record.ids[ball], states[ball, 0], record.radii[ball], color)
    axes.set_aspect("equal")
    axes.set_xlabel("y [m]")
    axes.set_ylabel("x [m]")
    return axes


@checked
def speeds(record: Record, *, ax: Axes | None = None) -> Axes:
    """Speed [m/s] of every moving ball over time [s]."""
    axes: Axes = _axes(ax, (9.0, 4.0))
    times = _times(record)
    speed = np.linalg.norm(record.states(times)[:, :, 1], axis=-1)
    for ball in np.flatnonzero(speed.max(axis=0) > 0):
        color = tuple(record.colors[ball])
        axes.plot(times, speed[:, ball], color=color, label=record.ids[ball], path_effects=_edge())
    _over_time(axes, "speed [m/s]")
    return axes


@checked
def energy(record: Record, *, ax: Axes | None = None) -> Axes:
    """Kinetic energy [J] of all balls over time [s].

    Translation, m v^2 / 2, and stacked on it rotation, m R^2 w^2 / 5.
    """
    axes: Axes = _axes(ax, (9.0, 4.0))
    times = _times(record)
    states = record.states(times)
    energies = (weight * np.sum(states[:, :, row] ** 2, axis=-1) for row, weight in _weights(record))
    travel, rotation = (np.sum(of_balls, axis=-1) for of_balls in energies)
    axes.fill_between(times, 0, travel, label="travel", color="#3b6ea5", linewidth=0)
    axes.fill_between(times, travel, travel + rotation, label="rotation", color="#e0a030", linewidth=0)
    _over_time(axes, "kinetic energy [J]")
    return axes


def _weights(record: Record) -> list[tuple[int, NDArray[np.float64]]]:
    """Which row of a state to square, and its factor: m / 2 for the velocity, I / 2 = m R^2 / 5 for the
    spin."""
    return [(1, record.masses / 2), (2, record.masses * record.radii**2 / 5)]


def _axes(ax: Axes | None, size: tuple[float, float]) -> Any:
    if ax is not None:
        return ax
    try:
        from matplotlib import pyplot
    except ImportError as error:
        raise ImportError("carom.plot needs matplotlib: pip install matplotlib") from error
    return pyplot.subplots(figsize=size, layout="constrained")[1]


def _plan(place: NDArray[np.float64]) -> tuple[float, float]:
    return float(place[1]), float(place[0])


def _edge() -> list[Any]:
    """A thin dark edge along a line, so that white and yellow lines show on white paper."""
    from matplotlib import patheffects

    return [patheffects.withStroke(linewidth=2.4, foreground="#444444")]


def _disc(axes: Any, place: NDArray[np.float64], radius: float, face: Any, edge: Any) -> None:
    from matplotlib.patches import Circle

    axes.add_patch(Circle(_plan(place), radius, facecolor=face, edgecolor=edge, linewidth=0.8, zorder=5))


def _name(
    axes: Any, name: str, place: NDArray[np.float64], radius: float, color: NDArray[np.float64]
) -> None:
    """A ball's id on its disc, or beside the disc if the id is too long."""
    y, x = _plan(place)
    short = len(name) <= 3
    ink = "white" if short and color @ (0.299, 0.587, 0.114) < 0.5 else "black"
    left, align = (y, "center") if short else (y + 1.3 * radius, "left")
    axes.text(left, x, name, ha=align, va="center", fontsize=6, color=ink, zorder=6, clip_on=True)


def _outline(record: Record, axes: Any, end: float) -> None:
    """Draws cloth, noses, jaws and pockets, and fits the axes to them, or to the balls on an endless
    cloth."""
    from matplotlib.collections import LineCollection
    from matplotlib.patches import Circle, Rectangle

    plan = record.table
    ends = [[(y1, x1), (y2, x2)] for _, x1, y1, x2, y2 in plan.cushions]
    circles = [(y, x, radius) for _, x, y, radius in plan.jaws + plan.pockets]
    corners = [(y + s * r, x + s * r) for y, x, r in circles for s in (-1, 1)]
    points = np.array([p for line in ends for p in line] + corners)
    if len(points) == 0:  # an endless cloth: show the balls' paths until `end`
        axes.set_facecolor(_CLOTH)
        places = record.states(np.minimum(_times(record), end))[:, :, 0, 1::-1].reshape(-1, 2)
        points = np.concatenate([places - 4 * record.radii.max(), places + 4 * record.radii.max()])
    else:
        axes.set_facecolor(_RAIL)
        corner = (plan.corner[1], plan.corner[0])
        size = (plan.length, plan.width)
        axes.add_patch(Rectangle(corner, *size, facecolor=_CLOTH, edgecolor="none", zorder=0))
    for _, x, y, radius in plan.pockets:
        axes.add_patch(Circle((y, x), radius, facecolor=_HOLE, edgecolor="none", zorder=1))
    for _, x, y, radius in plan.jaws:
        axes.add_patch(Circle((y, x), radius, facecolor=_RAIL, edgecolor="black", linewidth=0.6, zorder=2))
    axes.add_collection(LineCollection(ends, colors="black", linewidths=1.0, zorder=2))
    low, high = points.min(axis=0) - 0.01, points.max(axis=0) + 0.01
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(high[1], low[1])


def _path(record: Record, ball: int, end: float) -> list[tuple[NDArray[np.float64], bool]]:
    """One piece for every motion segment until `end` in which the ball moves.

    A piece is its points (n, 2), in the plot's coordinates, and whether the ball is in the air.
    """
    segments = record.segments[ball]
    stops = np.append(segments["start"][1:], record.duration)
    pieces = []
    for start, stop, state, velocity in zip(segments["start"], stops, segments["state"], segments["v"]):
        stop = min(stop, end)
        if not start < stop or not velocity.any():
            continue
        # The next segment's first instant belongs to that segment, but the position is the same on both
        # sides.
        places = record.states(np.linspace(start, stop, _POINTS))[:, ball, 0, 1::-1]
        pieces.append((places, record.MOTIONS[state] == "airborne"))
    return pieces


def _trail(axes: Any, path: list[tuple[NDArray[np.float64], bool]], color: NDArray[np.float64]) -> None:
    from matplotlib.collections import LineCollection

    for flying, style in ((False, "solid"), (True, (0, (2, 2)))):
        lines = [places for places, in_air in path if in_air == flying]
        if lines:
            axes.add_collection(LineCollection(
                lines, colors=[tuple(color)], linewidths=1.2, linestyles=[style], zorder=3))


def _times(record: Record) -> NDArray[np.float64]:
    """Times between which all curves are smooth: both sides of every segment's start, and some in between."""
    starts = np.unique(np.concatenate([segments["start"] for segments in record.segments]))
    starts = starts[starts < record.duration]
    stops = np.append(starts[1:], record.duration)
    spans = zip(starts, stops)
    inside = [np.append(np.linspace(start, stop, 9)[:-1], np.nextafter(stop, start)) for start, stop in spans]
    return np.concatenate([*inside, [record.duration]])


def _over_time(axes: Any, what: str) -> None:
    axes.set_xlabel("time [s]")
    axes.set_ylabel(what)
    axes.set_xlim(left=0)
    axes.set_ylim(bottom=0)
    if axes.get_legend_handles_labels()[0]:
        axes.legend()
