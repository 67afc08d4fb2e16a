"""How a record shows itself in a notebook: the page that plays it, or a picture where there is no program."""

from __future__ import annotations

import base64
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
    try:
        inside = html.escape(record.page())
    except (OSError, RuntimeError):
        return _pictured(record, text)
    style = "width:100%;height:620px;border:0"
    return f'<iframe title="{text}" style="{style}" sandbox="allow-scripts" srcdoc="{inside}"></iframe>'


def _pictured(record: Record, text: str) -> str:
    drawn = picture(record)
    if drawn is None:
        return f"<p>{text} (a picture needs matplotlib: <code>pip install 'carom-billiards[notebook]'</code>)</p>"
    data = base64.b64encode(drawn).decode("ascii")
    return f'<figure style="margin:0"><img alt="{text}" src="data:image/png;base64,{data}"><figcaption>{text}</figcaption></figure>'
