"""The program `carom`, which comes with the package: the command, and its reports as data."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Sequence
from typing import Any, NoReturn

import numpy as np

from carom._arguments import checked
from carom._scene import SceneLike, as_scene

_PROGRAM = os.path.join(os.path.dirname(__file__), "bin", "carom")


def main() -> NoReturn:
    """The command `carom`."""
    os.execv(_PROGRAM, ["carom", *sys.argv[1:]])


def _column(values: list[str]) -> Any:
    try:
        return np.array(values, np.float64)
    except ValueError:
        return values


def _run(command: Sequence[str], folder: str) -> str:
    """The program's output, run in a folder whose name is removed from its messages."""
    import subprocess  # here, like csv and tempfile, so that `import carom` stays fast

    done = subprocess.run([_PROGRAM, *command], cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode == 2:
        raise ValueError(done.stderr.strip().replace(f"{folder}{os.sep}", ""))
    if done.returncode != 0:
        raise RuntimeError(done.stderr.strip() or f"carom ended with exit status {done.returncode}")
    return done.stdout


def _write(path: str, text: str) -> None:
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


def _report(arguments: Sequence[str], scene: SceneLike, table: bool) -> dict[str, Any]:
    """Runs a command with --json, and if `table` is set with --csv, whose columns are then under "table"."""
    import csv
    import tempfile

    with tempfile.TemporaryDirectory(prefix="carom-") as folder:
        command = [*arguments, "--json"]
        _write(os.path.join(folder, "scene.toml"), as_scene(scene).source)
        command.append("scene.toml")
        rows = os.path.join(folder, "table.csv")
        if table:
            command += ["--csv", rows]
        result: dict[str, Any] = json.loads(_run(command, folder))
        if table:
            with open(rows, encoding="utf-8", newline="") as file:
                header, *lines = csv.reader(file)
            result["table"] = {name: _column([line[k] for line in lines]) for k, name in enumerate(header)}
        return result


@checked
def margin(
    scene: SceneLike, *, runs: int = 5, fps: float | None = None, size: tuple[int, int] | None = None,
    render: bool = True, backend: str = "auto",
) -> dict[str, Any]:
    """Compares the cost of every frame of a shot with 1/fps: the report of `carom margin` as data.

    See docs/guide/margin.md.

    runs: every frame is measured this often; its median counts
    fps, size: from the scene's [render] section if they are left out
    render: also draw, read back, encode and write the frames
    backend: "osmesa", "egl", or "auto": OSMesa if it is installed, else EGL

    Returns the keys of `carom margin --json`, times in ms, and "table": for every column an array with one
    number per frame. Times are wall-clock times, so other load on the machine is included. Raises ValueError
    for bad input, and RuntimeError if nothing can draw.
    """
    options = ["margin", "--repeat", str(runs), "--gl", backend]
    if not render:
        options.append("--no-render")
    if fps is not None:
        options += ["--fps", repr(float(fps))]
    if size is not None:
        options += ["--size", f"{size[0]}x{size[1]}"]
    return _report(options, scene, table=True)


@checked
def sensitivity(
    scene: SceneLike, *, hand: str = "aim=0.2,speed=3%,tip=0.02", shots: int = 1000, seed: int = 1
) -> dict[str, Any]:
    """The effect of small errors of aim, speed, tip and position on a shot: the report of `carom sensitivity`
    as data (docs/guide/find.md).

    hand: standard deviations of the errors, as in the command
    shots: played with these errors
    seed: of the errors

    Returns the keys of `carom sensitivity --json`. Raises ValueError for bad input or a scene without a cue,
    and RuntimeError for a shot without derivatives.
    """
    options = ["sensitivity", "--hand", hand, "--shots", str(int(shots)), "--seed", str(int(seed))]
    return _report(options, scene, table=False)


@checked
def accuracy(
    scene: SceneLike,
    *,
    target: float | None = None,
    march: Sequence[int] | None = None,
    tolerances: Sequence[float] | None = None,
    runs: int = 5,
) -> dict[str, Any]:
    """Measures the cost of accuracy: the report of `carom accuracy` as data (docs/guide/accuracy.md).

    target: the error allowed at the end [m], on which the recommendation is based
    march, tolerances: the settings to compare
    runs: interleaved rounds, over which minimum, median and maximum are taken

    Returns the keys of `carom accuracy --json`, "rows" and more. Raises ValueError for bad input.
    """
    options = ["accuracy", "--repeat", str(runs)]
    if target is not None:
        options += ["--target", repr(float(target))]
    if march is not None:
        options += ["--march", ",".join(str(int(n)) for n in march)]
    if tolerances is not None:
        options += ["--tolerance", ",".join(repr(float(e)) for e in tolerances)]
    return _report(options, scene, table=False)
