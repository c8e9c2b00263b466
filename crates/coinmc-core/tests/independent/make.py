"""Writes the tables beside it: intervals, Student's quantiles and launches of presets by SciPy.

Nothing here is taken from coinmc: presets are written down again from their sources, turns are
SciPy's rotations, quantiles and intervals its distributions.

    python crates/coinmc-core/tests/independent/make.py     # SciPy 1.17.1 wrote what is checked in
"""

import csv
import math
from pathlib import Path

import numpy as np
from scipy import stats
from scipy.spatial.transform import Rotation

HERE = Path(__file__).parent


def write(name, header, rows):
    """Writes a table."""
    with (HERE / name).open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows(rows)


def intervals():
    """Wilson's score interval and Clopper and Pearson's, few tosses and many."""
    for n in [1, 2, 7, 30, 400, 10_000, 3_000_000]:
        for k in sorted({0, 1, n // 7, n // 3, n // 2, n - 1, n}):
            if k > n:
                continue
            for confidence in [0.5, 0.95, 0.9999]:
                for ours, theirs in [("wilson", "wilson"), ("clopper-pearson", "exact")]:
                    found = stats.binomtest(k, n).proportion_ci(confidence, theirs)
                    yield ours, k, n, confidence, repr(float(found.low)), repr(float(found.high))


def students():
    """The t that is exceeded with a probability."""
    for dof in [1, 2, 3, 15, 16, 100]:
        for tail in [0.25, 0.05, 0.025, 1e-3, 1e-6]:
            yield dof, tail, repr(float(stats.t.isf(tail, dof)))


# The coin of the launches: H/R = 1.5, R = 10 mm; squares of its radii of gyration.
HEIGHT, RADIUS = 0.015, 0.01
AXIAL = RADIUS**2 / 2
TRANSVERSE = RADIUS**2 / 4 + HEIGHT**2 / 12
UP = np.array([0.0, 0.0, 1.0])


def isotropic(a, b):
    """A direction whose vertical component is uniform (Archimedes)."""
    z = 2 * a - 1
    turn = Rotation.from_euler("z", 2 * math.pi * b)
    return turn.apply([math.sin(math.acos(z)), 0.0, z])


def euler(a, b, c):
    """Unity's Quaternion.Euler of three angles, on a coin whose axis is vertical.

    Unity turns about its z, then x, then its vertical y, with the left hand. Its y is our z, its z
    our y: in our right-handed axes the first two turn the other way. So does the third; its angle,
    uniform on the circle, is counted to the right here.
    """
    return Rotation.from_euler("yxz", 2 * math.pi * np.array([-b, -a, c])).apply(UP)


def tilted(angle):
    """The heads normal turned from the vertical towards x: to the right about y."""
    return Rotation.from_euler("y", angle).apply(UP)


def uniform(u, low, high):
    """The quantile of a uniform distribution."""
    return stats.uniform.ppf(u, low, high - low)


def normal(u, mean, sd):
    """The quantile of a normal distribution."""
    return stats.norm.ppf(u, mean, sd)


def launch(preset, u):
    """Height, velocity, axis and spin."""
    still, turn = np.zeros(3), 2 * math.pi
    if preset == "robot":
        # arXiv 2401.03557: 0 to 5 rev/s about a horizontal axis, 0 to 180 degrees; 0.5 m is ours
        return 0.5, still, tilted(uniform(u[0], 0, math.pi)), [0, uniform(u[3], 0, 5 * turn), 0]
    if preset == "table1":
        # arXiv 2401.03557, table 1: 5 m, 16 to 24 m/s upwards, each spin component within 50 rad/s
        upwards = [0, 0, uniform(u[9], 16, 24)]
        return 5.0, upwards, euler(*u[:3]), [uniform(x, -50, 50) for x in u[3:6]]
    if preset == "clean":
        return 1.0, still, isotropic(*u[:2]), [normal(x, 0, 20) for x in u[3:6]]
    if preset == "clean-flat":
        return 1.0, still, tilted(uniform(u[0], 0, turn)), [0, normal(u[3], 0, 20), 0]
    if preset == "hand":
        # Keller 1986: 2.4 m/s and 238.6 rad/s; ours: 10 %, 1 m, psi of 81 +- 5 degrees between the
        # angular momentum and the axis, of which the rate is |L|/I_t
        upwards = [0, 0, normal(u[9], 2.4, 0.24)]
        psi = math.radians(normal(u[4], 81, 5))
        direction = Rotation.from_euler("yz", [psi, turn * u[5]]).apply(UP)
        momentum = TRANSVERSE * normal(u[3], 238.6, 23.86) * direction
        return 1.0, upwards, UP, momentum / [TRANSVERSE, TRANSVERSE, AXIAL]
    assert preset == "drop"
    return 1.0, still, isotropic(*u[:2]), still


def launches():
    """Some launches of every preset."""
    random = np.random.default_rng(30)
    for preset in ["robot", "table1", "clean", "clean-flat", "hand", "drop"]:
        for _ in range(12):
            u = [float(x) for x in random.uniform(size=10).round(6)]
            height, velocity, axis, spin = launch(preset, u)
            yield preset, *u, height, *(repr(float(x)) for x in [*velocity, *axis, *spin])


def main():
    """Writes all tables."""
    write("intervals.csv", ["method", "k", "n", "confidence", "lo", "hi"], intervals())
    write("student.csv", ["dof", "tail", "t"], students())
    numbers = ["height", "vx", "vy", "vz", "ux", "uy", "uz", "wx", "wy", "wz"]
    uniforms = [f"uniform_{i}" for i in range(10)]
    write("launches.csv", ["preset", *uniforms, *numbers], launches())


if __name__ == "__main__":
    main()
