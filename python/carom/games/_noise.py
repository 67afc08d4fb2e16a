"""Execution noise."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from carom import _carom
from carom._arguments import checked
from carom._types import Noise

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

#: The five numbers of a strike, in the order of arrays of strikes and of `Noise`.
STRIKE = ("speed", "aim_deg", "elevation_deg", "side", "height")


checked(Noise)


@overload
def noisy(cue: Mapping[str, Any], noise: Noise | str, seed: int, index: int = 0) -> dict[str, Any]: ...
@overload
def noisy(cue: ArrayLike, noise: Noise | str, seed: int, index: int = 0) -> NDArray[np.float64]: ...
@checked
def noisy(
    cue: Mapping[str, Any] | ArrayLike, noise: Noise | str, seed: int, index: int = 0
) -> dict[str, Any] | NDArray[np.float64]:
    """The strike of a player who intends `cue`.

    cue: a mapping, as for `Scene`, with the defaults of scene files; or an array (5,) of `STRIKE`; or (n, 5)
        for the shots index, index + 1, ...
    noise: standard deviations, or a name for `Noise.named`
    seed, index: equal ones give equal errors, the same as `carom sweep --vary cue.speed=normal(sd)` and so on

    Returns a mapping or an array, as cue was. The result is always valid in a scene: a negative speed becomes
    0, an elevation below 0 becomes a level cue, and an offset of more than half a radius moves straight
    towards the centre until it is half a radius. "none" changes nothing else.

    Raises ValueError for a number that is not finite, a negative deviation, or an array of another shape.
    """
    sd = Noise.named(noise) if isinstance(noise, str) else noise
    if not isinstance(cue, Mapping):
        strikes = np.array(cue, np.float64)
        if strikes.ndim not in (1, 2) or strikes.shape[-1] != len(STRIKE):
            raise ValueError(f"cue: expected the shape (5,) or (n, 5), not {strikes.shape}")
        _carom.add_noise(strikes.reshape(-1), sd, seed, index)
        return strikes
    standard = dict(zip(STRIKE, _carom.standard_strike()))
    side, height = cue.get("offset", (standard["side"], standard["height"]))
    numbers = [cue.get(key, standard[key]) for key in STRIKE[:3]]
    speed, aim, elevation, side, height = noisy([*numbers, side, height], sd, seed, index).tolist()
    return dict(cue) | {"speed": speed, "aim_deg": aim, "elevation_deg": elevation, "offset": [side, height]}
