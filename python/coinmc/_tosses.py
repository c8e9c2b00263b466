"""Tosses one by one."""

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
    """Tosses of one point, each by itself. Made by `toss`.

    Attributes
    ----------
    face : ndarray of uint8, shape (n,)
        What shows: codes of `Face`.
    ended : ndarray of uint8, shape (n,)
        Why the toss ended: codes of `Ended`.
    impacts : ndarray of uint32, shape (n,)
        Impacts computed.
    time_s : ndarray of float64, shape (n,)
        When the toss ended, s since launch: as soon as its face was decided, which is before the
        coin lies still.
    final : ndarray of `STATE`, shape (n,)
        The coin at that instant.
    config : Config
        What was tossed.
    point, first : int
        Point of the sweep, and number of the first toss.
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
        """Give the number of tosses."""
        return len(self.face)

    @property
    def launches(self) -> np.ndarray:
        """How the tosses began, dtype `LAUNCH`: as given, else drawn again."""
        if self._given is not None:
            return self._given
        return launches(self.config, len(self), first=self.first, point=self.point)

    @property
    def counts(self) -> dict[str, int]:
        """Tosses by what shows."""
        counts = np.bincount(self.face, minlength=len(Face))
        return {face.name.lower(): int(counts[face]) for face in Face}

    def estimate(self, confidence: float = 0.95) -> dict[str, Estimate]:
        """Estimate the probability of each face, with Wilson's interval.

        Parameters
        ----------
        confidence : float
            Probability that an interval holds the true value, between 0 and 1.

        Returns
        -------
        dict of str to Estimate
            By ``heads``, ``tails``, ``side``. Undecided tosses may have gone either way: the lower
            end takes none of them, the upper end all.
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
    """Toss, and keep every toss.

    Parameters
    ----------
    config : path, dict or Config
        What is tossed, and how.
    n : int, optional
        How many; without it, as many as the config asks for at each point.
    launches : ndarray of `LAUNCH`, optional
        Launches of your own, instead of n that are drawn. Axes need not have unit length. Any
        dtype with the same fields will do; one that is contiguous and native is not copied.
    first : int, optional
        Number of the first toss: toss k is the same toss in every call, run and machine.
    point : int, optional
        Point of the sweep.
    faces_only : bool, optional
        Give nothing but the array of what shows: a byte a toss instead of 110, and a little faster.
    threads : int, optional
        Threads that toss; without it, one a core. They change nothing but the time.
    progress : bool or callable, optional
        Whether to show progress; see the guide.
    overrides : dict, optional
        Values that replace the config's, by dotted key.

    Returns
    -------
    Tosses, or with ``faces_only`` ndarray of uint8, shape (n,)

    Raises
    ------
    coinmc.ConfigError
        If the config means nothing.
    ValueError
        If the point is answered by a closed form, or a launch is none.

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
            raise ValueError(f"n = {n}, but there are {len(launches)} launches: leave n away")
    count = _count(config, n, launches)
    begin = (plan_of(config), point, first, None if launches is None else rows(launches))
    threads = threads_of(threads)
    with reporting(progress, "toss") as report:
        if faces_only:
            face = np.empty(count, np.uint8)
            _lib.toss(*begin, face, None, threads, report)
            return face
        tosses = Tosses(config, point, first, count, launches)
        beside = (tosses.ended, tosses.impacts, tosses.time_s, rows(tosses.final))
        _lib.toss(*begin, tosses.face, beside, threads, report)
    return tosses


def _count(config: Config, n: int | None, launches: np.ndarray | None) -> int:
    if launches is not None:
        return len(launches)
    if n is not None:
        return natural(n, "n")
    if config.stop.half_width is not None:
        raise ValueError("this config stops at a half width: say how many tosses, n")
    return config.stop.tosses
