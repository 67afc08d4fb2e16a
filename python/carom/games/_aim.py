"""Aim help: by geometry where that is exact, and by playing the shot where it is not."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from carom import _carom
from carom._arguments import checked
from carom._scene import SceneLike, as_scene
from carom.games._rules import _two

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


class PocketLine(NamedTuple):
    """The straight ways of a ball into a pocket that touch neither the noses of cushions nor jaws."""

    pocket: str  # id
    towards: tuple[float, float]  # unit vector in the middle of these ways
    width_deg: float  # how far apart the outermost of them are; 0: there is none
    distance: float  # [m] from the ball to where it begins to fall
    in_the_way: str  # the nearest ball on the middle way, or ""

    @property
    def open(self) -> bool:
        """Whether there is such a way, and no ball on the middle one."""
        return self.width_deg > 0.0 and not self.in_the_way


class Aim(NamedTuple):
    """An aim that was looked for."""

    aim_deg: float | None  # of the strike, which was played and pots the ball; None: see why
    geometric_deg: float  # aim_pot: at the ghost ball, without throw, squirt and swerve
    cut_deg: float  # aim_pot: of that aim
    cushion: str  # bank_routes: the cushion that the ball meets
    shots: int  # that were played to find it
    why: str  # why there is none; "" where there is one


@checked
def ghost_ball(ball: ArrayLike, towards: ArrayLike, radius: float = 0.028575) -> tuple[float, float]:
    """Where the cue ball's centre is [m] when it meets a ball of the same radius and sends it along `towards`, a unit vector, without throw."""
    return _carom.ghost_ball(_two(ball), _two(towards), 2.0 * radius)


@checked
def cut_angle_deg(cue_ball: ArrayLike, ghost: ArrayLike, towards: ArrayLike) -> float:
    """Angle between the cue ball's way to the ghost ball and the object ball's way: 0 is straight; from 90 on there is no such cut."""
    return _carom.cut_angle_deg(_two(cue_ball), _two(ghost), _two(towards))


@checked
def pocket_lines(scene: SceneLike, ball: str, cue_ball: str = "cue") -> list[PocketLine]:
    """A line for every pocket of the table. The cue ball is in nobody's way, as it will have moved. Raises ValueError for a ball that is not there."""
    return [PocketLine(*line) for line in _carom.pocket_lines(as_scene(scene)._native, ball, cue_ball)]


@checked
def aim_pot(scene: SceneLike, ball: str, pocket: str) -> Aim:
    """The aim that pots a ball into a pocket ("p1", ...): from the ghost ball, corrected by playing the shot until the ball runs down the middle of
    its ways.

    scene: its cue says how the ball is struck; its aim is not read

    Raises ValueError for a ball or a pocket that is not there, a scene without a cue, and a shot that does not end at rest.
    """
    return Aim(*_carom.aim_pot(as_scene(scene)._native, ball, pocket))


@checked
def bank_routes(scene: SceneLike, ball: str, pocket: str) -> list[Aim]:
    """Aims that pot a ball by way of one cushion, at most one for every straight cushion; each was played. Otherwise as aim_pot."""
    return [Aim(*aim) for aim in _carom.bank_routes(as_scene(scene)._native, ball, pocket)]
