"""Colours, markers and labels of all plots, and the axes that a plot is drawn into.

The colours are those of Okabe & Ito, which colour-blind readers can distinguish and which suit
light and dark backgrounds. Faces also differ by marker. Everything but data and text is mid-grey;
text and frames follow matplotlib's settings, so that dark styles work.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from matplotlib.axes import Axes

__all__ = [
    "CYCLE",
    "FACES",
    "FACE_MARKERS",
    "LEFT",
    "MODES",
    "NEUTRAL",
    "UNDECIDED",
    "axis_label",
    "face_list",
]

#: Colour of each face, in the order of every table.
FACES = {"heads": "#0072B2", "tails": "#D55E00", "side": "#009E73"}
#: Marker of each face, to distinguish faces without colour.
FACE_MARKERS = {"heads": "o", "tails": "s", "side": "^"}
#: Colour of tosses without a face.
UNDECIDED = "#BBBBBB"
#: Colour of tosses that left the table.
LEFT = "#CC79A7"
#: Colour of each mode of motion.
MODES = {"flight": "#56B4E9", "sticking": "#009E73", "sliding": "#E69F00", "ended": "#999999"}
#: Reference lines, bands, the ground: readable on white and on black.
NEUTRAL = "#808080"
#: Colours of curves that do not stand for a face.
CYCLE = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#999999"]
#: Markers of curves that do not stand for a face.
CYCLE_MARKERS = ["o", "s", "^", "D", "v", "P", "X"]

# Longest first: the first suffix that matches gives the unit.
_UNITS = {
    "_per_cpu_s": "1/s",
    "_per_s": "1/s",
    "_kg_m2": "kg m²",
    "_rad_s": "rad/s",
    "_m_s2": "m/s²",
    "_j_kg": "J/kg",
    "_m_s": "m/s",
    "_rad": "rad",
    "_deg": "°",
    "_kg": "kg",
    "_m2": "m²",
    "_us": "µs",
    "_m": "m",
    "_s": "s",
}
_NAMES = {
    "ratio": "H/R, height over radius",
    "restitution": "restitution e",
    "friction": "friction μ",
    "wx_rad_s": "spin about x, rad/s",
    "wy_rad_s": "spin about y, rad/s",
    "wz_rad_s": "spin about z, rad/s",
    "vx_m_s": "velocity along x, m/s",
    "vy_m_s": "velocity along y, m/s",
    "vz_m_s": "upward velocity, m/s",
    "height_m": "height of the centre, m",
    "tilt_deg": "tilt of the heads normal from the vertical, °",
    "tilt_rad": "tilt of the heads normal from the vertical, rad",
}


def axis_label(name: str) -> str:
    """Return the label of an axis: the name of the column in words, and its unit.

    Parameters
    ----------
    name : str
        Name of a column or parameter; its suffix gives the unit (``_m_s``: m/s).

    Returns
    -------
    str

    Examples
    --------
    >>> from coinmc.plot.style import axis_label
    >>> axis_label("ratio"), axis_label("rolling_friction_m"), axis_label("jams")
    ('H/R, height over radius', 'rolling friction, m', 'jams')
    """
    name = name.rpartition(".")[2]
    if name in _NAMES:
        return _NAMES[name]
    for suffix, unit in _UNITS.items():
        if name.endswith(suffix) and name != suffix.lstrip("_"):
            return f"{name.removesuffix(suffix).replace('_', ' ')}, {unit}"
    return name.replace("_", " ")


def face_list(faces: str | Iterable[str]) -> list[str]:
    """Check the names of one or more faces and return them as a list.

    Parameters
    ----------
    faces : str or iterable of str
        ``"heads"``, ``"tails"``, ``"side"``.

    Returns
    -------
    list of str

    Raises
    ------
    ValueError
        If a name is unknown, or there is none.
    """
    listed = [faces] if isinstance(faces, str) else [str(face) for face in faces]
    unknown = [face for face in listed if face not in FACES]
    if unknown or not listed:
        raise ValueError(
            f"unknown face {', '.join(unknown) or '(none given)'}: use {', '.join(FACES)}"
        )
    return listed


def axes_for(
    ax: Axes | None, *, space: bool = False, size: tuple[float, float] = (6.4, 4.2)
) -> Any:
    """Return the given axes, or those of a new figure.

    Only new figures use pyplot, so that notebooks and ``pyplot.show()`` display them.
    """
    if ax is None:
        from matplotlib import pyplot

        settings = {"projection": "3d"} if space else {}
        return pyplot.subplots(figsize=size, layout="constrained", subplot_kw=settings)[1]
    if space and ax.name != "3d":
        raise ValueError('the view in space needs 3-D axes: figure.add_subplot(projection="3d")')
    return ax
