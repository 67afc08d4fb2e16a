"""How a notebook displays a record: the page that plays it, or a picture."""

from __future__ import annotations

import html
import io

from carom import plot
from carom._record import Record


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
