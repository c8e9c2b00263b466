"""What an engine says to the spins and angles of the throws."""

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from coinmc._config import Config, ConfigLike, as_config
from coinmc._intervals import Estimate, wilson
from coinmc._launches import launches, natural
from coinmc._tosses import toss
from coinmc.experiment._misread import FACES

__all__ = ["LogLikelihood", "Prediction", "predict"]

#: Jeffreys' prior: a face that no toss of a throw showed is not impossible.
_PRIOR = 0.5


class LogLikelihood(NamedTuple):
    """How well a model explains the faces of the throws, in natural logarithms.

    Attributes
    ----------
    value : float
        Of the throws that were read.
    lo, hi : float
        With each throw that was not read as the face that fits worst, and best.
    throws, unread : int
        How many throws were read and were not.
    """

    value: float
    lo: float
    hi: float
    throws: int
    unread: int


class Prediction:
    """Faces of the throws by an engine.

    Attributes
    ----------
    p : ndarray, shape (throws, 3)
        Probability of heads, tails and side for each throw: shares of its tosses.
    repeats : int
        Tosses of each throw.
    config : Config
        The config.
    """

    def __init__(self, counts: np.ndarray, config: Config) -> None:
        self.counts = counts
        self.repeats: int = int(counts.sum(axis=1).max()) if len(counts) else 0
        self.config = config
        self.p: NDArray[np.float64] = counts[:, :3] / max(self.repeats, 1)

    def estimate(self, confidence: float = 0.95) -> dict[str, Estimate]:
        """Return the probability of each face over all throws.

        The interval is that of the model's probability for launches like these: throws differ from
        each other by more than the tosses of one throw do, so it has the error of as many throws.
        """
        n = len(self.p)
        by_face = {}
        for column, face in enumerate(FACES):
            p = self.p[:, column]
            mean = float(p.mean()) if n else 0.0
            # as many independent tosses as have the variance that the throws show
            alike = mean * (1.0 - mean) * n / float(p.var()) if n and p.var() > 0.0 else float(n)
            tosses = round(min(max(alike, n), n * self.repeats))
            lost = round(tosses * float(self.counts[:, 3].mean()) / self.repeats) if n else 0
            told = wilson(min(round(mean * tosses), tosses - lost), lost, tosses, confidence)
            by_face[face] = Estimate(*told, tosses, confidence)
        return by_face

    def log_likelihood(self, faces: np.ndarray) -> LogLikelihood:
        """Return the likelihood of faces, one for each throw; ``""`` where none was read."""
        smooth = (self.counts[:, :3] + _PRIOR) / (self.counts.sum(axis=1) + 3.0 * _PRIOR)[:, None]
        logs = np.log(smooth)
        codes = np.array([FACES.index(face) if face in FACES else -1 for face in faces], dtype=int)
        read = codes >= 0
        value = float(logs[read, codes[read]].sum())
        lost = logs[~read]
        worst, best = (
            (float(lost.min(axis=1).sum()), float(lost.max(axis=1).sum()))
            if len(lost)
            else (0.0, 0.0)
        )
        return LogLikelihood(value, value + worst, value + best, int(read.sum()), len(lost))


def predict(
    config: ConfigLike,
    number: np.ndarray,
    spin_rev_s: np.ndarray,
    angle_deg: np.ndarray,
    *,
    planned: int,
    repeats: int = 1,
    spin_sd_rev_s: float = 0.0,
    angle_sd_deg: float = 0.0,
    seed: int = 0,
    overrides: Mapping[str, Any] | None = None,
) -> Prediction:
    """Toss the throws of a robot with an engine; arguments as of `Day.predict`."""
    repeats = natural(repeats, "repeats")
    if repeats < 1:
        raise ValueError("repeats must be at least 1")
    for name, value in (("spin_sd_rev_s", spin_sd_rev_s), ("angle_sd_deg", angle_sd_deg)):
        if not 0.0 <= value < math.inf:
            raise ValueError(f"{name} must be 0 or more, not {value}")
    config = as_config(config, overrides)
    rng = np.random.default_rng(seed)
    counts = np.zeros((len(number), 4), np.int64)
    rows = np.arange(len(number))
    most = int(number.max()) + 1 if len(number) else 0
    for again in range(repeats):
        # what the robot does not set is as drawn for this throw, anew in every repeat
        drawn = launches(config, most, first=again * planned)[number]
        angle = np.radians(angle_deg + angle_sd_deg * rng.standard_normal(len(number)))
        spin = spin_rev_s + spin_sd_rev_s * rng.standard_normal(len(number))
        drawn["axis"] = np.column_stack([np.sin(angle), np.zeros_like(angle), np.cos(angle)])
        drawn["spin_rad_s"] = 0.0
        drawn["spin_rad_s"][:, 1] = 2.0 * math.pi * spin
        faces = toss(config, launches=drawn, faces_only=True)
        counts[rows, np.minimum(faces, 3)] += 1
    return Prediction(counts, config)
