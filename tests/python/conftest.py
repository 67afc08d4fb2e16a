"""Where the repository and the program are. The package is the one that Python finds: tests/python/CMakeLists.txt points PYTHONPATH
at the build, and an installed wheel is tested without it."""

from __future__ import annotations

import csv
import os
import pathlib
import subprocess

import pytest

# Pictures without a display, and without the backend of whoever runs the tests.
os.environ["MPLBACKEND"] = "Agg"
SOURCE = pathlib.Path(os.environ.get("CAROM_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2]))
SCENES = sorted((SOURCE / "scenes").glob("*.toml"))
#: Whether tests that take minutes run, too: CAROM_SLOW_TESTS=1.
SLOW = os.environ.get("CAROM_SLOW_TESTS") == "1"
#: What takes so many seconds hangs: far above what a busy machine needs, for no test may fail because others work there.
HANGS = 600.0
BAD_SCENES = sorted((SOURCE / "tests/data/bad_scenes").glob("*.toml"))


def carom_program(*arguments: object, text: str | None = None, binary: bool = False):
    """What the program prints. Its own tests are elsewhere; here it is what Python has to agree with."""
    program = os.environ.get("CAROM_PROGRAM", SOURCE / "build/release/carom")
    return subprocess.run(
        [program, *map(str, arguments)], check=True, capture_output=True, text=not binary, input=text).stdout


def rows_of(path):
    """The rows of a CSV file, the header first."""
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.reader(file))


def not_printed(wanted, output):
    """The first line of a page's text block that does not appear in its place in the output, or "". "..." stands for any lines, and at the end
    of a line for the rest of it."""
    lines = output.splitlines()
    for line in wanted.splitlines():
        if line == "...":
            continue
        start = line.removesuffix("...")
        while lines and not (lines[0].startswith(start) if line.endswith("...") else lines[0] == line):
            lines.pop(0)
        if not lines:
            return line or "(an empty line)"
        lines.pop(0)
    return ""


def refused(error, call, *cases):
    """Every case of (arguments, message): keywords of `call` in a mapping, or one argument, or a call of its own where `call` is None."""
    for given, message in cases:
        with pytest.raises(error, match=message):
            if call is None:
                given()
            elif isinstance(given, dict):
                call(**given)
            else:
                call(given)


def stuck_scene(speed):
    """Balls of different mass that come to rest against each other, for which there is no model, if the first one moves to the right."""
    import carom

    balls = [
        {"id": "a", "position": [0, 0], "velocity": [speed, 0]},
        {"id": "b", "position": [0.2, 0], "mass": 0.34}]
    return carom.Scene(
        table={"cushion": []}, balls={"mu_b": 0, "e_b": 0}, physics={"clusters": "sequential"}, ball=balls)


def program_sweep(folder, scene, rules, count, seed):
    """The header and the rows of `carom sweep`."""
    words = [word for rule in rules for word in ("--vary", rule)]
    carom_program("sweep", scene, *words, "--count", count, "--seed", seed, "-o", folder / "s.csv")
    header, *rows = rows_of(folder / "s.csv")
    return header, rows


@pytest.fixture
def draw_scene():
    import carom

    return carom.Scene.load(SOURCE / "scenes/draw.toml")


@pytest.fixture
def break_scene():
    import carom

    return carom.Scene.load(SOURCE / "scenes/eight_ball_break.toml")
