"""Tosses of points that stop at a half width, over those at which it first held.

    python benches/python/overshoot.py [--half-width 0.02 0.01 …] [--scenes 50]

For each of the bouncing scenes (`robot`, H/R from .3 to 2.1, e from .1 to .7): the tosses that a
point took, its pilot included, over the number at which the same rule (every face's interval of
Clopper and Pearson, 95 %) would first have held had somebody looked after every toss, without a
price for looking. Needs SciPy.
"""

import argparse

import numpy as np
from scipy.stats import beta

import coinmc

RATIOS = np.linspace(0.3, 2.1, 10)
RESTITUTIONS = np.linspace(0.1, 0.7, 5)
FACES = (coinmc.Face.HEADS, coinmc.Face.TAILS, coinmc.Face.SIDE)
ALPHA = 0.05


def scene(number: int) -> dict:
    """Return the config of a scene."""
    at = number % (len(RATIOS) * len(RESTITUTIONS))
    return {
        "seed": 27 + number,
        "coin": {"ratio": float(RATIOS[at % len(RATIOS)])},
        "surface": {"restitution": float(RESTITUTIONS[at // len(RATIOS)]), "friction": 0.3},
        "launch": {"preset": "robot"},
        "engine": {"flat": {}},
    }


def arms(counts: np.ndarray, tosses: np.ndarray) -> np.ndarray:
    """Return the longer arm of each interval of Clopper and Pearson."""
    p = counts / tosses
    low = np.where(counts > 0, beta.ppf(ALPHA / 2, counts, tosses - counts + 1), 0.0)
    high = np.where(counts < tosses, beta.ppf(1 - ALPHA / 2, counts + 1, tosses - counts), 1.0)
    return np.maximum(p - low, high - p)


def first_held(config: dict, half_width: float) -> int:
    """Return the first number of tosses after which all intervals were short enough."""
    most = int(1.2 * 0.25 * 1.96**2 / half_width**2) + 1000
    face = coinmc.toss(config, most, faces_only=True)
    counts = np.array([np.cumsum(face == one) for one in FACES])
    tosses = np.arange(1, most + 1)
    p = counts / tosses
    # the longer arm of Clopper and Pearson is never shorter than that of the normal distribution
    normal = 1.959963 * np.sqrt(p * (1 - p) / tosses)
    [candidates] = np.nonzero(normal.max(axis=0) <= half_width)
    for some in np.array_split(candidates, len(candidates) // 500 + 1):
        [held] = np.nonzero(arms(counts[:, some], tosses[some]).max(axis=0) <= half_width)
        if len(held):
            return int(tosses[some[held[0]]])
    raise AssertionError


def main() -> None:
    """Measure and print."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument(
        "--half-width", type=float, nargs="+", default=[0.02, 0.01, 0.005, 0.002]
    )
    arguments.add_argument("--scenes", type=int, default=50)
    given = arguments.parse_args()
    for half_width in given.half_width:
        ratios = []
        for number in range(given.scenes):
            config = scene(number)
            stop = {"half_width": half_width, "max_tosses": 10**8}
            result = coinmc.estimate({**config, "stop": stop})
            taken = int(result["tosses"][0] + result["pilot_tosses"][0])
            ratios.append(taken / first_held({**config, "stop": {"tosses": 1}}, half_width))
        ratios = np.array(ratios)
        print(
            f"± {half_width}: {ratios.mean():.3f} on average, {np.median(ratios):.3f} median, "
            f"{ratios.max():.3f} at most, {(ratios > 1.2).sum()} of {len(ratios)} above 1.2",
            flush=True,
        )


if __name__ == "__main__":
    main()
