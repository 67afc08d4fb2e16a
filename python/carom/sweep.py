"""Sweeps: many shots of one scene whose values are drawn, as a table.

The draws are those of `carom sweep`: a shot depends on the seed, its number and the key, whatever else varies.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from carom import _carom, _toml
from carom._scene import Scene
from carom._simulate import Shots, ShotStatus

if TYPE_CHECKING:
    import pyarrow

__all__ = ["columns", "table"]

#: What a shot is called in the column "outcome".
_OUTCOMES = tuple(status.name.lower() for status in ShotStatus)


def _rules(vary: Mapping[str, Any] | Sequence[str]) -> list[str]:
    if isinstance(vary, str):
        raise ValueError('vary: expected a list of rules such as ["cue.speed=uniform(2,4)"], or a mapping')
    if not isinstance(vary, Mapping):
        return list(vary)
    rules = []
    for key, values in vary.items():
        if not isinstance(values, str):
            values = f"list({','.join(_toml.value(value, key, 'vary') for value in values)})"
        rules.append(f"{key}={values}")
    return rules


def _drawn(rule: str, texts: list[str]) -> Any:
    """What a rule drew, by its kind and not by what happened to come: all parts of a sweep have the same types."""
    import tomllib

    kind, _, values = rule.partition("=")[2].partition("(")
    if kind == "list":
        listed = tomllib.loads(f"v = [{values[:-1]}\n]")["v"]
        if all(type(value) is int for value in listed):
            kind = "integer"
        elif not all(type(value) in (int, float) for value in listed):
            return texts
    return np.array([int(text, 0) for text in texts], np.int64) if kind == "integer" else np.array([float(text) for text in texts], np.float64)


def columns(
    scene: Scene,
    vary: Mapping[str, Any] | Sequence[str],
    shots: int,
    *,
    seed: int = 1,
    first: int = 0,
    last: int | None = None,
    threads: int = 0,
) -> dict[str, Any]:
    """Plays shots of a sweep; the columns of `carom sweep` as arrays, and as lists where they hold texts.

    vary: rules as for `carom sweep --vary`, or a mapping from keys to distributions ("normal(0.5)") or lists of values
    shots: how many the whole sweep has
    seed: of all draws
    first, last: only the shots first to last - 1
    threads: 0 takes one for each core; the rows do not depend on it

    A shot without a result has NaN, and None where there are texts or integers. Raises ValueError for a rule that cannot be read or
    that gives no valid scene, SceneError for a value that no file can hold.
    """
    end = shots if last is None else last
    if not 0 <= first <= end <= shots:
        raise ValueError(f"first={first}, last={last}: expected 0 <= first <= last <= {shots}")
    if threads < 0:
        raise ValueError(f"threads={threads}: expected at least 0")
    if not 0 <= seed < 2**64:
        raise ValueError(f"seed={seed}: expected 0 to 2**64 - 1")
    rules = _rules(vary)
    sweep = _carom.make_sweep(scene._native, rules, seed)
    n, ids = end - first, scene.ids
    played = Shots.empty(n, len(ids))
    values, failures = sweep.play(first, n, threads, played._native())
    messages = dict(failures)
    result: dict[str, Any] = {"shot": np.arange(first, end, dtype=np.int64)}
    for k, (key, rule) in enumerate(zip(sweep.keys, rules)):
        result[key] = _drawn(rule, values[k :: len(rules)])
    result |= _outcomes(played, ids, _carom.pocket_ids(scene._native), messages)
    return result


def _outcomes(shots: Shots, ids: tuple[str, ...], pockets: list[str], messages: dict[int, str]) -> dict[str, Any]:
    failed = [i in messages for i in range(len(shots.status))]

    def texts(values: list[str]) -> list[str | None]:
        return [None if bad else value for bad, value in zip(failed, values)]

    fallen = []
    for fell in shots.fell.tolist():
        order = sorted((place, ball) for ball, place in enumerate(fell) if place >= 0)
        fallen.append(";".join(ids[ball] for _, ball in order))
    result: dict[str, Any] = {
        "outcome": [_OUTCOMES[status] for status in shots.status.tolist()],
        "duration": shots.duration,
        "events": [None if bad else events for bad, events in zip(failed, shots.events.tolist())],
        "first_contact": texts([ids[ball] if ball >= 0 else "" for ball in shots.first_hit.tolist()]),
        "pocketed": texts(fallen),
    }
    for ball, name in enumerate(ids):
        result[f"{name}.x"] = shots.xy[:, ball, 0]
        result[f"{name}.y"] = shots.xy[:, ball, 1]
        result[f"{name}.pocket"] = texts([pockets[p] if p >= 0 else "out" if p == -2 else "" for p in shots.pocket[:, ball].tolist()])
    result["message"] = [messages.get(i, "") for i in range(len(failed))]
    return result


def table(
    scene: Scene,
    vary: Mapping[str, Any] | Sequence[str],
    shots: int,
    *,
    seed: int = 1,
    first: int = 0,
    last: int | None = None,
    threads: int = 0,
) -> pyarrow.Table:
    """`columns` as a pyarrow Table, whose metadata say where it comes from: scene, vary, seed, first, last, version. What a shot
    without a result lacks is null. Needs pyarrow (extra [sweep])."""
    import pyarrow

    parts = columns(scene, vary, shots, seed=seed, first=first, last=last, threads=threads)
    arrays = {}
    for name, values in parts.items():
        if isinstance(values, np.ndarray):
            arrays[name] = pyarrow.array(values, mask=np.isnan(values) if values.dtype == np.float64 else None)
        else:
            arrays[name] = pyarrow.array(values, pyarrow.int64() if name == "events" else pyarrow.string())
    about = {
        "carom.scene": scene.source,
        "carom.vary": "\n".join(_rules(vary)),
        "carom.seed": str(seed),
        "carom.first": str(first),
        "carom.last": str(shots if last is None else last),
        "carom.version": _carom.VERSION,
    }
    return pyarrow.table(arrays, metadata=about)
