"""The probabilities of heads, tails and side in one triangle."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon
from numpy.typing import NDArray

from coinmc.plot.style import NEUTRAL, axes_for, axis_label, colours, scene_text
from coinmc.plot.table import columns, need, parameters, select

__all__ = ["ternary"]

# Where each face has probability 1: heads, tails, side.
_CORNERS = np.array([[0.0, 0.0], [1.0, 0.0], [0.5, np.sqrt(0.75)]])
_FACES = ("heads", "tails", "side")
# Characters of a line of the title.
_WIDEST_LINE = 60
# Points that are named.
_MOST_NAMED = 8


def ternary(
    result: Any,
    *,
    where: Mapping[str, Any] | None = None,
    along: str | None = None,
    label: str | None = None,
    color: Any = None,
    ax: Axes | None = None,
) -> Axes:
    """Draw the probabilities of the three faces in a triangle, with their intervals.

    A corner is a face with probability 1, the star a three-way fair coin. Around each point lies
    the region in which all three probabilities are within their intervals.

    Parameters
    ----------
    result : table
        A result, or any table with the columns ``p_<face>``, ``p_<face>_lo`` and ``p_<face>_hi`` of
        the three faces.
    where : mapping of str to value, optional
        Use only rows with these values.
    along : str, optional
        Column along which the points are joined, and whose values are written beside them; by
        default the parameter that varies, if there is only one.
    label : str, optional
        Name of the points in the legend, which is drawn if there is one.
    color : color, optional
        Colour of points and regions.
    ax : Axes, optional
        Axes to draw into; a new figure if absent.

    Returns
    -------
    Axes

    Notes
    -----
    Three intervals of 95 % hold jointly with at least 85 % (Bonferroni). Undecided tosses belong to
    no corner: the positions of the points use the fractions of the decided tosses.

    Examples
    --------
    >>> from coinmc import plot
    >>> faces = {"heads": 0.38, "tails": 0.37, "side": 0.25}
    >>> ends = {"": 0, "_lo": -0.01, "_hi": 0.01}
    >>> table = {f"p_{f}{end}": [p + by] for f, p in faces.items() for end, by in ends.items()}
    >>> len(plot.ternary(table).patches)  # the triangle and the region
    2
    """
    table = select(columns(result), where)
    p, low, high = (
        np.stack(need(table, [f"p_{face}{end}" for face in _FACES]), axis=1).astype(float)
        for end in ("", "_lo", "_hi")
    )
    known = np.isfinite(p).all(axis=1) & (p.sum(axis=1) > 0)
    table = {name: column[known] for name, column in table.items()}
    p, low, high = p[known], low[known], high[known]
    ax = axes_for(ax, size=(5.2, 4.8))
    if not ax.patches:
        _frame(ax)
    color = colours(ax).cycle[0] if color is None else color
    along = along or _only_varied(table)
    order = np.argsort(table[along], kind="stable") if along else np.arange(len(p))
    points = (p / p.sum(axis=1, keepdims=True)) @ _CORNERS
    for lo, hi in zip(low, high, strict=True):
        corners = _region(lo, hi)
        if len(corners) > 2:
            ax.add_patch(Polygon(corners, color=color, alpha=0.3, linewidth=0.8))
    line = "-" if along else "none"
    look = {"linestyle": line, "linewidth": 1.2, "marker": "o", "markersize": 4}
    ax.plot(*points[order].T, color=color, label=label, zorder=3, **look)
    if along:
        _name_points(ax, points[order], table[along][order], along)
    if label:
        ax.legend(fontsize="small", frameon=False, loc="upper left")
    ax.set_title(_title(table, along), fontsize="small", color=NEUTRAL)
    return ax


def _title(table: Mapping[str, NDArray[Any]], along: str | None) -> str:
    scene = scene_text({name: column for name, column in table.items() if name != along})
    numbers = f"numbers: {axis_label(along)}" if along else ""
    return "\n".join([*textwrap.wrap(scene, _WIDEST_LINE), *([numbers] if numbers else [])])


def _only_varied(table: Mapping[str, NDArray[Any]]) -> str | None:
    varied = [name for name in parameters(table) if len(np.unique(table[name])) > 1]
    return varied[0] if len(varied) == 1 else None


def _name_points(ax: Axes, points: NDArray[Any], values: NDArray[Any], along: str) -> None:
    """Write all values, or of many the first, the last and some between."""
    for at in np.unique(np.linspace(0, len(values) - 1, _MOST_NAMED).round().astype(int)):
        ax.annotate(
            f"{values[at]:g}",
            points[at],
            xytext=(11, 0),
            textcoords="offset points",
            fontsize="small",
            va="center",
        )


def _frame(ax: Axes) -> None:
    """Draw the triangle with lines at fifths, and the fair point."""
    ax.add_patch(Polygon(_CORNERS, fill=False, edgecolor=NEUTRAL))
    for share in (0.2, 0.4, 0.6, 0.8):
        for face in range(3):
            # where the share of this face is constant
            ends = np.zeros((2, 3))
            ends[:, face] = share
            ends[0, (face + 1) % 3] = ends[1, (face + 2) % 3] = 1 - share
            ax.plot(*(ends @ _CORNERS).T, color=NEUTRAL, linewidth=0.5, alpha=0.6, zorder=0)
            _tick(ax, ends[0] @ _CORNERS, share, face)
    fair = _CORNERS.mean(axis=0)
    ax.plot(*fair, marker="*", color=NEUTRAL, markersize=10, linestyle="none")
    ax.annotate(
        "1/3 each",
        fair,
        xytext=(-8, 0),
        textcoords="offset points",
        ha="right",
        va="center",
        fontsize="small",
        color=NEUTRAL,
    )
    places = [("right", "top"), ("left", "top"), ("center", "bottom")]
    for corner, face, (ha, va) in zip(_CORNERS, _FACES, places, strict=True):
        ax.annotate(
            f"P({face}) = 1",
            corner,
            ha=ha,
            va=va,
            xytext=(0, 4 if va == "bottom" else -13),
            textcoords="offset points",
        )
    ax.set(xlim=(-0.14, 1.14), ylim=(-0.11, 0.94))
    ax.set_aspect("equal")
    ax.set_axis_off()


def _tick(ax: Axes, at: NDArray[np.float64], share: float, face: int) -> None:
    """Write a share of a face where its line meets the edge from which it is read."""
    towards, ha = {0: ((0, -9), "center"), 1: ((5, 2), "left"), 2: ((-5, 2), "right")}[face]
    ax.annotate(
        f"{share:g}",
        at,
        xytext=towards,
        textcoords="offset points",
        ha=ha,
        va="center",
        fontsize="x-small",
        color=NEUTRAL,
    )


def _region(low: NDArray[np.float64], high: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the corners of the region in which every probability lies in its interval.

    The triangle is cut by successive half planes (Sutherland & Hodgman 1974), in barycentric
    coordinates.
    """
    corners = np.eye(3)
    for face in range(3):
        corners = _cut(corners, corners[:, face] - low[face])
        corners = _cut(corners, high[face] - corners[:, face])
    return corners @ _CORNERS


def _cut(corners: NDArray[np.float64], inside: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the part of a polygon where a linear function, given at its corners, is >= 0."""
    kept = []
    for at in range(len(corners)):
        here, before = inside[at], inside[at - 1]
        if (here < 0) != (before < 0):
            share = before / (before - here)
            kept.append(corners[at - 1] + share * (corners[at] - corners[at - 1]))
        if here >= 0:
            kept.append(corners[at])
    return np.array(kept).reshape(-1, 3)
