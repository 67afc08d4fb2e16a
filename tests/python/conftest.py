"""Paths of the repository and the program.

Tests the package that Python finds: tests/python/CMakeLists.txt sets PYTHONPATH to the build; without it, an
installed wheel is tested.
"""

from __future__ import annotations

import csv
import os
import pathlib
import signal
import subprocess

import pytest

# Draw without a display, whatever backend the user has configured.
os.environ["MPLBACKEND"] = "Agg"
# Programs that the tests start stop at Ctrl-C, even if these tests run in the background, which ignores it.
signal.signal(signal.SIGINT, signal.default_int_handler)
SOURCE = pathlib.Path(os.environ.get("CAROM_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2]))
SCENES = sorted((SOURCE / "scenes").glob("*.toml"))
#: CAROM_SLOW_TESTS=1 also runs the tests that take minutes.
SLOW = os.environ.get("CAROM_SLOW_TESTS") == "1"
#: Anything that runs for this many seconds hangs. Far more than a busy machine needs: load must not fail a
#: test.
HANGS = 600.0
BAD_SCENES = sorted((SOURCE / "tests/data/bad_scenes").glob("*.toml"))


def carom_program(*arguments: object, text: str | None = None, binary: bool = False):
    """The program's output, which Python must match; other tests check the program."""
    program = os.environ.get("CAROM_PROGRAM", SOURCE / "build/release/carom")
    return subprocess.run(
        [program, *map(str, arguments)], check=True, capture_output=True, text=not binary, input=text).stdout


def rows_of(path):
    """The rows of a CSV file, the header first."""
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.reader(file))


def not_printed(wanted, output):
    """The first line of a page's text block that the output lacks, or "".

    "..." on its own stands for any lines, and at the end of a line for the rest of that line.
    """
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
    """Checks every case (arguments, message): a mapping of keywords, a single argument, or without `call` a
    function to call."""
    for given, message in cases:
        with pytest.raises(error, match=message):
            if call is None:
                given()
            elif isinstance(given, dict):
                call(**given)
            else:
                call(given)


def stuck_scene(e_t):
    """With e_t = 0.9999999 ball a does not stop bouncing: its run ends at the limit of events."""
    import carom

    balls = [{"id": "a", "position": [0, 0], "height": 0.1}, {"id": "b", "position": [0.2, 0]}]
    return carom.Scene(table={"cushion": []}, balls={"e_t": e_t}, ball=balls)


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
