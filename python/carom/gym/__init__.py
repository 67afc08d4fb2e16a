"""Learning environments: `import carom.gym` registers them with Gymnasium. It needs the extra [gym].

`gymnasium.make("carom/Pot-v0")` makes one table, `gymnasium.make_vec("carom/Pot-v0", num_envs=256)` a batch.
See docs/guide/learning.md.
"""

from __future__ import annotations

import reprlib
from typing import Any

try:
    import gymnasium
except ImportError as error:
    raise ImportError("carom.gym needs Gymnasium: pip install gymnasium") from error

from carom._arguments import checked
from carom.gym._env import FeaturePlanes, TableEnv
from carom.gym._games import (
    EightBallRun, Game, Judged, NineBallRun, Position, Pot, States, SumToThree, ThreeCushion)
from carom.gym._strikes import Strikes
from carom.gym._tables import Rollout
from carom.gym._vector import TableVectorEnv

__all__ = [
    "GAMES",
    "EightBallRun",
    "FeaturePlanes",
    "Game",
    "Judged",
    "NineBallRun",
    "Position",
    "Pot",
    "Rollout",
    "States",
    "Strikes",
    "SumToThree",
    "TableEnv",
    "TableVectorEnv",
    "ThreeCushion",
    "make_env",
    "make_vector_env",
]

#: The games by their names in "carom/NAME-v0".
GAMES: dict[str, type[Game]] = {
    "Pot": Pot,
    "Position": Position,
    "ThreeCushion": ThreeCushion,
    "SumToThree": SumToThree,
    "NineBallRun": NineBallRun,
    "EightBallRun": EightBallRun,
}
#: The options that belong to the game rather than the environment.
_OWN = ("table", "scene")


def _game(name: str, options: dict[str, Any]) -> Game:
    """Makes the game from its own options, which it removes from the others."""
    if name not in GAMES:
        raise ValueError(f"game: expected {', '.join(GAMES)}, not {reprlib.repr(name)}")
    return GAMES[name](**{key: options.pop(key) for key in _OWN if key in options})


@checked
def make_env(game: str, **options: Any) -> TableEnv:
    """`gymnasium.make(f"carom/{game}-v0", ...)` without Gymnasium's wrappers."""
    return TableEnv(_game(game, options), **options)


@checked
def make_vector_env(game: str, num_envs: int = 1, **options: Any) -> TableVectorEnv:
    """The same as `gymnasium.make_vec(f"carom/{game}-v0", ...)`."""
    return TableVectorEnv(_game(game, options), num_envs, **options)


for _name in GAMES:
    gymnasium.register(
        f"carom/{_name}-v0",
        entry_point="carom.gym:make_env",
        vector_entry_point="carom.gym:make_vector_env",
        kwargs={"game": _name},
    )
