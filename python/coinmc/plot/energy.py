"""Energy of a toss against time."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from coinmc.plot.motion import Motion, motion_of
from coinmc.plot.style import CYCLE, MODES, NEUTRAL, axes_for

__all__ = ["energy"]


def energy(trace: Any, *, barriers: bool = True, ax: Axes | None = None) -> Axes:
    """Plot energy per unit mass against time, with shaded modes and marked impacts.

    Parameters
    ----------
    trace : coinmc.Trace
        A trace from `coinmc.trace`.
    barriers : bool
        Draw the energies of the coin at rest on a face, on its side, and balanced on its rim:
        once the energy is below the last of these, the face cannot change.
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
    values = _energies(trace)
    ax = axes_for(ax)
    ax.set(yscale="log", xlabel="time since launch, s", ylabel="energy per mass, J/kg")
    key = [Line2D([], [], color=CYCLE[0], label="energy")]
    ax.plot(values[0], values[1], color=CYCLE[0], linewidth=1.5)
    shaded = dict.fromkeys(mode for mode, _ in motion.phases() if mode in ("sticking", "sliding"))
    for mode, phase in motion.phases():
        if mode in shaded:
            begin, end = motion.time_s[phase][[0, -1]]
            ax.axvspan(begin, end, color=MODES[mode], alpha=0.3, linewidth=0)
    key += [Patch(color=MODES[mode], alpha=0.3, label=mode) for mode in shaded]
    if len(motion.impacts):
        times = motion.time_s[motion.impacts]
        # along the lower edge on any scale
        edge = {"transform": ax.get_xaxis_transform(), "clip_on": False}
        ax.plot(times, np.full(len(times), 0.015), "^", color=NEUTRAL, markersize=5, **edge)
        key.append(Line2D([], [], color=NEUTRAL, marker="^", linestyle="none", label="impact"))
    if barriers:
        _barriers(ax, motion, trace.scene["gravity_m_s2"])
    ax.legend(handles=key, fontsize="small", frameon=False, loc="upper right")
    return ax


def _energies(trace: Any) -> tuple[Any, Any]:
    """Return times and energies of samples and events in order of time."""
    time = np.concatenate([trace.samples["time_s"], trace.events["time_s"]])
    value = np.concatenate([trace.samples["energy_j_kg"], trace.events["energy_j_kg"]])
    # records at one instant are ordered by decreasing energy: impacts only dissipate
    order = np.lexsort((-value, time))
    return time[order], value[order]


def _barriers(ax: Axes, motion: Motion, gravity_m_s2: float) -> None:
    radius, half = motion.radius_m, motion.height_m / 2
    rim = np.hypot(radius, half)
    # the level of the rim is the highest: its name goes above the line, the others go below
    for name, height, place in (
        ("on its rim", rim, (3, 2)),
        ("on its side", radius, (3, -11)),
        ("on a face", half, (80, -11)),
    ):
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
