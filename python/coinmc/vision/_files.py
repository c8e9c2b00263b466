"""Small JSON documents with a format and a version, and new files that replace nothing."""

import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TextIO

from coinmc._errors import VisionError

__all__ = ["document", "new_file"]

_MOST_BYTES = 1 << 20


def document(path: Path | str, kind: str, version: int) -> dict[str, Any]:
    """Read a JSON document of this format and version.

    Raises
    ------
    coinmc.VisionError
        If it cannot be read, is another kind of file or has a newer version.
    """
    try:
        with open(path, "rb") as file:
            content = file.read(_MOST_BYTES + 1)
        if len(content) > _MOST_BYTES:
            raise VisionError(f"{path} is too large for a {kind} file: at most 1 MiB")
        read = json.loads(content)
    except OSError as error:
        raise VisionError(f"{path} cannot be read: {error.strerror}") from error
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
