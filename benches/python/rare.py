"""Gain of `coinmc.rare` over brute force, and whether both agree.

    python benches/python/rare.py [--tosses 2000000]

Prints for coins of several thicknesses P(side) of both, the standard normal deviate z of their
difference, and how many times fewer tosses and how much less time `coinmc.rare` took for its error.
"""

import argparse
import math
import time

import coinmc

#: Soft ground on which a coin hardly bounces and soon stops rolling.
SOFT = {
    "restitution": 0.1,
    "friction": 0.4,
    "rolling_friction_m": 1e-3,
    "contact_patch_m": 1e-3,
}
#: Name and surface of the ground, preset of the launch, ratio H/R.
CASES = [
    ("soft", SOFT, "drop", 0.5),
    ("soft", SOFT, "drop", 0.1),
    ("soft", SOFT, "drop", 0.02),
    ("soft", SOFT, "drop", 0.004),
    ("felt", {"material": "felt"}, "drop", 0.25),
    ("felt", {"material": "felt"}, "hand", 0.1),
    ("carpet", {"material": "carpet"}, "hand", 0.3),
]


def measure(name: str, surface: dict[str, object], preset: str, ratio: float, tosses: int) -> str:
    """Return a line of the table."""
    config = {
        "coin": {"ratio": ratio, "radius_m": 0.0116},
        "surface": surface,
        "launch": {"preset": preset, "height_m": 0.3},
        "engine": {"volumetric": {}},
    }
    begin = time.perf_counter()
    rare = coinmc.rare(config)
    middle = time.perf_counter()
    brute = coinmc.estimate({**config, "seed": 2, "stop": {"tosses": tosses}})
    end = time.perf_counter()
    p = float(brute["p_side"][0])
    n = int(brute["tosses"][0])
    of_rare = (rare.hi - rare.lo) / 2.0 / 1.96
    z = (rare.p - p) / math.hypot(of_rare, math.sqrt(p * (1.0 - p) / n))
    # the time of brute force for the same standard error
    needed = rare.p * (1.0 - rare.p) / of_rare**2
    faster = (end - middle) * needed / n / (middle - begin)
    what = f"{name}, {preset}, H/R {ratio}"
    return (
        f"{what:<22} {rare.p:.2e} {p:.2e} z {z:+.1f}  {rare.gain:.1f} times fewer tosses,"
        f" {rare.gain_of_work:.1f} times less work, {faster:.1f} times less time"
    )


def main() -> None:
    """Measure and print."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--tosses", type=int, default=2_000_000)
    tosses = arguments.parse_args().tosses
    for case in CASES:
        print(measure(*case, tosses), flush=True)


if __name__ == "__main__":
    main()
