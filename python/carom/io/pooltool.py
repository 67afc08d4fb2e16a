"""pooltool's files, both ways: the System of pooltool 0.6.0 as JSON, and read as MessagePack.

`load` returns the scene that a System plays, with pooltool's models. `save` writes a record so that pooltool
plays it. Neither needs pooltool. lab/notes/2026-11-pooltool.md measures the agreement.
"""

from __future__ import annotations

import os
from typing import Any

from carom._arguments import checked
from carom._record import Record
from carom._scene import Scene
from carom.io import _system
from carom.io._system import POCKETS, STATES
from carom.io._tree import Tree, read_tree

__all__ = ["load", "save", "table"]

#: The friction between balls in pooltool, a + b exp(-c u). It belongs to pooltool's models, not to its files.
FRICTION = (0.009951, 0.108, 1.088)


@checked
def load(path: str | os.PathLike[str]) -> Scene:
    """The scene of a System at its start; of a simulated System, the scene that was simulated.

    The models are pooltool's defaults that carom has: `inelastic` impacts of balls with the
    friction of Alciatore's TP A.14, `stronge` cushions and jaws, `sequential` clusters, `pocket = "at_once"`,
    `vertical = "drop"`, and a cue without losses. Two of pooltool's formulas differ: it limits the friction
    between balls by a normal impulse of e v m instead of (1 + e) v m/2, and it takes the normal of a jaw from
    the centre of the jaw's circle. Friction and the heights of jaws are scaled so that impacts agree.
    Pocketed balls are left out. Cushions, jaws and pockets are named c1, ..., j1, ..., p1, ... in pooltool's
    order.

    Raises SceneError if the file is not such a System, or if carom refuses its contents.
    """
    name = os.fspath(path)
    root = read_tree(name)
    balls = _balls(root)
    tree = {"table": _table(root.at("table"), balls), **balls}
    cue = _cue(root)
    if cue is not None:
        tree["cue"] = cue
    return Scene.from_dict(tree, name)


#: Measures of pooltool's table specifications, and their places in carom.
_SPECS = {"width": "mouth", "angle": "angle_deg", "radius": "radius"}


@checked
def table(specs: dict[str, Any]) -> dict[str, Any]:
    """The section [table] of a scene for a table specification of pooltool: the attributes of its
    PocketTableSpecs, SnookerTableSpecs or BilliardTableSpecs as a dict, such as `attrs.asdict(specs)`. The
    facings of side pockets end according to their angle; in pooltool they end up to 0.1 mm beside that.

    Raises SceneError if a measure is missing or is not a number.
    """
    root = Tree("specification", specs)

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


def _table(table: Tree, balls: dict[str, Any]) -> dict[str, Any]:
    cushions, jaws = [], []
    ball_radius = balls["ball"][0].get("radius", balls["balls"].get("radius"))
    segments = table.at("cushion_segments")
    for _, part in segments.at("linear").items():
        (x1, y1, height), (x2, y2, _) = part.at("p1").numbers(3), part.at("p2").numbers(3)
        cushions.append({"from": [x1, y1], "to": [x2, y2], "height": height})
    for _, part in segments.at("circular").items():
        (x, y, height), radius = part.at("center").numbers(3), part.at("radius").number()
        if not ball_radius + radius > 0.0:
            part.at("radius").fail("is not the radius of a jaw")
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


def _balls(root: Tree) -> dict[str, Any]:
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


def _parameters(params: Tree) -> tuple[float, float, dict[str, dict[str, Any]]]:
    """Radius, mass, and the parameters that all balls must share."""
    radius = params.at("R").number()
    restitution = params.at("e_b").number()
    if not 0.0 <= restitution <= 1.0:
        params.at("e_b").fail("is not between 0 and 1")
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


def _struck(root: Tree) -> bool:
    """Whether the shot begins with the cue: in a simulated System, whether it did; otherwise, whether it
    would."""
    events = [event.at("event_type").text() for event in root.at("events").parts()]
    if events:
        return "stick_ball" in events
    moves = any(part.at("state").at("s").number() in (1, 2, 3) for _, part in root.at("balls").items())
    return not moves and root.at("cue").at("V0").number() > 0


def _cue(root: Tree) -> dict[str, Any] | None:
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
    cushions. The cue is from the record's scene, with the speed that gives the ball the same velocity in
    pooltool. A record loaded from a file has no cue.

    Raises ValueError if the name does not end in .json, the balls differ in size or mass, or the table has
    arcs, and OSError if the file cannot be written.
    """
    name = os.fspath(path)
    if not name.endswith(".json"):
        raise ValueError(f"{name}: a System is saved as .json; use a name that ends in .json")
    _system.write(record, name)
