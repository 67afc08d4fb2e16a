"""carom from Python by ctypes: states are (3, 3) arrays of rows position, velocity, angular velocity ("rvw", as pooltool
has them), so that its balls go in and out as they are.

    python3 carom_rvw.py            # finds libcarom.so where the loader finds it (LD_LIBRARY_PATH)
"""

import ctypes
from ctypes import POINTER, byref, c_char, c_char_p, c_double, c_int32, c_size_t, c_void_p

import numpy as np

lib = ctypes.CDLL("libcarom.so.0.1")


class ImpactParams(ctypes.Structure):
    _fields_ = [(name, c_double) for name in ("R", "m", "mu_s1", "mu_s2", "mu_b", "e_b")]


class Cue(ctypes.Structure):
    """The defaults are those of a scene file."""

    _fields_ = [(name, c_double) for name in ("speed", "aim_deg", "elevation_deg", "side", "height", "mass", "end_mass", "restitution")]

    def __init__(self, **values):
        lib.carom_cue_init(byref(self))
        super().__init__(**values)


class Event(ctypes.Structure):
    _fields_ = [("time", c_double), ("type", c_char_p), ("a", c_char_p), ("b", c_char * 72)]


doubles = POINTER(c_double)
lib.carom_last_error.restype = c_char_p
lib.carom_collide_balls.argtypes = [doubles, doubles, POINTER(ImpactParams), c_double, doubles, doubles]
lib.carom_collide_balls_batch.argtypes = [c_size_t, doubles, doubles, POINTER(ImpactParams), c_size_t, c_double, doubles,
                                          doubles, POINTER(c_int32)]
lib.carom_scene_create.argtypes = [c_char_p, c_char_p, POINTER(c_void_p)]
lib.carom_scene_free.argtypes = [c_void_p]
lib.carom_scene_set_ball.argtypes = [c_void_p, c_char_p, doubles]
lib.carom_scene_set_cue.argtypes = [c_void_p, c_char_p, POINTER(Cue)]
lib.carom_cue_init.argtypes = [POINTER(Cue)]
lib.carom_simulate.argtypes = [c_void_p, c_double, POINTER(c_void_p)]
lib.carom_record_free.argtypes = [c_void_p]
lib.carom_record_duration.argtypes = [c_void_p]
lib.carom_record_duration.restype = c_double
lib.carom_record_event_count.argtypes = [c_void_p]
lib.carom_record_event_count.restype = c_size_t
lib.carom_record_event.argtypes = [c_void_p, c_size_t, POINTER(Event)]
lib.carom_record_state.argtypes = [c_void_p, c_size_t, c_double, doubles, POINTER(c_char_p)]


def check(status):
    if status != 0:
        raise ValueError(lib.carom_last_error().decode())


def pointer(array):
    return array.ctypes.data_as(doubles)


def states(rvw):
    """A copy that ctypes can hand on: float64, row by row."""
    return np.array(rvw, dtype=np.float64, order="C")


def collide(rvw1, rvw2, params, tolerance=1e-6):
    """Two (3, 3) states, or two (n, 3, 3) arrays of them; gives them after the impact, in the same shape."""
    out1, out2 = states(rvw1), states(rvw2)
    if out1.shape != out2.shape or out1.shape[-2:] != (3, 3):
        raise ValueError(f"expected two arrays (3, 3) or (n, 3, 3), not {out1.shape} and {out2.shape}")
    if out1.ndim == 2:
        check(lib.carom_collide_balls(pointer(out1), pointer(out2), byref(params), tolerance, pointer(out1), pointer(out2)))
    else:
        check(lib.carom_collide_balls_batch(len(out1), pointer(out1), pointer(out2), byref(params), 1, tolerance,
                                            pointer(out1), pointer(out2), None))
    return out1, out2


def simulate(balls, cue=None, struck="cue", table="nine_foot", kind="pool", times=()):
    """Runs the shot of `balls`, {id: rvw}, to its end. Gives its events, the states at the end, {id: rvw}, and those at
    `times`, {id: (len(times), 3, 3)}."""
    scene, record = c_void_p(), c_void_p()
    check(lib.carom_scene_create(table.encode(), kind.encode(), byref(scene)))
    try:
        for name, rvw in balls.items():
            check(lib.carom_scene_set_ball(scene, name.encode(), pointer(states(rvw))))
        if cue is not None:
            check(lib.carom_scene_set_cue(scene, struck.encode(), byref(cue)))
        check(lib.carom_simulate(scene, -1.0, byref(record)))
    finally:
        lib.carom_scene_free(scene)
    try:
        events = []
        for i in range(lib.carom_record_event_count(record)):
            event = Event()
            check(lib.carom_record_event(record, i, byref(event)))
            events.append((event.time, event.type.decode(), event.a.decode(), event.b.decode()))
        end, sampled = {}, {}
        for i, name in enumerate(balls):
            rows = np.empty((len(times) + 1, 3, 3))
            for k, t in enumerate([*times, lib.carom_record_duration(record)]):
                check(lib.carom_record_state(record, i, t, pointer(rows[k]), None))
            end[name], sampled[name] = rows[-1], rows[:-1]
        return events, end, sampled
    finally:
        lib.carom_record_free(record)


def main():
    radius = 0.028575
    params = ImpactParams(R=radius, m=0.17, mu_s1=0.2, mu_s2=0.2, mu_b=0.05, e_b=0.95)
    cue = np.array([[0, 0, radius], [0, 1.0, 0], [-35.0, 0, 0]])
    one = np.array([[radius, 0.0494933, radius], [0, 0, 0], [0, 0, 0]])
    _, after = collide(cue, one, params)
    print("object ball after the impact\n", after)
    many = collide(np.repeat(cue[None], 1000, axis=0), np.repeat(one[None], 1000, axis=0), params)[1]
    assert np.allclose(many, after, atol=2e-6), "a batch keeps the same bound"

    balls = {"cue": [[0.635, 0.60, radius], [0, 0, 0], [0, 0, 0]], "1": [[0.65, 1.40, radius], [0, 0, 0], [0, 0, 0]]}
    events, end, sampled = simulate(balls, Cue(speed=3.0, aim_deg=90.0, side=0.1, height=0.0), times=[0.0, 0.25, 0.5])
    for time, kind, a, b in events:
        print(f"{time:9.6f} s  {kind:<14} {a} {b}")
    print("cue ball at the end\n", end["cue"])
    assert np.array_equal(sampled["1"][0], balls["1"]), "states at 0 s are those that went in"
    try:
        simulate({"cue": balls["cue"], "1": [[0.635, 0.61, radius], [0, 0, 0], [0, 0, 0]]})
    except ValueError as error:
        print("refused:", error)


if __name__ == "__main__":
    main()
