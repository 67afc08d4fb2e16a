"""Aiming aids: by geometry if that is exact, otherwise by playing the shot."""

from __future__ import annotations

from typing import TYPE_CHECKING

from carom import _carom
from carom._arguments import checked
from carom._scene import SceneLike, as_scene
from carom._types import Aim, PocketLine
from carom.games._rules import _two

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


@checked
def ghost_ball(ball: ArrayLike, towards: ArrayLike, radius: float = 0.028575) -> tuple[float, float]:
    """The cue ball's centre [m] when it meets a ball of the same radius and, without throw, sends it along
    `towards`.

    towards: a unit vector
    """
    return _carom.ghost_ball(_two(ball), _two(towards), 2.0 * radius)


@checked
def cut_angle_deg(cue_ball: ArrayLike, ghost: ArrayLike, towards: ArrayLike) -> float:
    """The angle between the cue ball's path to the ghost ball and the object ball's path.

    0 is a straight shot; from 90 on, the cut is impossible.
    """
    return _carom.cut_angle_deg(_two(cue_ball), _two(ghost), _two(towards))


@checked
def pocket_lines(scene: SceneLike, ball: str, cue_ball: str = "cue") -> list[PocketLine]:
    """One line for every pocket of the table. Raises ValueError for a missing ball.

    The cue ball blocks no path, because it will have moved.
    """
    lines: list[PocketLine] = _carom.pocket_lines(as_scene(scene)._native, ball, cue_ball)
    return lines


@checked
def aim_pot(scene: SceneLike, ball: str, pocket: str) -> Aim:
    """The aim that pots a ball into a pocket ("p1", ...).

    The search starts at the ghost ball and plays the shot until the ball runs down the middle of its paths.

    scene: its cue gives the strike; the cue's aim is ignored

    Raises ValueError for a missing ball or pocket, a scene without a cue, and a shot that does not end at
    rest.
    """
    aim: Aim = _carom.aim_pot(as_scene(scene)._native, ball, pocket)
    return aim


@checked
def bank_routes(scene: SceneLike, ball: str, pocket: str) -> list[Aim]:
    """Aims that pot a ball off one cushion, at most one per straight cushion. Otherwise like `aim_pot`."""
    aims: list[Aim] = _carom.bank_routes(as_scene(scene)._native, ball, pocket)
    return aims
