"""Files that claim to be pooltool's: the only exception is SceneError, and memory is bounded by the file's
size."""

from __future__ import annotations

import copy
import json
import os
import random
import subprocess
import sys
import time

import carom
import pytest
from carom.io import pooltool
from conftest import SOURCE

SYSTEMS = SOURCE / "tests/data/pooltool"
#: Seconds for which the random files are made. 600 before a release.
SECONDS = float(os.environ.get("CAROM_FUZZ_SECONDS", "2"))


def refused(path, message=""):
    with pytest.raises(carom.SceneError, match=message) as caught:
        pooltool.load(path)
    assert caught.value.file == str(path)


def array(msgpack, shape, data=b"", kind="<f8"):
    return msgpack.packb({b"nd": True, b"type": kind, b"kind": b"", b"shape": shape, b"data": data})


@pytest.mark.parametrize("shape", [[20000, 20000, 0], [0], [10**9, 0], [2, 2], [-1], ["1"], [1] * 40])
def test_an_arrays_size_must_match_its_shape(shape, tmp_path):
    msgpack = pytest.importorskip("msgpack")
    path = tmp_path / "s.msgpack"
    path.write_bytes(array(msgpack, shape, b"" if shape[-1:] == [0] else bytes(8)))
    refused(path, "an array of [0-9]+ numbers with the shape")


KINDS = ["O", "(1000,1000)f8", "f8,f8", "V8", "<U2", "c16", 3, None, {"names": ["a"]}]


@pytest.mark.parametrize("kind", KINDS)
def test_an_array_must_contain_numbers(kind, tmp_path):
    msgpack = pytest.importorskip("msgpack")
    path = tmp_path / "s.msgpack"
    path.write_bytes(array(msgpack, [1], bytes(8), kind))
    refused(path, "an array of type")


@pytest.mark.parametrize("member", [b"\xdd\x00\x01\x00\x00", b"\xdf\x00\x00\x80\x00"], ids=["lists", "maps"])
def test_lists_claiming_to_be_long_use_no_memory(member, tmp_path):
    pytest.importorskip("msgpack")
    pytest.importorskip("resource")
    path = tmp_path / "s.msgpack"
    path.write_bytes(member * 500 + bytes(70000))
    program = """
import resource, sys, carom
from carom.io import pooltool
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
try:
    pooltool.load(sys.argv[1])
except carom.SceneError:
    print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before)
"""
    ran = subprocess.run([sys.executable, "-c", program, path], check=True, capture_output=True, text=True)
    assert int(ran.stdout) < 40000  # KiB; 500 lists of 65536 places would be 256 000


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[" * 100000, "too many nested objects"),
        ('{"a": ' * 100000 + "1" + "}" * 100000, "too many nested objects"),
        ("[" + "9" * 5000 + "]", "a number that is too long"),
        ('{"balls": "\\ud800"}', "half of a surrogate pair"),
        ("\ufeff{}", "is not JSON"),
        ("", "is not JSON"),
    ],
)
def test_json_refused_by_python_is_refused(text, message, tmp_path):
    path = tmp_path / "s.json"
    path.write_text(text, encoding="utf-8")
    refused(path, message)


@pytest.mark.parametrize(
    ("where", "value", "message"),
    [
        ("balls.1.params.R", 10**400, "balls.1.params.R is not a number"),
        ("balls.1.params.e_b", -1, "balls.1.params.e_b is not between 0 and 1"),
        ("balls.1.params.e_b", float("inf"), "balls.1.params.e_b is not a number"),
        ("table.cushion_segments.circular.1t.radius", -0.028575, "radius is not the radius of a jaw"),
        ("balls.1.state.rvw", {}, "balls.1.state.rvw is not a list"),
        ("balls.1", None, "balls.1.state is missing"),
        ("cue.V0", True, "cue.V0 is not a number"),
    ],
)
def test_impossible_values_are_reported(where, value, message, tmp_path):
    system = json.loads((SYSTEMS / "start.json").read_text())
    *way, last = where.split(".")
    part = system
    for key in way:
        part = part[key]
    assert last in part
    part[last] = value
    path = tmp_path / "s.json"
    path.write_text(json.dumps(system))
    refused(path, message)


def test_names_in_messagepack_must_be_strings(tmp_path):
    msgpack = pytest.importorskip("msgpack")
    system = json.loads((SYSTEMS / "start.json").read_text())
    path = tmp_path / "s.msgpack"
    for name in (1, b"1", 1.5, None):
        path.write_bytes(msgpack.packb(system | {"balls": {name: system["balls"]["1"]}}))
        refused(path, "balls has a name that is not a string")


def parts_of(value):
    """All objects and lists of a tree."""
    inside = list(value.values()) if isinstance(value, dict) else value if isinstance(value, list) else None
    return [] if inside is None else [value, *(part for member in inside for part in parts_of(member))]


ODD = (
    None, True, -1, 0, 1.5, 10**400, 2**64, 1e308, float("nan"), float("inf"), "", "x", "\ud800", "\x00",
    "9" * 30, [], {}, [[]])


def spoiled(system, draw):
    """A system with some values, names or members that it should not have."""
    for _ in range(draw.randint(1, 3)):
        part = draw.choice(parts_of(system))
        keys = list(part) if isinstance(part, dict) else list(range(len(part)))
        if not keys:
            continue
        key, how = draw.choice(keys), draw.random()
        if how < 0.2:
            del part[key]
        elif how < 0.3 and isinstance(part, dict):
            part[draw.choice(["", "\ud800", "1" * 30, "t", "x\n"])] = part[key]
        else:
            part[key] = copy.deepcopy(draw.choice(ODD))
    return system


def test_random_files_are_scenes_or_refused(tmp_path):
    msgpack = pytest.importorskip("msgpack")
    texts = [path.read_text() for path in sorted(SYSTEMS.glob("*.json"))]
    ends, draw, seed = time.monotonic() + SECONDS, random.Random(0), 0
    while time.monotonic() < ends or seed < 40:
        seed += 1
        draw.seed(seed)
        system = spoiled(json.loads(draw.choice(texts)), draw)
        kind = draw.choice(["json", "msgpack"])
        if kind == "json":
            data = bytearray(json.dumps(system).encode())
        else:
            try:
                data = bytearray(msgpack.packb(system, unicode_errors="surrogatepass"))
            except OverflowError:
                continue
        if draw.random() < 0.5:
            for _ in range(draw.randint(1, 4)):
                at = draw.randrange(len(data))
                data[at:at + draw.randint(0, 2)] = draw.randbytes(draw.randint(0, 2))
        path = tmp_path / f"s.{kind}"
        path.write_bytes(data)
        try:
            pooltool.load(path)
        except carom.SceneError:
            pass
        except BaseException as error:
            raise AssertionError(f"seed {seed}: {kind}") from error
