"""The path of the coin, seen from the side, from above and in space."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon
from matplotlib.ticker import MaxNLocator
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from numpy.typing import NDArray

from coinmc.plot.motion import Motion, motion_of
from coinmc.plot.outline import hull, rims
from coinmc.plot.style import NEUTRAL, Palette, axes_for, colours

__all__ = ["View", "path"]

View = Literal["side", "top", "space"]

# Horizontal and vertical coordinate of each planar view, and the direction towards the viewer.
_PLANES = {"side": ((0, 2), np.array([0.0, -1.0, 0.0])), "top": ((0, 1), np.array([0.0, 0.0, 1.0]))}


def path(
    trace: Any,
    *,
    view: View | None = None,
    coins: int = 16,
    times: tuple[float, float] | None = None,
    label: str | None = None,
    color: Any = None,
    ax: Axes | None = None,
) -> Axes:
    """Draw the trajectory, with the coin at regular times, its impacts and its modes.

    The line is the path of the centre, coloured by mode: flight, sticking, sliding. The rim of
    heads has the colour of heads, that of tails that of tails. Triangles mark the contact points of
    impacts, larger for harder impacts. The coin is drawn to scale.

    Parameters
    ----------
    trace : coinmc.Trace
        A trace from `coinmc.trace`.
    view : {"side", "top", "space"}, optional
        From the side (x and z), from above (x and y) or in space; by default from the side for a
        planar toss, in space for others.
    coins : int
        Number of positions of the coin to draw, evenly spaced in time from first to last; fewer
        where it hardly leaves its place, as drawn coins would hide each other.
    times : tuple of float, optional
        Draw only this interval of time, s since launch.
    label : str, optional
        Name of the toss in the legend.
    color : color, optional
        Colour of the line, instead of one for each mode.
    ax : Axes, optional
        Axes to draw into, 3-D axes for the view in space; a new figure if absent.

    Returns
    -------
    Axes

    Examples
    --------
    >>> import coinmc
    >>> from coinmc import plot
    >>> toss = coinmc.trace("examples/hand.toml", toss=3)
    >>> plot.path(toss, view="side").get_ylabel()
    'z, m'
    """
    motion = motion_of(trace)
    if times is not None:
        motion = motion.between(*times)
    view = view or ("side" if motion.is_planar else "space")
    if view not in ("side", "top", "space"):
        raise ValueError(f"unknown view {view!r}: use side, top or space")
    if coins < 0:
        raise ValueError(f"coins must not be negative, found {coins}")
    own = ax is None
    ax = axes_for(ax, space=view == "space", size=_size(motion, view))
    palette = colours(ax)
    if color is not None:
        palette.modes = dict.fromkeys(palette.modes, color)
    if view == "space":
        _in_space(ax, motion, coins, palette)
    else:
        _in_plane(ax, motion, view, coins, palette)
    key = _key(motion, palette, label, one=color is not None)
    if view == "space":
        ax.legend(handles=key, fontsize="small", frameon=False, loc="upper left", ncols=2)
    elif own:
        # beside the path, which fills its frame
        place = {"loc": "upper left", "bbox_to_anchor": (1, 1)}
        ax.legend(handles=key, fontsize="small", frameon=False, **place)
    else:
        # above: the path fills its frame
        place = {"loc": "lower left", "bbox_to_anchor": (0, 1), "ncols": 3}
        ax.legend(handles=key, fontsize="small", frameon=False, **place)
    return ax


def _size(motion: Motion, view: str) -> tuple[float, float]:
    """Return a size of a figure in whose frame the path fits at equal scales, inches."""
    if view == "space":
        return (7.2, 5.4)
    across, up = _PLANES[view][0]
    low, high = _limits(motion, across, up)
    wide, tall = high - low
    # room for labels and the legend beside the frame
    return (4.4 * np.clip(wide / tall, 0.4, 2.0) + 2.4, 4.4 * np.clip(tall / wide, 0.4, 1.0) + 0.7)


def _limits(
    motion: Motion, across: int, up: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the lowest and highest coordinates that the coin reaches, with a margin."""
    reach = 1.15 * max(np.hypot(*rim) for rim in motion.rims_m)
    way = motion.position_m[:, [across, up]]
    low, high = way.min(axis=0) - reach, way.max(axis=0) + reach
    if up == 2:
        # nothing is below the ground
        low[1] = max(low[1], -0.35 * motion.radius_m)
    return low, high


def strobe(motion: Motion, coins: int) -> NDArray[np.int64]:
    """Return indices of records spaced as evenly in time as possible."""
    if coins == 0:
        return np.array([], int)
    wanted = np.linspace(motion.time_s[0], motion.time_s[-1], coins)
    return np.unique(np.searchsorted(motion.time_s, wanted).clip(0, len(motion.time_s) - 1))


def _apart(motion: Motion, coins: int, seen: tuple[int, ...]) -> NDArray[np.int64]:
    """Return the first and last of such indices, and those at which the coin is seen elsewhere."""
    some = strobe(motion, coins)
    least = 0.7 * np.hypot(motion.radius_m, motion.height_m / 2)
    way, kept = motion.position_m[:, seen], some[:1].tolist()
    for at in some[1:-1]:
        shown = [kept[-1], some[-1]]
        if np.linalg.norm(way[shown] - way[at], axis=1).min() >= least:
            kept.append(at)
    return np.array([*kept, *some[1:][-1:]], int)


def draw_coin(ax: Axes, motion: Motion, at: int, view: str, alpha: float = 1.0) -> list[Any]:
    """Draw the coin at one instant, seen from the side or from above; return the artists."""
    coordinates, towards = _PLANES[view]
    rings = rims(motion.position_m[at], motion.axis[at], motion.rims_m)
    flat = [ring[:, coordinates] for ring in rings]
    body = Polygon(
        hull(np.concatenate(flat)), facecolor=NEUTRAL, edgecolor=NEUTRAL, alpha=0.35 * alpha
    )
    palette = colours(ax)
    artists: list[Any] = [ax.add_patch(body)]
    # a face turned away is hidden; a face on edge is a line
    facing = motion.axis[at] @ towards
    for ring, face, visible in zip(flat, ("heads", "tails"), (facing, -facing), strict=True):
        if visible > -1e-9:
            look = {"edgecolor": palette.faces[face], "linewidth": 1.6, "alpha": alpha}
            rim = Polygon(ring, fill=False, **look)
            artists.append(ax.add_patch(rim))
    return artists


def _in_plane(ax: Axes, motion: Motion, view: str, coins: int, palette: Palette) -> None:
    across, up = _PLANES[view][0]
    drawn = _apart(motion, coins, (across, up))
    for at, alpha in zip(drawn, np.linspace(0.4, 1, len(drawn)), strict=True):
        draw_coin(ax, motion, int(at), view, float(alpha))
    for mode, phase in motion.phases():
        line = motion.position_m[phase]
        ax.plot(line[:, across], line[:, up], color=palette.modes[mode], linewidth=1.3)
    hits = motion.feet_m()[motion.impacts]
    ax.scatter(hits[:, across], hits[:, up], s=_sizes(motion), c=NEUTRAL, marker="^", zorder=3)
    low, high = _limits(motion, across, up)
    if view == "side":
        ax.axhline(0, color=NEUTRAL, linewidth=1, zorder=0)
        ax.axhspan(low[1], 0, color=NEUTRAL, alpha=0.25, linewidth=0, zorder=0)
    ax.set(xlabel="x, m", ylabel="z, m" if view == "side" else "y, m")
    ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]))
    # equal scales keep the coin round; the shape of the frame follows from the path
    ax.set_aspect("equal", adjustable="box", anchor="S")
    wide, tall = high - low
    ax.xaxis.set_major_locator(MaxNLocator(int(np.clip(6 * wide / tall, 2, 6))))
    ax.yaxis.set_major_locator(MaxNLocator(int(np.clip(6 * tall / wide, 2, 6))))


def _in_space(ax: Any, motion: Motion, coins: int, palette: Palette) -> None:
    # as from far away: what is as large is drawn as large
    ax.set_proj_type("ortho")
    drawn = _apart(motion, coins, (0, 1, 2))
    for at, alpha in zip(drawn, np.linspace(0.45, 1, len(drawn)), strict=True):
        _solid(ax, motion, int(at), palette, float(alpha))
    for mode, phase in motion.phases():
        ax.plot(*motion.position_m[phase].T, color=palette.modes[mode], linewidth=1.5)
    hits = motion.feet_m()[motion.impacts]
    ax.scatter(*hits.T, s=_sizes(motion), c=NEUTRAL, marker="^", depthshade=False)
    low = motion.position_m.min(axis=0) - motion.radius_m
    high = motion.position_m.max(axis=0) + motion.radius_m
    low[2] = min(low[2], 0.0)
    ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    # the same scale along all axes
    ax.set_box_aspect(high - low, zoom=1.0)
    # few ticks, and their labels clear of those of the axes: a toss is often longer than wide
    longest = (high - low).max()
    for axis, name, start, end in zip(
        (ax.xaxis, ax.yaxis, ax.zaxis), "xyz", low, high, strict=True
    ):
        span = end - start
        ticks = MaxNLocator(max(2, round(5 * span / longest))).tick_values(start, end)
        # at the corner in front the labels of two axes would meet
        last = end - 0.1 * span if name == "x" else end
        axis.set_ticks([tick for tick in ticks if start <= tick <= last])
        axis.set_tick_params(labelsize="small", pad=0)
        axis.set_label_text(f"{name}, m")
        axis.labelpad = 6
        axis.pane.set_visible(name == "z")
        axis.pane.set_alpha(0.3)
    ax.grid(False)


def _solid(ax: Any, motion: Motion, at: int, palette: Palette, alpha: float) -> None:
    """Draw the coin in space: both faces in their colours, and its side."""
    rings = rims(motion.position_m[at], motion.axis[at], motion.rims_m)
    heads, tails = rings
    after = np.roll(np.arange(len(heads)), -1)
    side = np.stack([heads, tails, tails[after], heads[after]], axis=1)
    ax.add_collection3d(Poly3DCollection(side, facecolor=NEUTRAL, alpha=0.3 * alpha, linewidth=0))
    for ring, face in zip(rings, ("heads", "tails"), strict=True):
        look = {"facecolor": palette.faces[face], "edgecolor": palette.faces[face]}
        ax.add_collection3d(Poly3DCollection([ring], alpha=0.7 * alpha, linewidth=0.8, **look))


def _sizes(motion: Motion) -> NDArray[np.float64]:
    """Return areas of the impact markers, which grow with the speed of approach."""
    speeds = _approach_m_s(motion)
    hardest = speeds.max(initial=0.0)
    return 12 + 60 * (speeds / hardest if hardest > 0 else speeds)


def _approach_m_s(motion: Motion) -> NDArray[np.float64]:
    """Return the downward speed of the contact point just before each impact, m/s."""
    # the previous record is the touching event, at the same instant
    before = np.maximum(motion.impacts - 1, 0)
    lever = (motion.feet_m() - motion.position_m)[before]
    velocity = motion.velocity_m_s[before] + np.cross(motion.spin_rad_s[before], lever)
    return np.maximum(-velocity[:, 2], 0.0)


def _key(motion: Motion, palette: Palette, label: str | None, *, one: bool) -> list[Line2D]:
    """Make the legend of what occurs in the motion; `one` line for all modes."""
    occurring = dict.fromkeys(mode for mode, _ in motion.phases())
    key = [Line2D([], [], linestyle="none", label=label)] if label else []
    if one:
        color = palette.modes["flight"]
        key = [Line2D([], [], color=color, label=label or "centre")]
    else:
        key += [Line2D([], [], color=palette.modes[mode], label=mode) for mode in occurring]
    count = len(motion.impacts)
    if count:
        name = f"{count} impact{'s' if count > 1 else ''}"
        key.append(Line2D([], [], color=NEUTRAL, marker="^", linestyle="none", label=name))
    key += [
        Line2D([], [], color=palette.faces[face], linewidth=3, label=face)
        for face in ("heads", "tails")
    ]
    key.append(Line2D([], [], linestyle="none", label=f"ends: {motion.outcome.replace('_', ' ')}"))
    return key
