"""Scenes."""

from __future__ import annotations

import contextlib
import math
import os
import re
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from carom import _carom, _toml
from carom._arguments import ArgumentError, checked, may_be
from carom._errors import SceneError, check_exists

if TYPE_CHECKING:
    from typing import Self

    from numpy.typing import NDArray


def _placeless(error: SceneError) -> SceneError:
    """The error without its line numbers, which mean nothing for a scene that was built in code."""
    return SceneError(re.sub(r" in line \d+", "", error.message), error.file)


def _section(value: str | Mapping[str, Any], key: str) -> Mapping[str, Any]:
    return {key: value} if isinstance(value, str) else value


@checked
class Scene:
    """A table, its balls, and a strike if there is one. Immutable and valid.

    Sections and keys are those of scene files (docs/reference/scene_format.md):
    `Scene(table="carom", balls="carom", rack="three_cushion", cue={"ball": "white", "speed": 4})`. A string
    instead of a section is the preset of a table, of balls or of a cue, or the game of a rack.

    table: the table, "nine_foot" if it is left out
    balls: the material of all balls
    ball: one mapping for each ball that is placed by itself
    rack: balls that are placed together
    cue: the strike; without it, no ball is struck
    physics, effects, stop, render: as in files

    Raises SceneError if the engine refuses the scene.

    A scene pickles as its text. Two scenes are equal if their `text()` is equal.
    """

    __slots__ = ("_native",)
    _native: _carom.Scene

    def __init__(
        self,
        *,
        table: str | Mapping[str, Any] | None = None,
        balls: str | Mapping[str, Any] | None = None,
        ball: Sequence[Mapping[str, Any]] | None = None,
        rack: str | Mapping[str, Any] | None = None,
        cue: str | Mapping[str, Any] | None = None,
        physics: Mapping[str, Any] | None = None,
        **sections: Mapping[str, Any],
    ) -> None:
        tree: dict[str, Any] = {}
        for name, part in (("table", table), ("balls", balls), ("rack", rack), ("cue", cue)):
            if part is not None:
                tree[name] = _section(part, "game" if name == "rack" else "preset")
        if ball is not None:
            tree["ball"] = ball
        if physics is not None:
            tree["physics"] = physics
        self._native = _from_tree(tree | sections, "scene")

    @classmethod
    def _of(cls, native: _carom.Scene) -> Self:
        scene = cls.__new__(cls)
        scene._native = native
        return scene

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Self:
        """The scene in a TOML file. Raises SceneError, with the place of the mistake, also if it cannot be
        read; it is a FileNotFoundError, too, if there is no such file."""
        name = os.fspath(path)
        check_exists(name)
        return cls._of(_carom.parse_scene(_carom.read_scene_text(name), name))

    @classmethod
    def loads(cls, text: str, name: str = "scene") -> Self:
        """The scene in a TOML text. Raises SceneError with the place of the mistake.

        name: the file name in messages
        """
        return cls._of(_carom.parse_scene(text, name))

    @classmethod
    def from_dict(cls, tree: Mapping[str, Any], name: str = "scene") -> Self:
        """The scene that a file with this content describes, as `tomllib.load` returns it.

        Numbers and arrays of numpy are accepted. Raises SceneError with the message for a file, but no line.
        """
        return cls._of(_from_tree(tree, name))

    def to_dict(self) -> dict[str, Any]:
        """The scene's file as a tree, as it was written: `Scene.from_dict(scene.to_dict()) == scene`."""
        import tomllib

        return tomllib.loads(self._native.source)

    def replace(self, **changes: Any) -> Self:
        """The scene with other values.

        A key with dots sets one value, as in `carom sweep --vary`: "ball.cue.position.x",
        "table.pocket.p1.radius" or `scene.replace(**{"cue.speed": 3, "balls.mu_s": 0.18})`. A key without
        dots replaces a whole section, and None removes it: `scene.replace(cue={"speed": 3, "aim_deg": 88})`.

        Raises SceneError for an unknown key, or if the engine refuses the result.
        """
        native, name = self._native, self._native.file
        sections = {key: part for key, part in changes.items() if "." not in key}
        if sections:
            tree = {key: part for key, part in (self.to_dict() | sections).items() if part is not None}
            native = _from_tree(tree, name)
        values = [(key, _toml.value(value, key, name)) for key, value in changes.items() if "." in key]
        if values:
            try:
                native = _carom.parse_scene(native.changed(values), name)
            except SceneError as error:
                raise _placeless(error) from None
        return self._of(native)

    def __getitem__(self, key: str) -> Any:
        """The value of a key as `replace` names it, also if the file leaves it out: `scene["cue.speed"]`, or
        a section as a dict. Raises KeyError if the scene has no such value."""
        import tomllib

        if not isinstance(key, str):
            raise ArgumentError(f"key: expected a string, such as 'cue.speed', not {key!r}")
        with contextlib.suppress(ValueError):
            if not math.isnan(number := self._native.number(key)):
                return number
        at: Any = tomllib.loads(self.text())
        for name in key.split("."):
            if isinstance(at, list):
                at = {part["id"]: part for part in at if isinstance(part, dict) and "id" in part}
            at = at.get(name) if isinstance(at, dict) else None
        if at is None:
            raise KeyError(f"{key}: the scene has no such value; print(scene.text()) shows them")
        return at

    def text(self) -> str:
        """The scene as a TOML file with every value written out, a rack as its balls.

        `Scene.loads(scene.text())` is the same scene to the bit.
        """
        return self._native.text

    @property
    def source(self) -> str:
        """The TOML that the scene was read from."""
        return self._native.source

    @property
    def file(self) -> str:
        """The file name in messages."""
        return self._native.file

    @property
    def ids(self) -> tuple[str, ...]:
        """The balls, in the order of every array's ball axis."""
        return tuple(self._native.ids)

    @property
    def positions(self) -> NDArray[np.float64]:
        """The balls' starting positions [m]: (balls, 2), a copy."""
        out = np.empty((self._native.balls, 2))
        self._native.positions(out.reshape(-1))
        return out

    def __eq__(self, other: object) -> bool:
        return self.text() == other.text() if isinstance(other, Scene) else NotImplemented

    def __hash__(self) -> int:
        return hash(self.text())

    def __reduce__(self) -> tuple[Any, tuple[str, str]]:
        return type(self).loads, (self._native.source, self._native.file)

    def __repr__(self) -> str:
        some = ", ".join(self.ids[:4]) + (", ..." if len(self.ids) > 4 else "")
        table = self._native.table
        place = f"{table[0] or 'outline'} {table[1]:.3f} x {table[2]:.3f} m, " if table[1] > 0 else ""
        return f"<carom.Scene {self.file}: {place}{len(self.ids)} balls ({some})>"


#: Accepted as a scene: a Scene, the path of its file, or its tree.
SceneLike: TypeAlias = Scene | str | os.PathLike[str] | Mapping[str, Any]
may_be("SceneLike", "Scene | str | PathLike | Mapping")


def as_scene(scene: SceneLike) -> Scene:
    if isinstance(scene, Scene):
        return scene
    return Scene.from_dict(scene) if isinstance(scene, Mapping) else Scene.load(scene)


def _from_tree(tree: Mapping[str, Any], name: str) -> _carom.Scene:
    try:
        return _carom.parse_scene(_toml.document(tree, name), name)
    except SceneError as error:
        raise _placeless(error) from None


def scene_with_cue(
    cue: str | Mapping[str, Any] | None, make: Callable[[str], _carom.Scene], **standard: Any
) -> Scene:
    """The scene that `make` returns for the section [cue] of this cue, or for an empty text without a cue.

    standard: defaults for keys that the cue leaves out
    """
    tree = {} if cue is None else {"cue": standard | dict(_section(cue, "preset"))}
    try:
        return Scene._of(make(_toml.document(tree, "scene")))
    except SceneError as error:
        raise _placeless(error) from None


@checked
def tables() -> dict[str, dict[str, Any]]:
    """The measures of every table preset, as `carom check` prints them, in m and degrees.

    Each has the `balls` that it is for, its `size`, `cushion_height` and, if it has pockets, `rail_width`,
    `corner_pockets` and `side_pockets`: the keys of scene files, with every value, and `cut_off_deg`. On a
    straight path that is farther than this from the pocket's axis, a ball of that game cannot pass both
    points of the mouth untouched.
    """
    return dict(_carom.tables())
