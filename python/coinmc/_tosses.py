"""Individual tosses."""

from collections.abc import Callable, Mapping
from functools import cached_property
from typing import Any, Literal, overload

import numpy as np
from numpy.typing import NDArray

from coinmc import _lib
from coinmc._codes import Ended, Face
from coinmc._config import Config, ConfigLike, as_config, plan_of
from coinmc._errors import ConfigError, advised
from coinmc._intervals import Estimate, estimates
from coinmc._launches import (
    STATE,
    LaunchesLike,
    as_launches,
    launches,
    natural,
    rows,
    threads_of,
)
from coinmc._progress import reporting
from coinmc._table import ArrowTable, flattened

__all__ = ["Tosses", "toss"]


class Tosses(ArrowTable):
    """Individual tosses of one point. Made by `toss`.

    Libraries that support Arrow read it as a table, one row per toss: ``polars.DataFrame(tosses)``.

    Attributes
    ----------
    face : ndarray of uint8, shape (n,)
        Face of each toss: codes of `Face`.
    ended : ndarray of uint8, shape (n,)
        Reason why each toss ended: codes of `Ended`.
    impacts : ndarray of uint32, shape (n,)
        Number of impacts.
    config : Config
        The config.
    point, first : int
        Index of the point in the sweep, and index of the first toss.
    """

    config: Config
    face: NDArray[np.uint8]
    ended: NDArray[np.uint8]
    impacts: NDArray[np.uint32]
    point: int
    first: int

    def __init__(
        self,
        config: Config,
        point: int,
        first: int,
        n: int,
        given: NDArray[np.void] | None,
        threads: int | None = None,
    ) -> None:
        self.config = config
        self.point = point
        self.first = first
        self._given = given
        self._threads = threads
        self.face = np.empty(n, np.uint8)
        self.ended = np.empty(n, np.uint8)
        self.impacts = np.empty(n, np.uint32)

    def __len__(self) -> int:
        """Return the number of tosses."""
        return len(self.face)

    @cached_property
    def _ends(self) -> tuple[NDArray[np.float64], NDArray[np.void]]:
        """Compute the tosses again, one at a time, as only that path knows where coins are."""
        time_s, final = np.empty(len(self)), np.empty(len(self), STATE)
        given = None if self._given is None else rows(self._given)
        ends = (time_s, rows(final))
        _lib.toss(plan_of(self.config), self.point, self.first, given, ends, self._threads, None)
        return time_s, final

    @property
    def time_s(self) -> NDArray[np.float64]:
        """Time at which each toss ended, s since launch, shape (n,).

        A toss ends as soon as its face is decided, before the coin comes to rest. Times and final
        states are computed when they are first asked for: that takes several times as long as the
        faces.
        """
        return self._ends[0]

    @property
    def final(self) -> NDArray[np.void]:
        """State of the coin when each toss ended, dtype `STATE`, shape (n,). See `time_s`.

        It is in the laboratory frame on a tilted table, too, where traces are in axes of the table.
        """
        return self._ends[1]

    @property
    def columns(self) -> dict[str, NDArray[Any]]:
        """What `face`, `ended`, `impacts`, `time_s` and `final` hold, as columns of a table.

        ``face`` and ``ended`` are names, ``toss`` is the number of the toss, and ``final`` has a
        column per component, such as ``position_x_m``.
        """
        names = np.array([face.name.lower() for face in Face])
        reasons = np.array([reason.name.lower() for reason in Ended])
        return {
            "toss": np.arange(self.first, self.first + len(self), dtype=np.uint64),
            "face": names[self.face],
            "ended": reasons[self.ended],
            "impacts": self.impacts,
            "time_s": self.time_s,
            **flattened(self.final),
        }

    @property
    def launches(self) -> NDArray[np.void]:
        """Launches of the tosses, dtype `LAUNCH`: those given, or the drawn ones, drawn again."""
        if self._given is not None:
            return self._given
        drawn: dict[str, Any] = {"first": self.first, "point": self.point}
        return launches(self.config, len(self), **drawn, threads=self._threads)

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


@overload
def toss(
    config: ConfigLike,
    n: int | None = None,
    *,
    launches: LaunchesLike | None = None,
    first: int = 0,
    point: int = 0,
    faces_only: Literal[False] = False,
    threads: int | None = None,
    progress: bool | Callable[[int, int], None] | None = None,
    overrides: Mapping[str, Any] | None = None,
) -> Tosses: ...


@overload
def toss(
    config: ConfigLike,
    n: int | None = None,
    *,
    launches: LaunchesLike | None = None,
    first: int = 0,
    point: int = 0,
    faces_only: Literal[True],
    threads: int | None = None,
    progress: bool | Callable[[int, int], None] | None = None,
    overrides: Mapping[str, Any] | None = None,
) -> NDArray[np.uint8]: ...


def toss(
    config: ConfigLike,
    n: int | None = None,
    *,
    launches: LaunchesLike | None = None,
    first: int = 0,
    point: int = 0,
    faces_only: bool = False,
    threads: int | None = None,
    progress: bool | Callable[[int, int], None] | None = None,
    overrides: Mapping[str, Any] | None = None,
) -> Tosses | NDArray[np.uint8]:
    """Compute tosses and return the outcome of each.

    Parameters
    ----------
    config : path, dict or Config
        The config. It needs no ``[stop]`` if n is given, and no ``[launch]`` if launches are.
    n : int, optional
        Number of tosses; by default the number per point in the config.
    launches : ndarray of `LAUNCH` or dict of arrays, optional
        Your own launches, instead of n drawn ones: an array, or a dict with an array of shape
        (n, 3), or (3,) for all, for each field of `LAUNCH`. Axes need not have unit length. x and
        y must be 0 where the table has an edge or is tilted: coins are launched above its middle.
        Any dtype with the same fields is accepted; a contiguous array of native byte order is not
        copied.
    first : int, optional
        Index of the first toss: toss k is the same toss in every call, in every run and on every
        machine.
    point : int, optional
        Index of the point in the sweep.
    faces_only : bool, optional
        Return only the array of faces.
    threads : int, optional
        Number of threads; by default what the environment variable ``COINMC_THREADS`` says, or one
        per core. It does not affect the results.
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
    given = None if launches is None else as_launches(launches)
    if n is not None and given is not None and natural(n, "n") != len(given):
        count = f"are {len(given)} launches" if len(given) != 1 else "is 1 launch"
        raise ValueError(f"n = {n}, but there {count}: omit n")
    try:
        config = as_config(config, overrides, _absent(n, given))
    except ConfigError as error:
        raise advised(error, {"stop": "n", "launch": "launches"}) from None
    first, point = natural(first, "first"), natural(point, "point")
    count, threads = _count(config, n, given), threads_of(threads)
    source = (plan_of(config), point, first, None if given is None else rows(given))
    with reporting(progress, "toss") as report:
        if faces_only:
            face = np.empty(count, np.uint8)
            _lib.toss(*source, face, threads, report)
            return face
        tosses = Tosses(config, point, first, count, given, threads)
        outcomes = (tosses.face, tosses.ended, tosses.impacts)
        _lib.toss(*source, outcomes, threads, report)
    return tosses


def _absent(n: int | None, given: NDArray[np.void] | None) -> dict[str, Any]:
    """Return what a config need not say of launches and their number if they are given."""
    absent: dict[str, Any] = {}
    if n is not None or given is not None:
        absent["stop.tosses"] = 1
    if given is not None:
        absent["launch.preset"] = "robot"
    return absent


def _count(config: Config, n: int | None, given: NDArray[np.void] | None) -> int:
    if given is not None:
        return len(given)
    if n is not None:
        return natural(n, "n")
    if config.stop.has_targets:
        raise ValueError("this config stops at targets: give the number of tosses, n")
    return config.stop.tosses
