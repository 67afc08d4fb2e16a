"""Files that appear complete or not at all."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from typing import BinaryIO


@contextlib.contextmanager
def whole_file(path: str) -> Iterator[BinaryIO]:
    """A file to write. It gets its name once it is complete, and then survives a power cut. Raises OSError,
    which names `path`."""
    grows = f"{path}.{os.urandom(4).hex()}.tmp"
    try:
        with open(grows, "xb") as file:
            yield file
            file.flush()
            os.fsync(file.fileno())
        os.replace(grows, path)
        folder = os.open(os.path.dirname(path) or ".", os.O_RDONLY)
        try:
            os.fsync(folder)
        finally:
            os.close(folder)
    except OSError as error:
        raise OSError(error.errno, f"cannot write: {error.strerror or error}", path) from None
    finally:
        if os.path.exists(grows):
            os.unlink(grows)
