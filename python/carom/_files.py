"""Files that appear complete or not at all."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Iterator
from typing import BinaryIO


@contextlib.contextmanager
def whole_file(
    path: str, temporary: str = "", publish: Callable[[str, str], None] = os.replace
) -> Iterator[BinaryIO]:
    """A file to write. It gets its name once it is complete, and then survives a power cut. Raises OSError.

    temporary: the file's name until then
    publish: gives the file its name
    """
    grows = temporary or f"{path}.{os.urandom(4).hex()}.tmp"
    try:
        with open(grows, "xb") as file:
            yield file
            file.flush()
            os.fsync(file.fileno())
        publish(grows, path)
    finally:
        if os.path.exists(grows):
            os.unlink(grows)
    folder = os.open(os.path.dirname(path) or ".", os.O_RDONLY)
    try:
        os.fsync(folder)
    finally:
        os.close(folder)
