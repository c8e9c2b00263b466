"""The path of the coin, seen from the side, from above and in space."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from coinmc.plot.motion import Motion, motion_of
from coinmc.plot.outline import hull, rims
from coinmc.plot.style import FACES, MODES, NEUTRAL, axes_for

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
    ax: Axes | None = None,
) -> Axes:
    """Draw the trajectory, with the coin at regular times, its impacts and its modes.

    The line is the path of the centre, coloured by mode: flight, sticking, sliding. The rim of
    heads is blue, that of tails orange. Triangles mark the contact points of impacts, larger for
    harder impacts.

    Parameters
    ----------
    trace : coinmc.Trace
        A trace from `coinmc.trace`.
    view : {"side", "top", "space"}, optional
        From the side (x and z), from above (x and y) or in space; by default from the side for a
        planar toss, in space for others.
    coins : int
        Number of positions of the coin to draw, evenly spaced in time from first to last.
    times : tuple of float, optional
        Draw only this interval of time, s since launch.
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
    ax = axes_for(ax, space=view == "space", size=(6.0, 5.0))
    if view == "space":
        _in_space(ax, motion, coins)
    else:
        _in_plane(ax, motion, view, coins)
    place = "upper left" if view == "space" else "best"
    ax.legend(handles=_key(motion), fontsize="small", frameon=False, loc=place)
    return ax


def strobe(motion: Motion, coins: int) -> NDArray[np.int64]:
    """Return indices of records spaced as evenly in time as possible."""
    if coins == 0:
        return np.array([], int)
    wanted = np.linspace(motion.time_s[0], motion.time_s[-1], coins)
    return np.unique(np.searchsorted(motion.time_s, wanted).clip(0, len(motion.time_s) - 1))


def draw_coin(ax: Axes, motion: Motion, at: int, view: str, alpha: float = 1.0) -> list[Any]:
    """Draw the coin at one instant, seen from the side or from above; return the artists."""
    coordinates, towards = _PLANES[view]
    rings = rims(motion.position_m[at], motion.axis[at], motion.radius_m, motion.height_m)
    flat = [ring[:, coordinates] for ring in rings]
    body = Polygon(
        hull(np.concatenate(flat)), facecolor=NEUTRAL, edgecolor=NEUTRAL, alpha=0.35 * alpha
    )
    artists: list[Any] = [ax.add_patch(body)]
    # a face turned away is hidden; a face on edge is a line
    facing = motion.axis[at] @ towards
    for ring, face, visible in zip(flat, ("heads", "tails"), (facing, -facing), strict=True):
        if visible > -1e-9:
            rim = Polygon(ring, fill=False, edgecolor=FACES[face], linewidth=1.4, alpha=alpha)
            artists.append(ax.add_patch(rim))
    return artists


def _in_plane(ax: Axes, motion: Motion, view: str, coins: int) -> None:
    across, up = _PLANES[view][0]
    drawn = strobe(motion, coins)
    for at, alpha in zip(drawn, np.linspace(0.4, 1, len(drawn)), strict=True):
        draw_coin(ax, motion, int(at), view, float(alpha))
    for mode, phase in motion.phases():
        line = motion.position_m[phase]
        ax.plot(line[:, across], line[:, up], color=MODES[mode], linewidth=1.3)
    hits = motion.feet_m()[motion.impacts]
    ax.scatter(hits[:, across], hits[:, up], s=_sizes(motion), c=NEUTRAL, marker="^", zorder=3)
    if view == "side":
        ax.axhline(0, color=NEUTRAL, linewidth=1, zorder=0)
    ax.set(xlabel="x, m", ylabel="z, m" if view == "side" else "y, m")
    # equal scales keep the coin round; the limits follow from the shape of the frame
    ax.set_aspect("equal", adjustable="datalim")


def _in_space(ax: Any, motion: Motion, coins: int) -> None:
    drawn = strobe(motion, coins)
    for at, alpha in zip(drawn, np.linspace(0.4, 1, len(drawn)), strict=True):
        rings = rims(motion.position_m[at], motion.axis[at], motion.radius_m, motion.height_m)
        for ring, face in zip(rings, ("heads", "tails"), strict=True):
            closed = np.concatenate([ring, ring[:1]])
            ax.plot(*closed.T, color=FACES[face], linewidth=1.1, alpha=alpha)
    for mode, phase in motion.phases():
        ax.plot(*motion.position_m[phase].T, color=MODES[mode], linewidth=1.3)
    hits = motion.feet_m()[motion.impacts]
    ax.scatter(*hits.T, s=_sizes(motion), c=NEUTRAL, marker="^", depthshade=False)
    ax.set_xlabel("x, m", labelpad=8)
    ax.set_ylabel("y, m", labelpad=8)
    ax.set_zlabel("z, m")
    # the same scale along all axes, and room for the labels
    spans = [high - low for low, high in (ax.get_xlim3d(), ax.get_ylim3d(), ax.get_zlim3d())]
    ax.set_box_aspect(spans, zoom=0.85)
    # few ticks: a toss is often much longer than wide
    for axis in (ax.xaxis, ax.yaxis):
        axis.set_major_locator(MaxNLocator(3))


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


def _key(motion: Motion) -> list[Line2D]:
    """Make the legend of what occurs in the motion."""
    occurring = dict.fromkeys(mode for mode, _ in motion.phases())
    key = [Line2D([], [], color=MODES[mode], label=mode) for mode in occurring]
    count = len(motion.impacts)
    if count:
        label = f"{count} impact{'s' if count > 1 else ''}"
        key.append(Line2D([], [], color=NEUTRAL, marker="^", linestyle="none", label=label))
    key += [
        Line2D([], [], color=FACES[face], label=f"rim of {face}") for face in ("heads", "tails")
    ]
    key.append(Line2D([], [], linestyle="none", label=f"ends: {motion.outcome.replace('_', ' ')}"))
    return key
