"""Numbers of a scene from tracked positions of its balls."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom import _carom
from carom._arguments import checked
from carom._scene import Scene, SceneLike, as_scene
from carom._types import FitResult

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


@checked
def fit(
    scene: SceneLike,
    t: ArrayLike,
    ball: Sequence[str],
    xy: ArrayLike,
    *,
    vary: Sequence[str],
    most_shots: int = 100,
) -> FitResult:
    """Fits numbers of a scene to tracked positions, by Gauss-Newton with a loss that is robust to outliers.

    scene: the shot, with first guesses; it should meet the same things in the same order as the tracks
    t, ball, xy: time since the stroke [s], ball id and position [m] of every point: (points,), (points,),
        (points, 2), at any rate and with gaps; NaN for a ball that was not seen
    vary: keys of the numbers, as in a sweep: "balls.mu_s", "cue.speed"

    Raises ValueError for an unknown ball or key, or a shot without derivatives. A warning names values
    that the tracks cannot separate.
    """
    played = as_scene(scene)
    times, places = np.asarray(t, np.float64).reshape(-1), np.asarray(xy, np.float64)
    if places.shape != (len(times), 2) or len(ball) != len(times):
        n = len(times)
        raise ValueError(f"t, ball and xy: expected {n} of each, xy with the shape ({n}, 2)")
    if not (times >= 0).all():
        raise ValueError("t: expected times of at least 0, since the stroke")
    numbers = {name: i for i, name in enumerate(played.ids)}
    unknown = [name for name in ball if name not in numbers]
    if unknown:
        raise ValueError(f"ball: the scene has no ball {unknown[0]!r}; it has {', '.join(numbers)}")
    seen = np.isfinite(places).all(axis=1)
    found: FitResult
    found, fitted = _carom.fit(
        played._native,
        np.ascontiguousarray(times[seen]),
        np.array([numbers[name] for name in ball], np.int32)[seen],
        np.ascontiguousarray(places[seen]).reshape(-1),
        list(vary),
        most_shots,
    )
    for warning in found.warnings:
        warnings.warn(warning, stacklevel=3)
    residuals = np.full(places.shape, np.nan)
    residuals[seen] = found.fun
    return found._replace(fun=residuals, scene=Scene._of(fitted))
