"""How a notebook displays a record: the page that plays it, or a picture."""

from __future__ import annotations

import html
import io

import numpy as np

from carom import plot
from carom._errors import SceneError
from carom._record import Record
from carom._scene import Scene
from carom._simulate import simulate


def picture(record: Record) -> bytes | None:
    """The table from above with trails, as PNG; None without matplotlib."""
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError:
        return None
    # Not a pyplot figure: the notebook would show that a second time.
    figure = Figure(figsize=(8.0, 4.6), dpi=100, layout="constrained")
    FigureCanvasAgg(figure)
    plot.table(record, ax=figure.add_subplot())
    out = io.BytesIO()
    figure.savefig(out, format="png", metadata={"Software": None})
    return out.getvalue()


def shown(record: Record) -> str:
    """Self-contained HTML: a frame with the shot's page, whose scripts have no access to the notebook."""
    text = html.escape(repr(record)[len("<carom.") : -1])
    style = "width:100%;height:620px;border:0"
    page = html.escape(record.page())
    return f'<iframe title="{text}" style="{style}" sandbox="allow-scripts" srcdoc="{page}"></iframe>'


def drawing(scene: Scene) -> str:
    """The table from above with the balls at the start and the line of aim, as SVG."""
    try:
        record = simulate(scene, until=0.0)
    except SceneError:
        return f"<pre>{html.escape(repr(scene))}</pre>"
    table, (x, y) = record.table, scene.positions.T
    # The long side lies across; without a table, the balls' box.
    if table.width:
        left, low, wide, high = table.corner[1], table.corner[0], table.length, table.width
    else:
        left, low, wide, high = float(y.min()), float(x.min()), float(np.ptp(y)), float(np.ptp(x))
    parts = [f'<rect x="{left}" y="{low}" width="{wide}" height="{high}" fill="#2f7d5b"/>']
    for name, cx, cy, radius in table.pockets:
        parts.append(f'<circle cx="{cy}" cy="{cx}" r="{radius}"><title>{html.escape(name)}</title></circle>')
    for _, x1, y1, x2, y2 in table.cushions:
        parts.append(f'<path d="M{y1} {x1}L{y2} {x2}" stroke="#14503a" stroke-width="0.02"/>')
    for ball, px, py, radius, color in zip(scene.ids, x, y, record.radii, record.colors):
        fill = "".join(f"{round(255 * part):02x}" for part in color)
        title = f"<title>{html.escape(ball)}</title>"
        parts.append(f'<circle cx="{py}" cy="{px}" r="{radius}" fill="#{fill}">{title}</circle>')
    if len(record.events):  # a strike
        struck, aim = scene.ids.index(scene["cue.ball"]), np.radians(scene["cue.aim_deg"])
        line = f"M{y[struck]} {x[struck]}l{np.sin(aim)} {np.cos(aim)}"
        parts.append(f'<path d="{line}" stroke="#fff" stroke-width="0.008" opacity="0.7"/>')
    box = f"{left - 0.1} {low - 0.1} {wide + 0.2} {high + 0.2}"
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{box}" style="width:100%;max-width:640px">'
            f"{''.join(parts)}</svg>")
