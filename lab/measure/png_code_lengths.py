#!/usr/bin/env python3
"""Computes the lengths of the Huffman codes built into the PNG writer (render/src/frames/png_code.cpp) from
frames of several scenes and cameras.

Also prints the frame sizes with these codes and with codes made for each frame, relative to zlib's level 1
without filters.

    cmake --build --preset release --target carom_program
    lab/measure/png_code_lengths.py [BUILD_FOLDER]
"""
import pathlib
import subprocess
import sys
import zlib

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build/release") / "carom"
WIDTH, HEIGHT = 1920, 1080
SEGMENT = 64  # pixels; no run crosses a segment's end
LONGEST = 12  # bits of a code
# The byte before every row (Paeth), the end of the data, the first code of a run.
FILTER, END, RUNS = 4, 256, 257
BREAK = "eight_ball_break"
FRAMES = {
    "top": [BREAK],
    "snooker": ["snooker_break"],
    "carom": ["three_cushion"],
    "nine balls": ["nine_ball_break"],
    "rail": [BREAK, "--camera", "rail"],
    "player": [BREAK, "--camera", "player"],
    "follow": [BREAK, "--camera", "follow"],
    "overlays": [BREAK, "--overlay", "trails,events,spin,ghost,clock"],
    "near": [BREAK, "--eye", "0.6,-0.5,0.8", "--target", "0.6,1.2,0"],
    "at the cloth": [BREAK, "--eye", "0.6,0.9,0.25", "--target", "0.63,1.9,0"],
}

# Deflate's codes for lengths of 3 to 258: the shortest length of each of the 29 codes, and the number of
# extra bits.
BASE = [3, 4, 5, 6, 7, 8, 9, 10, 11, 13, 15, 17, 19, 23, 27, 31, 35, 43, 51, 59, 67, 83, 99, 115, 131, 163,
        195, 227, 258]
EXTRA = [0] * 8 + [1] * 4 + [2] * 4 + [3] * 4 + [4] * 4 + [5] * 4 + [0]
CODE_OF_RUN = np.array([0] + [max(i for i in range(29) if BASE[i] <= 3 * n) for n in range(1, SEGMENT + 1)])
EXTRA_OF_RUN = np.array(EXTRA)[CODE_OF_RUN]
CODES = RUNS + CODE_OF_RUN.max() + 1


def frames_of(scene, *options):
    command = [PROGRAM, "render", ROOT / f"scenes/{scene}.toml", *options, "--raw"]
    command += ["--size", f"{WIDTH}x{HEIGHT}", "--from", "0.8", "--to", "2.4", "--fps", "0.8"]
    raw = subprocess.run(command, check=True, capture_output=True).stdout
    return np.frombuffer(raw, np.uint8).reshape(-1, HEIGHT, WIDTH, 3)


def residuals(image):
    """The image after the Paeth filter."""
    x = image.astype(np.int16)
    left, up, corner = np.zeros_like(x), np.zeros_like(x), np.zeros_like(x)
    left[:, 1:], up[1:], corner[1:, 1:] = x[:, :-1], x[:-1], x[:-1, :-1]
    a, b, c = abs(up - corner), abs(left - corner), abs(left + up - 2 * corner)
    guess = np.where((a <= b) & (a <= c), left, np.where(b <= c, up, corner))
    return ((x - guess) & 255).astype(np.uint8)


class Counts:
    """The count of each byte outside runs, and the runs: rows of (pixels, bytes per pixel, count)."""

    def __init__(self, image):
        rest = residuals(image)
        pixels = rest.astype(np.uint32) @ np.array([1, 256, 65536], np.uint32)
        same = np.zeros(pixels.shape, bool)
        same[:, 1:] = pixels[:, 1:] == pixels[:, :-1]
        self.alone = np.bincount(rest[~same].ravel(), minlength=CODES)
        self.alone[FILTER] += HEIGHT
        self.alone[END] += 1
        found = []
        for x in range(0, WIDTH, SEGMENT):
            edges = np.diff(np.pad(same[:, x : x + SEGMENT].astype(np.int8), ((0, 0), (1, 1))), axis=1)
            begin, end = np.argwhere(edges == 1), np.argwhere(edges == -1)
            found.append(np.stack([end[:, 1] - begin[:, 1], pixels[begin[:, 0], x + begin[:, 1]]], 1))
        runs, self.often = np.unique(np.concatenate(found), axis=0, return_counts=True)
        self.length, pixel = runs.T
        self.bytes = [pixel & 255, pixel >> 8 & 255, pixel >> 16]

    def with_lengths(self, lengths):
        """The use count of each code if every run has the shorter of its two forms, and the bits after the
        codes."""
        as_bytes = self.length * sum(lengths[b] for b in self.bytes)
        as_run = lengths[RUNS + CODE_OF_RUN[self.length]] + EXTRA_OF_RUN[self.length] + 1
        written_out = as_bytes < as_run
        counts = self.alone.copy()
        for b in self.bytes:
            np.add.at(counts, b[written_out], (self.often * self.length)[written_out])
        runs = self.length[~written_out], self.often[~written_out]
        np.add.at(counts, RUNS + CODE_OF_RUN[runs[0]], runs[1])
        return counts, (runs[1] * (EXTRA_OF_RUN[runs[0]] + 1)).sum()

    def bits(self, lengths):
        counts, extra = self.with_lengths(lengths)
        return (counts * lengths).sum() + extra


def code_lengths(counts, longest):
    """The best lengths of at most `longest` bits (package-merge); 0 where the count is 0."""
    items = sorted((count, [code]) for code, count in enumerate(counts) if count > 0)
    merged = []
    for _ in range(longest):
        merged = sorted(items + merged, key=lambda item: item[0])
        pairs = [(a[0] + b[0], a[1] + b[1]) for a, b in zip(merged[::2], merged[1::2])]
        last, merged = merged, pairs
    lengths = np.zeros(len(counts), int)
    for _, codes in last[: 2 * len(items) - 2]:
        np.add.at(lengths, codes, 1)
    return lengths


def main():
    usable = np.zeros(CODES, bool)
    usable[: END + 1] = True
    usable[RUNS + CODE_OF_RUN[1:]] = True
    frames = [(name, image) for name, words in FRAMES.items() for image in frames_of(*words)]
    level_1 = [
        len(zlib.compress(np.pad(i.reshape(HEIGHT, -1), ((0, 0), (1, 0))).tobytes(), 1)) for _, i in frames]
    counts = [Counts(image) for _, image in frames]
    lengths = np.full(CODES, 8)
    for _ in range(6):  # a run's form depends on the lengths, and they on it
        shares = sum(c.with_lengths(lengths)[0] / size for c, size in zip(counts, level_1))
        # Every byte can occur: at least one in a million.
        lengths = code_lengths(np.where(usable, np.maximum(1e6 * shares / shares.sum(), 1), 0), LONGEST)
    for (name, _), c, size in zip(frames, counts, level_1):
        own = code_lengths(np.where(usable, c.with_lengths(lengths)[0] + 0.01, 0), 15)
        print(f"{name:14} zlib {size:7}  these codes {c.bits(lengths) / 8 / size:.3f}  own "
              f"{c.bits(own) / 8 / size:.3f}")
    # As in the source: a length, and the number of successive codes with it.
    changes = [0, *(np.flatnonzero(np.diff(lengths)) + 1), CODES]
    print(", ".join(f"{{{lengths[i]}, {j - i}}}" for i, j in zip(changes, changes[1:])))


if __name__ == "__main__":
    main()
