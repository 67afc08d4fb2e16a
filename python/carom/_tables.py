"""Records as pandas tables."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import pandas

    from carom._record import Record


def _pandas() -> Any:
    try:
        import pandas
    except ImportError as error:
        raise ImportError("to_pandas needs pandas: pip install 'carom-billiards[notebook]'") from error
    return pandas


def events(record: Record) -> pandas.DataFrame:
    """A row for every event."""
    pandas = _pandas()
    view, named = record.events, record.event_list()
    return pandas.DataFrame(
        {
            "time": view["time"],
            "type": pandas.Categorical.from_codes(view["type"].astype(np.int16), list(record.EVENT_TYPES)),
            "a": [event.a for event in named],
            "b": [event.b for event in named],
            "detail": view["detail"],
            "slow": view["slow"],
        }
    )


def segments(record: Record) -> pandas.DataFrame:
    """A row for every motion segment, ball after ball."""
    pandas = _pandas()
    all_of = np.concatenate(record.segments)
    counts = [len(of_ball) for of_ball in record.segments]
    columns: dict[str, Any] = {"ball": np.repeat(np.array(record.ids, dtype=object), counts)}
    for name in all_of.dtype.names or ():
        if name == "state":
            columns[name] = pandas.Categorical.from_codes(all_of[name].astype(np.int16), list(record.MOTIONS))
        elif all_of[name].ndim == 1:
            columns[name] = all_of[name]
        else:
            for axis, values in zip("xyz", all_of[name].T):
                columns[name + axis] = values
    return pandas.DataFrame(columns)
