"""Games on the table: rules, aiming aids, and the noise of a player's strike.

Pure functions, the same as in C++ (`carom/games/*.h`). A game is a loop: `new_game`, then for every shot
`legal`, `carom.simulate`, `judge`, a choice among the verdict's options, and `next_scene`.
"""

from carom._types import (
    Advice,
    Aim,
    Call,
    Cue,
    Foul,
    GameInfo,
    Legal,
    Noise,
    Option,
    PocketLine,
    Respot,
    RuleOption,
    Share,
    State,
    Verdict,
)
from carom.games._aim import aim_pot, bank_routes, cut_angle_deg, ghost_ball, pocket_lines
from carom.games._noise import STRIKE, noisy
from carom.games._player import SKILLS, Player, PlayerShot, advise
from carom.games._rules import (
    GAMES,
    all_games,
    book_of,
    judge,
    legal,
    may_place,
    new_game,
    next_scene,
    rule_options,
    spots,
)

__all__ = [
    "GAMES",
    "SKILLS",
    "STRIKE",
    "Advice",
    "Aim",
    "Call",
    "Cue",
    "Foul",
    "GameInfo",
    "Legal",
    "Noise",
    "Option",
    "Player",
    "PlayerShot",
    "PocketLine",
    "Respot",
    "RuleOption",
    "Share",
    "State",
    "Verdict",
    "advise",
    "aim_pot",
    "all_games",
    "bank_routes",
    "book_of",
    "cut_angle_deg",
    "ghost_ball",
    "judge",
    "legal",
    "may_place",
    "new_game",
    "next_scene",
    "noisy",
    "pocket_lines",
    "rule_options",
    "spots",
]
