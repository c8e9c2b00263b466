"""Probabilities with their intervals, of counts."""

from typing import NamedTuple

__all__ = ["Estimate", "estimates", "normal_quantile"]


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
    z = normal_quantile(confidence)
    undecided = counts["undecided"]
    made = {}
    for face in ("heads", "tails", "side"):
        k = counts[face]
        p = k / n if n else float("nan")
        made[face] = Estimate(
            p, _wilson(k, n, z)[0], _wilson(k + undecided, n, z)[1], n, confidence
        )
    return made


def normal_quantile(confidence: float) -> float:
    """Give z such that a normal number lies within ± z standard deviations with this confidence."""
    # half a dozen modules that nothing else needs
    from statistics import NormalDist

    if not 0.0 < confidence < 1.0:
        raise ValueError(f"the confidence must lie between 0 and 1, not {confidence}")
    return -NormalDist().inv_cdf((1.0 - confidence) / 2.0)


def _wilson(k: int, n: int, z: float) -> tuple[float, float]:
    """Score interval: all p with ``|k/n - p| <= z sqrt(p(1 - p)/n)``. Wilson, JASA 22 (1927)."""
    if n == 0:
        return 0.0, 1.0
    p, z2n = k / n, z * z / n
    arm = z * (p * (1.0 - p) / n + z2n / (4.0 * n)) ** 0.5
    lo = 0.0 if k == 0 else max((p + z2n / 2.0 - arm) / (1.0 + z2n), 0.0)
    hi = 1.0 if k == n else min((p + z2n / 2.0 + arm) / (1.0 + z2n), 1.0)
    return lo, hi
