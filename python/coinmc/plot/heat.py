"""P(face) over two axes of a sweep."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PatchCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle
from numpy.typing import NDArray

from coinmc.plot.style import NEUTRAL, axes_for, axis_label, face_list, scene_text
from coinmc.plot.table import columns, need, parameters, select

__all__ = ["heat"]

_SETTINGS = ("", "_lo", "_hi")
_SMALL: dict[str, Any] = {"fontsize": "small", "color": NEUTRAL}


def heat(
    result: Any,
    x: str = "ratio",
    y: str = "restitution",
    face: str = "side",
    *,
    where: Mapping[str, Any] | None = None,
    target: float = 1 / 3,
    bar: bool = True,
    label: str | None = None,
    color: Any = "white",
    ax: Axes | None = None,
) -> Axes:
    """Map a probability over two parameters, with its contour at a target.

    Cells whose interval contains the target are hatched: the true contour may pass through them.

    Parameters
    ----------
    result : table
        A result, or any table with the columns `x`, `y`, ``p_<face>``, ``p_<face>_lo`` and
        ``p_<face>_hi`` in which every pair of `x` and `y` has one row.
    x, y : str
        Columns of the axes.
    face : str
        ``heads``, ``tails`` or ``side``.
    where : mapping of str to value, optional
        Use only rows with these values, such as ``{"friction": 0.3}``: needed if more than two
        parameters vary.
    target : float
        The probability whose contour is drawn.
    bar : bool
        Whether to draw a colour bar. Its label says the widest interval of the map: what differs by
        less is noise.
    label : str, optional
        Name of the contour in the legend; by default the probability.
    color : color
        Colour of the contour and of the hatches.
    ax : Axes, optional
        Axes to draw into; a new figure if absent.

    Returns
    -------
    Axes

    Raises
    ------
    ValueError
        If a pair of `x` and `y` has no row, or several.

    Examples
    --------
    >>> import numpy as np
    >>> from coinmc import plot
    >>> ratio, e = (axis.ravel() for axis in np.meshgrid([1.0, 1.5, 2.0], [0.2, 0.6]))
    >>> p = {"p_side": ratio / 4, "p_side_lo": ratio / 5, "p_side_hi": ratio / 3}
    >>> table = {"ratio": ratio, "restitution": e, **p}
    >>> plot.heat(table).get_ylabel()
    'restitution e'
    """
    (face,) = face_list(face)
    table = select(columns(result), where)
    need(table, [x, y, *(f"p_{face}{end}" for end in _SETTINGS)])
    xs, ys, (p, low, high) = _grid(table, x, y, [f"p_{face}{end}" for end in _SETTINGS])
    ax = axes_for(ax)
    mesh = ax.pcolormesh(_edges(xs), _edges(ys), p, cmap="cividis", rasterized=True)
    name = "1/3" if abs(target - 1 / 3) < 1e-9 else f"{target:g}"
    key = _hatch(ax, _edges(xs), _edges(ys), (low <= target) & (target <= high), name, color)
    if min(p.shape) > 1 and np.nanmin(p) < target < np.nanmax(p):
        ax.contour(xs, ys, p, levels=[target], colors=[color], linewidths=2.2)
        # white on the map, grey in the legend, which has no map behind it
        in_key = {"color": NEUTRAL if color == "white" else color, "linewidth": 2.2}
        key.append(Line2D([], [], label=label or f"P({face}) = {name}", **in_key))
    ax.set(xlabel=axis_label(x), ylabel=axis_label(y))
    if key:
        place = {"loc": "lower left", "bbox_to_anchor": (0, 1), "ncols": 2}
        ax.legend(handles=key, frameon=False, fontsize="small", **place)
    if bar:
        reach = np.nanmax(np.maximum(high - p, p - low))
        within = f", within ± {reach:.1g}" if reach > 0 else ""
        ax.figure.colorbar(mesh, ax=ax, label=f"P({face}){within}")
    scene = scene_text({key: column for key, column in table.items() if key not in (x, y)})
    if scene:
        ax.text(1, -0.16, scene, transform=ax.transAxes, ha="right", va="top", **_SMALL)
    return ax


def _grid(
    table: Mapping[str, NDArray[Any]], x: str, y: str, names: list[str]
) -> tuple[NDArray[np.float64], NDArray[np.float64], list[NDArray[np.float64]]]:
    """Return the values of both axes, and each column as a grid with y as its first axis."""
    xs, at_x = np.unique(table[x], return_inverse=True)
    ys, at_y = np.unique(table[y], return_inverse=True)
    counts = np.zeros((len(ys), len(xs)), int)
    np.add.at(counts, (at_y, at_x), 1)
    if counts.max(initial=0) > 1:
        free = [
            name
            for name in parameters(table)
            if name not in (x, y) and len(np.unique(table[name])) > 1
        ]
        remedy = f"fix {', '.join(free)} with where={{…}}" if free else "the table repeats rows"
        raise ValueError(f"several rows have the same {x} and {y}: {remedy}")
    if counts.min(initial=1) < 1:
        row, column = np.argwhere(counts == 0)[0]
        raise ValueError(f"no row has {x} = {xs[column]:g} and {y} = {ys[row]:g}: not a full grid")
    grids = []
    for name in names:
        grid = np.empty(counts.shape)
        grid[at_y, at_x] = table[name]
        grids.append(grid)
    return xs, ys, grids


def _edges(centres: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return cell edges half way between the centres; the outer cells are symmetric."""
    if len(centres) == 1:
        return centres[0] + np.array([-0.5, 0.5])
    inner = (centres[1:] + centres[:-1]) / 2
    return np.concatenate([[2 * centres[0] - inner[0]], inner, [2 * centres[-1] - inner[-1]]])


def _hatch(
    ax: Axes,
    xs: NDArray[np.float64],
    ys: NDArray[np.float64],
    cells: NDArray[np.bool_],
    name: str,
    color: Any,
) -> list[Any]:
    """Hatch cells and return their entries of the legend."""
    if not cells.any():
        return []
    rectangles = [
        Rectangle((xs[i], ys[j]), xs[i + 1] - xs[i], ys[j + 1] - ys[j])
        for j, i in np.argwhere(cells)
    ]
    look = {"facecolor": "none", "edgecolor": color, "linewidth": 0, "hatch": "////"}
    ax.add_collection(PatchCollection(rectangles, **look))
    seen = NEUTRAL if color == "white" else color
    return [Patch(**{**look, "edgecolor": seen}, label=f"interval holds {name}")]
