"""carom: event-based billiards.

A `Scene` says what stands on the table and how it is struck, `simulate` plays it, and the `Record` says exactly what happened.
`simulate_many` plays many shots that differ in numbers. SI units throughout: metres, seconds, radians per second; angles whose
names end in `_deg` are degrees. The table's frame has x along the short side, y along the long side and z up from the cloth.

Long calls run without the GIL, and Ctrl-C ends them. Results have the same bits on every machine and with any number of threads.
"""

from carom import games, kernel, plot, sweep
from carom._carom import VERSION as __version__
from carom._errors import SceneError
from carom._program import accuracy, margin
from carom._record import Event, Record, TablePlan
from carom._scene import Scene
from carom._render import render
from carom._show import picture, shown
from carom._simulate import Shots, ShotStatus, SimulationError, simulate, simulate_many

# Notebooks show a record by these; a record itself knows nothing of plots.
setattr(Record, "_repr_html_", shown)
setattr(Record, "_repr_png_", picture)

__all__ = [
    "Event",
    "Record",
    "Scene",
    "SceneError",
    "ShotStatus",
    "Shots",
    "SimulationError",
    "TablePlan",
    "__version__",
    "accuracy",
    "games",
    "kernel",
    "margin",
    "plot",
    "render",
    "simulate",
    "simulate_many",
    "sweep",
]
