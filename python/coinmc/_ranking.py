"""Which unknown matters most?"""

import html
import json
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coinmc import _lib
from coinmc._config import ConfigLike
from coinmc._launches import natural, threads_of
from coinmc._progress import reporting
from coinmc._question import html_table, source_of

__all__ = ["Ranking", "rank"]

#: Numbers with an interval, each in three columns.
_INTERVALS = ("p_from", "p_to", "first", "total")
_NUMBERS = ("value", "from", "to", "undecided_from", "undecided_to")


class Ranking:
    """The answer of `rank`.

    Attributes
    ----------
    columns : dict of str to ndarray
        A row for each unknown, the one that matters most first: its key ``parameter``, its
        ``value`` in the scene and its range ``from`` and ``to``; the probability of the face at
        both ends, ``p_from`` and ``p_to``; the indices of Sobol', ``first`` and ``total`` (NaN if
        the probability does not move measurably). All of these four have an interval, such as
        ``total_lo`` and ``total_hi``, which allows for any face of the undecided tosses,
        ``undecided_from`` and ``undecided_to`` of them at the ends.
    mean, standard_deviation : float
        Of the face's probability over all ranges.
    document : dict
        All of the answer, as ``coinmc sensitivity --rank --format json`` prints it.
    """

    def __init__(self, document: dict[str, Any]) -> None:
        self._picture = document.pop("picture")
        self.document = document
        rows = document["rows"]
        self.columns: dict[str, NDArray[Any]] = {
            "parameter": np.array([row["parameter"] for row in rows])
        }
        for name in _NUMBERS:
            self.columns[name] = np.array([row[name] for row in rows])
        for name in _INTERVALS:
            for end, suffix in (("value", ""), ("lo", "_lo"), ("hi", "_hi")):
                cells = [row[name][end] if row[name] else np.nan for row in rows]
                self.columns[name + suffix] = np.array(cells, float)
        self.mean: float = document["mean"]["value"]
        self.standard_deviation: float = document["standard_deviation"]["value"]

    @property
    def face(self) -> str:
        """The face."""
        return self.document["face"]

    @property
    def tosses(self) -> int:
        """All tosses that were made."""
        return self.document["tosses"]

    def __len__(self) -> int:
        """Return the number of unknowns."""
        return len(self.columns["parameter"])

    def __getitem__(self, name: str) -> NDArray[Any]:
        """Return a column."""
        return self.columns[name]

    def __repr__(self) -> str:
        lines = [f"<coinmc.Ranking {self._title()}>"]
        for key, *cells in self._rows():
            lines.append(f"  {key}: total index {cells[-1]}")
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        p = f"P({self.face})"
        heads = ["unknown", "from", "to", f"{p} from", f"{p} to", "first", "total"]
        return (
            f"<p>{html.escape(self._title())}</p>{html_table(heads, self._rows())}{self._picture}"
        )

    def picture(self) -> str:
        """Return a tornado plot: the text of an SVG file."""
        return self._picture

    def _rows(self) -> list[list[str]]:
        def shown(name: str, row: int) -> str:
            value, lo, hi = (self[f"{name}{end}"][row] for end in ("", "_lo", "_hi"))
            if self["undecided_from"].any() or self["undecided_to"].any():
                # they widen it to one side
                return f"{value:.3f} [{lo:.3f}, {hi:.3f}]"
            return f"{value:.3f} ± {0.5 * (hi - lo):.3f}"

        return [
            [
                str(self["parameter"][row]),
                f"{self['from'][row]:g}",
                f"{self['to'][row]:g}",
                *(shown(name, row) for name in _INTERVALS),
            ]
            for row in range(len(self))
        ]

    def _title(self) -> str:
        mean, deviation = self.mean, self.standard_deviation
        return f"P({self.face}) over all ranges: {mean:.3f}, standard deviation {deviation:.3f}"


def rank(
    config: ConfigLike | None = None,
    scene: str | None = None,
    *,
    over: Mapping[str, tuple[float, float]] | None = None,
    face: str = "side",
    samples: int = 500,
    tosses: int = 4096,
    threads: int | None = None,
    progress: bool | Callable[[int, int], None] | None = None,
    overrides: Mapping[str, Any] | None = None,
) -> Ranking:
    """Rank unknown numbers by what they explain, like ``coinmc sensitivity --rank``.

    Parameters
    ----------
    config : path, dict or Config, optional
        The scene; its ``[stop]`` has no effect.
    scene : str, optional
        Without a config: an everyday scene, by default ``"table"``. `coinmc.scenes` lists them.
    over : dict of str to tuple of float, optional
        What is unknown by its key, and from where to where it may be; of an everyday scene by
        default all that it assumes. All values of a range are as likely, or all logarithms if the
        upper end is more than ten times the lower.
    face : str, optional
        ``"heads"``, ``"tails"`` or ``"side"``.
    samples : int, optional
        Samples of all ranges.
    tosses : int, optional
        Tosses at each end of each range.
    threads : int, optional
        Number of threads.
    progress : bool or callable, optional
        Whether to show progress.
    overrides : dict, optional
        Values that replace those of the config, by dotted key.

    Returns
    -------
    Ranking

    Examples
    --------
    Of a coin that does not bounce the thickness matters and the friction does not.

    >>> import coinmc
    >>> ranking = coinmc.rank({
    ...     "coin": {"ratio": 1.0},
    ...     "surface": {"landing": "adhesive", "restitution": 0.0, "friction": 0.3},
    ...     "launch": {"preset": "clean-flat"},
    ...     "engine": {"flat": {}},
    ... }, over={"surface.friction": (0.1, 0.5), "coin.ratio": (0.5, 1.5)})
    >>> ranking["parameter"].tolist()
    ['coin.ratio', 'surface.friction']
    >>> bool(ranking["total_hi"][0] > 0.9 and ranking["total_lo"][1] < 0.1)
    True
    """
    source, sets = source_of(config, scene, overrides)
    asked = {
        "source": source,
        "overrides": sets,
        "face": str(face).lower(),
        "over": None if over is None else [_range(key, ends) for key, ends in over.items()],
        "samples": natural(samples, "samples"),
        "tosses": natural(tosses, "tosses"),
        "threads": threads_of(threads),
    }
    with reporting(progress, "rank") as report:
        return Ranking(json.loads(_lib.rank(asked, report)))


def _range(key: str, ends: tuple[float, float]) -> tuple[str, float, float]:
    if len(ends) != 2:
        raise ValueError(f"over[{key!r}] must be (least, most)")
    least, most = ends
    return key, float(least), float(most)
