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
        try:
            reply = _reply(source, classifier, line)
        except VisionError as error:
            reply = {"error": str(error)[: LONGEST_LINE // 8]}
        replies.write(json.dumps(reply) + "\n")
        replies.flush()


def _reply(source: Source, classifier: Classifier, line: str) -> dict[str, Any]:
    try:
        request = json.loads(line) if len(line) < LONGEST_LINE else None
    except (ValueError, RecursionError):
        request = None
    if isinstance(request, dict) and len(request) == 1:
        if isinstance(request.get("take"), dict):
            return _take(source, request["take"])
        if isinstance(request.get("classify"), str):
            return _classify(classifier, Path(request["classify"]))
    raise VisionError("a request is take or classify, as docs/guide/robot.md says")


def _take(source: Source, take: dict[str, Any]) -> dict[str, Any]:
    throw, attempt = take.get("throw"), take.get("attempt")
    folder, name = take.get("folder"), take.get("name")
    good = all(isinstance(n, int) and 0 <= n < 1 << 32 for n in (throw, attempt))
    if not good or not isinstance(folder, str) or not isinstance(name, str):
        raise VisionError("take has throw, attempt, folder and name")
    if not Path(folder).is_absolute() or not Path(folder).is_dir():
        raise VisionError("the folder must be absolute, and exist")
    content, kind = source.take(throw, attempt)
    store = PhotoStore(Path(folder))
    return {"image": store.keep(name, kind, content, throw=throw, attempt=attempt)}


def _classify(classifier: Classifier, path: Path) -> dict[str, Any]:
    reading = classifier.read(path).document()
    PhotoStore(path.parent).read(path.name, reading)
    return reading
