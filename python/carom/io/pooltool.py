"""pooltool's files, both ways: the System of pooltool 0.6.0 as JSON, and read as MessagePack.

`load` returns the scene that a System plays, with pooltool's models. `save` writes a record so that pooltool
plays it. Neither needs pooltool. lab/notes/2026-11-pooltool.md measures what agrees and what does not.
"""

from __future__ import annotations

import json
import math
import os
from typing import Any, NoReturn

import numpy as np

from carom._arguments import checked
from carom._errors import SceneError
from carom._record import Record
from carom._scene import Scene
from carom.io import _system
from carom.io._system import POCKETS, STATES

__all__ = ["load", "save", "table"]

#: The friction between balls in pooltool, a + b exp(-c u). It belongs to pooltool's models, not to its files.
FRICTION = (0.009951, 0.108, 1.088)
_READS = "pooltool writes JSON if the name of the file ends in .json, and MessagePack for .msgpack"


class _Tree:
    """A part of the file, with its path for messages."""

    def __init__(self, file: str, value: Any, path: str = "") -> None:
        self.file, self.value, self.path = file, value, path

    def fail(self, what: str) -> NoReturn:
        wanted = "expected a System as pooltool 0.6.0 saves it"
        raise SceneError(f"{self.path or 'the file'} {what}; {wanted}", self.file)

    def at(self, key: str) -> _Tree:
        part = _Tree(self.file, None, f"{self.path}.{key}" if self.path else key)
        if not isinstance(self.value, dict) or key not in self.value:
            part.fail("is missing")
        part.value = self.value[key]
        return part

    def items(self) -> list[tuple[str, _Tree]]:
        """The members of an object, those with numbers as names sorted by number."""
        if not isinstance(self.value, dict):
            self.fail("is not an object")

        def place(name: str) -> tuple[int, int, str]:
            number = name.rstrip("t")
            return (0, int(number), "") if number.isdecimal() else (1, 0, name)

        order = sorted(self.value, key=place)
        return [(name, self.at(name)) for name in order]

    def parts(self) -> list[_Tree]:
        if not isinstance(self.value, list):
            self.fail("is not a list")
        return [_Tree(self.file, value, f"{self.path}[{i}]") for i, value in enumerate(self.value)]

    def number(self) -> float:
        number = isinstance(self.value, (int, float)) and not isinstance(self.value, bool)
        if not number or not math.isfinite(self.value):
            self.fail("is not a number")
        return float(self.value)

    def numbers(self, count: int) -> list[float]:
        parts = self.parts()
        if len(parts) != count:
            self.fail(f"has {len(parts)} numbers instead of {count}")
        return [part.number() for part in parts]

    def text(self) -> str:
        if not isinstance(self.value, str):
            self.fail("is not a string")
        return str(self.value)


@checked
def load(path: str | os.PathLike[str]) -> Scene:
    """The scene of a System at its start; of a simulated System, the scene that was simulated.

    The models are pooltool's defaults as far as carom has them: `inelastic` impacts of balls with the
    friction of Alciatore's TP A.14, `stronge` cushions and jaws, `sequential` clusters, `pocket = "at_once"`,
    `vertical = "drop"`, and a cue without losses. Two of pooltool's formulas differ: it limits the friction
    between balls by a normal impulse of e v m instead of (1 + e) v m/2, and it takes the normal of a jaw from
    the centre of the jaw's circle. Friction and the heights of jaws are scaled so that impacts agree.
    Pocketed balls are left out. Cushions, jaws and pockets are named c1, ..., j1, ..., p1, ... in pooltool's
    order.

    Raises SceneError if the file is not such a System, or if carom refuses its contents.
    """
    name = os.fspath(path)
    root = _Tree(name, _unpacked(name) if name.endswith(".msgpack") else _parsed(name))
    balls = _balls(root)
    tree = {"table": _table(root.at("table"), balls), **balls}
    cue = _cue(root)
    if cue is not None:
        tree["cue"] = cue
    return Scene.from_dict(tree, name)


def _parsed(name: str) -> Any:
    try:
        with open(name, encoding="utf-8") as file:
            return json.load(file)
    except OSError as error:
        raise SceneError(f"cannot be read: {error.strerror}", name) from None
    except json.JSONDecodeError as error:
        what = f"is not JSON: {error.msg}; {_READS}"
        raise SceneError(what, name, error.lineno, error.colno) from None
    except UnicodeDecodeError:
        raise SceneError(f"is not JSON because it is not UTF-8; {_READS}", name) from None


def _unpacked(name: str) -> Any:
    """What msgpack-numpy wrote: arrays and numbers of numpy are maps with their type and bytes."""
    try:
        import msgpack
    except ImportError:
        what = "is MessagePack, which needs the package msgpack; install it, or save as .json in pooltool"
        raise SceneError(what, name) from None

    def plain(item: dict[Any, Any]) -> Any:
        if b"nd" not in item:
            return item
        kind = np.dtype(item[b"type"])
        if kind.kind not in "biuf":
            raise ValueError(f"an array of type {kind}")
        array = np.frombuffer(item[b"data"], kind)
        return array.reshape(item[b"shape"]).tolist() if item[b"nd"] else array[0].item()

    try:
        with open(name, "rb") as file:
            return msgpack.unpackb(file.read(), object_hook=plain, strict_map_key=False)
    except OSError as error:
        raise SceneError(f"cannot be read: {error.strerror}", name) from None
    except (ValueError, KeyError, TypeError, IndexError, msgpack.UnpackException) as error:
        raise SceneError(f"is not MessagePack as pooltool saves it: {error}", name) from None


#: Measures of pooltool's table specifications, and where carom has them.
_SPECS = {"width": "mouth", "angle": "angle_deg", "radius": "radius"}


@checked
def table(specs: dict[str, Any]) -> dict[str, Any]:
    """The section [table] of a scene for a table specification of pooltool: the attributes of its
    PocketTableSpecs, SnookerTableSpecs or BilliardTableSpecs as a dict, such as `attrs.asdict(specs)`. The
    facings of side pockets end where their angle leads, and not up to 0.1 mm beside that, as in pooltool.

    Raises SceneError if a measure is missing or is not a number.
    """
    root = _Tree("specification", specs)

    def measure(key: str) -> float:
        return root.at(key).number()

    whole: dict[str, Any] = {"size": [measure("w"), measure("l")]}
    whole["cushion_height"] = measure("cushion_height")
    if "corner_pocket_width" not in specs:
        return {"preset": "carom", **whole}
    for kind, axis, jaws in (("corner", 135.0, "corner_jaw_radius"), ("side", 90.0, "side_jaw_radius")):
        pockets = {ours: measure(f"{kind}_pocket_{theirs}") for theirs, ours in _SPECS.items()}
        pockets["angle_deg"] += axis
        # From the mouth's middle to the hole: at a corner, the mouth is half its width before the corner.
        front = pockets["mouth"] / 2 if kind == "corner" else 0.0
        pockets["shelf"] = measure(f"{kind}_pocket_depth") - pockets["radius"] + front
        pockets["jaw_radius"] = measure(jaws)
        whole[f"{kind}_pockets"] = pockets
    return {"preset": "nine_foot", **whole, "rail_width": measure("cushion_width")}


def _table(table: _Tree, balls: dict[str, Any]) -> dict[str, Any]:
    cushions, jaws = [], []
    ball_radius = balls["ball"][0].get("radius", balls["balls"].get("radius"))
    segments = table.at("cushion_segments")
    for _, part in segments.at("linear").items():
        (x1, y1, height), (x2, y2, _) = part.at("p1").numbers(3), part.at("p2").numbers(3)
        cushions.append({"from": [x1, y1], "to": [x2, y2], "height": height})
    for _, part in segments.at("circular").items():
        (x, y, height), radius = part.at("center").numbers(3), part.at("radius").number()
        # At this height carom's normal, from the nose to the ball, is as steep as pooltool's, from the
        # circle's centre.
        height = ball_radius + (height - ball_radius) * ball_radius / (ball_radius + radius)
        jaws.append({"center": [x, y], "radius": radius, "height": height})
    pockets = dict(table.at("pockets").items())
    order = [name for name in POCKETS if name in pockets] + [name for name in pockets if name not in POCKETS]
    holes = []
    for part in (pockets[name] for name in order):
        holes.append({"center": part.at("center").numbers(3)[:2], "radius": part.at("radius").number()})
    return {"cushion": cushions} | ({"jaw": jaws} if jaws else {}) | ({"pocket": holes} if holes else {})


def _balls(root: _Tree) -> dict[str, Any]:
    """The sections ball, balls and physics."""
    struck = _struck(root)
    balls, common = [], None
    for name, part in root.at("balls").items():
        history = part.at("history").at("states").parts()
        state = history[0] if history else part.at("state")
        kind = state.at("s").number()
        if kind not in range(len(STATES)):
            state.at("s").fail(f"is {kind:g}, but states of motion are 0 to {len(STATES) - 1}")
        if STATES[int(kind)] == "pocketed":
            continue
        rows = state.at("rvw").parts()
        if len(rows) != 3:
            state.at("rvw").fail(f"has {len(rows)} rows instead of 3")
        position, velocity, spin = (row.numbers(3) for row in rows)
        radius, mass, rest = _parameters(part.at("params"))
        if common is not None and rest != common:
            part.at("params").fail("differs from other balls in more than R and m, which carom cannot play")
        common = rest
        ball = {"id": name, "position": position[:2], "radius": radius, "mass": mass}
        if STATES[int(kind)] != "stationary" and not struck:
            ball |= {"velocity": velocity[:2], "spin": spin}
        balls.append(ball)
    if common is None:
        root.at("balls").fail("has no ball on the table")
    first = balls[0]
    if all(ball["radius"] == first["radius"] and ball["mass"] == first["mass"] for ball in balls):
        common["balls"] |= {"radius": first["radius"], "mass": first["mass"]}
        for ball in balls:
            del ball["radius"], ball["mass"]
    return {"ball": balls, **common}


def _parameters(params: _Tree) -> tuple[float, float, dict[str, dict[str, Any]]]:
    """Radius, mass, and the parameters that all balls must share."""
    radius = params.at("R").number()
    restitution = params.at("e_b").number()
    scale = 2 * restitution / (1 + restitution)
    balls = {
        "mu_s": params.at("u_s").number(),
        "mu_r": params.at("u_r").number(),
        "mu_sp": params.at("u_sp_proportionality").number() * radius,
        "mu_b_fit": [FRICTION[0] * scale, FRICTION[1] * scale, FRICTION[2]],
        "e_b": restitution,
        "e_c": params.at("e_c").number(),
        "f_c": params.at("f_c").number(),
    }
    physics = {
        "gravity": params.at("g").number(),
        "ball_ball": "inelastic",
        "cushion": "stronge",
        "clusters": "sequential",
        "pocket": "at_once",
        "vertical": "drop",
    }
    return radius, params.at("m").number(), {"balls": balls, "physics": physics}


def _struck(root: _Tree) -> bool:
    """Whether the shot begins with the cue: in a simulated System, whether it did; otherwise, whether it
    would."""
    events = [event.at("event_type").text() for event in root.at("events").parts()]
    if events:
        return "stick_ball" in events
    moves = any(part.at("state").at("s").number() in (1, 2, 3) for _, part in root.at("balls").items())
    return not moves and root.at("cue").at("V0").number() > 0


def _cue(root: _Tree) -> dict[str, Any] | None:
    if not _struck(root):
        return None
    cue = root.at("cue")
    return {
        "preset": "lossless",
        "ball": cue.at("cue_ball_id").text(),
        "speed": cue.at("V0").number(),
        "aim_deg": cue.at("phi").number(),
        "elevation_deg": cue.at("theta").number(),
        "offset": [cue.at("a").number(), cue.at("b").number()],
        "mass": cue.at("specs").at("M").number(),
        "end_mass": cue.at("specs").at("end_mass").number(),
    }


@checked
def save(record: Record, path: str | os.PathLike[str]) -> None:
    """Writes a record as a simulated System, which pooltool 0.6.0 loads, shows and evaluates.

    The file appears complete or not at all. Between events pooltool computes the motion again, from the state
    after each event and the coefficients. It has no formula for balls that fly, fall, or rest on each other;
    for these, the file holds 200 intermediate states per second as transitions. pooltool's viewer needs a
    table of its own layout: pool and snooker tables with 18 cushions and 6 pockets, carom tables with 4
    cushions. The cue is that of the record's scene, with the speed that gives the ball the same velocity in
    pooltool. A record loaded from a file has no cue.

    Raises ValueError if the name does not end in .json, the balls differ in size or mass, or the table has
    arcs, and OSError if the file cannot be written.
    """
    name = os.fspath(path)
    if not name.endswith(".json"):
        raise ValueError(f"{name}: a System is saved as .json; use a name that ends in .json")
    _system.write(record, name)
