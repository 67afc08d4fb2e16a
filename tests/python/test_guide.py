"""The Python blocks in the docs print what the pages say, and pass a strict type check."""

from __future__ import annotations

import contextlib
import io
import os
import re
import runpy
import subprocess
import sys

import pytest
from conftest import SOURCE, carom_program, not_printed, rows_of

BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
PAGES = [
    page for page in [SOURCE / "README.md", *sorted(SOURCE.glob("docs/**/*.md"))]
    if "```python\n" in page.read_text()]


def blocks(page):
    """Python blocks, each with its expected output: the text block right after it, or None."""
    found = list(BLOCK.finditer(page.read_text()))
    for block, following in zip(found, [*found[1:], None]):
        if block[1] == "python":
            text = page.read_text()
            close = following is not None and following[1] == "text"
            close = close and text[block.end() : following.start()].strip() == ""
            yield block[2], following[2] if close else None


def test_there_are_pages():
    assert [page.name for page in PAGES] == [
        "README.md", "clusters.md", "games.md", "learning.md", "player.md", "python.md",
        "teaching.md"]


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.stem)
def test_blocks_print_the_output_on_the_page(page, tmp_path, monkeypatch):
    pytest.importorskip("pandas")
    pyplot = pytest.importorskip("matplotlib.pyplot")
    for package in ("gymnasium", "pettingzoo") if "carom.gym" in page.read_text() else ():
        pytest.importorskip(package, reason=f"{package} is not installed: pip install {package}")
    for name in ("scenes", "tests", "examples"):
        (tmp_path / name).symlink_to(SOURCE / name)
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    for code, wanted in blocks(page):
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(compile(code, page.name, "exec"), names)
        assert not not_printed(wanted or "", printed.getvalue()), printed.getvalue()
    pyplot.close("all")


def test_the_example_plays_its_described_shot(tmp_path):
    example = runpy.run_path(str(SOURCE / "examples/python/shot.py"))
    (tmp_path / "cut.toml").write_text(example["cut_shot"]().text())
    carom_program("simulate", tmp_path / "cut.toml", "--events", tmp_path / "e.csv")
    printed = subprocess.run([sys.executable, SOURCE / "examples/python/shot.py"], capture_output=True,
                             text=True, check=True).stdout.splitlines()
    rows = rows_of(tmp_path / "e.csv")[1:]
    assert [line.split() for line in printed[: len(rows)]] == [
        f"{float(t):.6f} s {kind} {a} {b}".split() for t, kind, a, b, *_ in rows]
    assert re.fullmatch(r"aim at \d+\.\d+ degrees to pot ball 1; 0\.\d+ degrees wide", printed[-1])


def test_blocks_and_examples_pass_a_strict_type_check(tmp_path):
    for package in ("mypy", "matplotlib", "gymnasium", "pettingzoo"):
        pytest.importorskip(package)
    files = sorted((SOURCE / "examples").glob("*/*.py"))
    for page in PAGES:
        files.append(tmp_path / f"{page.stem}_page.py")
        files[-1].write_text("".join(code for code, _ in blocks(page)))
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--follow-imports=silent", "--config-file", "/dev/null",
         "--cache-dir", os.environ.get("CAROM_MYPY_CACHE", tmp_path / "cache"), *files],
        capture_output=True,
        text=True,
        env=os.environ | {"MYPYPATH": os.environ.get("PYTHONPATH", "")},
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
