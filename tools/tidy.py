#!/usr/bin/env python3
"""Runs clang-tidy with the checks of .clang-tidy; called by tools/lint.

    tools/tidy.py BUILD FILE.cpp ...     BUILD: a configured build folder; it need not be built

Nine tenths of clang-tidy's time go into the standard library and other libraries, which it parses again for
every source. So sources that are compiled alike are checked together, as one file that includes them. If
names of two such sources clash, the sources are checked again one by one, which is only slower.

Exit status 1: there are findings, or clang-tidy failed; both are printed. 2: a file cannot be checked.
"""
import argparse
import collections
import concurrent.futures
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
GROUP_SIZE = 30
# In tests, an extra string copy is harmless, and doubles are compared bit by bit.
LEFT_OUT_IN_TESTS = "-performance-*,-bugprone-suspicious-memory-comparison"
# Sources with an entry point: a program or a fuzz target.
ENTRY = re.compile(r"^int main\(|LLVMFuzzerTestOneInput", re.MULTILINE)
# A message of clang-tidy begins FILE:LINE:COLUMN: KIND: and continues in indented lines and notes.
FINDING = re.compile(r"^(?P<file>/[^:\n]+):\d+:\d+: (?:warning|error): ")
BROKEN = re.compile(r"^(?P<file>[^:\n]+):\d+:\d+: error: .*\[clang-diagnostic-error")
CHATTER = re.compile(r"^\d+ (warning|error)s?( and \d+ errors?)? (generated|treated as errors?)\.?$")

Flags = collections.namedtuple("Flags", "meaning includes")
Group = collections.namedtuple("Group", "flags files")


def flags_of(command):
    """The flags in a compile command that change the meaning of a source, unlike optimisation, sanitizers and
    warnings."""
    meaning, includes = [], []
    words = iter(shlex.split(command))
    for word in words:
        if word == "-isystem":
            includes.append((word, next(words)))
        elif word.startswith("-I"):
            includes.append((word,))
        elif word.startswith(("-D", "-U", "-m", "-std=")):
            meaning.append(word)
    return Flags(tuple(sorted(meaning)), tuple(includes))


def compiled_flags(build):
    """The flags of each source, one set for every target that compiles it."""
    flags = collections.defaultdict(list)
    for entry in json.loads((build / "compile_commands.json").read_text()):
        flags[pathlib.Path(entry["file"]).resolve()].append(flags_of(entry["command"]))
    return flags


def companies_of(files, flags):
    """Files that can be checked together: equal flags, the same top folder, and at most one entry point."""
    companies, with_entry = collections.defaultdict(list), set()
    for file in files:
        company = flags[file][0].meaning, file.relative_to(ROOT).parts[0]
        entry = bool(ENTRY.search(file.read_text()))
        if entry and company in with_entry:
            companies[file].append(file)
            continue
        companies[company].append(file)
        if entry:
            with_entry.add(company)
    return companies.values()


def groups_of(files, flags):
    """Groups of similar size, of at most GROUP_SIZE files.

    A source of several targets is checked with the flags of the first. Sources of the kernel are checked
    alone, once for every instruction set, because they include little and may clash.
    """
    kernel = [file for file in files if file.is_relative_to(ROOT / "kernel")]
    groups = [Group(each, [file]) for file in kernel for each in flags[file]]
    for company in companies_of([file for file in files if file not in kernel], flags):
        count = -(-len(company) // GROUP_SIZE)
        for part in range(count):
            some = company[part * len(company) // count:(part + 1) * len(company) // count]
            includes = dict.fromkeys(include for file in some for include in flags[file][0].includes)
            groups.append(Group(Flags(flags[some[0]][0].meaning, tuple(includes)), some))
    return groups


class Tidy:
    """Runs of clang-tidy, each in its own folder below FOLDER."""

    def __init__(self, folder, total):
        self.folder, self.total = folder, total
        self.lock = threading.Lock()
        self.printed, self.checked, self.runs, self.failed = set(), 0, 0, False
        self.start = time.monotonic()

    def run(self, group):
        with self.lock:
            self.runs += 1
            folder = self.folder / str(self.runs)
        folder.mkdir(parents=True, exist_ok=True)
        source = folder / "sources.cpp"
        allowed = "// NOLINT(bugprone-suspicious-include): on purpose"
        source.write_text("".join(f'#include "{file}"  {allowed}\n' for file in group.files))
        arguments = ["clang++", *group.flags.meaning,
                     *(word for include in group.flags.includes for word in include),
                     "-c", str(source)]
        database = [{"directory": str(folder), "file": str(source), "arguments": arguments}]
        (folder / "compile_commands.json").write_text(json.dumps(database, indent=1))
        command = ["clang-tidy", "--quiet", f"--config-file={ROOT / '.clang-tidy'}", "-p", str(folder)]
        if any(group.files[0].is_relative_to(ROOT / folder) for folder in ("tests", "lab/tests")):
            command.append(f"--checks={LEFT_OUT_IN_TESTS}")
        return subprocess.run(
            [*command, str(source)],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)

    def check(self, group):
        result = self.run(group)
        blamed = {match["file"] for match in map(BROKEN.match, result.stdout.splitlines()) if match}
        if blamed and len(group.files) > 1:
            self.take_apart(group, blamed, result.stdout)
            return
        with self.lock:
            self.report(result)
            self.checked += len(group.files)
            seconds = time.monotonic() - self.start
            done = f"{self.checked} of {self.total}"
            print(f"lint: clang-tidy has checked {done} files, {seconds:.0f} s", flush=True)

    def take_apart(self, group, blamed, output):
        """Checks files with a clash one by one, and the others together again."""
        alone = [file for file in group.files if str(file) in blamed] or group.files
        first = next(line for line in output.splitlines() if BROKEN.match(line))
        with self.lock:
            print(f"lint: {len(alone)} of {len(group.files)} files clash and are checked one by one; "
                  f"rename this to make it faster:\n    {first}", flush=True)
        for file in alone:
            self.check(Group(group.flags, [file]))
        rest = [file for file in group.files if file not in alone]
        if rest:
            self.check(Group(group.flags, rest))

    def report(self, result):
        """Prints new findings: one in a header is found again in every group that includes it."""
        show = True
        for line in result.stdout.splitlines():
            if FINDING.match(line):
                show = line not in self.printed
                self.printed.add(line)
            if show:
                print(line, flush=True)
        for line in result.stderr.splitlines():
            if not CHATTER.match(line):
                print(line, file=sys.stderr, flush=True)
        self.failed = self.failed or result.returncode != 0


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("files", type=pathlib.Path, nargs="+")
    arguments = parser.parse_args()
    flags = compiled_flags(arguments.build)
    files = list(dict.fromkeys(file.resolve() for file in arguments.files))
    unknown = [str(file) for file in files if file not in flags]
    if unknown:
        print(f"lint: no target compiles {', '.join(unknown)}; name .cpp files, not their headers",
              file=sys.stderr)
        return 2
    # The largest first, so that no processor is idle at the end; size is a good enough estimate of time.
    groups = sorted(
        groups_of(files, flags), key=lambda group: -sum(file.stat().st_size for file in group.files))
    count = sum(len(group.files) for group in groups)
    tidy = Tidy((arguments.build / "tidy").resolve(), count)
    print(f"lint: clang-tidy checks {count} files in {len(groups)} runs", flush=True)
    with concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        list(pool.map(tidy.check, groups))
    if tidy.failed:
        print(f"lint: {len(tidy.printed)} findings, printed above", file=sys.stderr)
    return 1 if tidy.failed else 0


if __name__ == "__main__":
    sys.exit(main())
