"""The parts of a run, merged."""

import os
import warnings
from collections.abc import Iterable
from pathlib import Path

from coinmc import _lib
from coinmc._config import Config
from coinmc._results import Result

__all__ = ["merge"]


def merge(
    parts: Iterable[str | os.PathLike[str]],
    out: str | os.PathLike[str],
    *,
    partial: bool = False,
) -> Result:
    """Merge the parts of a run that ``coinmc run --shard`` divided, like ``coinmc merge``.

    Parameters
    ----------
    parts : iterable of path
        Run directories of the parts. They are only read.
    out : path
        The run directory of the whole: new or empty. Its bytes are those of one run.
    partial : bool, optional
        Merge what parts there are. A warning names those that are missing, and the result is that
        of a run that was stopped: merge again into the same directory when all are there, or go on
        with `run`.

    Returns
    -------
    Result

    Raises
    ------
    coinmc.RunError
        If chunks are missing and not `partial`, or the parts are not of one run.

    Warns
    -----
    RuntimeWarning
        If `partial` and something is missing.
    """
    if isinstance(parts, str | os.PathLike):
        raise TypeError("parts must be a list of directories, not one directory")
    path = Path(out)
    table, missing, names, messages = _lib.merge([os.fspath(p) for p in parts], path, partial)
    if missing:
        chunks = f"{missing} chunk" + ("s" if missing != 1 else "")
        which = f": part {', '.join(names)}" if names else ""
        messages.append(f"merged without {chunks}{which}")
    for message in messages:
        warnings.warn(message, RuntimeWarning, stacklevel=2)
    return Result(table, Config.from_toml(table.config), path)
