"""Small JSON documents with a format and a version, and new files that replace nothing."""

import errno
import json
import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, BinaryIO, TextIO

from coinmc._errors import VisionError

__all__ = ["document", "new_file", "open_plain"]

_MOST_BYTES = 1 << 20


@contextmanager
def open_plain(path: Path | str) -> Iterator[BinaryIO]:
    """Open a file to read it. A pipe or a device, which might never end, is an `OSError`."""
    with open(path, "rb", opener=_at_once) as file:
        if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
            raise OSError(errno.EINVAL, "it is not a plain file", str(path))
        yield file


def _at_once(path: str, flags: int) -> int:
    # a pipe is opened only when another program writes to it, if this is not said
    return os.open(path, flags | getattr(os, "O_NONBLOCK", 0))


def document(path: Path | str, kind: str, version: int) -> dict[str, Any]:
    """Read a JSON document of this format and version.

    Raises
    ------
    coinmc.VisionError
        If it cannot be read, is another kind of file or has a newer version.
    """
    try:
        with open_plain(path) as file:
            content = file.read(_MOST_BYTES + 1)
    except OSError as error:
        raise VisionError(f"{path} cannot be read: {error.strerror}") from error
    if len(content) > _MOST_BYTES:
        raise VisionError(f"{path} is too large for a {kind} file: at most 1 MiB")
    try:
        read = json.loads(content)
    except (ValueError, RecursionError) as error:
        raise VisionError(f"{path} is not JSON: {error}") from error
    if not isinstance(read, dict) or read.get("format") != kind:
        raise VisionError(f"{path} is not a {kind} file")
    if read.get("version") != version:
        raise VisionError(
            f"{path} has version {read.get('version')!r}, but this program reads {version}"
        )
    return read


@contextmanager
def new_file(path: Path | str) -> Iterator[TextIO]:
    """Open a new text file.

    Raises
    ------
    coinmc.VisionError
        If it exists or cannot be written.
    """
    try:
        with open(path, "x", encoding="utf-8") as file:
            yield file
    except FileExistsError:
        raise VisionError(f"{path} exists: give a new name") from None
    except OSError as error:
        raise VisionError(f"{path} cannot be written: {error.strerror}") from error
