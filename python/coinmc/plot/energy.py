"""Energy of a toss against time."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from coinmc.plot.motion import Motion, motion_of
from coinmc.plot.style import NEUTRAL, axes_for, colours

__all__ = ["energy"]


def energy(
    trace: Any,
    *,
    barriers: bool = True,
    label: str | None = None,
    color: Any = None,
    ax: Axes | None = None,
) -> Axes:
    """Plot energy per unit mass against time, with shaded modes and marked impacts.

    The thick line is what can still tilt the coin: its height, its vertical motion and its turning
    about a diameter. The thin line is all energy, with that of moving along the surface and of
    turning about the coin's own axis. On a tilted table the height is that above the table, and the
    thin line has the height of the place along it as well.

    Parameters
    ----------
    trace : coinmc.Trace
        A trace from `coinmc.trace`.
    barriers : bool
        Draw the energies of the coin at rest on a face, on its side, and balanced on its rim:
        once the energy is below the last of these, the face cannot change (on a level table). A
        coin with a conical edge, or a load, has two of the first and of the last.
    label : str, optional
        Name of the toss in the legend.
    color : color, optional
        Colour of both lines.
    ax : Axes, optional
        Axes to draw into; a new figure if absent.

    Returns
    -------
    Axes

    Notes
    -----
    The energy axis is logarithmic, since every impact dissipates a fraction of the energy. The
    potential energy is zero for a point on the surface.

    Examples
    --------
    >>> import coinmc
    >>> from coinmc import plot
    >>> plot.energy(coinmc.trace("examples/first.toml", toss=1)).get_ylabel()
    'energy per mass, J/kg'
    """
    motion = motion_of(trace)
    time, whole, tilting = _energies(trace)
    ax = axes_for(ax)
    ax.set(yscale="log", xlabel="time since launch, s", ylabel="energy per mass, J/kg")
    palette = colours(ax)
    color = palette.cycle[0] if color is None else color
    name = f"{label}: " if label else ""
    ax.plot(time, whole, color=color, linewidth=0.8, alpha=0.8)
    ax.plot(time, tilting, color=color, linewidth=1.8)
    key = [
        Line2D([], [], color=color, linewidth=1.8, label=f"{name}can tilt the coin"),
        Line2D([], [], color=color, linewidth=0.8, label=f"{name}all energy"),
    ]
    shaded = dict.fromkeys(mode for mode, _ in motion.phases() if mode in ("sticking", "sliding"))
    for mode, phase in motion.phases():
        if mode in shaded:
            begin, end = motion.time_s[phase][[0, -1]]
            ax.axvspan(begin, end, color=palette.modes[mode], alpha=0.3, linewidth=0)
    key += [Patch(color=palette.modes[mode], alpha=0.3, label=mode) for mode in shaded]
    if len(motion.impacts):
        times = motion.time_s[motion.impacts]
        # along the lower edge on any scale
        edge = {"transform": ax.get_xaxis_transform(), "clip_on": False}
        ax.plot(times, np.full(len(times), 0.015), "^", color=NEUTRAL, markersize=5, **edge)
        key.append(Line2D([], [], color=NEUTRAL, marker="^", linestyle="none", label="impact"))
    if barriers:
        _barriers(ax, motion, -trace.weight_m_s2[2])
    before = ax.get_legend()
    if before and label:
        key = [*before.legend_handles[:1], *key]
    ax.legend(handles=key, fontsize="small", frameon=False, loc="upper right")
    return ax


def _energies(trace: Any) -> tuple[Any, Any, Any]:
    """Return times, energies, and what of them can tilt, of all records in order of time."""

    def both(name: str) -> Any:
        return np.concatenate([trace.samples[name], trace.events[name]])

    time, whole = both("time_s"), both("energy_j_kg")
    along = (both("velocity_m_s")[:, :2] ** 2).sum(axis=1)
    axial = (both("spin_rad_s") * both("axis")).sum(axis=1)
    # how far the coin has gone down a tilted table
    fallen = (both("position_m")[:, :2] * trace.weight_m_s2[:2]).sum(axis=1)
    tilting = whole - along / 2 - trace.axial_gyration_m2 * axial**2 / 2 + fallen
    # records at one instant are ordered by decreasing energy: impacts only dissipate
    order = np.lexsort((-whole, time))
    return time[order], whole[order], tilting[order]


def _barriers(ax: Axes, motion: Motion, gravity_m_s2: float) -> None:
    levels = _levels(motion)
    flat = levels[-1][1]
    # the level of the rim is the highest: its name goes above the line, the others go below
    for name, height in levels:
        above = name.startswith("balanced")
        beside = not above and "side" not in name and flat >= 0.8 * motion.radius_m
        place = (3, 2) if above else (120 if beside else 3, -11)
        level = gravity_m_s2 * height
        ax.axhline(level, color=NEUTRAL, linewidth=0.8, linestyle=":", zorder=0)
        ax.annotate(
            name,
            (0, level),
            xycoords=ax.get_yaxis_transform(),
            xytext=place,
            textcoords="offset points",
            color=NEUTRAL,
            fontsize="small",
        )


def _levels(motion: Motion) -> list[tuple[str, float]]:
    """Return the heights of the centre at rest and at the balances, m, that of a face last."""
    heads, tails = motion.rims_m
    if heads == tails:
        radius, half = heads
        return [
            ("balanced on its rim", float(np.hypot(radius, half))),
            ("at rest on its side", radius),
            ("at rest on a face", half),
        ]
    # on its edge both rims are at the ground
    slope = np.arctan2(heads[0] - tails[0], heads[1] + tails[1])
    edge = tails[0] * np.cos(slope) + tails[1] * np.sin(slope)
    return [
        ("balanced on the rim of heads", float(np.hypot(*heads))),
        ("balanced on the rim of tails", float(np.hypot(*tails))),
        ("at rest on its side", float(edge)),
        ("at rest, heads up", tails[1]),
        ("at rest, tails up", heads[1]),
    ]
