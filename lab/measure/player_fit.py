#!/usr/bin/env python3
"""Fits the value of a position to racks, writes games/src/player/worth.h, and prints the calibration.

    carom_player_games positions league league 500 nine_ball > fit.txt
    carom_player_games positions league league 500 nine_ball 900001 > other.txt
    player_fit.py [--write] rotation=fit.txt:other.txt [eight_ball=FIT[,FIT ...][:OTHER] ...]

Nine-ball and ten-ball share a row, rotation. Each line of a file has the rack, the features, and whether the
player to shoot won. The fit is a logistic regression by Newton's method with a ridge around a guess.
Calibration uses racks that the fit has not seen, those of OTHER or else of five folds: ten bins of equal
size, each with the mean chance and the share of wins. A file of `player_games chances` has a chance in place
of the features: only its calibration is printed. --write replaces the weights of the named games in worth.h.
"""
import pathlib
import re
import sys

import numpy as np

TABLE = pathlib.Path(__file__).resolve().parents[2] / "games/src/player/worth.h"
# A guess to which the fit is drawn, and how strongly. The turn and a pot keep the worth of the guess: racks
# resolve it badly, and players who see no worth in them only play safe (lab/notes/2026-11-player.md).
GUESS = np.array([0.0, 4.0, 4.0, 0.25, 0.0, 0.0])
RIDGE = np.array([1e6, 10.0, 10.0, 1e6, 10.0, 10.0])
FOLDS = 5
BINS = 10


def chance(x, w):
    return 1.0 / (1.0 + np.exp(-x @ w))


def fitted(x, y):
    w = GUESS.copy()
    for _ in range(30):
        p = chance(x, w)
        gradient = x.T @ (y - p) - RIDGE * (w - GUESS)
        curvature = (x * (p * (1 - p))[:, None]).T @ x + np.diag(RIDGE)
        w += np.linalg.solve(curvature, gradient)
    return w


def log_loss(y, p):
    return -np.mean(y * np.log(p) + (1 - y) * np.log(1 - p))


def read(paths):
    data = np.concatenate([np.loadtxt(path) for path in paths.split(",")])
    return data[:, 0].astype(int), data[:, 1:-1], data[:, -1]


def main():
    for word in sys.argv[1:]:
        if word == "--write":
            continue
        game, _, paths = word.rpartition("=")
        path, _, other = paths.partition(":")
        rack, x, y = read(path)
        told = x.shape[1] == 1
        if other:
            weights = fitted(x, y)
            rack, x, y = read(other)
            p = chance(x, weights)
        else:
            p = x[:, 0].copy()
            for fold in range(0 if told else FOLDS):
                out = rack % FOLDS == fold
                p[out] = chance(x[out], fitted(x[~out], y[~out]))
            weights = None if told else fitted(x, y)
        print(f"{game} {path}: {len(np.unique(rack))} seeds, {len(y)} positions")
        p = np.clip(p, 1e-6, 1 - 1e-6)
        print(f"log loss {log_loss(y, p):.4f}; of a constant {log_loss(y, np.full(len(y), y.mean())):.4f}")
        for part in np.array_split(np.argsort(p), BINS):
            print(f"  chance {100 * p[part].mean():5.1f} %, won {100 * y[part].mean():5.1f} %")
        if weights is None:
            continue
        row = ", ".join(f"{weight:.3f}" for weight in weights)
        print(row)
        if "--write" in sys.argv:
            name = "kWorth" + game.title().replace("_", "")
            text, count = re.subn(rf"({name} = \{{)[^}}]*", rf"\g<1>{row}", TABLE.read_text(encoding="utf-8"))
            if count != 1:
                sys.exit(f"{game}: {TABLE} has no {name}")
            TABLE.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
