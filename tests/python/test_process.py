"""The package in a process: imports, Ctrl-C, threads, fork and spawn, constant memory."""

from __future__ import annotations

import concurrent.futures
import gc
import multiprocessing
import os
import resource
import signal
import subprocess
import sys
import threading
import time

import carom
import numpy as np
import pytest
from conftest import HANGS, SOURCE

# A ball that rolls for ever between ideal cushions: only a limit or a signal ends it.
PERPETUAL = """
import carom
ideal = {"mu_s": 0, "mu_r": 0, "mu_sp": 0, "mu_b": 0, "e_b": 1, "e_c": 1, "f_c": 0}
scene = carom.Scene(balls=ideal, physics={"cushion": "smooth"}, table="carom",
                    ball=[{"id": "cue", "velocity": [3, 4]}], stop={"time": 1e6})
"""


def run(code, **options):
    return subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options)


@pytest.mark.parametrize(
    "call",
    [
        "carom.simulate(scene)",
        "carom.simulate_many(scene.replace(stop={'time': 20.0}), shots=10**8 // 5, threads=2, out=None)",
    ],
)
def test_ctrl_c_ends_a_long_call(call):
    call = call.replace("10**8 // 5", "2_000_000")
    process = run(
        PERPETUAL
        + f"""
print("ready", flush=True)
try:
    {call}
except KeyboardInterrupt:
    print("interrupted", flush=True)
print(carom.simulate(scene, until=1.0).stopped)
"""
    )
    assert process.stdout.readline() == "ready\n"
    time.sleep(0.3)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=HANGS)
    assert out == "interrupted\ntime\n", err
    assert process.returncode == 0


def test_nothing_heavy_is_imported():
    news = "print(*sorted(set(sys.modules) - before))"
    code = f"import sys, numpy; before = set(sys.modules); import carom; {news}"
    out, err = run(code).communicate(timeout=HANGS)
    new = {name.split(".")[0] for name in out.split()}
    heavy = {"asyncio", "csv", "email", "inspect", "matplotlib", "multiprocessing", "pandas", "pyarrow",
             "subprocess", "tempfile", "tomllib"}
    assert "carom" in new and not new & heavy, (new, err)


def test_python_threads_play_in_parallel(break_scene):
    hashes = set()
    record = carom.simulate(break_scene)
    times = np.linspace(0, record.duration, 200)
    wanted, turned = record.states(times), record.orientations(times)
    alone = carom.simulate_many(break_scene, shots=20, hashes=True)

    def work(_):
        assert (record.states(times) == wanted).all() and (record.orientations(times) == turned).all()
        assert (carom.simulate_many(break_scene, shots=20, hashes=True, threads=2).hash == alone.hash).all()
        hashes.add(carom.simulate(break_scene).hash())

    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        list(pool.map(work, range(12)))
    assert hashes == {record.hash()}


def test_the_gil_is_released_during_play(break_scene):
    beats, done = [], threading.Event()

    def beat():
        while not done.wait(0.001):
            beats.append(1)

    beside = threading.Thread(target=beat)
    beside.start()
    shots = carom.simulate_many(break_scene, shots=1500)
    done.set()
    beside.join()
    assert (shots.status == 0).all()
    assert len(beats) > 5


def _hash(scene):
    return carom.simulate(scene).hash()


@pytest.mark.parametrize("method", ["spawn", "fork"])
def test_scenes_can_be_sent_to_processes(draw_scene, method):
    scenes = [draw_scene.replace(**{"cue.speed": v}) for v in (2.0, 3.0)]
    context = multiprocessing.get_context(method)
    with concurrent.futures.ProcessPoolExecutor(2, mp_context=context) as pool:
        assert list(pool.map(_hash, scenes)) == [_hash(s) for s in scenes]
        assert [record.hash() for record in pool.map(carom.simulate, scenes)] == [_hash(s) for s in scenes]


def test_a_forked_child_plays_after_threads_have_run(draw_scene):
    wanted = int(carom.simulate_many(draw_scene, shots=100, threads=2, hashes=True).hash[0])
    child = os.fork()
    if child == 0:
        again = carom.simulate_many(draw_scene, shots=100, threads=2, hashes=True)
        os._exit(0 if int(again.hash[0]) == wanted else 1)
    assert os.waitpid(child, 0)[1] == 0


def resident():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * resource.getpagesize()


def test_many_records_leak_no_memory(draw_scene):
    # CAROM_RECORDS=1000000 was required for a release; the suite runs part of it.
    count = int(os.environ.get("CAROM_RECORDS", 20_000))
    broken = carom.Scene(ball=[{"id": "a"}])
    kept = []

    def play(n):
        for i in range(n):
            record = carom.simulate(draw_scene, max_events=20)
            record.events, record.segments, record.states(0.1), record.orientations(0.1), record.hash()
            if i % 100 == 0:
                kept[:] = [record.events]
                with pytest.raises(carom.SceneError):
                    broken.replace(**{"cue.speed": 1})

    play(count // 4)
    gc.collect()
    before = resident()
    play(count)
    gc.collect()
    assert resident() - before < 8e6


def test_the_environments_instruction_set_is_used_or_refused(draw_scene, monkeypatch):
    wanted = carom.simulate(draw_scene).hash()
    monkeypatch.setenv("CAROM_ISA", "scalar")
    assert carom.simulate(draw_scene).hash() == wanted
    monkeypatch.setenv("CAROM_ISA", "v9")
    with pytest.raises(ValueError, match="v9"):
        carom.simulate(draw_scene)


def test_the_version_matches_the_program():
    from conftest import carom_program

    assert carom.__version__ in carom_program("--version")
    assert SOURCE.joinpath("CMakeLists.txt").read_text().count(f"VERSION {carom.__version__}") == 1


def test_everything_public_is_documented():
    undocumented = []
    for name in carom.__all__:
        thing = getattr(carom, name)
        if name.startswith("__"):
            continue
        members = [
            m for n, m in vars(thing).items() if not n.startswith("_")] if isinstance(thing, type) else []
        if not thing.__doc__:
            undocumented.append(name)
        for member in members:
            member = getattr(member, "__func__", member)
            if (callable(member) or isinstance(member, property)) and not member.__doc__:
                undocumented.append(f"{name}: {member}")
    for module in (carom.games, carom.kernel, carom.plot, carom.scenes, carom.sweep):
        undocumented += [
            f"{module.__name__}.{name}" for name in module.__all__ if not getattr(module, name).__doc__]
    assert not undocumented
