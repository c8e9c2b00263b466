"""What can go wrong, as exceptions."""

from typing import NamedTuple

__all__ = ["ConfigError", "Error", "FilmError", "Problem", "RunError", "TraceError"]


class Problem(NamedTuple):
    """One problem of a config or of a film's text.

    Attributes
    ----------
    source : str
        The file, or ``--set`` for an override.
    line, column : int
        Place, from 1; 0 if the problem has no place in a text.
    message : str
        What was found and what is allowed.
    help : str or None
        How to mend it.
    """

    source: str
    line: int
    column: int
    message: str
    help: str | None


class Error(Exception):
    """What all exceptions of coinmc have in common."""


class _Diagnosed(Error, ValueError):
    def __init__(self, message: str, problems: "list[tuple] | tuple[()]" = ()) -> None:
        super().__init__(message)
        self.problems = [Problem(*problem) for problem in problems]

    def __reduce__(self):  # exceptions travel between processes
        return type(self), (str(self), [tuple(problem) for problem in self.problems])


class ConfigError(_Diagnosed):
    """A config means nothing. The text is the command line's, with a caret under each token.

    Attributes
    ----------
    problems : list of Problem
        All that was found, in the order of their places.
    """


class FilmError(_Diagnosed):
    """A film's text cannot be read, or its drops cannot be fitted.

    Attributes
    ----------
    problems : list of Problem
        What is wrong with a text; empty for what is wrong with a fit.
    """


class RunError(Error, RuntimeError):
    """A run failed, or a directory is not that of the run. Finished work is kept."""


class TraceError(Error, ValueError):
    """There is no such toss, or it cannot be traced so."""
