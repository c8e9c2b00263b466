"""A trace prepared for plots: samples and events in order of time, and the size of the coin."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["Motion", "motion_of"]

_MODES = np.array(["flight", "sticking", "sliding", "ended"])
_KINDS = np.array(["launched", "touching", "impact", "sticking", "sliding", "lift_off", "ended"])
# Fields with one row per instant.
_RECORDED = ("time_s", "position_m", "velocity_m_s", "axis", "spin_rad_s", "mode", "kind")
# The mode after an event. Touching changes nothing: the impact follows at the same instant.
_MODE_AFTER = {"sticking": "sticking", "sliding": "sliding", "ended": "ended"}


@dataclass(frozen=True)
class Motion:
    """The coin at every instant of a trace.

    Attributes
    ----------
    time_s : ndarray, (n,)
        Time since launch, s; never decreases.
    position_m, velocity_m_s, axis, spin_rad_s : ndarray, (n, 3)
        Centre, its velocity, unit normal of the heads face, angular velocity.
    mode : ndarray of str, (n,)
        The mode of motion from then on: ``flight``, ``sticking``, ``sliding`` or ``ended``.
    kind : ndarray of str, (n,)
        The event, or ``sample``.
    radius_m, height_m : float
        Size of the coin.
    rims_m : tuple
        Radius and distance from the centre of the faces, heads and tails, m.
    outcome : str
        The face, or the reason why there is none.
    """

    time_s: NDArray[np.float64]
    position_m: NDArray[np.float64]
    velocity_m_s: NDArray[np.float64]
    axis: NDArray[np.float64]
    spin_rad_s: NDArray[np.float64]
    mode: NDArray[np.str_]
    kind: NDArray[np.str_]
    radius_m: float
    height_m: float
    rims_m: tuple[tuple[float, float], ...]
    outcome: str

    @property
    def is_planar(self) -> bool:
        """Whether the motion stays in the plane y = 0, with the coin turning about y."""
        return not (self.position_m[:, 1].any() or self.axis[:, 1].any())

    @property
    def impacts(self) -> NDArray[np.int64]:
        """Indices of the impacts."""
        return np.flatnonzero(self.kind == "impact")

    def between(self, first_s: float, last_s: float) -> Motion:
        """Return the part of the motion in an interval of time.

        Raises
        ------
        ValueError
            If nothing was recorded in it.
        """
        rows = (self.time_s >= first_s) & (self.time_s <= last_s)
        if not rows.any():
            raise ValueError(
                f"nothing was recorded from {first_s:g} s to {last_s:g} s: the trace goes from "
                f"{self.time_s[0]:g} s to {self.time_s[-1]:g} s"
            )
        return replace(self, **{name: getattr(self, name)[rows] for name in _RECORDED})

    def feet_m(self) -> NDArray[np.float64]:
        """Return the lowest point of the coin at every instant, (n, 3).

        If a whole face or a line of the side is lowest, it is the middle of that.
        """
        down = self.axis * self.axis[:, 2:3] - np.array([0.0, 0.0, 1.0])
        length = np.linalg.norm(down, axis=1, keepdims=True)
        out = np.divide(down, length, out=np.zeros_like(down), where=length > 1e-9)
        (heads, above), (tails, below) = self.rims_m
        upper, lower = heads * out + above * self.axis, tails * out - below * self.axis
        higher = _small_to_zero((upper - lower)[:, 2:3] / self.radius_m)
        # halfway where both rims are lowest
        share = 0.5 * (1.0 + np.sign(higher))
        return self.position_m + share * lower + (1.0 - share) * upper

    def phases(self) -> list[tuple[str, slice]]:
        """Return the phases of constant mode, each including the first instant of the next."""
        starts = [0, *(1 + np.flatnonzero(self.mode[1:] != self.mode[:-1])), len(self.mode) - 1]
        return [
            (str(self.mode[begin]), slice(int(begin), int(end) + 1))
            for begin, end in itertools.pairwise(starts)
            if self.time_s[end] > self.time_s[begin]
        ]


def _small_to_zero(values: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.where(np.abs(values) < 1e-9, 0.0, values)


def motion_of(trace: Any) -> Motion:
    """Return the motion recorded in a trace.

    Parameters
    ----------
    trace : coinmc.Trace
        A trace from `coinmc.trace`.

    Returns
    -------
    Motion

    Raises
    ------
    ValueError
        If the trace has no event and no sample.
    """
    samples, events = trace.samples, trace.events
    time = np.concatenate([samples["time_s"], events["time_s"]])
    if not len(time):
        raise ValueError("the trace is empty: there is nothing to draw")
    # events come before samples of the same instant
    rank = np.concatenate([np.ones(len(samples), int), np.zeros(len(events), int)])
    order = np.lexsort((rank, time))
    kind = np.concatenate([np.full(len(samples), "sample"), _names(events["kind"], _KINDS)])[order]

    def both(name: str) -> NDArray[np.float64]:
        return np.concatenate([samples[name], events[name]])[order]

    return Motion(
        time_s=time[order],
        position_m=both("position_m"),
        velocity_m_s=both("velocity_m_s"),
        axis=both("axis"),
        spin_rad_s=both("spin_rad_s"),
        mode=_modes(kind),
        kind=kind,
        radius_m=float(trace.scene["radius_m"]),
        height_m=float(trace.scene["height_m"]),
        rims_m=trace.rims_m,
        outcome=str(trace.outcome),
    )


def _names(values: NDArray[Any], names: NDArray[np.str_]) -> NDArray[np.str_]:
    """Convert codes to names; keep names as they are."""
    return names[values] if np.issubdtype(values.dtype, np.integer) else values.astype(str)


def _modes(kinds: NDArray[np.str_]) -> NDArray[np.str_]:
    """Return the mode after each event and sample, derived from the events."""
    mode, modes = "flight", []
    for kind in kinds.tolist():
        if kind in ("launched", "impact", "lift_off"):
            mode = "flight"
        mode = _MODE_AFTER.get(kind, mode)
        modes.append(mode)
    return np.array(modes)
