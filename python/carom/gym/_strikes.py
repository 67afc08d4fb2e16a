"""How actions become strikes."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

import numpy as np

from carom import _carom
from carom._arguments import checked

if TYPE_CHECKING:
    from numpy.typing import NDArray

#: [ball radii] The largest offset of the tip that scenes allow, minus a hair so that rounding cannot exceed
#: it.
_LARGEST_OFFSET = 0.5 * (1 - 1e-12)
_NOT_ASKED = np.empty(0)


def _norm(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(np.sqrt(vectors[..., 0] * vectors[..., 0] + vectors[..., 1] * vectors[..., 1]))


@checked
@dataclasses.dataclass(frozen=True)
class Strikes:
    """How an action in [-1, 1]^5 becomes a strike; in [-1, 1]^6 if it includes the elevation.

    Every action is legal: numbers outside [-1, 1] are clipped, and NaN makes a shot with the status INVALID.

    aim "angle": action[0:2] is the direction (cos, sin), of any length; (0, 0) aims along +x aim "ball":
    action[0] chooses one of the balls that may be hit first, in the order of the ids; action[1] aims at its
    centre with 0, and past its right and left edge with -1 and 1 action[2]: the cue's speed, from speed[0] to
    speed[1] [m/s] action[3:5]: side and height of the tip. The square is mapped to the disc that scenes
    allow: (1, 1) is on the rim at 45 degrees action[5]: the elevation, if `elevation_deg` is a pair
    """

    aim: str = "angle"
    speed: tuple[float, float] = (0.3, 6.0)
    elevation_deg: float | tuple[float, float] = 0.0

    def __post_init__(self) -> None:
        if self.aim not in ("angle", "ball"):
            raise ValueError(f"aim={self.aim!r}: expected 'angle' or 'ball'")
        if not (len(self.speed) == 2 and 0 < self.speed[0] <= self.speed[1] < np.inf):
            raise ValueError(f"speed={self.speed!r}: expected the slowest and fastest speed [m/s], above 0")
        low, high = self.elevations
        if not 0 <= low <= high < 90:
            degrees = "degrees from 0 to below 90, one number or two"
            raise ValueError(f"elevation_deg={self.elevation_deg!r}: expected {degrees}")

    @property
    def size(self) -> int:
        """The number of values in an action."""
        return 6 if isinstance(self.elevation_deg, tuple) else 5

    @property
    def elevations(self) -> tuple[float, float]:
        own = self.elevation_deg
        return own if isinstance(own, tuple) else (own, own)

    def cue(
        self, actions: NDArray[np.floating], xy: NDArray[np.float64], struck: int,
        legal: NDArray[np.bool_], radii: NDArray[np.float64],
    ) -> NDArray[np.float64]:
        """The strikes of n actions, as an array for `simulate_many(cue=...)`.

        actions: (n, size)
        xy: (n, balls, 2), the balls' positions
        struck: the index of the cue ball
        legal: (n, balls), the balls that may be hit first
        radii: (balls,)
        """
        act = np.ascontiguousarray(actions, np.float64)
        along = _NOT_ASKED
        if self.aim != "angle":
            along = _at_balls(np.clip(act, -1.0, 1.0), xy, struck, legal, radii).reshape(-1)
        out = np.empty((len(act), 5))
        limits = self.speed, self.elevations, _LARGEST_OFFSET
        _carom.strikes(len(act), act.reshape(-1), along, *limits, out.reshape(-1))
        return out


def _at_balls(
    act: NDArray[np.float64], xy: NDArray[np.float64], struck: int,
    legal: NDArray[np.bool_], radii: NDArray[np.float64],
) -> NDArray[np.float64]:
    """The directions to the balls that the actions choose."""
    rows = np.arange(len(act))
    counts = legal.sum(1)
    # NaN chooses the first ball, and its direction is NaN.
    share = np.nan_to_num(0.5 * (act[:, 0] + 1.0))
    wanted = np.minimum(share * counts, np.maximum(counts - 1, 0)).astype(np.intp)
    chosen = np.argmax(np.cumsum(legal, axis=1) > wanted[:, None], axis=1)
    to = xy[rows, chosen] - xy[:, struck]
    distance = _norm(to)
    # The line of the cue ball's centre passes the other ball's centre at this fraction of the distance.
    aside = act[:, 1] * np.minimum((radii[struck] + radii[chosen]) / distance, 1.0)
    ahead = np.sqrt(np.maximum(1.0 - aside * aside, 0.0))
    x, y = to[:, 0] * ahead - to[:, 1] * aside, to[:, 1] * ahead + to[:, 0] * aside
    along = np.column_stack((x, y)) + 0.0 * act[:, :1]
    # If no ball may be hit, there is no direction.
    along[counts == 0] = 0.0
    return along
