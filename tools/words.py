#!/usr/bin/env python3
"""Checks widths and phrases (CONTRIBUTING.md, "House style"); called by tools/lint.

    tools/words.py [FILE ...]     without files: every file of the project that git knows

No line of code or prose is wider than 110 columns, except tables, links, addresses and commands in
Markdown, and data. No comment or page uses the phrases below, which were this project's worst habits. Without
files, the number of places with a weak word must be the one below, which may only shrink.
Exit status 1: there are findings, each printed as FILE:LINE: what is wrong.
"""
import pathlib
import re
import subprocess
import sys

WIDTH = 110
CODE = {".h", ".cpp", ".c", ".py", ".pyi", ".js", ".jslib", ".mjs", ".ts", ".css", ".frag", ".vert", ".cmake",
        ".sh"}
# Data, history, and the page that lists these phrases.
# The types are generated from rows, whose words count in C++.
LEFT_OUT = ("lab/notes/", "tests/data/", "tests/fuzz/corpus/", "lab/data/", "CHANGELOG.md", "CONTRIBUTING.md",
            "docs/reference/types.md", "python/carom/_types.py", "web/npm/index.d.ts")
PHRASES = {
    r"\bso (much|many)\b(?! that)": "the number or the amount",
    r"\bbut for\b": "except for",
    r"\bways? of (the|a) balls?\b": "path",
    r"\bof its own accord\b": "by itself",
    r"\bmay be wrong by\b": "tolerance, or error",
    r"\bnothing of (it|them|this)\b": "none of it",
    r"\bas it comes\b": "unchanged",
    r"\bwho (asks|calls|reads|wants|needs)\b": "the caller, or the reader",
    r"\bthat is there\b": "existing",
    r"\bin touch\b": "touching",
    r"\btells\b": "says, prints, states or shows",
    r"^[\s/<*]*(?-i:What|Whatever|Those of|That of)\b(?!.*\?)": "a subject that is no clause",
}
# Words that are right in some places, and the number of places where they are left: verbs that a machine or a
# formula can have as its subject, and clauses used as nouns.
WEAK = {
    r"\btakes?\b": (70, "accept, need, last, use"),
    r"\b(go|goes) on\b": (1, "continue"),
    r"\banswers?\b": (19, "return, print, respond"),
    r"\bstands?\b": (8, "be, be listed, be stated"),
    r"\b(those|that) of\b": (106, "the noun again"),
    r"\b(what|whatever|whoever)\b": (128, "a noun"),
}


def texts(path, lines):
    """The lines in which phrases are looked for: prose outside code blocks, and comments."""
    fenced = False
    for number, line in enumerate(lines, 1):
        if path.suffix == ".md":
            if line.lstrip().startswith("```"):
                fenced = not fenced
            elif not fenced:
                yield number, line
        elif match := re.search(r"(//|#|/\*|^\s*\*|\"\"\")(.*)", line):
            yield number, match.group(2)


def too_wide(path, lines):
    fenced = False
    for number, line in enumerate(lines, 1):
        if path.suffix == ".md" and line.lstrip().startswith("```"):
            fenced = not fenced
        if len(line) <= WIDTH or "http" in line:
            continue
        if path.suffix == ".md" and (fenced or line.lstrip().startswith(("|", "<!--", "[", "!["))):
            continue
        yield number


def main(arguments):
    listed = subprocess.run(["git", "ls-files"], capture_output=True, text=True, check=True).stdout
    named = arguments or listed.split("\n")
    found, weak = 0, dict.fromkeys(WEAK, 0)
    for path in map(pathlib.Path, filter(None, named)):
        if str(path).startswith(LEFT_OUT) or not path.is_file():
            continue
        script = not path.suffix and path.read_bytes()[:2] == b"#!"
        if path.suffix not in CODE | {".md"} and path.name != "CMakeLists.txt" and not script:
            continue
        lines = path.read_text(encoding="utf-8").splitlines()
        for number in too_wide(path, lines):
            print(f"{path}:{number}: wider than {WIDTH} columns")
            found += 1
        if path.name == pathlib.Path(__file__).name:
            continue
        for number, text in texts(path, lines):
            for word in WEAK:
                weak[word] += len(re.findall(word, text, re.IGNORECASE))
            for phrase, better in PHRASES.items():
                if bad := re.search(phrase, text, re.IGNORECASE):
                    print(f'{path}:{number}: "{bad.group()}": write {better}')
                    found += 1
    for word, (left, better) in WEAK.items():
        if not arguments and weak[word] != left:
            print(f"tools/words.py: {word} is in {weak[word]} places instead of {left}: " +
                  (f"write {better}" if weak[word] > left else "lower the number here"))
            found += 1
    return found > 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
