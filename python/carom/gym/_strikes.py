"""Actions as strikes."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

import numpy as np

from carom import _carom
from carom._arguments import checked

if TYPE_CHECKING:
    from numpy.typing import NDArray

#: [ball radii] How far from the centre scenes let the tip hit; a hair less, so that no rounding passes it.
_LARGEST_OFFSET = 0.5 * (1 - 1e-12)
_NOT_ASKED = np.empty(0)


def _norm(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(np.sqrt(vectors[..., 0] * vectors[..., 0] + vectors[..., 1] * vectors[..., 1]))


@checked
@dataclasses.dataclass(frozen=True)
class Strikes:
    """How an action in [-1, 1]^5 (6 with an elevation of its own) is a strike. Every action is a legal one: numbers outside [-1, 1] are brought
    to it, and a number that is none makes a shot with the status INVALID.

    aim "angle": action[0:2] is the direction (cos, sin), of any length; (0, 0) aims along +x
    aim "ball": action[0] chooses one of the balls that may be hit first, in the order of the ids; action[1] says how full: 0 at its centre, -1 and
        1 past its right and left edge
    action[2]: the speed of the cue, from speed[0] to speed[1] [m/s]
    action[3:5]: side and height of the tip. The square is laid on the disc that scenes take: (1, 1) becomes the rim at 45 degrees
    action[5]: the elevation, where `elevation_deg` is a pair
    """

    aim: str = "angle"
    speed: tuple[float, float] = (0.3, 6.0)
    elevation_deg: float | tuple[float, float] = 0.0

    def __post_init__(self) -> None:
        if self.aim not in ("angle", "ball"):
            raise ValueError(f"aim={self.aim!r}: expected 'angle' or 'ball'")
        if not (len(self.speed) == 2 and 0 < self.speed[0] <= self.speed[1] < np.inf):
            raise ValueError(f"speed={self.speed!r}: expected the slowest and the fastest strike, in m/s and above 0")
        low, high = self.elevations
        if not 0 <= low <= high < 90:
            raise ValueError(f"elevation_deg={self.elevation_deg!r}: expected degrees from 0 to below 90, one number or two")

    @property
    def size(self) -> int:
        """Numbers in an action."""
        return 6 if isinstance(self.elevation_deg, tuple) else 5

    @property
    def elevations(self) -> tuple[float, float]:
        return self.elevation_deg if isinstance(self.elevation_deg, tuple) else (self.elevation_deg, self.elevation_deg)

    def cue(
        self, actions: NDArray[np.floating], xy: NDArray[np.float64], struck: int, legal: NDArray[np.bool_], radii: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """The strikes of n actions, as `simulate_many(cue=...)` takes them.

        actions: (n, size)
        xy: (n, balls, 2), where the balls are; struck: which of them is hit by the cue
        legal: (n, balls) which of them may be hit first
        radii: (balls,)
        """
        act = np.ascontiguousarray(actions, np.float64)
        along = _NOT_ASKED if self.aim == "angle" else _at_balls(np.clip(act, -1.0, 1.0), xy, struck, legal, radii).reshape(-1)
        out = np.empty((len(act), 5))
        _carom.strikes(len(act), act.reshape(-1), along, self.speed, self.elevations, _LARGEST_OFFSET, out.reshape(-1))
        return out


def _at_balls(
    act: NDArray[np.float64], xy: NDArray[np.float64], struck: int, legal: NDArray[np.bool_], radii: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Directions at the balls that the actions choose."""
    rows = np.arange(len(act))
    counts = legal.sum(1)
    # A number that is none chooses the first ball, and its direction is none.
    wanted = np.minimum(np.nan_to_num(0.5 * (act[:, 0] + 1.0)) * counts, np.maximum(counts - 1, 0)).astype(np.intp)
    chosen = np.argmax(np.cumsum(legal, axis=1) > wanted[:, None], axis=1)
    to = xy[rows, chosen] - xy[:, struck]
    distance = _norm(to)
    # The line of the cue ball's centre passes the other ball's centre at this part of the distance.
    aside = act[:, 1] * np.minimum((radii[struck] + radii[chosen]) / distance, 1.0)
    ahead = np.sqrt(np.maximum(1.0 - aside * aside, 0.0))
    along = np.column_stack((to[:, 0] * ahead - to[:, 1] * aside, to[:, 1] * ahead + to[:, 0] * aside)) + 0.0 * act[:, :1]
    # Where no ball may be hit there is no direction.
    along[counts == 0] = 0.0
    return along
