"""pooltool's files, both ways: the System of pooltool 0.6.0 as JSON.

`load` gives the scene that a System plays, with pooltool's models; `save` writes a record so that pooltool plays it. pooltool itself is
not needed. What agrees, and what does not, was measured: lab/notes/2026-11-pooltool.md.
"""

from __future__ import annotations

import json
import math
import os
from typing import Any, NoReturn

from carom._arguments import checked
from carom._errors import SceneError
from carom._record import Record
from carom._scene import Scene
from carom.io import _system
from carom.io._system import POCKETS, STATES

__all__ = ["load", "save"]

#: The friction of balls in pooltool, a + b exp(-c u), which is part of its models and not of a file.
FRICTION = (0.009951, 0.108, 1.088)


class _Tree:
    """A part of the file, with its path for messages."""

    def __init__(self, file: str, value: Any, path: str = "") -> None:
        self.file, self.value, self.path = file, value, path

    def fail(self, what: str) -> NoReturn:
        raise SceneError(f"{self.path or 'the file'} {what}; expected a System as pooltool 0.6.0 saves it in .json", self.file)

    def at(self, key: str) -> _Tree:
        part = _Tree(self.file, None, f"{self.path}.{key}" if self.path else key)
        if not isinstance(self.value, dict) or key not in self.value:
            part.fail("is missing")
        part.value = self.value[key]
        return part

    def items(self) -> list[tuple[str, _Tree]]:
        """The members of an object, those with numbers as names in their order."""
        if not isinstance(self.value, dict):
            self.fail("is no object")
        order = sorted(self.value, key=lambda name: (0, int(name.rstrip("t")), "") if name.rstrip("t").isdecimal() else (1, 0, name))
        return [(name, self.at(name)) for name in order]

    def parts(self) -> list[_Tree]:
        if not isinstance(self.value, list):
            self.fail("is no list")
        return [_Tree(self.file, value, f"{self.path}[{i}]") for i, value in enumerate(self.value)]

    def number(self) -> float:
        if isinstance(self.value, bool) or not isinstance(self.value, (int, float)) or not math.isfinite(self.value):
            self.fail("is no number")
        return float(self.value)

    def numbers(self, count: int) -> list[float]:
        parts = self.parts()
        if len(parts) != count:
            self.fail(f"has {len(parts)} numbers instead of {count}")
        return [part.number() for part in parts]

    def text(self) -> str:
        if not isinstance(self.value, str):
            self.fail("is no text")
        return str(self.value)


@checked
def load(path: str | os.PathLike[str]) -> Scene:
    """The scene of a System, from its start; of one that was simulated, what was simulated.

    The models are pooltool's defaults as far as carom has them: `inelastic` impacts of balls with the friction of Alciatore's TP A.14,
    `stronge` cushions and jaws, pair by pair, `pocket = "at_once"`, `vertical = "drop"`, a cue that loses nothing. pooltool takes the
    normal impulse of two balls for the limit of friction as e v m and not (1 + e) v m/2, and the normal of a jaw from the centre of its
    circle; friction and the jaws' heights are scaled so that impacts agree.
    Balls in pockets are left out. Cushions, jaws and pockets are c1, ..., j1, ..., p1, ... in pooltool's order.

    Raises SceneError where the file is no such System, and where carom refuses what is in it.
    """
    name = os.fspath(path)
    try:
        with open(name, encoding="utf-8") as file:
            root = _Tree(name, json.load(file))
    except OSError as error:
        raise SceneError(f"cannot be read: {error.strerror}", name) from None
    except json.JSONDecodeError as error:
        raise SceneError(f"is no JSON: {error.msg}; pooltool writes it where the name of a file ends in .json", name, error.lineno, error.colno) from None
    except UnicodeDecodeError:
        raise SceneError("is no JSON: it is not UTF-8; pooltool writes it where the name of a file ends in .json", name) from None
    balls = _balls(root)
    tree = {"table": _table(root.at("table"), balls), **balls}
    cue = _cue(root)
    if cue is not None:
        tree["cue"] = cue
    return Scene.from_dict(tree, name)


def _table(table: _Tree, balls: dict[str, Any]) -> dict[str, Any]:
    cushions, jaws = [], []
    ball_radius = balls["ball"][0].get("radius", balls["balls"].get("radius"))
    segments = table.at("cushion_segments")
    for _, part in segments.at("linear").items():
        (x1, y1, height), (x2, y2, _) = part.at("p1").numbers(3), part.at("p2").numbers(3)
        cushions.append({"from": [x1, y1], "to": [x2, y2], "height": height})
    for _, part in segments.at("circular").items():
        (x, y, height), radius = part.at("center").numbers(3), part.at("radius").number()
        # The height at which carom's normal, from the nose to the ball, is as steep as pooltool's, from the centre of the circle.
        height = ball_radius + (height - ball_radius) * ball_radius / (ball_radius + radius)
        jaws.append({"center": [x, y], "radius": radius, "height": height})
    pockets = dict(table.at("pockets").items())
    order = [name for name in POCKETS if name in pockets] + [name for name in pockets if name not in POCKETS]
    holes = [{"center": pockets[name].at("center").numbers(3)[:2], "radius": pockets[name].at("radius").number()} for name in order]
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
            state.at("s").fail(f"is {kind:g}, and states of motion are 0 to {len(STATES) - 1}")
        if STATES[int(kind)] == "pocketed":
            continue
        rows = state.at("rvw").parts()
        if len(rows) != 3:
            state.at("rvw").fail(f"has {len(rows)} rows instead of 3")
        position, velocity, spin = (row.numbers(3) for row in rows)
        radius, mass, rest = _parameters(part.at("params"))
        if common is not None and rest != common:
            part.at("params").fail("differ from those of other balls in more than R and m, which carom does not have")
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
    """Radius, mass, and what all balls have to share."""
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
    """Whether the shot begins with the cue: of a System that was simulated, as it was; of another, as pooltool would."""
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
    """Writes a record as a simulated System, whole or not at all, which pooltool 0.6.0 loads, shows and evaluates.

    Between events pooltool computes the motion anew, from the state after each event and the coefficients. Where a record has more
    than that (balls that fly, fall or rest on each other), states in between stand there as transitions, 200 a second. pooltool's
    viewer wants a table of its own layout: pool and snooker tables with 18 cushions and 6 pockets, carom tables with 4. The cue is that
    of the record's scene; its speed is that which gives the ball the same velocity in pooltool. A record from a file has no cue.

    Raises ValueError for a name that does not end in .json and for balls that are not alike, OSError where the file cannot be written.
    """
    name = os.fspath(path)
    if not name.endswith(".json"):
        raise ValueError(f"{name}: a System is saved as .json")
    _system.write(record, name)
