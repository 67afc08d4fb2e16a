"""A player of pool: advice, and an opponent."""

from __future__ import annotations

from typing import Any, NamedTuple

from carom import _carom
from carom._arguments import checked
from carom._scene import Scene, SceneLike, as_scene, scene_with_cue
from carom._types import Advice, Call, State
from carom.games._noise import noisy

#: The levels of a player, the weakest first.
SKILLS: tuple[str, ...] = tuple(_carom.skills())


@checked
def advise(
    state: State, scene: SceneLike, skill: str = "professional", *, seed: int = 1, best: int = 3,
    shots: int = 400, threads: int = 1,
) -> list[Advice]:
    """The best shots of different kind, ball or pocket, the best first; at least one.

    scene: the balls, at rest; for a break, the rack. The cue ball may be missing while it is in hand
    skill: size of the player's errors and depth of its search: one of `SKILLS`
    best: largest number of shots advised
    shots: fresh shots for each; 0: none, and `makes` and `fouls` come from the search
    threads: 0 uses every core; the result does not depend on it

    Raises ValueError for a game without a player (`carom.games.rules` of eight-ball, nine-ball and ten-ball
    have one), a game that is over, and a state that does not fit the scene.
    """
    if best < 1 or shots < 0 or threads < 0:
        raise ValueError("best must be at least 1, shots and threads at least 0")
    advice: list[Advice] = _carom.advise(state, as_scene(scene)._native, skill, seed, best, shots, threads)
    return advice


class PlayerShot(NamedTuple):
    """A player's shot, with its errors."""

    words: str  # its intention
    scene: Scene  # the shot
    call: Call
    cue: dict[str, Any]  # the strike, as for `carom.Scene`
    place: tuple[float, float] | None  # of the cue ball, if it is in hand [m]


@checked
class Player:
    """An opponent: it tries to play the best advice, and strikes with the errors of its level.

    skill: one of `SKILLS`
    """

    def __init__(self, skill: str = "club", seed: int = 1) -> None:
        if skill not in SKILLS:
            raise ValueError(f"skill={skill!r}: expected {', '.join(SKILLS)}")
        self.skill, self.seed, self._shots = skill, seed, 0

    def shot(self, state: State, scene: SceneLike) -> PlayerShot:
        """The next shot from a table at rest. Raises ValueError as `advise`."""
        self._shots += 1
        table = as_scene(scene)
        seed = (self.seed * 1_000_003 + self._shots) % 2**63
        best = advise(state, table, self.skill, seed=seed, best=1, shots=0)[0]
        cue = noisy(best.cue._asdict(), _carom.noise_of_skill(self.skill, 0.028575), self.seed, self._shots)
        shot = scene_with_cue(cue, lambda section: _carom.struck(table._native, best.place, section))
        return PlayerShot(best.words, shot, best.call, cue, best.place)
