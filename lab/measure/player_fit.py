#!/usr/bin/env python3
"""Fits the value of a position (games/src/player/lie.cpp) to racks, and prints how well it is calibrated.

    carom_player_games positions league league 4000 eight_ball > positions.txt
    player_fit.py positions.txt

Each line of the file has the rack, the features, and whether the player to shoot won. The fit is a logistic
regression by Newton's method with a small ridge. Calibration uses racks that the fit has not seen (five
folds): ten bins of equal size, each with the mean chance and the share of wins. A file of `player_games
chances` has a chance in place of the features: only its calibration is printed.
"""
import sys

import numpy as np

RIDGE = 1.0
FOLDS = 5
BINS = 10


def chance(x, w):
    return 1.0 / (1.0 + np.exp(-x @ w))


def fitted(x, y):
    w = np.zeros(x.shape[1])
    for _ in range(30):
        p = chance(x, w)
        gradient = x.T @ (y - p) - RIDGE * w
        curvature = (x * (p * (1 - p))[:, None]).T @ x + RIDGE * np.eye(len(w))
        w += np.linalg.solve(curvature, gradient)
    return w


def log_loss(y, p):
    return -np.mean(y * np.log(p) + (1 - y) * np.log(1 - p))


def main():
    data = np.loadtxt(sys.argv[1])
    rack, x, y = data[:, 0].astype(int), data[:, 1:-1], data[:, -1]
    told = x.shape[1] == 1
    p = x[:, 0].copy()
    for fold in range(0 if told else FOLDS):
        out = rack % FOLDS == fold
        p[out] = chance(x[out], fitted(x[~out], y[~out]))
    print(f"{len(np.unique(rack))} seeds, {len(y)} positions")
    p = np.clip(p, 1e-6, 1 - 1e-6)
    print(f"log loss {log_loss(y, p):.4f}; of a constant {log_loss(y, np.full(len(y), y.mean())):.4f}")
    order = np.argsort(p)
    for part in np.array_split(order, BINS):
        print(f"  chance {100 * p[part].mean():5.1f} %, won {100 * y[part].mean():5.1f} %")
    if not told:
        print(", ".join(f"{value:.2f}" for value in fitted(x, y)))


if __name__ == "__main__":
    main()
