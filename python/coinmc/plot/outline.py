"""The rims of the coin in space, and the outline of the coin seen from a distance."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["hull", "rims"]

# Points of a rim; 0.4 % of the radius between chord and arc.
_POINTS = 36


def rims(
    position_m: NDArray[np.float64],
    axis: NDArray[np.float64],
    rims_m: tuple[tuple[float, float], ...],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return points on the rims of heads and of tails, each (36, 3), in m.

    They have the radii and the distances from the centre ``rims_m``.

    Examples
    --------
    >>> import numpy as np
    >>> from coinmc.plot.outline import rims
    >>> heads, tails = rims(np.zeros(3), np.array([0.0, 0.0, 1.0]), 2 * ((1.0, 0.25),))
    >>> set(heads[:, 2].tolist()), set(tails[:, 2].tolist())
    ({0.25}, {-0.25})
    """
    # any direction not along the axis yields two vectors that span the face
    other = np.eye(3)[np.argmin(np.abs(axis))]
    first = np.cross(axis, other)
    first /= np.linalg.norm(first)
    second = np.cross(axis, first)
    angle = np.linspace(0, 2 * np.pi, _POINTS, endpoint=False)[:, None]
    circle = np.cos(angle) * first + np.sin(angle) * second
    (heads, above), (tails, below) = rims_m
    return (
        position_m + heads * circle + above * axis,
        position_m + tails * circle - below * axis,
    )


def hull(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the corners of the convex hull of points in a plane, anticlockwise (Andrew 1979).

    Parameters
    ----------
    points : ndarray, (n, 2)

    Returns
    -------
    ndarray, (m, 2)

    Examples
    --------
    >>> import numpy as np
    >>> from coinmc.plot.outline import hull
    >>> hull(np.array([[0, 0], [2, 0], [1, 1], [2, 2], [0, 2]])).tolist()
    [[0, 0], [2, 0], [2, 2], [0, 2]]
    """
    ordered = points[np.lexsort((points[:, 1], points[:, 0]))].tolist()

    def chain(path: list[list[float]]) -> list[list[float]]:
        kept: list[list[float]] = []
        for point in path:
            while len(kept) > 1 and _turn(kept[-2], kept[-1], point) <= 0:
                kept.pop()
            kept.append(point)
        return kept[:-1]

    return np.array(chain(ordered) + chain(ordered[::-1]))


def _turn(a: list[float], b: list[float], c: list[float]) -> float:
    """Return twice the signed area of the triangle: positive if the path turns left."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
