"""Scenes that are built in code, written as the text that the engine reads."""

from __future__ import annotations

import datetime
import json
from collections.abc import Iterable, Mapping
from typing import Any

from carom._errors import SceneError

# The engine refuses values nested deeper; the limit here stops endless recursion into a tree that contains
# itself.
_DEEPEST = 20


def _string(text: str) -> str:
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def value(of: object, path: str, name: str, depth: int = 0) -> str:
    """A value as TOML. `path` and `name` are for messages. Raises SceneError for what TOML cannot hold."""
    if isinstance(of, str):
        return _string(of)
    if isinstance(of, bool):
        return "true" if of else "false"
    if isinstance(of, int):
        if not -(2**63) <= of < 2**63:
            raise SceneError(f"{path} is beyond 64 bits; write a smaller number", name)
        return str(int(of))
    if isinstance(of, float):
        return repr(float(of))
    if isinstance(of, (datetime.date, datetime.time)):
        return of.isoformat()
    if depth > _DEEPEST:
        raise SceneError(f"{path} is nested in more than {_DEEPEST} others; use fewer levels", name)
    if isinstance(of, Mapping):
        items = (f"{_key(k, path, name)} = {value(v, f'{path}.{k}', name, depth + 1)}" for k, v in of.items())
        return "{" + ", ".join(items) + "}"
    item = getattr(of, "tolist", None)
    if item is not None:
        return value(item(), path, name, depth + 1)  # an array or a number of numpy
    if isinstance(of, Iterable) and not isinstance(of, (bytes, set, frozenset)):
        return "[" + ", ".join(value(v, f"{path}[{i}]", name, depth + 1) for i, v in enumerate(of)) + "]"
    if of is None:
        raise SceneError(f"{path} is None; leave the key out", name)
    raise SceneError(f"{path} has the type {type(of).__name__}; use numbers, strings, lists and dicts", name)


def _key(key: object, path: str, name: str) -> str:
    if not isinstance(key, str):
        raise SceneError(f"{path or 'the scene'} has the key {key!r}; use strings as keys", name)
    return _string(key)


def document(tree: Mapping[str, Any], name: str) -> str:
    """A tree as a TOML file."""
    return "".join(f"{_key(k, '', name)} = {value(v, str(k), name)}\n" for k, v in tree.items())
