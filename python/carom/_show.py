"""How a record shows itself in a notebook: the page that plays it, or a picture."""

from __future__ import annotations

import html
import io

from carom import plot
from carom._record import Record


def picture(record: Record) -> bytes | None:
    """The plan of the table with trails as PNG; None where there is no matplotlib."""
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError:
        return None
    # Not a figure of pyplot's, which the notebook would show a second time.
    figure = Figure(figsize=(8.0, 4.6), dpi=100, layout="constrained")
    FigureCanvasAgg(figure)
    plot.table(record, ax=figure.add_subplot())
    out = io.BytesIO()
    figure.savefig(out, format="png", metadata={"Software": None})
    return out.getvalue()


def shown(record: Record) -> str:
    """HTML without a reference to anything outside: a frame with the page of the shot. Its scripts see nothing of the notebook."""
    text = html.escape(repr(record)[len("<carom.") : -1])
    style = "width:100%;height:620px;border:0"
    return f'<iframe title="{text}" style="{style}" sandbox="allow-scripts" srcdoc="{html.escape(record.page())}"></iframe>'
