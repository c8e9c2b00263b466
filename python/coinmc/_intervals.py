"""Probabilities with their intervals, of counts."""

from typing import NamedTuple

from coinmc import _lib

__all__ = ["Estimate", "estimates", "normal_quantile", "wilson"]


class Estimate(NamedTuple):
    """A probability, and an interval that holds the true one with the stated confidence.

    Attributes
    ----------
    p : float
        Share of all tosses; NaN without tosses.
    lo, hi : float
        Ends of Wilson's score interval.
    n : int
        All tosses, undecided ones included.
    confidence : float
        Probability that the interval holds the true value, before the data were seen.
    """

    p: float
    lo: float
    hi: float
    n: int
    confidence: float

    @property
    def half_width(self) -> float:
        """The longer arm of the interval."""
        return max(self.hi - self.p, self.p - self.lo) if self.n else 1.0


def estimates(counts: dict[str, int], confidence: float) -> dict[str, Estimate]:
    """Estimate the probability of every face; undecided tosses may have gone either way."""
    n = sum(counts.values())
    made = {}
    for face in ("heads", "tails", "side"):
        share = wilson(counts[face], counts["undecided"], n, confidence)
        made[face] = Estimate(*share, n, confidence)
    return made


def wilson(k: int, undecided: int, n: int, confidence: float) -> tuple[float, float, float]:
    """Estimate a probability from k of n tosses: the share and both ends of Wilson's interval.

    Examples
    --------
    >>> from coinmc._intervals import wilson
    >>> share, low, high = wilson(7312, 0, 100_000, 0.95)
    >>> f"{low:.6f} {high:.6f}"
    '0.071523 0.074750'
    """
    return _lib.wilson(k, undecided, n, _between_0_and_1(confidence))


def normal_quantile(confidence: float) -> float:
    """Give z such that a normal number lies within ± z standard deviations with this confidence."""
    return -_lib.inverse_normal_cdf((1.0 - _between_0_and_1(confidence)) / 2.0)


def _between_0_and_1(confidence: float) -> float:
    if not 0.0 < confidence < 1.0:
        raise ValueError(f"the confidence must lie between 0 and 1, not {confidence}")
    return confidence
