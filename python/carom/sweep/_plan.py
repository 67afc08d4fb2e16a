"""The plan of a sweep: its shots, and how they are divided into shards."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

from carom import _carom
from carom._arguments import checked
from carom._files import whole_file
from carom._names import GameName
from carom._scene import Scene, SceneLike, as_scene
from carom.sweep._columns import MOST_SHOTS, Player

FORMAT = "carom sweep plan 2"
#: The number of first shots that every worker compares with the plan before it plays others.
_PROBE = 8
#: Dask needs 3 ms and 9 kB for each (lab/measure/sweep_cost.py).
_MOST_SHARDS = 100_000


class SweepError(RuntimeError):
    """A mismatch of plan, folder or worker, or a wrong file. `str()` names them and says what to do."""


@checked
class Plan(NamedTuple):
    """The shots of a sweep. Made by `plan`, or read by `Plan.load`."""

    scene: str  # TOML
    name: str  # the scene's, for messages
    vary: tuple[str, ...]  # rules of `carom sweep --vary`
    seed: int
    shots: int
    shard: int  # shots per shard; the last one may have fewer
    measures: tuple[str, ...]  # expressions, a column each
    game: str  # the rules for measures such as "foul", or ""
    version: str  # carom's
    probe: str  # digest of the first shots' records, which shows whether a worker's carom gives the same bits

    @property
    def id(self) -> str:
        """SHA-256 of the whole plan."""
        return _digest({"format": FORMAT, **self._asdict()})

    @property
    def shards(self) -> int:
        """The number of shards."""
        return -(-self.shots // self.shard)

    def range(self, shard: int) -> tuple[int, int]:
        """The first shot of a shard, and the one after its last."""
        if not 0 <= shard < self.shards:
            raise ValueError(f"shard={shard}: expected 0 to {self.shards - 1}")
        return shard * self.shard, min((shard + 1) * self.shard, self.shots)

    def file(self, shard: int) -> str:
        """The name of a shard's file in the folder."""
        return f"shard-{shard:0{len(str(self.shards - 1))}}.parquet"

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the plan, or keeps a file with the same plan. Raises SweepError if the file has
        other content."""
        name = os.fspath(path)
        if not os.path.exists(name):
            tree = {"format": FORMAT, **self._asdict(), "sha256": self.id}
            with whole_file(name) as file:
                file.write(json.dumps(tree, indent=1, ensure_ascii=False).encode() + b"\n")
        elif Plan.load(name) != self:
            raise SweepError(f"{name}: another plan is already there; remove it, or write elsewhere")

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Plan:
        """Reads a plan. Raises SweepError for a file that is not a plan or was changed."""
        name = os.fspath(path)
        remedy = "make a new plan with carom.sweep.plan"
        try:
            with open(name, encoding="utf-8") as file:
                tree = json.load(file)
        except json.JSONDecodeError as error:
            raise SweepError(f"{name}:{error.lineno}:{error.colno}: {error.msg}; {remedy}") from None
        except (OSError, ValueError) as error:
            raise SweepError(f"{name}: cannot read it: {getattr(error, 'strerror', None) or error}") from None
        if not isinstance(tree, dict) or tree.get("format") != FORMAT:
            raise SweepError(f'{name}: not a plan of a sweep: "format" must be "{FORMAT}"; {remedy}')
        digest = tree.pop("sha256", None)
        if _digest(tree) != digest:
            raise SweepError(f"{name}: the plan was changed by hand or is damaged; {remedy}")
        del tree["format"]
        return cls(**tree | {key: tuple(tree[key]) for key in ("vary", "measures")})


def _digest(tree: Mapping[str, Any]) -> str:
    return hashlib.sha256(json.dumps(tree, sort_keys=True).encode()).hexdigest()


@lru_cache(maxsize=8)
def player_of(plan: Plan) -> Player:
    """The player of a plan's shots."""
    about = {"carom.plan": plan.id, "carom.version": plan.version}
    scene = Scene.loads(plan.scene, plan.name)
    return Player(scene, plan.vary, plan.seed, plan.measures, plan.game or None, about)


def _probe(player: Player, shots: int) -> str:
    _, status, hashes = player.sweep.play(0, min(shots, _PROBE), 1, True)
    return _digest({"status": status.tolist(), "hash": hashes.tolist()})


@lru_cache(maxsize=8)
def require_same_bits(plan: Plan) -> None:
    """Raises SweepError if this process may play other rows: another version of carom, or other bits."""
    if plan.version != _carom.VERSION or _probe(player_of(plan), plan.shots) != plan.probe:
        here = f"{os.uname().nodename}, process {os.getpid()}: carom {_carom.VERSION}"
        other = f"is another build than the carom {plan.version} that made the plan, or gives other bits"
        raise SweepError(f"{here} {other}; install the same build everywhere, or make a new plan")


@checked
def plan(
    scene: SceneLike, vary: Mapping[str, Any] | Sequence[str], shots: int, *,
    seed: int = 1, shard: int = 250_000, measures: Sequence[str] = (), game: GameName | None = None,
) -> Plan:
    """Makes the plan of a sweep; plays only the first few shots.

    shots: at most 2**53
    shard: shots per file, which a worker keeps in memory; 10 to 60 s of work are a good size
    scene, vary, seed, measures, game: as for `columns`

    Raises ValueError for a number out of range, or a rule that cannot be read or that makes no valid scene,
    and SceneError for the scene.
    """
    scene = as_scene(scene)
    if not 1 <= shots <= MOST_SHOTS:
        raise ValueError(f"shots={shots}: expected 1 to 2**53")
    least = -(-shots // _MOST_SHARDS)
    if shard < least:
        raise ValueError(f"shard={shard}: expected at least {least}, for at most {_MOST_SHARDS} shards")
    player = Player(scene, vary, seed, measures, game)
    return Plan(scene.source, os.path.basename(scene.file), tuple(player.rules), int(seed), int(shots),
                int(shard), tuple(measures), game or "", _carom.VERSION, _probe(player, shots))
