"""The plan of a sweep: its shots, and how they are divided into shards."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from typing import Any, Literal, NamedTuple

from carom import _carom
from carom._arguments import checked
from carom._files import whole_file
from carom._names import GameName
from carom._scene import Scene, SceneLike, as_scene
from carom.sweep._columns import MOST_SHOTS, Player

FORMAT = "carom sweep plan 1"
#: The number of first shots that every worker compares with the plan before it plays others.
_PROBE = 8
_MOST_SHARDS = 10_000_000
#: Which records are hashed: none, some for each shard's digest, or all for a column.
_HASHES = ("none", "digest", "column")
#: A shard's digest is over the shots whose number is a multiple of this. Not all, since hashing takes half
#: as long as a short shot.
HASH_EVERY = 64


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
    hashes: str  # "none", "digest" or "column"
    version: str  # carom's
    probe: str  # digest of the first shots' records, which shows whether a worker's carom gives the same bits
    measures: tuple[str, ...] = ()  # expressions, a column each
    game: str = ""  # the rules for measures such as "foul"

    @property
    def id(self) -> str:
        """SHA-256 of the whole plan."""
        return sha256(canonical(self._content()))

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

    def files(self) -> Iterator[str]:
        """The names of all files, in the order of the shots."""
        return map(self.file, range(self.shards))

    def types(self) -> dict[str, tuple[str, str]]:
        """For every column its type, "int64", "uint64", "float64" or "text", and its unit or ""."""
        types = player_of(self).types()
        return types | {"record_hash": ("uint64", "")} if self.hashes == "column" else types

    def _content(self) -> dict[str, Any]:
        content: dict[str, Any] = {"format": FORMAT, **self._asdict(), "vary": list(self.vary)}
        content["measures"] = list(self.measures)
        # A plan without measures is equal to the plan of earlier versions.
        return content if self.measures else dict(list(content.items())[:-2])

    def text(self) -> str:
        """The content of the plan's file: JSON."""
        return json.dumps({**self._content(), "sha256": self.id}, indent=1, ensure_ascii=False) + "\n"

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the plan, or keeps a file with the same plan. Raises SweepError if the file has
        other content."""
        name = os.fspath(path)
        if os.path.exists(name):
            if Plan.load(name) != self:
                what = "another plan is already there; remove it, or write elsewhere"
                raise SweepError(f"{name}: {what}")
            return
        try:
            with whole_file(name) as file:
                file.write(self.text().encode())
        except OSError as error:
            raise SweepError(f"{name}: cannot write it: {error.strerror}") from None

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Plan:
        """Reads a plan. Raises SweepError for a file that is not a plan or was changed."""
        name = os.fspath(path)
        try:
            with open(name, encoding="utf-8") as file:
                tree = json.load(file)
        except json.JSONDecodeError as error:
            what = f"{error.msg}; a plan is written by carom.sweep.plan(...).save()"
            raise SweepError(f"{name}:{error.lineno}:{error.colno}: {what}") from None
        except (OSError, ValueError) as error:
            raise SweepError(f"{name}: cannot read it: {getattr(error, 'strerror', None) or error}") from None
        return cls._of(tree, name)

    @classmethod
    def _of(cls, tree: Any, name: str) -> Plan:
        if not isinstance(tree, dict) or tree.get("format") != FORMAT:
            raise SweepError(f'{name}: not a plan of a sweep: "format" must be "{FORMAT}"')
        content = {key: value for key, value in tree.items() if key not in ("format", "sha256")}
        digest = sha256(canonical({"format": FORMAT, **content}))
        if tuple(content) not in (cls._fields, cls._fields[:-2]) or tree.get("sha256") != digest:
            what = "the plan was changed by hand or is damaged; make a new one with carom.sweep.plan"
            raise SweepError(f"{name}: {what}")
        lists = {key: tuple(content[key]) for key in ("vary", "measures") if key in content}
        return cls(**content | lists)


def sha256(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


def canonical(tree: Any) -> bytes:
    """A tree as bytes, which are equal if and only if the trees are."""
    return json.dumps(tree, ensure_ascii=False, sort_keys=True, separators=(",", ":")).encode()


@lru_cache(maxsize=8)
def player_of(plan: Plan) -> Player:
    return Player(Scene.loads(plan.scene, plan.name), plan.vary, plan.seed, plan.measures, plan.game or None)


def _probe(player: Player, shots: int) -> str:
    played = player.play(0, min(shots, _PROBE), 1, hash_every=1)
    return sha256(played.hash.astype("<u8").tobytes() + played.status.tobytes())


@lru_cache(maxsize=8)
def wrong_worker(plan: Plan) -> str:
    """Why this process must not play shots of the plan, or "": another version of carom, or other bits."""
    if plan.version != _carom.VERSION:
        versions = f"this is carom {_carom.VERSION}, and the plan is of carom {plan.version}"
        return f"{versions}: install that one here, or make a new plan"
    if _probe(player_of(plan), plan.shots) != plan.probe:
        return (
            f"this carom {_carom.VERSION} gives other bits for the first shots than the carom that made the "
            "plan: install the same build everywhere, or make a new plan"
        )
    return ""


@checked
def plan(
    scene: SceneLike,
    vary: Mapping[str, Any] | Sequence[str],
    shots: int,
    *,
    seed: int = 1,
    shard: int = 250_000,
    hashes: Literal["none", "digest", "column"] = "digest",
    measures: Sequence[str] = (),
    game: GameName | None = None,
) -> Plan:
    """Makes the plan of a sweep; plays only the first few shots.

    scene: a scene, the path of its file, or its tree
    vary: rules as for `carom sweep --vary`, or a mapping from keys to distributions ("normal(0.5)") or lists
        of values
    shots: at most 2**53
    seed: of all draws
    shard: shots per file, and the largest loss of a killed worker; 10 to 60 s of work are a good size
    hashes: "digest" keeps one hash per shard, over the records of every 64th shot, with which the shard can
        be replayed and compared; "column" also keeps `int(record.hash(), 16)` of every shot in a column
        "record_hash", which takes time if shots are short; or "none"
    measures, game: as for `columns`

    Raises ValueError for a number out of range, or a rule that cannot be read or that makes no valid scene,
    and SceneError for the scene.
    """
    scene = as_scene(scene)
    if not 1 <= shots <= MOST_SHOTS:
        raise ValueError(f"shots={shots}: expected 1 to 2**53")
    if shard < 1:
        raise ValueError(f"shard={shard}: expected at least 1")
    if -(-shots // shard) > _MOST_SHARDS:
        least = -(-shots // _MOST_SHARDS)
        what = f"that makes more than {_MOST_SHARDS} shards; use at least {least} shots in each"
        raise ValueError(f"shard={shard}: {what}")
    if hashes not in _HASHES:
        raise ValueError(f"hashes={hashes!r}: expected one of {', '.join(_HASHES)}")
    player = Player(scene, vary, seed, measures, game)
    name = os.path.basename(scene.file)
    probe = _probe(player, shots)
    made = Plan(scene.source, name, tuple(player.rules), int(seed), int(shots), int(shard), hashes,
                _carom.VERSION, probe, tuple(measures), game or "")
    if "record_hash" in player.types():
        raise ValueError("vary: record_hash names a column that is always there")
    return made
