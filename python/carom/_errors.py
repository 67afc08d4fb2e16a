"""Errors with the engine's messages."""

from __future__ import annotations

import errno
import os


class SceneError(ValueError):
    """A mistake in a scene or a record file.

    `str()` is "file:line:column: what is wrong and what to do", without the line and column if there are
    none, as in a scene that was built in code.

    message: what is wrong and what to do, without the place
    file: the name of the file, or the name that was given to the text
    line, column: counted from 1, or None
    """

    message: str
    file: str
    line: int | None
    column: int | None

    def __init__(self, message: str, file: str = "scene", line: int = 0, column: int = 0) -> None:
        super().__init__(message, file, line, column)
        self.message = message
        self.file = file
        self.line = line if line > 0 else None
        self.column = column if line > 0 else None

    def __str__(self) -> str:
        place = "" if self.line is None else f":{self.line}:{self.column}"
        return f"{self.file}{place}: {self.message}"


class SceneNotFoundError(SceneError, FileNotFoundError):
    """The file of a scene or a record does not exist: a SceneError, and a FileNotFoundError as of `open`."""

    def __init__(self, message: str, file: str, line: int = 0, column: int = 0) -> None:
        super().__init__(message, file, line, column)
        self.errno, self.strerror, self.filename = errno.ENOENT, os.strerror(errno.ENOENT), file

    def __reduce__(self) -> tuple[type[SceneNotFoundError], tuple[str, str]]:
        return SceneNotFoundError, (self.message, self.file)


def check_exists(path: str) -> None:
    if not os.path.lexists(path):
        raise SceneNotFoundError("cannot be read: there is no such file; check the path", path)
