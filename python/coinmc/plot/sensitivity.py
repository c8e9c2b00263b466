"""How a probability depends on parameters."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes

from coinmc.plot.style import NEUTRAL, axes_for, colours, face_list
from coinmc.plot.table import columns, need

__all__ = ["sensitivity"]


def sensitivity(
    table: Any,
    face: str = "side",
    *,
    label: str | None = None,
    color: Any = None,
    ax: Axes | None = None,
) -> Axes:
    """Plot how much P(face) changes with each parameter, with intervals, largest first.

    Parameters
    ----------
    table : table
        A result of `coinmc.sensitivity`, or any table with the columns ``parameter``,
        ``d_p_<face>``, ``d_p_<face>_lo`` and ``d_p_<face>_hi``.
    face : str
        ``heads``, ``tails`` or ``side``.
    label : str, optional
        Name of the bars in the legend, which is drawn if there is one.
    color : color, optional
        Colour of the bars; by default that of the face.
    ax : Axes, optional
        Axes to draw into; a new figure if absent.

    Returns
    -------
    Axes

    Notes
    -----
    A bar is dP/d ln(parameter): P changes by a hundredth of it when the parameter grows by one per
    cent.

    Examples
    --------
    >>> from coinmc import plot
    >>> table = {
    ...     "parameter": ["coin.ratio", "surface.friction"],
    ...     "d_p_side": [0.6, -0.1], "d_p_side_lo": [0.5, -0.12], "d_p_side_hi": [0.7, -0.08],
    ... }
    >>> plot.sensitivity(table).get_xlabel()
    'dP(side)/d ln(parameter)'
    """
    (face,) = face_list(face)
    names = ("parameter", *(f"d_p_{face}{end}" for end in ("", "_lo", "_hi")))
    parameter, value, low, high = need(columns(table), names)
    # horizontal bars count from the bottom: the largest goes last, to the top
    order = np.argsort(np.abs(value), kind="stable")
    value, low, high = value[order], low[order], high[order]
    ax = axes_for(ax)
    ax.barh(
        np.arange(len(value)),
        value,
        xerr=np.maximum([value - low, high - value], 0),
        color=colours(ax).faces[face] if color is None else color,
        label=label,
        ecolor=NEUTRAL,
        height=0.6,
        capsize=3,
    )
    ax.axvline(0, color=NEUTRAL, linewidth=0.8)
    ax.set_yticks(np.arange(len(value)), [str(name) for name in parameter[order]])
    ax.set_xlabel(f"dP({face})/d ln(parameter)")
    if label:
        ax.legend(fontsize="small", frameon=False)
    return ax
