"""A record as a System of pooltool 0.6.0."""

from __future__ import annotations

import json
import tomllib
from typing import TYPE_CHECKING, Any

import numpy as np

from carom._files import whole_file
from carom._record import Record

if TYPE_CHECKING:
    from numpy.typing import NDArray

#: The names of pooltool's motion states, by number.
STATES = ("stationary", "spinning", "sliding", "rolling", "pocketed")
#: Pockets in the order of carom's p1 to p6.
POCKETS = ("lb", "lc", "lt", "rt", "rc", "rb")
#: Seconds between two states while pooltool has no formula for the motion.
_STEP = 0.005
#: How deep a pocket is in pooltool's pictures [m].
_DEPTH = 0.08
_TYPES = {
    "cue_strike": "stick_ball",
    "ball_ball": "ball_ball",
    "ball_ball_hold": "ball_ball",
    "ball_cluster": "ball_ball",
    "ball_cushion": "ball_linear_cushion",
    "ball_cushion_hold": "ball_linear_cushion",
    "ball_jaw": "ball_circular_cushion",
    "ball_jaw_hold": "ball_circular_cushion",
    "ball_pocket": "ball_pocket",
    "slide_roll": "sliding_rolling",
    "roll_spin": "rolling_spinning",
    "roll_stop": "rolling_stationary",
    "spin_stop": "spinning_stationary",
}
_BALLSETS = {
    "pooltool_pocket": {"cue", *map(str, range(1, 16))},
    "billiard": {"white", "yellow", "red"},
}


def write(record: Record, name: str) -> None:
    if np.ptp(record.radii) > 0 or np.ptp(record.masses) > 0:
        raise ValueError(f"{name}: the balls differ in radius or mass; save a record with equal balls")
    writer = _Writer(record)
    if any("side" in jaw for jaw in writer.file["table"]["jaws"]):
        raise ValueError(f"{name}: pooltool has no round walls; save a record without [[table.arc]]")
    text = json.dumps(writer.system(), allow_nan=False)
    with whole_file(name) as file:
        file.write(text.encode())


class _Writer:
    def __init__(self, record: Record) -> None:
        self.record = record
        self.file: dict[str, Any] = json.loads(record._native.text())
        scene = record._scene()
        self.scene: dict[str, Any] = {} if scene is None else tomllib.loads(scene.text())
        self.states_of = {name: number for number, name in enumerate(STATES)}
        self.states_of |= {"falling": 2, "airborne": 2, "out": 4, "colliding": 2}
        self.table = self._table()
        self.balls = [self._ball(i) for i in range(len(record.ids))]
        self.cue = self._cue()
        self.in_pockets: dict[str, list[str]] = {name: [] for name in self.table["pockets"]}

    # Parts without time.

    def _table(self) -> dict[str, Any]:
        table = self.file["table"]
        cushions, jaws, pockets = table["cushions"], table["jaws"], table["pockets"]
        pool = (len(cushions), len(jaws), len(pockets)) == (18, 12, 6)
        carom = (len(cushions), len(jaws), len(pockets)) == (4, 0, 0)
        if pool:  # a facing has one round end, and the numbers are pooltool's
            self.cushion_ids = [str(i + 1) for i in range(18)]
            self.jaw_ids = [f"{i}t" for i in (1, 2, 4, 5, 7, 8, 10, 11, 13, 14, 16, 17)]
            self.pocket_ids = list(POCKETS)
        else:
            self.cushion_ids = ["3", "9", "12", "18"] if carom else [part["id"] for part in cushions]
            self.jaw_ids = [part["id"] for part in jaws]
            self.pocket_ids = [part["id"] for part in pockets]
        ball = float(self.record.radii[0])
        # pooltool.load() explains this height; this is its inverse.
        circular = {
            name: {
                "id": name,
                "center": [*part["center"], ball + (part["height"] - ball) * (ball + part["radius"]) / ball],
                "radius": part["radius"],
            }
            for name, part in zip(self.jaw_ids, jaws)
        }
        linear: dict[str, Any] = {}
        holes: dict[str, Any] = {}
        for name, part in zip(self.cushion_ids, cushions):
            ends = {f"p{i + 1}": [*part[end], part["height"]] for i, end in enumerate(("from", "to"))}
            linear[name] = {"id": name, **ends, "direction": 2}
        for name, part in zip(self.pocket_ids, pockets):
            place = {"center": [*part["center"], 0.0], "radius": part["radius"], "depth": _DEPTH}
            holes[name] = {"id": name, **place, "contains": []}
        return {
            "cushion_segments": {"linear": linear, "circular": circular},
            "pockets": holes,
            "table_type": "snooker" if table["preset"] == "snooker" else "billiard" if carom else "pocket",
            # This is the only table that matches one of pooltool's models.
            "model_descr": {"name": "seven_foot_showood" if table["preset"] == "seven_foot" else "null"},
            "height": 0.708,
            "lights_height": 1.99,
        }

    def _ball(self, ball: int) -> dict[str, Any]:
        """A ball without a state."""
        record, common = self.record, self.file["balls"]
        radius = float(record.radii[ball])
        ballset = next((name for name, ids in _BALLSETS.items() if ids.issuperset(record.ids)), None)
        params = {
            "m": float(record.masses[ball]),
            "R": radius,
            "u_s": common["mu_s"],
            "u_r": common["mu_r"],
            "u_sp_proportionality": common["mu_sp"] / radius,
            "u_b": common["mu_b"],
            "e_b": common["e_b"],
            "e_c": common["e_c"],
            "f_c": common["f_c"],
            "g": self.file["gravity"],
        }
        return {
            "id": record.ids[ball],
            "state": None,
            "params": params,
            "ballset": None if ballset is None else {"name": ballset},
            "initial_orientation": {"pos": [1.0, 1.0, 1.0, 1.0], "sphere": [1.0, 0.0, 0.0, 0.0]},
            "history": {"states": []},
            "history_cts": {"states": []},
        }

    def _cue(self) -> dict[str, Any]:
        # A record without a cue gets one at rest, at the first ball.
        own = self.scene.get("cue", {"speed": 0.0, "aim_deg": 0.0, "elevation_deg": 0.0, "offset": [0.0, 0.0],
                                     "mass": 0.567, "end_mass": 0.0, "restitution": 1.0})
        specs = {
            "brand": "carom",
            "M": own["mass"],
            "length": 1.4732,
            "tip_radius": 0.0106045,
            "shaft_radius_at_tip": 0.0065,
            "shaft_radius_at_butt": 0.02,
            "end_mass": own["end_mass"],
        }
        return {
            "id": "cue_stick",
            # pooltool's tip loses no energy: 2 V0 there is (1 + restitution) speed here.
            "V0": own["speed"] * (1 + own["restitution"]) / 2,
            "phi": own["aim_deg"],
            "theta": own["elevation_deg"],
            "a": own["offset"][0],
            "b": own["offset"][1],
            "cue_ball_id": own.get("ball", self.record.ids[0]),
            "specs": specs,
        }

    # States.

    def _state(self, time: float, rvw: NDArray[np.float64], motion: int) -> dict[str, Any]:
        return {"rvw": rvw.tolist(), "s": self.states_of[self.record.MOTIONS[motion]], "t": time}

    def _states(self, time: float) -> list[dict[str, Any]]:
        """The states of all balls, after everything that happens at that time."""
        rvw, motion = self.record.states(time), self.record.motion(time)
        return [self._state(time, rvw[i], int(motion[i])) for i in range(len(self.balls))]

    def _first(self) -> list[dict[str, Any]]:
        """The states of all balls before the cue strikes."""
        states = self._states(0.0)
        for event in self.record.events[:1]:
            if self.record.EVENT_TYPES[event["type"]] == "cue_strike":
                ball = int(event["a"])
                segment = self.record.segments[ball][0]
                rvw = np.array([segment["r"], segment["v"], segment["w"]])
                states[ball] = self._state(0.0, rvw, int(segment["state"]))
        return states

    # Events.

    def _agent(self, ball: int, before: dict[str, Any], after: dict[str, Any]) -> dict[str, Any]:
        part = self.balls[ball]
        initial, final = part | {"state": before}, part | {"state": after}
        return {"id": part["id"], "agent_type": "ball", "initial": initial, "final": final}

    def _partner(self, kind: str, event: np.void) -> dict[str, Any] | None:
        """The cue, cushion, jaw or pocket that a ball meets; None for a ball."""
        if kind == "stick_ball":
            return {"id": "cue_stick", "agent_type": "cue", "initial": self.cue, "final": None}
        segments = self.table["cushion_segments"]
        if kind in ("ball_linear_cushion", "ball_circular_cushion"):
            shape, ids = ("linear", self.cushion_ids) if "linear" in kind else ("circular", self.jaw_ids)
            part, agent = segments[shape][ids[event["b"]]], f"{shape}_cushion_segment"
            return {"id": part["id"], "agent_type": agent, "initial": part, "final": None}
        if kind == "ball_pocket":
            name = self.pocket_ids[event["b"]]
            part, inside = self.table["pockets"][name], self.in_pockets[name]
            before = part | {"contains": list(inside)}
            inside.append(self.record.ids[event["a"]])
            after = part | {"contains": list(inside)}
            return {"id": name, "agent_type": "pocket", "initial": before, "final": after}
        return None

    def _groups(self, event: np.void, kind: str) -> list[list[int]]:
        """The balls of an event; those of a cluster as pairs."""
        if self.record.EVENT_TYPES[event["type"]] == "ball_cluster":
            first, *others = self.record.clusters[event["detail"]]
            return [[first, other] for other in others]
        return [[int(event["a"]), int(event["b"])]] if kind == "ball_ball" else [[int(event["a"])]]

    def _happenings(self) -> list[tuple[float, str, list[int], np.void | None]]:
        """Time, type and balls of every event, and of every extra state that pooltool needs, in order."""
        listed: list[tuple[float, str, list[int], np.void | None]] = []
        told: set[tuple[float, int]] = set()
        for event in self.record.events:
            kind = _TYPES.get(self.record.EVENT_TYPES[event["type"]])
            if kind is None:  # its new segments show it
                continue
            for balls in self._groups(event, kind):
                listed.append((float(event["time"]), kind, balls, event))
                told.update((float(event["time"]), ball) for ball in balls)
        for ball, times in enumerate(map(self._needed, range(len(self.balls)))):
            listed += [(time, "", [ball], None) for time in times if (time, ball) not in told]
        return sorted(listed, key=lambda happening: happening[0])

    def _needed(self, ball: int) -> list[float]:
        """Times at which pooltool needs a ball's state: at every segment's start, and often while it has no
        formula."""
        times: list[float] = []
        segments = self.record.segments[ball]
        stops = np.append(segments["start"][1:], self.record.duration)
        for segment, stop in zip(segments, stops):
            start = float(segment["start"])
            if not start < stop:
                continue
            motion = self.record.MOTIONS[segment["state"]]
            held = segment["held"] and motion in ("sliding", "rolling")
            foreign = motion in ("falling", "airborne", "colliding") or held
            count = int(np.ceil((stop - start) / _STEP)) if foreign else 1
            times += [start + k * (float(stop) - start) / count for k in range(count)]
        return [time for time in times if time > 0.0]

    def system(self) -> dict[str, Any]:
        none = [{"id": "dummy", "agent_type": "null", "initial": None, "final": None}]
        events: list[dict[str, Any]] = [{"event_type": "none", "agents": none, "time": 0.0}]
        first = self._first()
        histories: list[list[dict[str, Any]]] = [[state] for state in first]
        for time, kind, balls, event in self._happenings():
            after = self._states(time)
            earlier = first if time == 0.0 else self._states(float(np.nextafter(time, -1.0)))
            before = [state | {"t": time} for state in earlier]
            if not kind:  # pooltool has no such event: use the one that ends in this state
                ends = {0: "rolling_stationary", 1: "rolling_spinning"}
                kind = ends.get(after[balls[0]]["s"], "sliding_rolling")
            agents = [self._agent(ball, before[ball], after[ball]) for ball in balls]
            partner = None if event is None else self._partner(kind, event)
            if partner is not None:
                agents.insert(0 if kind == "stick_ball" else 1, partner)
            events.append({"event_type": kind, "agents": agents, "time": time})
            # pooltool keeps all balls at each of its events; other times are kept for their own ball only.
            for ball in balls if event is None else range(len(after)):
                histories[ball].append(after[ball])
        # pooltool 0.6.0 fails an assertion if the end is a multiple of its frame time, as in a run that was
        # cut off.
        end = self.record.duration + (0.0 if self.record.stopped == "at_rest" else 1e-9)
        last = self._states(end)
        events.append({"event_type": "none", "agents": none, "time": end})
        for name, inside in self.in_pockets.items():
            self.table["pockets"][name] = self.table["pockets"][name] | {"contains": inside}
        ended = {
            ball["id"]: ball | {"state": state, "history": {"states": [*history, state]}}
            for ball, state, history in zip(self.balls, last, histories)
        }
        return {"cue": self.cue, "table": self.table, "balls": ended, "t": end, "events": events}
