"""How far do numerical settings move the probabilities?"""

import json
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coinmc import _lib
from coinmc._config import ConfigLike
from coinmc._launches import natural, threads_of
from coinmc._progress import reporting, shown_digits
from coinmc._question import source_of
from coinmc._table import ArrowTable

__all__ = ["Convergence", "converge"]

_FACES = ("heads", "tails", "side")


class Convergence(ArrowTable):
    """Shifts of probabilities, one row per point. Made by `converge`.

    Libraries that support Arrow read it as a table.

    Attributes
    ----------
    document : dict
        All of the answer, as ``coinmc converge --format json`` prints it.
    """

    def __init__(self, document: dict[str, Any]) -> None:
        self.document = document
        columns: dict[str, list[Any]] = {}
        for row in document["rows"]:
            for name, cell in row.items():
                if isinstance(cell, dict):
                    for end, suffix in (("value", ""), ("lo", "_lo"), ("hi", "_hi")):
                        columns.setdefault(name + suffix, []).append(cell[end])
                else:
                    columns.setdefault(name, []).append(cell)
        self._columns = {name: np.array(cells) for name, cells in columns.items()}

    @property
    def columns(self) -> dict[str, NDArray[Any]]:
        """Columns by name.

        ``point`` and its swept parameters; for each face ``p_<face>``, its probability with the
        settings of the config, with ``p_<face>_lo`` and ``p_<face>_hi``; ``shift_<face>``, P with
        tight settings minus that, with its interval ``shift_<face>_lo`` and ``shift_<face>_hi``,
        and ``biased_<face>``, whether that excludes 0, all points and faces together; ``changed``,
        tosses that end on another face;
        ``undecided`` and ``undecided_tight``; ``tosses`` with either settings.
        """
        return self._columns

    @property
    def settings(self) -> list[dict[str, Any]]:
        """What was tightened: ``key``, ``usual`` and ``tight`` value of each setting."""
        return self.document["settings"]

    @property
    def is_biased(self) -> bool:
        """Whether any shift is not due to chance."""
        return any(bool(self.columns[f"biased_{face}"].any()) for face in _FACES if len(self))

    def __len__(self) -> int:
        """Return the number of points that are tossed."""
        return len(self.columns.get("point", ()))

    def __repr__(self) -> str:
        lines = [f"<coinmc.Convergence {len(self)} points{', biased' if self.is_biased else ''}>"]
        for row in range(len(self)):
            cells = [f"point {self['point'][row]}"]
            for face in _FACES:
                shift, lo, hi = (self[f"shift_{face}{end}"][row] for end in ("", "_lo", "_hi"))
                digits = shown_digits(max(hi - shift, shift - lo))
                numbers = f"{shift:+.{digits}f} [{lo:+.{digits}f}, {hi:+.{digits}f}]"
                cells.append(f"{face} {numbers}")
            lines.append("  ".join(cells))
        return "\n".join(lines)


def converge(
    config: ConfigLike,
    *,
    tosses: int = 20_000,
    threads: int | None = None,
    progress: bool | Callable[[int, int], None] | None = None,
    overrides: Mapping[str, Any] | None = None,
) -> Convergence:
    """Toss every point with numerical tolerances a tenth, too, like ``coinmc converge``.

    The same launches are tossed with both settings, so that only tosses that end on another face
    contribute to the error of a shift.

    Parameters
    ----------
    config : path, dict or Config
        The config; its ``[stop]`` has no effect.
    tosses : int, optional
        Tosses of each point with either settings.
    threads : int, optional
        Number of threads.
    progress : bool or callable, optional
        Whether to show progress.
    overrides : dict, optional
        Values that replace those of the config, by dotted key.

    Returns
    -------
    Convergence

    Examples
    --------
    >>> import coinmc
    >>> found = coinmc.converge({
    ...     "coin": {"ratio": 1.2}, "surface": {"restitution": 0.5, "friction": 0.3},
    ...     "launch": {"preset": "robot"}, "engine": {"flat": {}},
    ... }, tosses=2048)
    >>> found.settings[0]["key"], found.is_biased
    ('engine.flat.zeno', False)
    """
    source, sets = source_of(config, None, overrides)
    asked = {
        "source": source,
        "overrides": sets,
        "tosses": natural(tosses, "tosses"),
        "threads": threads_of(threads),
    }
    with reporting(progress, "converge") as report:
        return Convergence(json.loads(_lib.converge(asked, report)))
