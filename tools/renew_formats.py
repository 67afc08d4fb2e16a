#!/usr/bin/env python3
"""Writes anew what docs/ says about file formats and the command line from the program's own tables:
docs/reference/command_line.md, docs/reference/scene.schema.json, docs/reference/record.schema.json, and the tables of docs/reference/scene_format.md between the marks <!-- begin NAME --> and <!-- end NAME -->.

    cmake --build --preset release --target carom_program
    tools/renew_formats.py [BUILD_FOLDER]
"""
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
PROGRAM = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build/release") / "carom"


def describe(what):
    return subprocess.run([PROGRAM, "describe", what], check=True, capture_output=True, text=True).stdout


def main():
    (ROOT / "docs/reference/command_line.md").write_text(describe("command-line"))
    (ROOT / "docs/reference/scene.schema.json").write_text(describe("scene-schema"))

    (ROOT / "docs/reference/record.schema.json").write_text(describe("record-schema"))

    path = ROOT / "docs/reference/scene_format.md"
    page = path.read_text()
    for block, name in re.findall(r"(<!-- begin (\w+) -->.*?<!-- end \2 -->)", describe("scene-format"), re.S):
        page, found = re.subn(rf"<!-- begin {name} -->.*?<!-- end {name} -->", lambda _: block, page, flags=re.S)
        if found != 1:
            sys.exit(f"renew_formats: docs/reference/scene_format.md has the marks of {name} {found} times")
    path.write_text(page)


main()
