#!/usr/bin/env python3
"""Rewrites the results of `carom-lab validate` in docs/reference/validation.md.

These are its table between the marks <!-- begin summary --> and <!-- end summary -->, and its figures in
docs/images. They are the same on every machine.

    cmake --build --preset release --target carom_lab_program
    lab/measure/renew_validation.py [--carom build/release/carom-lab] [--check]

--check writes nothing, and fails if the page or a figure differs from the program's output.
"""
import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = "docs/reference/validation.md"
FIGURES = ["V2", "V3", "V4", "V7", "V17", "V18", "B1", ""]  # "": all cases in one


def validate(carom, folder, case):
    """The output of --json and --plot."""
    figure = pathlib.Path(folder, "figure.svg")
    command = [carom, "validate", *([case] if case else []), "--json", "--plot", figure]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    return json.loads(done.stdout)["cases"], figure.read_text()


def worst(group):
    row = max(group, key=lambda r: abs(r["difference"]))
    off, unit = row["computed"] - row["measured"], row["unit"]
    by = f"{off:+.2g} {unit}"
    if row["measured"] and unit != "deg":
        by = f"{off / row['measured']:+.0%}".replace("%", " %")
    return f"{row['difference']:+.1f} ({by})"


def summary(all_rows):
    """One line for the cases with the same title and variant (V8 to V16 are nine shots of one kind), then a
    list of the variants."""
    groups, keys = {}, {}
    for row in all_rows:
        groups.setdefault((row["title"], row["variant"]), []).append(row)
        if row["keys"] and row["keys"] != row["variant"]:
            keys[(row["variant"], f"`{row['preset']}` with `{row['keys']}`")] = None
    lines = ["| case | what | trust | variant | free | within | worst |",
             "|---|---|---|---|---|---|---|"]
    last = None
    for (title, variant), group in groups.items():
        ids = [group[0]["case"], group[-1]["case"]]
        same_id = ids[0] if ids[0] == ids[1] else f"{ids[0]} to {ids[1]}"
        what = [same_id, title, group[0]["trust"]] if title != last else ["", "", ""]
        last = title
        words = sum(r["kind"] == "words" for r in group)
        free = "in words" if words == len(group) else "yes" if all(r["free_of_fit"] for r in group) else "no"
        within = f"{sum(r['within'] for r in group)} of {len(group)}"
        if 0 < words < len(group):
            within += f", {words} in words"
        lines.append(
            "| " + " | ".join([*what, variant, free, within, worst(group)]) + " |")
    return "\n".join(lines) + "\n\n" + "".join(f"* {name}: {what}\n" for name, what in keys)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--carom", default=str(ROOT / "build/release/carom-lab"))
    parser.add_argument(
        "--check", action="store_true", help="write nothing, and fail where something is stale")
    args = parser.parse_args()
    new = {}
    with tempfile.TemporaryDirectory() as folder:
        for case in FIGURES:
            rows, figure = validate(args.carom, folder, case)
            new[f"docs/images/validation_{case or 'all'}.svg"] = figure
    # The last result has all rows.
    page, found = re.subn(r"(<!-- begin summary -->\n).*?(<!-- end summary -->)",
                          lambda m: m[1] + summary(rows) + m[2], (ROOT / PAGE).read_text(), flags=re.S)
    if found != 1:
        sys.exit(f"renew_validation: {PAGE} has the marks of the table {found} times")
    new[PAGE] = page
    stale = [
        name for name, text in new.items() if not (ROOT / name).exists() or (ROOT / name).read_text() != text]
    if args.check and stale:
        sys.exit(f"stale: {', '.join(stale)}; run lab/measure/renew_validation.py")
    for name in stale:
        (ROOT / name).write_text(new[name])
    print(f"renewed: {', '.join(stale)}" if stale else f"{PAGE} and its figures are what the program prints")


main()
