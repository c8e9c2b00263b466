"""Coverage and cost of points that stop at targets, where the probability is known.

    python benches/python/stopping.py [--points 2000]

Prints, for each target, how many of the points' intervals do not hold the probability of a coin
that does not bounce, (2/π) atan(x/2), and the tosses of a point as a multiple of those that a fixed
number chosen with knowledge of the probability would take.
"""

import argparse
import math

import numpy as np

import coinmc

# P(side), and the target
CASES = [
    (0.5, {"half_width": 0.005}),
    (0.3, {"half_width": 0.01}),
    (0.1, {"relative_error": 0.05}),
    (0.01, {"relative_error": 0.1}),
    (0.001, {"relative_error": 0.1}),
    (0.001, {"relative_error": 0.2}),
]
# of the normal distribution, for intervals of 95 %
Z = 1.959964


def measure(p: float, target: dict[str, float], points: int) -> tuple[float, float]:
    """Return the share of the points that miss, and tosses by those of a fixed number."""
    ratio = 2.0 * math.tan(0.5 * math.pi * p)
    config = {
        "seed": 7,
        "coin": {"ratio": {"from": ratio, "to": ratio * (1.0 + 1e-9), "steps": points}},
        "surface": {"landing": "adhesive", "restitution": 0.0, "friction": 0.3},
        "launch": {"preset": "clean-flat"},
        "engine": {"flat": {}},
        "sampling": {"method": "random"},
        "stop": {**target, "max_tosses": 10**8},
    }
    result = coinmc.estimate(config)
    low, high = (np.asarray(result[f"p_side_{end}"]) for end in ("lo", "hi"))
    tosses = np.asarray(result["tosses"]) + np.asarray(result["pilot_tosses"])
    fixed = max(
        Z**2 * q * (1.0 - q) / target.get("half_width", q * target.get("relative_error", 0.0)) ** 2
        for q in (p, 0.5 * (1.0 - p))
    )
    return float(np.mean((low > p) | (p > high))), float(np.mean(tosses)) / fixed


def main() -> None:
    """Measure and print."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--points", type=int, default=2000)
    points = arguments.parse_args().points
    for p, target in CASES:
        missed, cost = measure(p, target, points)
        print(f"P = {p}, {target}: {100.0 * missed:.1f} % miss, {cost:.2f} times the tosses")


if __name__ == "__main__":
    main()
