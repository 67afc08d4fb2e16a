"""Checks of arguments: `checked` checks the arguments of public functions against their annotations."""

from __future__ import annotations

import ast
import functools
import os
import reprlib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from types import FunctionType
from typing import Any, NamedTuple, TypeVar

import numpy as np

_Public = TypeVar("_Public")


class ArgumentError(TypeError, ValueError):
    """An argument of the wrong type. It is also a ValueError, which earlier versions raised."""


class _Kind(NamedTuple):
    words: str
    takes: Callable[[Any], bool]


def _is(*types: type) -> Callable[[Any], bool]:
    return lambda value: isinstance(value, types)


def _is_number(value: Any) -> bool:
    if not isinstance(value, (int, float, np.integer, np.floating)):
        return False
    try:
        float(value)
    except OverflowError:  # an integer of 309 digits and more
        return False
    return True


def _is_numbers(value: Any) -> bool:
    if value is None or isinstance(value, (str, bytes)):
        return False
    try:
        array = np.asarray(value)
        return (array.astype(np.float64) if array.dtype.kind == "O" else array).dtype.kind in "biuf"
    # Lists of different lengths, non-numbers, or integers that are too large.
    except (TypeError, ValueError, OverflowError):
        return False


def _is_list(value: Any) -> bool:
    return isinstance(value, (Sequence, np.ndarray)) and not isinstance(value, (str, bytes))


_ANY = _Kind("anything", lambda value: True)
_KINDS = {
    "Any": _ANY,
    "object": _ANY,
    "Observation": _ANY,
    "bool": _Kind("a bool", _is(bool, np.bool_)),
    "int": _Kind("a whole number", _is(int, np.integer)),
    "float": _Kind("a number", _is_number),
    "str": _Kind("a string", _is(str)),
    "Literal": _Kind("a string", _is(str)),
    "PathLike": _Kind("a path", _is(os.PathLike)),
    "Callable": _Kind("a function", callable),
    "Mapping": _Kind("a mapping", _is(Mapping)),
    "dict": _Kind("a dict", _is(dict)),
    "Sequence": _Kind("a list", _is_list),
    "tuple": _Kind("a list", _is_list),
    "Iterable": _Kind("a list", lambda value: _is(Iterable)(value) and not _is(str, bytes, Mapping)(value)),
    "ArrayLike": _Kind("an array of numbers", _is_numbers),
    "NDArray": _Kind("a numpy array", _is(np.ndarray)),
}


def _either(one: _Kind, other: _Kind) -> _Kind:
    if _ANY in (one, other):
        return _ANY
    return _Kind(f"{one.words} or {other.words}", lambda value: one.takes(value) or other.takes(value))


def _named(name: str) -> _Kind:
    """A class by its name, so that it need not be imported here."""
    article = "an" if name[0] in "AEIOU" else "a"
    return _Kind(f"{article} {name}", lambda value: name in (base.__name__ for base in type(value).__mro__))


def _plural(words: str) -> str:
    """Turns "a string or a list of numbers" into "strings or lists of numbers"."""
    nouns = [word.removeprefix("an ").removeprefix("a ").partition(" of ") for word in words.split(" or ")]
    return " or ".join(f"{noun}s{of}{items}" for noun, of, items in nouns)


def _with_items(whole: _Kind, inner: _Kind, count: int | None) -> _Kind:
    def takes(value: Any) -> bool:
        if not whole.takes(value) or count not in (None, len(value)):
            return False
        # An iterator can be read only once, and not here.
        return isinstance(value, Iterator) or all(map(inner.takes, value))

    items = _plural(inner.words) if count is None else f"{count} {_plural(inner.words)}"
    return _Kind(f"{whole.words} of {items}", takes)


def _kind(annotation: ast.expr) -> _Kind:
    match annotation:
        case ast.Constant(value=None):
            return _Kind("None", lambda value: value is None)
        case ast.BinOp(left=left, right=right):
            return _either(_kind(left), _kind(right))
        case ast.Subscript(value=ast.Name(id="Sequence" | "Iterable" as name), slice=inner):
            return _with_items(_KINDS[name], _kind(inner), None)
        case ast.Subscript(value=ast.Name(id="tuple"), slice=ast.Tuple(elts=[inner, *_] as items)):
            endless = isinstance(items[-1], ast.Constant)  # tuple[str, ...]
            return _with_items(_KINDS["tuple"], _kind(inner), None if endless else len(items))
        case ast.Subscript(value=whole):
            return _kind(whole)
        case ast.Attribute(attr=name) | ast.Name(id=name):
            return _named(name) if name not in _KINDS else _KINDS[name]
    return _ANY


def may_be(alias: str, annotation: str) -> None:
    """Defines `alias` as another annotation."""
    _KINDS[alias] = _kind(ast.parse(annotation, mode="eval").body)


def _check(name: str, kind: _Kind, value: Any) -> None:
    if not kind.takes(value):
        words = kind.words.replace(" or ", ", ", kind.words.count(" or ") - 1)
        raise ArgumentError(f"{name}: expected {words}, not {reprlib.repr(value)} ({type(value).__name__})")


def _checked(function: Any) -> Callable[..., Any]:
    code = function.__code__
    names = code.co_varnames[: code.co_argcount]
    kinds: dict[str, _Kind] = {}
    others = _ANY  # of **names

    def read() -> None:
        nonlocal kinds, others
        texts = {name: text for name, text in function.__annotations__.items() if name != "return"}
        kinds = {name: _kind(ast.parse(text, mode="eval").body) for name, text in texts.items()}
        if code.co_flags & 0x08:
            others = kinds[code.co_varnames[code.co_argcount + code.co_kwonlyargcount]]

    @functools.wraps(function)
    def call(*arguments: Any, **named: Any) -> Any:
        if not kinds:
            read()
        for name, value in (*zip(names, arguments), *named.items()):
            _check(name, kinds.get(name, _ANY if name == "self" else others), value)
        return function(*arguments, **named)

    return call


def checked(of: _Public) -> _Public:
    """A public function, or a class with its public methods, that raises ArgumentError for a wrong argument
    type."""
    if not isinstance(of, type):
        return _checked(of)  # type: ignore[return-value]
    for name, part in list(vars(of).items()):
        if name.startswith("_") and name != "__init__":
            continue
        if isinstance(part, FunctionType):
            setattr(of, name, _checked(part))
        elif isinstance(part, (classmethod, staticmethod)):
            setattr(of, name, type(part)(_checked(part.__func__)))
    return of
