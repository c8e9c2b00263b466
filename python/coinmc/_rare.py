"""How rare is a face?"""

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

__all__ = ["Rare", "rare"]


class Rare:
    """The answer of `rare`.

    Attributes
    ----------
    p, lo, hi : float
        Probability of the face and its interval, whose upper end counts undecided tosses.
    reached : bool
        Whether the interval is as short as asked for.
    tosses, pilot_tosses, launches : int
        Tosses of the answer and of its pilot, and launches drawn for the answer.
    gain, gain_of_work : float
        How many times as many tosses brute force takes, and how many times the work (impacts, steps
        in contact and one for each toss), the pilot included; NaN if the face was not seen,
        or in all tosses.
    strata : dict of str to ndarray
        Launches that first touch the ground alike: |cos| of the angle between the axis and the
        vertical ``cos_from`` and ``cos_to``, ``launches``, the ``chance`` with which they were
        tossed, ``tosses``, and those that have ``shown`` the face.
    document : dict
        All of the answer, as ``coinmc rare --format json`` prints it.
    """

    def __init__(self, document: dict[str, Any]) -> None:
        self.document = document
        self.p: float = document["p"]
        self.lo: float = document["lo"]
        self.hi: float = document["hi"]
        self.reached: bool = document["reached"]
        self.tosses: int = document["tosses"]
        self.pilot_tosses: int = document["pilot_tosses"]
        self.launches: int = document["launches"]
        self.gain: float
        self.gain_of_work: float
        self.gain, self.gain_of_work = (
            float("nan") if document[name] is None else float(document[name])
            for name in ("gain", "gain_of_work")
        )
        rows = document["rows"]
        self.strata: dict[str, NDArray[Any]] = {
            name: np.array([row[name] for row in rows]) for name in rows[0]
        }

    @property
    def face(self) -> str:
        """The face."""
        return self.document["face"]

    def __repr__(self) -> str:
        return f"<coinmc.Rare {self._title()}>"

    def _repr_html_(self) -> str:
        heads = list(self.strata)
        columns = [self.strata[name] for name in heads]
        rows = [[f"{cell:g}" for cell in row] for row in zip(*columns, strict=True)]
        return f"<p>{html.escape(self._title())}</p>{html_table(heads, rows)}"

    def _title(self) -> str:
        return (
            f"P({self.face}) = {self.p:.3e} [{self.lo:.3e}, {self.hi:.3e}], {self.tosses:,} tosses,"
            f" gain {self.gain:.1f}"
        )


def rare(
    config: ConfigLike | None = None,
    scene: str | None = None,
    *,
    face: str = "side",
    relative_error: float = 0.1,
    max_tosses: int = 10_000_000,
    threads: int | None = None,
    progress: bool | Callable[[int, int], None] | None = None,
    overrides: Mapping[str, Any] | None = None,
) -> Rare:
    """Estimate the probability of a rare face with fewer tosses, like ``coinmc rare``.

    Parameters
    ----------
    config : path, dict or Config, optional
        The scene; its ``[stop]`` has no effect.
    scene : str, optional
        Without a config: an everyday scene, by default ``"table"``. `coinmc.scenes` lists them.
    face : str, optional
        ``"heads"``, ``"tails"`` or ``"side"``.
    relative_error : float, optional
        Half width of the interval that is enough, as a share of the probability; at most 0.5.
    max_tosses : int, optional
        Tosses at which the answer stops short of that.
    threads : int, optional
        Number of threads.
    progress : bool or callable, optional
        Whether to show progress.
    overrides : dict, optional
        Values that replace those of the config, by dotted key.

    Returns
    -------
    Rare

    Examples
    --------
    A coin that does not bounce stands in (2/π) atan(x/2) of all tosses.

    >>> import math
    >>> import coinmc
    >>> answer = coinmc.rare({
    ...     "coin": {"ratio": 0.02},
    ...     "surface": {"landing": "adhesive", "restitution": 0.0, "friction": 0.3},
    ...     "launch": {"preset": "clean-flat"},
    ...     "engine": {"flat": {}},
    ... })
    >>> answer.lo < 2 / math.pi * math.atan(0.01) < answer.hi
    True
    >>> answer.reached, answer.gain > 2
    (True, True)
    """
    source, sets = source_of(config, scene, overrides)
    asked = {
        "source": source,
        "overrides": sets,
        "face": str(face).lower(),
        "relative_error": float(relative_error),
        "max_tosses": natural(max_tosses, "max_tosses"),
        "threads": threads_of(threads),
    }
    with reporting(progress, "rare") as report:
        return Rare(json.loads(_lib.rare(asked, report)))
