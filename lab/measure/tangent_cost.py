#!/usr/bin/env python3
"""Instructions of the derivatives of a shot, in shots: the table of lab/notes/2026-11-tangents.md.

Counted by callgrind, as the difference of eleven rounds and one. Needs valgrind, which supports AVX2 but not
AVX-512: CAROM_ISA defaults to v3. Builds the target carom_tangent_probe.

    lab/measure/tangent_cost.py [--build build/release] [--functions 0]
"""
import argparse
import os
import pathlib
import re
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
KEYS = ["cue.speed", "cue.aim_deg", "cue.offset.side", "cue.offset.height", "balls.mu_s", "balls.mu_r",
        "balls.e_b", "balls.e_c"]
SCENES = {"draw": (1, 4, 8), "three_cushion": (4,), "ten_ball_break": (4,)}


def count(probe, scene, what, keys, functions=0):
    """Instructions of one round."""
    totals = []
    with tempfile.TemporaryDirectory() as folder:
        for rounds in (1, 11):
            out = pathlib.Path(folder) / f"{rounds}.out"
            subprocess.run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", probe,
                            ROOT / f"scenes/{scene}.toml", what, str(rounds), *keys],
                           check=True, capture_output=True, env={"CAROM_ISA": "v3", **os.environ})
            totals.append(int(re.search(r"^totals: (\d+)", out.read_text(), re.M).group(1)))
        if functions:
            text = subprocess.run(["callgrind_annotate", out], capture_output=True, text=True).stdout
            print("\n".join(line[:150] for line in text.splitlines() if "%" in line)[:150 * functions])
    return (totals[1] - totals[0]) / 10


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default=ROOT / "build/release", type=pathlib.Path)
    parser.add_argument("--functions", type=int, default=0, help="list the dearest functions of draw")
    args = parser.parse_args()
    subprocess.run(["cmake", "--build", args.build, "--target", "carom_tangent_probe"], check=True,
                   capture_output=True)
    probe = args.build / "lab/measure/carom_tangent_probe"
    print(f"{'scene':18}{'shot':>10}{'plan':>10}  {'inputs':>6}{'tangents':>12}{'in shots':>10}"
          f"{'with plans':>12}")
    for scene, counts in SCENES.items():
        shot, plan = (count(probe, scene, what, ["cue.speed"]) for what in ("shot", "plan"))
        for inputs in counts:
            listed = args.functions if (scene, inputs) == ("draw", 4) else 0
            tangents = count(probe, scene, "tangents", KEYS[:inputs], listed)
            print(f"{scene:18}{shot:10.0f}{plan:10.0f}  {inputs:6}{tangents:12.0f}{tangents / shot:10.2f}"
                  f"{tangents / (shot + plan):12.2f}", flush=True)


if __name__ == "__main__":
    main()
