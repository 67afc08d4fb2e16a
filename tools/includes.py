#!/usr/bin/env python3
"""Finds uses of standard library names without their headers; called by tools/lint.

    tools/includes.py [--fix] FILE ...      --fix adds the includes (clang-format sorts them)

A header of one standard library may include another header that other libraries do not: g++ 14 drops some
that g++ 12 includes. A source may rely on the header of its own name (roots.cpp on roots.h). The list below
covers what this project uses. Exit status 1: there are findings.
"""
import argparse
import pathlib
import re
import sys

HEADERS = {
    "algorithm": r"std::(max|min|minmax|clamp|sort|stable_sort|nth_element|find|find_if|any_of|all_of|"
                 r"none_of|copy|copy_n|fill|fill_n|reverse|lower_bound|upper_bound|transform|count|count_if|"
                 r"max_element|min_element|minmax_element|remove_if|unique|rotate|equal|mismatch|search|"
                 r"binary_search|adjacent_find|is_sorted|replace|ranges::\w+)\s*\(",
    "array": r"std::array<",
    "atomic": r"std::atomic\b",
    "bit": r"std::(bit_cast|countr_zero|countl_zero|popcount|bit_width)\b",
    "cerrno": r"\berrno\b",
    "charconv": r"std::(from_chars|to_chars)\b",
    "chrono": r"std::chrono\b",
    "cmath": r"std::(abs|sqrt|sin|cos|tan|atan2|acos|pow|exp|log|log10|log2|floor|ceil|round|lround|isfinite|"
             r"isnan|isinf|hypot|fma|nextafter|copysign|ldexp|frexp|trunc|fmod|signbit)\(",
    "condition_variable": r"std::condition_variable\b",
    "cstdint": r"std::u?int(8|16|32|64)_t\b",
    "cstdio": r"std::(printf|fprintf|puts|fputs|snprintf|FILE|fopen|fflush|fwrite)\b|\bstderr\b|\bstdout\b",
    "cstdlib": r"std::(getenv|abort|exit|strtod|strtol|_Exit)\b",
    "cstring": r"std::(memcpy|memcmp|memset|strcmp|strncmp|strlen|strerror|strchr)\b",
    "ctime": r"\bclock_gettime\(|std::(time|strftime)\b",
    "exception": r"std::(exception|exception_ptr|current_exception|rethrow_exception)\b",
    "filesystem": r"std::filesystem\b",
    "fstream": r"std::(ifstream|ofstream|fstream)\b",
    "functional": r"std::(function|hash|greater|less)<",
    "iostream": r"std::(cout|cerr|cin)\b",
    "iterator": r"std::(back_inserter|inserter|istreambuf_iterator|distance|prev|next)\b",
    "limits": r"std::numeric_limits<",
    "map": r"std::(map|multimap)<",
    "memory": r"std::(unique_ptr|shared_ptr|make_unique|make_shared|weak_ptr|align)\b",
    "mutex": r"std::(mutex|lock_guard|unique_lock|scoped_lock|once_flag|call_once)\b",
    "numbers": r"std::numbers\b",
    "numeric": r"std::(accumulate|iota|inner_product|gcd)\(",
    "optional": r"std::(optional|nullopt)\b",
    "set": r"std::(set|multiset)<",
    "span": r"std::span<",
    "sstream": r"std::(ostringstream|istringstream|stringstream)\b",
    "stdexcept": r"std::(runtime_error|logic_error|invalid_argument|out_of_range|length_error)\b",
    "string": r"std::(string|to_string|getline)\b",
    "string_view": r"std::string_view\b",
    "thread": r"std::(thread|jthread|this_thread)\b",
    "tuple": r"std::(tuple|make_tuple|tie)\b",
    "unordered_map": r"std::unordered_map<",
    "utility": r"std::(pair|move|swap|exchange|forward|as_const)\b",
    "vector": r"std::vector<",
}
# The standard guarantees that each of the headers on the right includes the one on the left.
BROUGHT = {"exception": {"stdexcept"}, "string_view": {"string"},
           "utility": {"algorithm", "map", "memory", "optional", "tuple", "vector"}}
ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDERS = [ROOT / folder for folder in ("kernel/include", "engine/include", "render/include", "capi/include",
                                        "interface/include", "kernel", "kernel/src", "lab", "lab/carom",
                                        "engine/src", "render/src", "capi/src", "tools/carom", "tests")]
INCLUDE = re.compile(r'^#include [<"]([^>"]+)[>"]', re.MULTILINE)
NO_CODE = re.compile(r'//[^\n]*|"(?:[^"\\\n]|\\.)*"')


def includes_of(path, text):
    """Standard headers that a source or its own header includes."""
    found = set(INCLUDE.findall(text))
    if path.suffix == ".cpp":
        own = [name for name in found if pathlib.PurePath(name).stem == path.stem]
        headers = [root / name for name in own for root in (path.parent, *FOLDERS) if (root / name).exists()]
        for header in headers[:1]:
            found |= set(INCLUDE.findall(header.read_text()))
    return found


def missing_in(path, text):
    found = includes_of(path, text)
    code = NO_CODE.sub("", text)
    for header, names in HEADERS.items():
        if header not in found and not found & BROUGHT.get(header, set()):
            use = re.search(names, code)
            if use:
                yield header, use.group().rstrip("(<"), code.count("\n", 0, use.start()) + 1


def add(text, headers):
    lines = text.split("\n")
    standard = [i for i, line in enumerate(lines) if re.match(r"#include <[a-z_0-9]+>$", line)]
    if standard:
        at, extra = standard[0], []
    else:
        at = next(i for i, line in enumerate(lines) if line.startswith(("#include", "#pragma once")))
        at, extra = at + 1, [""]
    return "\n".join(lines[:at] + extra + [f"#include <{header}>" for header in headers] + lines[at:])


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--fix", action="store_true")
    parser.add_argument("files", type=pathlib.Path, nargs="+")
    arguments = parser.parse_args()
    findings = 0
    for path in arguments.files:
        text = path.read_text()
        missing = list(missing_in(path, text))
        findings += len(missing)
        for header, name, line in missing:
            print(f"{path}:{line}: {name} needs #include <{header}>")
        if missing and arguments.fix:
            path.write_text(add(text, [header for header, _, _ in missing]))
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
