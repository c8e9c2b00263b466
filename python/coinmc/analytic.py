"""Closed forms: probabilities of a cylinder that need no simulation.

All functions take numbers or arrays of any shape and broadcast them like NumPy functions; numbers
give numbers. NaN in any argument gives NaN, and so do values outside the domain of a function,
without exception or warning. `is_heads` returns booleans, and False for NaN. Ratios are H/R, height
over radius, from 0 to infinity, both included. Derivations, sources and accuracy are in
the documentation of the Rust crate coinmc-analytic, crates/coinmc-analytic/src.

Examples
--------
>>> from coinmc import analytic
>>> analytic.zone(1.5)
0.6
>>> analytic.arc([0.0, 2.0, float("nan")])
array([0. , 0.5, nan])
>>> round(analytic.fair_ratio("arc"), 4)
1.1547
"""

from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from coinmc import _lib
from coinmc._launches import plain

__all__ = [
    "RULES",
    "Faces",
    "arc",
    "bias_bound",
    "cross_section",
    "face_depth",
    "fair_ratio",
    "half_turns",
    "heads_band",
    "heads_in_window",
    "is_heads",
    "other_side",
    "precession",
    "precession_fair_ratio",
    "psi",
    "rule",
    "same_side",
    "side_depth",
    "surface_area",
    "well_depth_flat",
    "well_depth_solid",
    "zone",
    "zone_area",
]

#: Names of the rules: closed forms in the ratio alone.
RULES = ("arc", "zone", "surface-area", "cross-section", "well-depth-flat", "well-depth-solid")

#: A number for numbers, an array for arrays: as for NumPy's functions, types cannot tell which.
Real: TypeAlias = Any


class Faces(NamedTuple):
    """Probabilities of the faces, each an array as the arguments broadcast.

    Attributes
    ----------
    heads, tails, side : float or ndarray
        Each is computed directly, not as one minus the others.
    """

    heads: Real
    tails: Real
    side: Real


def arc(ratio: ArrayLike) -> Real:
    """P(side) of the arc rule, (2/π)·atan(x/2).

    Spin about a horizontal diameter, uniform landing angle, no bounce.

    Parameters
    ----------
    ratio : array_like
        H/R.
    """
    return _form("side:arc", ratio)


def zone(ratio: ArrayLike) -> Real:
    """P(side) of the zone rule, x/sqrt(x² + 4).

    Uniform orientation in space, no bounce.

    Parameters
    ----------
    ratio : array_like
        H/R.
    """
    return _form("side:zone", ratio)


def surface_area(ratio: ArrayLike) -> Real:
    """P(side) as the side's fraction of the surface area, x/(1 + x): no mechanics.

    Parameters
    ----------
    ratio : array_like
        H/R.
    """
    return _form("side:surface-area", ratio)


def cross_section(ratio: ArrayLike) -> Real:
    """P(side) as the side's fraction of the perimeter of the axial section, x/(2 + x).

    It contains no mechanics.

    Parameters
    ----------
    ratio : array_like
        H/R.
    """
    return _form("side:cross-section", ratio)


def well_depth_flat(ratio: ArrayLike) -> Real:
    """P(side) from the depths and widths of the potential energy wells, in the plane.

    Many bounces, spin about a horizontal diameter.

    Parameters
    ----------
    ratio : array_like
        H/R.
    """
    return _form("side:well-depth-flat", ratio)


def well_depth_solid(ratio: ArrayLike) -> Real:
    """P(side) from the depths and solid angles of the potential energy wells: a heuristic.

    Parameters
    ----------
    ratio : array_like
        H/R.
    """
    return _form("side:well-depth-solid", ratio)


def rule(name: str, ratio: ArrayLike) -> Faces:
    """Probabilities of all faces by a rule of `RULES`.

    Parameters
    ----------
    name : str
        The rule.
    ratio : array_like
        H/R.

    Returns
    -------
    Faces

    Raises
    ------
    ValueError
        If no rule has this name.

    Examples
    --------
    >>> from coinmc import analytic
    >>> analytic.rule("zone", 1.5)
    Faces(heads=0.2, tails=0.2, side=0.6)
    """
    name = _known(name)
    faces = _form(f"heads:{name}", ratio)
    return Faces(faces, faces, _form(f"side:{name}", ratio))


def fair_ratio(name: str, target: ArrayLike = 1 / 3) -> Real:
    """Ratio H/R at which P(side) by a rule equals a target.

    Parameters
    ----------
    name : str
        A rule of `RULES`.
    target : array_like
        The probability, from 0 to 1; 1/3 makes a three-sided coin fair.
    """
    return _form(f"fair:{_known(name)}", target)


def precession(ratio: ArrayLike, psi_rad: ArrayLike) -> Faces:
    """Probabilities of a coin that starts heads up, precesses, and does not bounce.

    Parameters
    ----------
    ratio : array_like
        H/R.
    psi_rad : array_like
        Angle between the coin's normal and its angular momentum, 0 to π, rad.

    Returns
    -------
    Faces

    Examples
    --------
    >>> from coinmc import analytic
    >>> import numpy as np
    >>> faces = analytic.precession(0.1, np.radians([90, 60]))
    >>> bool(faces.heads[1] > faces.heads[0])
    True
    """
    return Faces(
        _form("precession_heads", ratio, psi_rad),
        _form("precession_tails", ratio, psi_rad),
        _form("precession_side", ratio, psi_rad),
    )


def precession_fair_ratio(psi_rad: ArrayLike, target: ArrayLike = 1 / 3) -> Real:
    """Ratio H/R at which P(side) of a precessing coin equals a target.

    Parameters
    ----------
    psi_rad : array_like
        Angle between normal and angular momentum, above 0 and below π, rad.
    target : array_like
        The probability, from 0 to 1.
    """
    return _form("precession_fair", target, psi_rad)


def same_side(psi_rad: ArrayLike) -> Real:
    """Probability that a thin precessing coin, caught, shows the face it started with.

    Parameters
    ----------
    psi_rad : array_like
        Angle between normal and angular momentum, 0 to π, rad.
    """
    return _form("same_side", psi_rad)


def other_side(psi_rad: ArrayLike) -> Real:
    """Probability that it shows the other face, without the rounding error of 1 - `same_side`.

    Parameters
    ----------
    psi_rad : array_like
        Angle between normal and angular momentum, 0 to π, rad.
    """
    return _form("other_side", psi_rad)


def psi(p_same_side: ArrayLike) -> Real:
    """Angle ψ, rad, at which a thin coin shows the face it started with at this probability.

    Parameters
    ----------
    p_same_side : array_like
        From 1/2 to 1.
    """
    return _form("psi", p_same_side)


def side_depth(ratio: ArrayLike) -> Real:
    """Depth of the side's well of potential energy, (l - R)/R: how far the centre rises to the rim.

    Parameters
    ----------
    ratio : array_like
        H/R.
    """
    return _form("side_depth", ratio)


def face_depth(ratio: ArrayLike) -> Real:
    """Depth of a face's well of potential energy, (l - H/2)/R.

    Parameters
    ----------
    ratio : array_like
        H/R.
    """
    return _form("face_depth", ratio)


def zone_area(height_m: ArrayLike, radius_m: ArrayLike) -> Real:
    """Area, m², of the zone that the side of a coin cuts out of its circumscribed sphere.

    Parameters
    ----------
    height_m, radius_m : array_like
        H and R, m.
    """
    return _form("zone_area", height_m, radius_m)


def half_turns(
    upward_speed_m_s: ArrayLike, spin_rad_s: ArrayLike, gravity_m_s2: ArrayLike = 9.81
) -> Real:
    """Number of half turns until a coin tossed upwards is back at its initial height, 2uω/(πg).

    Parameters
    ----------
    upward_speed_m_s : array_like
        u, not negative, m/s.
    spin_rad_s : array_like
        ω about a horizontal diameter, rad/s.
    gravity_m_s2 : array_like
        g, positive, m/s².
    """
    return _form("half_turns", upward_speed_m_s, spin_rad_s, gravity_m_s2)


def is_heads(half_turns: ArrayLike) -> bool | NDArray[np.bool_]:
    """Whether a thin coin that started heads up shows heads after these half turns (Keller).

    Parameters
    ----------
    half_turns : array_like
        Number of half turns. Edges of the bands count as heads; NaN and infinity do not.
    """
    shows = _form("is_heads", half_turns)
    return bool(shows) if isinstance(shows, float) else shows != 0.0


def heads_band(
    turns: ArrayLike, upward_speed_m_s: ArrayLike, gravity_m_s2: ArrayLike = 9.81
) -> "tuple[Real, Real]":
    """Slowest and fastest spin, rad/s, that show heads after n whole turns (Keller's bands).

    Parameters
    ----------
    turns : array_like
        Number of whole turns n, 0 or more; other numbers give NaN.
    upward_speed_m_s : array_like
        u, not negative, m/s.
    gravity_m_s2 : array_like
        g, positive, m/s².
    """
    return (
        _form("band_slowest", turns, upward_speed_m_s, gravity_m_s2),
        _form("band_fastest", turns, upward_speed_m_s, gravity_m_s2),
    )


def heads_in_window(from_half_turns: ArrayLike, to_half_turns: ArrayLike) -> Real:
    """P(heads) if the number of half turns is uniformly distributed over a window.

    Parameters
    ----------
    from_half_turns, to_half_turns : array_like
        The window.
    """
    return _form("heads_in_window", from_half_turns, to_half_turns)


def bias_bound(width_half_turns: ArrayLike) -> Real:
    """Largest possible ``|P(heads) - 1/2|`` for a window of this width, ``min(1/2, 1/(2 width))``.

    Parameters
    ----------
    width_half_turns : array_like
        Width of the window of half turns, not negative.
    """
    return _form("bias_bound", width_half_turns)


def _known(name: str) -> str:
    if name not in RULES:
        raise ValueError(f"no rule is called {name!r}; there are {', '.join(RULES)}")
    return name


def _form(name: str, *arguments: ArrayLike) -> Real:
    arrays = np.broadcast_arrays(*(_real(argument) for argument in arguments))
    shape = arrays[0].shape
    out = np.empty(arrays[0].size)
    flat = [np.ascontiguousarray(array, np.float64).reshape(-1) for array in arrays]
    _lib.closed_form(name, flat, out)
    return float(out[0]) if shape == () else out.reshape(shape)


def _real(argument: ArrayLike) -> NDArray[Any]:
    array = plain(argument)
    if array.dtype.kind not in "fiub":
        raise TypeError(f"closed forms take real numbers, not {array.dtype}")
    return array
