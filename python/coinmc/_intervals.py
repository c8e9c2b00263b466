"""Probabilities and their intervals from counts."""

from typing import NamedTuple

from coinmc import _lib

__all__ = ["Estimate", "estimates", "normal_quantile", "wilson"]


class Estimate(NamedTuple):
    """An estimated probability and its confidence interval.

    Attributes
    ----------
    p : float
        Fraction of all tosses; NaN if there are none.
    lo, hi : float
        Ends of Wilson's score interval.
    n : int
        Number of tosses, including undecided ones.
    confidence : float
        Confidence level of the interval.
    """

    p: float
    lo: float
    hi: float
    n: int
    confidence: float

    @property
    def half_width(self) -> float:
        """The larger distance from the estimate to an end of the interval."""
        return max(self.hi - self.p, self.p - self.lo) if self.n else 1.0


def estimates(counts: dict[str, int], confidence: float) -> dict[str, Estimate]:
    """Estimate the probability of every face; undecided tosses may have gone either way."""
    n = sum(counts.values())
    by_face = {}
    for face in ("heads", "tails", "side"):
        interval = wilson(counts[face], counts["undecided"], n, confidence)
        by_face[face] = Estimate(*interval, n, confidence)
    return by_face


def wilson(k: int, undecided: int, n: int, confidence: float) -> tuple[float, float, float]:
    """Estimate a probability from k of n tosses; return k/n and both ends of Wilson's interval.

    Examples
    --------
    >>> from coinmc._intervals import wilson
    >>> share, low, high = wilson(7312, 0, 100_000, 0.95)
    >>> f"{low:.6f} {high:.6f}"
    '0.071523 0.074750'
    """
    return _lib.wilson(k, undecided, n, _between_0_and_1(confidence))


def normal_quantile(confidence: float) -> float:
    """Return the z for which a normal variate lies within ± z standard deviations."""
    return -_lib.inverse_normal_cdf((1.0 - _between_0_and_1(confidence)) / 2.0)


def _between_0_and_1(confidence: float) -> float:
    if not 0.0 < confidence < 1.0:
        raise ValueError(f"the confidence must lie between 0 and 1, not {confidence}")
    return confidence
