"""Names that arguments take, for editors and type checkers. A test compares them with the engine's lists."""

from __future__ import annotations

from typing import Literal, TypeAlias

from carom._arguments import may_be
from carom._types import GameName as GameName

RackName: TypeAlias = Literal["nine_ball", "ten_ball", "eight_ball"]
TableName: TypeAlias = Literal["seven_foot", "seven_foot_bar", "eight_foot", "nine_foot", "snooker",
                               "english_pool", "carom", "carom_ten_foot"]
CameraName: TypeAlias = Literal["scene", "top", "rail", "player", "follow"]
OverlayName: TypeAlias = Literal["trails", "events", "spin", "ghost", "clock", "diamonds"]
BallBallModel: TypeAlias = Literal["mathavan", "inelastic", "elastic"]
CushionModel: TypeAlias = Literal["han_2005", "mathavan_2010", "stronge", "impulse", "smooth"]

for _name in ("GameName", "RackName", "TableName", "CameraName", "OverlayName", "BallBallModel",
              "CushionModel"):
    may_be(_name, "str")
