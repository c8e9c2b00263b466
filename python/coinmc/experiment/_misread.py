"""Probabilities of faces from readings of which some are wrong."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

__all__ = ["FACES", "Confusion", "Corrected"]

FACES = ("heads", "tails", "side")
#: Draws of a posterior. Its quantiles are then known to about a hundredth of the interval.
DRAWS = 20_000
#: Jeffreys' prior of the cells of a row.
_PRIOR = 0.5


class Corrected(NamedTuple):
    """A probability corrected for wrong readings.

    Attributes
    ----------
    p : float
        Probability among the throws that were read: the median of its posterior.
    lo, hi : float
        Interval that holds for any faces of the throws that were not read, at the stated
        confidence: with the error of the counts and that of the error rates.
    confidence : float
        Confidence of the interval.
    """

    p: float
    lo: float
    hi: float
    confidence: float


class Confusion:
    """How often photos of each face are read as each face, as counted.

    Parameters
    ----------
    counts : array-like, shape (3, 3)
        Photos by the face that they show (rows) and the face that was read (columns): heads, tails,
        side. Photos in which none was read are not counted.

    Examples
    --------
    >>> from coinmc.experiment import Confusion
    >>> checked = Confusion([[400, 2, 0], [1, 380, 0], [0, 0, 90]])
    >>> checked.counts.sum(axis=1).tolist()
    [402, 381, 90]
    """

    def __init__(self, counts: Sequence[Sequence[int]] | np.ndarray) -> None:
        given = np.asarray(counts)
        if given.shape != (3, 3) or not np.issubdtype(given.dtype, np.integer):
            raise ValueError("a confusion matrix has three rows of three whole numbers")
        if (given < 0).any() or (given.sum(axis=1) == 0).any():
            raise ValueError("counts are 0 or more, and photos of every face are needed")
        self.counts: NDArray[np.int64] = given.astype(np.int64)

    @classmethod
    def of(cls, shown: Sequence[str], read: Sequence[str]) -> "Confusion":
        """Count photos by what they show and what was read in them; ``none`` is left out."""
        counts = np.zeros((3, 3), np.int64)
        for truth, face in zip(shown, read, strict=True):
            if truth in FACES and face in FACES:
                counts[FACES.index(truth), FACES.index(face)] += 1
        return cls(counts)

    def __repr__(self) -> str:
        wrong = int(self.counts.sum() - np.trace(self.counts))
        return f"<coinmc.experiment.Confusion {int(self.counts.sum()):,} photos, {wrong} wrong>"

    def corrected(
        self, counts: Mapping[str, int], confidence: float = 0.95, seed: int = 0
    ) -> dict[str, Corrected]:
        """Correct counts of readings.

        Error rates and frequencies are drawn from their posteriors with Jeffreys' prior, and each
        draw is solved for the probabilities. A throw without a reading may have shown any face.

        Parameters
        ----------
        counts : dict
            Throws read as ``heads``, ``tails`` and ``side``, and those ``undecided``.
        confidence : float
            Confidence of the intervals, between 0 and 1.
        seed : int
            Seed of the draws.

        Returns
        -------
        dict of str to Corrected
            By face.
        """
        if not 0.0 < confidence < 1.0:
            raise ValueError(f"the confidence must lie between 0 and 1, not {confidence}")
        rng = np.random.default_rng(seed)
        rates = np.stack([rng.dirichlet(row + _PRIOR, DRAWS) for row in self.counts], axis=1)
        seen = [counts.get(face, 0) for face in FACES]
        read = rng.dirichlet(np.array(seen) + _PRIOR, DRAWS)
        void, n = counts.get("undecided", 0), sum(seen) + counts.get("undecided", 0)
        # no throw was void, none ever is
        lost = rng.beta(void + _PRIOR, n - void + _PRIOR, DRAWS) if void else np.zeros(DRAWS)
        # read = true @ rates
        true = np.linalg.solve(np.swapaxes(rates, 1, 2), read[..., None])[..., 0]
        true = np.clip(true, 0.0, None)
        true /= true.sum(axis=1, keepdims=True)
        tail = (1.0 - confidence) / 2.0
        kept = (1.0 - lost)[:, None] * true
        low = np.quantile(kept, tail, axis=0)
        high = np.quantile(kept + lost[:, None], 1.0 - tail, axis=0)
        middle = np.median(true, axis=0)
        return {
            face: Corrected(float(middle[i]), float(low[i]), float(high[i]), confidence)
            for i, face in enumerate(FACES)
        }
