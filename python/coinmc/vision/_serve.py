"""The camera of ``coinmc robot``: requests and replies as lines of JSON."""

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any, TextIO

from coinmc._errors import VisionError
from coinmc.vision._classify import Classifier
from coinmc.vision._sources import Source
from coinmc.vision._store import PhotoStore

__all__ = ["serve"]

#: Longest line, bytes, as in the protocol of docs/guide/robot.md.
LONGEST_LINE = 1 << 16


def serve(source: Source, classifier: Classifier, lines: Iterable[str], replies: TextIO) -> None:
    """Reply to requests until they end.

    Parameters
    ----------
    source : Source
        Where photos come from.
    classifier : Classifier
        Reads them.
    lines : iterable of str
        Requests.
    replies : file
        Replies are written to it, one line each.
    """
    for line in lines:
        request = _request(line)
        about = _about(request)
        try:
            reply = _reply(source, classifier, request, about)
        except VisionError as error:
            reply = {"error": str(error)[: LONGEST_LINE // 8]}
        # the host takes no reply that could be about another photo
        replies.write(json.dumps({**about, **reply}) + "\n")
        replies.flush()


def _request(line: str) -> dict[str, Any]:
    try:
        request = json.loads(line) if len(line) < LONGEST_LINE else None
    except (ValueError, RecursionError):
        request = None
    return request if isinstance(request, dict) else {}


def _about(request: dict[str, Any]) -> dict[str, int]:
    """Return throw, attempt and number of a request; nothing if it lacks one of them."""
    asked = request.get("take", request)
    if not isinstance(asked, dict):
        return {}
    about = {key: asked.get(key) for key in ("throw", "attempt", "request")}
    good = all(type(n) is int and 0 <= n < 1 << 32 for n in about.values())
    return about if good else {}


def _reply(
    source: Source, classifier: Classifier, request: dict[str, Any], about: dict[str, int]
) -> dict[str, Any]:
    match request:
        case {"take": dict(take), **rest} if not rest:
            return _take(source, take, about)
        case {"classify": str(path), **rest} if about and rest == about:
            return _classify(classifier, Path(path))
    raise VisionError(
        "a request is take, or classify with throw, attempt and request: docs/guide/robot.md"
    )


def _take(source: Source, take: dict[str, Any], about: dict[str, int]) -> dict[str, Any]:
    folder, name = take.get("folder"), take.get("name")
    if not about or not isinstance(folder, str) or not isinstance(name, str):
        raise VisionError("take has throw, attempt, request, folder and name")
    if not Path(folder).is_absolute() or not Path(folder).is_dir():
        raise VisionError("the folder must be absolute, and exist")
    content, kind = source.take(about["throw"], name)
    of = {"throw": about["throw"], "attempt": about["attempt"]}
    return {"image": PhotoStore(Path(folder)).keep(name, kind, content, **of)}


def _classify(classifier: Classifier, path: Path) -> dict[str, Any]:
    reading = classifier.read(path).document()
    PhotoStore(path.parent).read(path.name, reading)
    return reading
