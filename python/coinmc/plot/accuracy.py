"""Error against run time, to compare methods at equal accuracy."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes

from coinmc.plot.style import CYCLE_MARKERS, NEUTRAL, axes_for, axis_label, colours
from coinmc.plot.table import columns, need

__all__ = ["time_against_error"]


def time_against_error(
    table: Any,
    *,
    time: str = "time_s",
    error: str = "total_error",
    by: str | None = None,
    low: str | None = None,
    high: str | None = None,
    slope: bool = True,
    label: str | None = None,
    color: Any = None,
    ax: Axes | None = None,
) -> Axes:
    """Plot error against run time, both logarithmic, with one curve per method.

    Parameters
    ----------
    table : table
        Columns `time`, `error` and, where known, the interval of the error; for instance the CSV
        of a study of ``coinmc-studies``. Rows with values that are not positive cannot be shown on
        logarithmic axes and are left out.
    time, error : str
        Columns of the axes.
    by : str, optional
        Column of text or numbers that separates the curves.
    low, high : str, optional
        Columns with the ends of the interval of the error; by default ``<error>_lo`` and
        ``<error>_hi`` if the table has them.
    slope : bool
        Whether to draw the decrease of a statistical error, 1/sqrt(time), from the first point of
        the first curve.
    label : str, optional
        Name of the table in the legend, before that of each curve.
    color : color, optional
        Colour of all curves, instead of one for each.
    ax : Axes, optional
        Axes to draw into; a new figure if absent.

    Returns
    -------
    Axes

    Examples
    --------
    >>> from coinmc import plot
    >>> table = {"time_s": [0.1, 1, 10], "total_error": [1e-2, 4e-3, 1.1e-3]}
    >>> ax = plot.time_against_error(table)
    >>> ax.get_xscale(), ax.get_ylabel()
    ('log', 'total error')
    """
    held = columns(table)
    need(held, [time, error, *(name for name in (by, low, high) if name)])
    low, high = low or f"{error}_lo", high or f"{error}_hi"
    ax = axes_for(ax)
    ax.set(xscale="log", yscale="log", xlabel=axis_label(time), ylabel=axis_label(error))
    cycle = colours(ax).cycle
    groups = list(dict.fromkeys(held[by].tolist())) if by else [None]
    for number, group in enumerate(groups):
        rows = (held[time] > 0) & (held[error] > 0)
        if by:
            rows &= held[by] == group
        order = np.argsort(held[time][rows], kind="stable")
        work, value = held[time][rows][order], held[error][rows][order]
        if slope and number == 0 and len(work):
            _slope(ax, value[0], work[0], held[time].max())
        ends = [held[name][rows][order] if name in held else value for name in (low, high)]
        ax.errorbar(
            work,
            value,
            yerr=np.maximum([value - ends[0], ends[1] - value], 0),
            color=cycle[number % len(cycle)] if color is None else color,
            marker=CYCLE_MARKERS[number % len(CYCLE_MARKERS)],
            markersize=4,
            linewidth=1,
            capsize=2.5,
            label=", ".join(str(part) for part in (label, group) if part is not None) or None,
        )
    if ax.get_legend_handles_labels()[1]:
        ax.legend(fontsize="small", frameon=False)
    return ax


def _slope(ax: Axes, error: float, first: float, last: float) -> None:
    """Draw the decrease of a statistical error from its first point."""
    errors = [error, error * np.sqrt(first / last)]
    ax.plot([first, last], errors, ":", color=NEUTRAL, label="error ~ 1/√time", zorder=0)
