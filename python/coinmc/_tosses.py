"""Individual tosses."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from coinmc import _lib
from coinmc._codes import Face
from coinmc._config import Config, ConfigLike, as_config, plan_of
from coinmc._intervals import Estimate, estimates
from coinmc._launches import STATE, as_launches, launches, natural, rows, threads_of
from coinmc._progress import reporting

__all__ = ["Tosses", "toss"]


class Tosses:
    """Individual tosses of one point. Made by `toss`.

    Attributes
    ----------
    face : ndarray of uint8, shape (n,)
        Face of each toss: codes of `Face`.
    ended : ndarray of uint8, shape (n,)
        Reason why each toss ended: codes of `Ended`.
    impacts : ndarray of uint32, shape (n,)
        Number of impacts.
    time_s : ndarray of float64, shape (n,)
        Time at which the toss ended, s since launch. A toss ends as soon as its face is decided,
        before the coin comes to rest.
    final : ndarray of `STATE`, shape (n,)
        State of the coin at that time.
    config : Config
        The config.
    point, first : int
        Index of the point in the sweep, and index of the first toss.
    """

    __slots__ = (
        "_given",
        "config",
        "ended",
        "face",
        "final",
        "first",
        "impacts",
        "point",
        "time_s",
    )

    config: Config
    face: np.ndarray
    ended: np.ndarray
    impacts: np.ndarray
    time_s: np.ndarray
    final: np.ndarray
    point: int
    first: int

    def __init__(
        self, config: Config, point: int, first: int, n: int, given: np.ndarray | None
    ) -> None:
        self.config = config
        self.point = point
        self.first = first
        self._given = given
        self.face = np.empty(n, np.uint8)
        self.ended = np.empty(n, np.uint8)
        self.impacts = np.empty(n, np.uint32)
        self.time_s = np.empty(n, np.float64)
        self.final = np.empty(n, STATE)

    def __len__(self) -> int:
        """Return the number of tosses."""
        return len(self.face)

    @property
    def launches(self) -> np.ndarray:
        """Launches of the tosses, dtype `LAUNCH`: those given, or the drawn ones, drawn again."""
        if self._given is not None:
            return self._given
        return launches(self.config, len(self), first=self.first, point=self.point)

    @property
    def counts(self) -> dict[str, int]:
        """Number of tosses by face."""
        counts = np.bincount(self.face, minlength=len(Face))
        return {face.name.lower(): int(counts[face]) for face in Face}

    def estimate(self, confidence: float = 0.95) -> dict[str, Estimate]:
        """Estimate the probability of each face, with Wilson's interval.

        Parameters
        ----------
        confidence : float
            Confidence level, between 0 and 1.

        Returns
        -------
        dict of str to Estimate
            By ``heads``, ``tails``, ``side``. Undecided tosses could have shown any face: the lower
            end counts none of them for the face, the upper end all.
        """
        return estimates(self.counts, confidence)

    def __repr__(self) -> str:
        counts = ", ".join(f"{count:,} {face}" for face, count in self.counts.items() if count)
        return f"<coinmc.Tosses {len(self):,}: {counts or 'none'}>"


def toss(
    config: ConfigLike,
    n: int | None = None,
    *,
    launches: np.ndarray | None = None,
    first: int = 0,
    point: int = 0,
    faces_only: bool = False,
    threads: int | None = None,
    progress: bool | Callable[[int, int], None] | None = None,
    overrides: Mapping[str, Any] | None = None,
) -> "Tosses | np.ndarray":
    """Compute tosses and return the outcome of each.

    Parameters
    ----------
    config : path, dict or Config
        The config.
    n : int, optional
        Number of tosses; by default the number per point in the config.
    launches : ndarray of `LAUNCH`, optional
        Your own launches, instead of n drawn ones. Axes need not have unit length. Any dtype with
        the same fields is accepted; a contiguous array of native byte order is not copied.
    first : int, optional
        Index of the first toss: toss k is the same toss in every call, in every run and on every
        machine.
    point : int, optional
        Index of the point in the sweep.
    faces_only : bool, optional
        Return only the array of faces: one byte per toss instead of 110, and slightly faster.
    threads : int, optional
        Number of threads; by default one per core. It does not affect the results.
    progress : bool or callable, optional
        Whether to show progress; see the guide.
    overrides : dict, optional
        Values that replace those of the config, by dotted key.

    Returns
    -------
    Tosses, or with ``faces_only`` ndarray of uint8, shape (n,)

    Raises
    ------
    coinmc.ConfigError
        If the config is invalid.
    ValueError
        If the point has a closed form instead of an engine, or a launch is invalid.

    Examples
    --------
    >>> import coinmc
    >>> tosses = coinmc.toss({
    ...     "seed": 1,
    ...     "coin": {"ratio": 1.2},
    ...     "surface": {"restitution": 0.5, "friction": 0.3},
    ...     "launch": {"preset": "robot"},
    ...     "engine": {"flat": {}},
    ...     "stop": {"tosses": 1000},
    ... })
    >>> len(tosses), tosses.face.dtype, tosses.final["position_m"].shape
    (1000, dtype('uint8'), (1000, 3))
    >>> bool(tosses.estimate()["side"].lo < 0.13 < tosses.estimate()["side"].hi)
    True
    """
    config = as_config(config, overrides)
    first, point = natural(first, "first"), natural(point, "point")
    if launches is not None:
        launches = as_launches(launches)
        if n is not None and natural(n, "n") != len(launches):
            raise ValueError(f"n = {n}, but there are {len(launches)} launches: omit n")
    count = _count(config, n, launches)
    source = (plan_of(config), point, first, None if launches is None else rows(launches))
    threads = threads_of(threads)
    with reporting(progress, "toss") as report:
        if faces_only:
            face = np.empty(count, np.uint8)
            _lib.toss(*source, face, None, threads, report)
            return face
        tosses = Tosses(config, point, first, count, launches)
        details = (tosses.ended, tosses.impacts, tosses.time_s, rows(tosses.final))
        _lib.toss(*source, tosses.face, details, threads, report)
    return tosses


def _count(config: Config, n: int | None, launches: np.ndarray | None) -> int:
    if launches is not None:
        return len(launches)
    if n is not None:
        return natural(n, "n")
    if config.stop.has_targets:
        raise ValueError("this config stops at targets: give the number of tosses, n")
    return config.stop.tosses
