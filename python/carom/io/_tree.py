"""The contents of an untrusted file. For any content, the only exception is SceneError, and memory is bounded
by a multiple of its size."""

from __future__ import annotations

import json
import math
import re
from typing import Any, NoReturn

import numpy as np

from carom._errors import SceneError

_READS = "pooltool writes JSON if the name of the file ends in .json, and MessagePack for .msgpack"
_NUMBER = re.compile("[0-9]{1,18}")
#: The types of numpy's numbers in MessagePack that Python also has.
_TYPE = re.compile("[<>=|]?(b1|[iu][1248]|f[248])")
#: pooltool saves vectors and matrices.
_MOST_DIMENSIONS = 2


class Tree:
    """A part of the file, with its path for messages."""

    def __init__(self, file: str, value: Any, path: str = "") -> None:
        self.file, self.value, self.path = file, value, path

    def fail(self, what: str) -> NoReturn:
        wanted = "expected a System as pooltool 0.6.0 saves it"
        raise SceneError(f"{self.path or 'the file'} {what}; {wanted}", self.file)

    def at(self, key: str) -> Tree:
        part = Tree(self.file, None, f"{self.path}.{key}" if self.path else key)
        if not isinstance(self.value, dict) or key not in self.value:
            part.fail("is missing")
        part.value = self.value[key]
        return part

    def items(self) -> list[tuple[str, Tree]]:
        """The members of an object, those with numbers as names sorted by number."""
        if not isinstance(self.value, dict):
            self.fail("is not an object")
        if not all(isinstance(name, str) for name in self.value):
            self.fail("has a name that is not a string")

        def place(name: str) -> tuple[int, int, str]:
            number = name.rstrip("t")
            return (0, int(number), "") if _NUMBER.fullmatch(number) else (1, 0, name)

        order = sorted(self.value, key=place)
        return [(name, self.at(name)) for name in order]

    def parts(self) -> list[Tree]:
        if not isinstance(self.value, list):
            self.fail("is not a list")
        return [Tree(self.file, value, f"{self.path}[{i}]") for i, value in enumerate(self.value)]

    def number(self) -> float:
        try:
            if isinstance(self.value, (int, float)) and not isinstance(self.value, bool):
                number = float(self.value)
                if math.isfinite(number):
                    return number
        except OverflowError:
            pass
        self.fail("is not a number")

    def numbers(self, count: int) -> list[float]:
        parts = self.parts()
        if len(parts) != count:
            self.fail(f"has {len(parts)} numbers instead of {count}")
        return [part.number() for part in parts]

    def text(self) -> str:
        if not isinstance(self.value, str):
            self.fail("is not a string")
        return self.value


def read_tree(name: str) -> Tree:
    """The contents of a file. Raises SceneError if it cannot be read or is of another kind."""
    tree = Tree(name, _unpacked(name) if name.endswith(".msgpack") else _parsed(name))
    return tree


def _contents(name: str) -> bytes:
    try:
        with open(name, "rb") as file:
            return file.read()
    except OSError as error:
        raise SceneError(f"cannot be read: {error.strerror}", name) from None


def _parsed(name: str) -> Any:
    try:
        text = _contents(name).decode()
        value = json.loads(text)
        # JSON can name half of a surrogate pair, which is no text.
        json.dumps(value, ensure_ascii=False).encode()
        return value
    except json.JSONDecodeError as error:
        what = f"is not JSON: {error.msg}; {_READS}"
        raise SceneError(what, name, error.lineno, error.colno) from None
    except UnicodeDecodeError:
        raise SceneError(f"is not JSON because it is not UTF-8; {_READS}", name) from None
    except UnicodeEncodeError:
        raise SceneError("has a text with half of a surrogate pair", name) from None
    except RecursionError:
        raise SceneError("has too many nested objects", name) from None
    except ValueError as error:  # an integer with thousands of digits
        raise SceneError(f"has a number that is too long: {error}", name) from None


def _array(item: dict[Any, Any]) -> Any:
    """Reads the maps of msgpack-numpy: arrays and numbers of numpy are maps with their type and bytes."""
    if b"nd" not in item:
        return item
    kind = item[b"type"]
    if not isinstance(kind, str) or not _TYPE.fullmatch(kind):
        raise ValueError(f"an array of type {kind!r:.40}")
    array = np.frombuffer(item[b"data"], kind)
    if not item[b"nd"]:
        return array[0].item()
    shape = item[b"shape"]
    sizes = isinstance(shape, list) and len(shape) <= _MOST_DIMENSIONS and all(
        isinstance(size, int) and 0 < size <= array.size for size in shape)
    # Without this, a few bytes can request [20000, 20000, 0] lists.
    if not sizes or math.prod(shape) != array.size:
        raise ValueError(f"an array of {array.size} numbers with the shape {shape!r:.40}")
    return array.reshape(shape).tolist()


def _unpacked(name: str) -> Any:
    try:
        import msgpack
    except ImportError:
        what = "is MessagePack, which needs the package msgpack; install it, or save as .json in pooltool"
        raise SceneError(what, name) from None
    data = _contents(name)
    try:
        # The package allocates memory for the declared number of members of every nested list.
        # Skipping allocates none, and fails if members are missing.
        complete = msgpack.Unpacker(max_buffer_size=max(1, len(data)), strict_map_key=False)
        complete.feed(data)
        complete.skip()
        return msgpack.unpackb(data, object_hook=_array, strict_map_key=False)
    except msgpack.OutOfData:
        raise SceneError("is not MessagePack as pooltool saves it: it ends too early", name) from None
    except (ValueError, KeyError, TypeError, IndexError, OverflowError, RecursionError,
            msgpack.UnpackException) as error:
        raise SceneError(f"is not MessagePack as pooltool saves it: {error}", name) from None
