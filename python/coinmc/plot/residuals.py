"""Residuals of a fit to film."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from coinmc.plot.style import CYCLE_MARKERS, NEUTRAL, axes_for, colours
from coinmc.plot.table import columns, need, select

__all__ = ["residuals"]

# Name, and number of colour and marker, of each coordinate, the same in every plot.
_COORDINATES = {
    coordinate: (name, number)
    for number, (coordinate, name) in enumerate({"x_m": "x", "z_m": "z", "theta_rad": "θ"}.items())
}


def residuals(
    fit: Any,
    *,
    coordinate: str | None = None,
    law: str | None = None,
    reach: float = 5.0,
    label: str | None = None,
    color: Any = None,
    ax: Axes | None = None,
) -> Axes:
    """Plot residuals of a film fit in standard deviations against time.

    The residuals of a good fit scatter evenly about 0, with 95 % of them within ± 2. A coordinate
    that stays on one side for some time indicates that the law, the coin or the calibration does
    not match the film.

    Parameters
    ----------
    fit : coinmc.film.Fit or table
        A fit, or the table that ``coinmc film fit --residuals table.csv`` writes (columns
        ``time_s``, ``coordinate``, ``standardised``, ``drop`` and perhaps ``law``).
    coordinate : {"x_m", "z_m", "theta_rad"}, optional
        Plot only this coordinate.
    law : str, optional
        The law to plot, if the table has several; the first if absent.
    reach : float
        Limit of the vertical axis, standard deviations. Residuals beyond it are drawn at the edge.
    label : str, optional
        Name of the fit, before that of the coordinate in the legend.
    color : color, optional
        Colour of all coordinates, instead of one for each; their markers still differ.
    ax : Axes, optional
        Axes to draw into; a new figure if absent.

    Returns
    -------
    Axes

    Examples
    --------
    >>> from coinmc import plot
    >>> table = {"time_s": [0, 0.1], "coordinate": ["x_m"] * 2, "standardised": [0.4, -1]}
    >>> table["drop"] = [0, 0]
    >>> plot.residuals(table).get_ylabel()
    'residual, standard deviations'
    """
    table = columns(getattr(fit, "residuals", fit))
    if "law" in table:
        table = select(table, {"law": law or table["law"][0]})
    if coordinate:
        table = select(table, {"coordinate": coordinate})
    names = ("time_s", "coordinate", "standardised", "drop")
    time, coordinates, values, drop = need(table, names)
    time = _since_first_frame(time, drop)
    ax = axes_for(ax)
    cycle = colours(ax).cycle
    ax.axhspan(-2, 2, color=NEUTRAL, alpha=0.15, linewidth=0, zorder=0)
    ax.axhline(0, color=NEUTRAL, linewidth=0.8, zorder=0)
    for held in dict.fromkeys(coordinates.tolist()):
        rows = coordinates == held
        name, number = _COORDINATES.get(held, (held, len(cycle) - 1))
        beyond = np.abs(values[rows]) > reach
        ax.plot(
            time[rows],
            values[rows].clip(-reach, reach),
            CYCLE_MARKERS[number],
            color=cycle[number] if color is None else color,
            markersize=3.5,
            markeredgewidth=0,
            alpha=0.85,
            label=(f"{label}, " if label else "")
            + name
            + (f" ({beyond.sum()} beyond ± {reach:g})" if beyond.any() else ""),
        )
    _impacts(ax, fit)
    ax.set(
        xlabel="time since the first frame, s",
        ylabel="residual, standard deviations",
        ylim=(-1.04 * reach, 1.04 * reach),
    )
    handles = ax.get_legend_handles_labels()[0]
    if getattr(fit, "drops", None):
        handles.append(Line2D([], [], color=NEUTRAL, linestyle=":", label="impact"))
    ax.legend(handles=handles, fontsize="small", frameon=False, ncols=4, loc="upper right")
    return ax


def _since_first_frame(time: Any, drop: Any) -> Any:
    """Return times since the first frame of each drop, so that drops overlap in the plot."""
    since = np.array(time, float)
    for number in np.unique(drop):
        rows = drop == number
        since[rows] -= since[rows].min()
    return since


def _impacts(ax: Axes, fit: Any) -> None:
    for drop in getattr(fit, "drops", None) or ():
        for instant in drop.impacts_s:
            ax.axvline(instant, color=NEUTRAL, linestyle=":", linewidth=1)
