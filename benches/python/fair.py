"""Coverage and cost of `coinmc.fair`, on a scene that is tossed quickly.

    python benches/python/fair.py [--repeats 200]

Prints how many of the repeats' intervals hold the root of a search that is fifty times as narrow,
the tosses of a search, and those of grids of points read by `Result.fair` at the same half width.
"""

import argparse
import statistics

import coinmc

SCENE = {
    "coin": {"ratio": 1.0},
    "surface": {"restitution": 0.5, "friction": 0.3},
    "launch": {"preset": "robot"},
    "engine": {"flat": {}},
}


def search(seed: int, half_width: float) -> coinmc.FairRoot:
    """Return the fair ratio by one search."""
    answer = coinmc.fair(
        SCENE,
        half_width=half_width,
        max_tosses=10**9,
        numerical_tosses=0,
        overrides={"seed": seed},
    )
    return answer.roots[0]


def grid(steps: int, half_width: float) -> tuple[int, float]:
    """Return the tosses with which a grid over the same range reaches a half width, and that."""
    tosses = 50_000
    while True:
        tosses = tosses * 5 // 4
        points = {"ratio": {"from": 0.05, "to": 4.0, "steps": steps}}
        found = coinmc.estimate({**SCENE, "coin": points}, tosses=tosses).fair()[0]
        reached = max(found.hi - found.value, found.value - found.lo)
        if reached <= half_width:
            return steps * tosses, reached


def main() -> None:
    """Measure and print."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--repeats", type=int, default=200)
    repeats = arguments.parse_args().repeats
    truth = search(seed=10**6, half_width=4e-4)
    print(f"fair H/R {truth.value:.5f} [{truth.lo:.5f}, {truth.hi:.5f}]")
    roots = [search(seed, 0.02) for seed in range(1, repeats + 1)]
    held = sum(root.lo <= truth.value <= root.hi for root in roots)
    mean = statistics.mean(root.tosses for root in roots)
    print(f"half width 0.02: {held} of {repeats} hold it, {mean:,.0f} tosses each")
    mean = statistics.mean(search(seed, 0.005).tosses for seed in range(1, 6))
    print(f"half width 0.005: {mean:,.0f} tosses")
    for steps in (20, 40, 80):
        tosses, reached = grid(steps, 0.005)
        print(f"grid of {steps}: {tosses:,} tosses for {reached:.4f}, {tosses / mean:.0f} times")


if __name__ == "__main__":
    main()
