"""The example scenes: `carom.scenes.load("draw")`."""

from __future__ import annotations

import os

from carom._arguments import checked
from carom._scene import Scene

_FOLDER = os.path.dirname(__file__)

__all__ = ["load", "names", "path"]


def names() -> list[str]:
    """The names of all scenes, in alphabetical order."""
    return sorted(name[:-5] for name in os.listdir(_FOLDER) if name.endswith(".toml"))


@checked
def path(name: str) -> str:
    """The path of a scene's file. Raises ValueError for another name."""
    if name not in names():
        raise ValueError(f"name={name!r}: expected one of {', '.join(names())}")
    return os.path.join(_FOLDER, f"{name}.toml")


@checked
def load(name: str) -> Scene:
    """The scene with this name. Raises ValueError for another name."""
    return Scene.load(path(name))
