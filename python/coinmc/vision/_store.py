"""Photos and what was read in them, stored so that nothing is lost, replaced or exchanged."""

import hashlib
import json
import os
import re
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from coinmc._errors import VisionError
from coinmc.vision._files import open_plain
from coinmc.vision._photo import MOST_BYTES

__all__ = ["LOG", "PhotoStore", "digest", "logged"]

#: The log in the folder of the photos.
LOG = "photos.jsonl"
FORMAT = "coinmc-photos"
VERSION = 1
_NAME = re.compile(r"[A-Za-z0-9_-][A-Za-z0-9_.-]{0,79}")
_LONGEST_LINE = 1 << 14
_PIECE = 1 << 20


@dataclass
class PhotoStore:
    """The folder of an experiment's photos.

    Attributes
    ----------
    folder : Path
        The folder.
    """

    folder: Path

    def keep(self, name: str, kind: str, content: bytes, **more: Any) -> str:
        """Store a photo on the disk and its SHA-256 in the log; return its name with extension.

        Raises
        ------
        coinmc.VisionError
            If the name could lead out of the folder, there is a photo of that name, or the disk
            does not take it.
        """
        if not _NAME.fullmatch(name):
            raise VisionError("a photo's name has 1 to 80 letters, digits, -, _ and .")
        image = f"{name}.{kind}"
        try:
            with (self.folder / image).open("xb") as file:
                file.write(content)
                file.flush()
                os.fsync(file.fileno())
            digest = hashlib.sha256(content).hexdigest()
            self._log({"image": image, "sha256": digest, "bytes": len(content), **more})
        except FileExistsError as error:
            raise VisionError(f"{image} exists, and photos are not replaced") from error
        except OSError as error:
            raise VisionError(f"cannot store a photo in {self.folder}: {error.strerror}") from error
        return image

    def read(self, image: str, reading: dict[str, Any]) -> None:
        """Add what was read in a photo to the log."""
        try:
            self._log({"image": image, "reading": reading})
        except OSError as error:
            raise VisionError(f"cannot write {self.folder / LOG}: {error.strerror}") from error

    def _log(self, entry: dict[str, Any]) -> None:
        line = json.dumps({**entry, "at_ms": time.time_ns() // 1_000_000}) + "\n"
        with (self.folder / LOG).open("ab+") as file:
            if file.tell() == 0:
                line = json.dumps({"format": FORMAT, "version": VERSION}) + "\n" + line
            else:
                file.seek(-1, os.SEEK_END)
                # the line before is incomplete if the power failed
                line = line if file.read(1) == b"\n" else "\n" + line
            file.write(line.encode())
            file.flush()
            os.fsync(file.fileno())


def logged(folder: Path) -> Iterator[dict[str, Any]]:
    """Read the entries of a log; incomplete lines are left out, and those that name no image.

    Raises
    ------
    coinmc.VisionError
        If there is a log that cannot be read, or of another format or version.
    """
    path = folder / LOG
    try:
        with open_plain(path) as file:
            head = _entry(file.readline(_LONGEST_LINE))
            if head.get("format") != FORMAT or head.get("version") != VERSION:
                raise VisionError(f"{path} is not a log of photos of version {VERSION}")
            while line := file.readline(_LONGEST_LINE):
                entry = _entry(line)
                image = entry.get("image")
                # no file has a name with a zero, and a terminal might obey one with an escape
                if isinstance(image, str) and image.isprintable():
                    yield entry
    except (FileNotFoundError, NotADirectoryError):
        return
    except OSError as error:
        raise VisionError(f"{path} cannot be read: {error.strerror}") from error


def digest(path: Path) -> str:
    """Return the SHA-256 of a photo, which is not read as a whole.

    Raises
    ------
    coinmc.VisionError
        If it cannot be read, or is larger than photos may be; the message says why.
    """
    found, length = hashlib.sha256(), 0
    try:
        with open_plain(path) as file:
            while length <= MOST_BYTES and (piece := file.read(_PIECE)):
                found.update(piece)
                length += len(piece)
    except OSError as error:
        raise VisionError(f"{path.name} cannot be read: {error.strerror}") from error
    if length > MOST_BYTES:
        raise VisionError(f"{path.name} is larger than {MOST_BYTES >> 20} MiB")
    return found.hexdigest()


def _entry(line: bytes) -> dict[str, Any]:
    try:
        entry = json.loads(line)
    except (ValueError, RecursionError):
        return {}
    return entry if isinstance(entry, dict) else {}
