"""carom: event-based billiards.

A `Scene` describes the table, the balls and the strike, `simulate` plays it, and the `Record` contains
the exact result. `simulate_many` plays many shots that differ in numbers. Units are SI throughout: metres,
seconds, radians per second; names that end in `_deg` are angles in degrees. In the table's frame x runs along
the short side, y along the long side, and z up from the cloth.

Long calls release the GIL, and Ctrl-C ends them. Results have the same bits on every machine and with any
number of threads.
"""

from typing import TYPE_CHECKING, Any

from carom import games, kernel, plot, scenes, sweep
from carom._carom import VERSION as __version__
from carom._errors import SceneError, SceneNotFoundError
from carom._fit import fit
from carom._measures import Measure, Solution, best_break, measures, solve
from carom._program import accuracy, margin, sensitivity
from carom._record import Event, EventColumn, Hit, Record, TablePlan, event_columns
from carom._scene import Scene, tables
from carom._render import render
from carom._show import drawing, picture, shown
from carom._simulate import Shots, ShotStatus, SimulationError, simulate, simulate_many
from carom._types import Cost, Fall, FitResult, Hand, Unknown

if TYPE_CHECKING:
    from carom import gym as gym


def __getattr__(name: str) -> Any:
    # Imported on first use, because it needs gymnasium.
    if name == "gym":
        import importlib

        return importlib.import_module("carom.gym")
    raise AttributeError(f"module 'carom' has no attribute {name!r}")


# Notebooks display a record or a scene through these methods, which depend on more than these classes do.
setattr(Record, "_repr_html_", shown)
setattr(Record, "_repr_png_", picture)
setattr(Scene, "_repr_html_", drawing)

__all__ = [
    "Cost",
    "Event",
    "EventColumn",
    "Fall",
    "FitResult",
    "Hand",
    "Hit",
    "Measure",
    "Record",
    "Scene",
    "SceneError",
    "SceneNotFoundError",
    "ShotStatus",
    "Shots",
    "SimulationError",
    "Solution",
    "TablePlan",
    "Unknown",
    "__version__",
    "accuracy",
    "best_break",
    "event_columns",
    "fit",
    "games",
    "kernel",
    "margin",
    "measures",
    "plot",
    "render",
    "scenes",
    "sensitivity",
    "simulate",
    "simulate_many",
    "solve",
    "sweep",
    "tables",
]
