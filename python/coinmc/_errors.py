"""The exceptions of coinmc."""

from collections.abc import Sequence
from typing import Any, NamedTuple

__all__ = [
    "ConfigError",
    "Error",
    "FilmError",
    "Problem",
    "RunError",
    "TraceError",
    "VisionError",
]


class Problem(NamedTuple):
    """One problem in a config or in the text of a film.

    Attributes
    ----------
    source : str
        The file, ``--set`` for an override, or the argument that asked for the value.
    line, column : int
        Location, counted from 1; 0 if the problem is not at any place in the text.
    message : str
        What was found and what is allowed.
    help : str or None
        How to fix it.
    """

    source: str
    line: int
    column: int
    message: str
    help: str | None


class Error(Exception):
    """Base class of all exceptions of coinmc."""


class _Diagnosed(Error, ValueError):
    def __init__(self, message: str, problems: Sequence[tuple[Any, ...]] = ()) -> None:
        super().__init__(message)
        self.problems: list[Problem] = [Problem(*problem) for problem in problems]


def advised(error: "ConfigError", instead: dict[str, str]) -> "ConfigError":
    """Add to the error which arguments take the place of tables that are missing."""
    for table, argument in instead.items():
        if any(problem.message.startswith(f"`{table}` is missing") for problem in error.problems):
            error.add_note(f"Or give {argument}, which takes the place of [{table}].")
    return error


class ConfigError(_Diagnosed):
    """A config is invalid. The message is that of the command line, with carets at each problem.

    Attributes
    ----------
    problems : list of Problem
        All problems found, ordered by location.
    """


class FilmError(_Diagnosed):
    """The text of a film cannot be read, or its drops cannot be fitted.

    Attributes
    ----------
    problems : list of Problem
        Problems in the text; empty if the fit failed.
    """


class RunError(Error, RuntimeError):
    """A run failed, or the directory belongs to another run. Finished work is kept."""


class TraceError(Error, ValueError):
    """There is no such toss, or it cannot be traced with these options."""


class VisionError(Error, ValueError):
    """A photo, a coin description or a camera file cannot be used; the message says why."""
