"""Single impacts: arrays of states in, arrays of states out.

A state is (3, 3): rows position [m], velocity [m/s], angular velocity [rad/s]. Parameters are numbers, or
arrays with one number per impact. Their names and units are those of scene files; their defaults are those of
the "pool_classic" balls.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from carom import _carom
from carom._arguments import checked
from carom._names import BallBallModel as BallBallModel, CushionModel as CushionModel
from carom._record import _output

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

__all__ = ["ball_ball", "ball_cushion"]

_EPSILON = np.finfo(np.float64).eps


def _rows(count: int, **columns: ArrayLike) -> NDArray[np.float64]:
    """One row for all impacts, or one per impact."""
    arrays = {name: np.asarray(values, np.float64) for name, values in columns.items()}
    for name, array in arrays.items():
        if array.ndim > 0 and array.size != count:
            raise ValueError(f"{name}: {array.size} numbers for {count} impacts; give one, or one for each")
    each = any(array.ndim > 0 for array in arrays.values())
    rows = np.empty((count if each else 1, len(arrays)))
    for k, array in enumerate(arrays.values()):
        rows[:, k] = array.reshape(-1)
    return rows


def _states(rvw: ArrayLike, inner: tuple[int, ...]) -> NDArray[np.float64]:
    states = np.asarray(rvw, np.float64)
    if states.shape[-len(inner) :] != inner:
        raise ValueError(f"rvw: expected the shape (..., {', '.join(map(str, inner))}), not {states.shape}")
    return states


@checked
def ball_ball(
    rvw: ArrayLike,
    *,
    model: BallBallModel = "mathavan",
    tolerance: float = 1e-6,
    radius: ArrayLike = 0.028575,
    mass: ArrayLike = 0.170097,
    mu_s: ArrayLike = 0.2,
    mu_b: ArrayLike = 0.05,
    e_b: ArrayLike = 0.95,
    out: NDArray[np.float64] | None = None,
) -> NDArray[np.float64]:
    """Impacts of two equal balls.

    rvw: (..., 2, 3, 3), both balls as they touch, with their centres at the same height
    model: "mathavan" (to `tolerance` of the approach speed, 1e-13 to 1e-1), "inelastic" or "elastic"
    radius [m], mass [kg], mu_s (cloth), mu_b (between the balls), e_b: one number, or one per impact
    out: a contiguous array to fill; it may be rvw itself

    Returns the states after the impact; balls that do not approach each other are unchanged. Raises
    ValueError, naming the first, for a state or parameter that cannot be used; the contents of `out` are then
    unspecified.
    """
    states = _states(rvw, (2, 3, 3))
    pairs = states.reshape(-1, 2, 9)
    after = _output(out, states.shape)
    params = _rows(len(pairs), radius=radius, mass=mass, mu_s1=mu_s, mu_s2=mu_s, mu_b=mu_b, e_b=e_b)
    balls = [np.ascontiguousarray(pairs[:, k]).reshape(-1) for k in range(2)]
    results = [np.empty_like(ball) for ball in balls]
    if len(pairs) > 0:
        _carom.ball_ball(model, tolerance, balls[0], balls[1], params.reshape(-1), results[0], results[1])
    for k in range(2):
        after.reshape(-1, 2, 9)[:, k] = results[k].reshape(-1, 9)
    return after


def _unit(normal: ArrayLike, count: int) -> NDArray[np.float64]:
    normals = np.atleast_2d(np.asarray(normal, np.float64)).reshape(-1, 2)
    if len(normals) not in (1, count):
        raise ValueError(f"normal: {len(normals)} vectors for {count} impacts; give one, or one for each")
    length = np.sqrt(normals[:, :1] * normals[:, :1] + normals[:, 1:] * normals[:, 1:])
    if not (np.abs(length - 1.0) <= 1e-3).all():
        raise ValueError("normal: expected vectors of length 1, from the cushion into the table")
    # A vector that is a unit vector up to rounding is used unchanged.
    return np.ascontiguousarray(np.where(np.abs(length - 1.0) <= 4.0 * _EPSILON, normals, normals / length))


@checked
def ball_cushion(
    rvw: ArrayLike,
    normal: ArrayLike,
    *,
    model: CushionModel = "han_2005",
    radius: ArrayLike = 0.028575,
    mass: ArrayLike = 0.170097,
    mu_s: ArrayLike = 0.2,
    e_c: ArrayLike = 0.85,
    f_c: ArrayLike = 0.2,
    height: ArrayLike | None = None,
    out: NDArray[np.float64] | None = None,
) -> NDArray[np.float64]:
    """Impacts of a ball on a cushion.

    rvw: (..., 3, 3)
    normal: (2,) or (..., 2), unit vectors from the cushion into the table
    model: "han_2005", "mathavan_2010", "stronge", "impulse" or "smooth"
    radius [m], mass [kg], mu_s (cloth), e_c, f_c (cushion): one number, or one per impact
    height: the nose's height above the cloth [m]; 1.28 radii if it is left out
    out: a contiguous array to fill; it may be rvw itself

    Returns the states after the impact; a ball that does not approach is unchanged. Raises ValueError for a
    state or parameter that cannot be used; the contents of `out` are then unspecified.
    """
    states = _states(rvw, (3, 3))
    after = _output(out, states.shape)
    flat: NDArray[np.float64] = np.ascontiguousarray(states).reshape(-1)
    count = flat.size // 9
    nose: Any = 1.28 * np.asarray(radius, np.float64) if height is None else height
    params = _rows(count, radius=radius, mass=mass, mu_s=mu_s, e_c=e_c, f_c=f_c, height=nose)
    r, m, s, e, f, h = params.T
    for name, inside, words in (
        ("radius", (r > 0) & np.isfinite(r), "greater than 0"),
        ("mass", (m > 0) & np.isfinite(m), "greater than 0"),
        ("mu_s", (s >= 0) & np.isfinite(s), "of at least 0"),
        ("e_c", (e >= 0) & (e <= 1), "from 0 to 1"),
        ("f_c", (f >= 0) & np.isfinite(f), "of at least 0"),
        ("height", (h > 0) & (h < 2 * r), "between 0 and twice the radius"),
    ):
        if not inside.all():
            raise ValueError(f"{name}: expected numbers {words}")
    if not np.isfinite(flat).all():
        raise ValueError("rvw: expected finite numbers")
    normals = _unit(normal, count)
    if count > 0:
        _carom.ball_cushion(model, flat, normals.reshape(-1), params.reshape(-1), after.reshape(-1))
    return after
