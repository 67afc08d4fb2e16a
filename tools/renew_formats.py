#!/usr/bin/env python3
"""Writes the program's descriptions of its file formats and command line into docs/reference.

The program contains scene_format.md as of its build, and adds its tables; so build it after every change of
that page.

    cmake --build --preset release --target carom_program
    tools/renew_formats.py [BUILD_FOLDER]
"""
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
PROGRAM = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build/release") / "carom"
PAGES = {"command-line": "command_line.md", "scene-schema": "scene.schema.json",
         "record-schema": "record.schema.json", "scene-format": "scene_format.md", "types": "types.md"}
TYPES = ROOT / "python/carom/_types.py"
MARKED = re.compile(r"(?ms)^ *(#|//) begin (\w+)\n.*?^ *\1 end \2\n")


def printed_by(what):
    return subprocess.run([PROGRAM, "describe", what], check=True, capture_output=True, text=True).stdout


for what, name in PAGES.items():
    path = ROOT / "docs/reference" / name
    printed = printed_by(what)
    if printed == path.read_text():
        continue
    # Otherwise a change that is not built in yet would be lost.
    if name == "scene_format.md" and path.stat().st_mtime > PROGRAM.stat().st_mtime:
        sys.exit(
            f"renew_formats: {path.relative_to(ROOT)} is newer than {PROGRAM}; build carom_program first")
    path.write_text(printed)

# Between the marks; the methods of a class follow them. A new class is appended.
for what, *paths in (("types-python", TYPES, ROOT / "python/carom/_simulate.py"),
                     ("types-typescript", ROOT / "web/npm/index.d.ts")):
    fresh = {block[2]: block[0] for block in MARKED.finditer(printed_by(what))}
    for path in paths:
        path.write_text(MARKED.sub(lambda old: fresh.pop(old[2], old[0]), path.read_text()))
    TYPES.write_text(TYPES.read_text() + "".join(f"\n\n{block}" for block in fresh.values()))
