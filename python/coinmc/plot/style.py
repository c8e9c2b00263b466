"""Colours, markers and labels of all plots, and the axes that a plot is drawn into.

The colours are those of Paul Tol's schemes *high contrast* and *medium contrast*: colour-blind
readers can distinguish them, and so can a print in grey, since they differ in lightness. On a dark
background their light partners take their place, which `colours` chooses. Faces also differ by
marker. Everything but data and text is mid-grey; text and frames follow matplotlib's settings.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from numpy.typing import NDArray

__all__ = [
    "CYCLE",
    "FACES",
    "FACE_MARKERS",
    "LEFT",
    "MODES",
    "NEUTRAL",
    "UNDECIDED",
    "Palette",
    "axis_label",
    "colours",
    "face_list",
    "scene_text",
]

#: Colour of each face, in the order of every table.
FACES = {"heads": "#004488", "tails": "#DDAA33", "side": "#BB5566"}
#: Marker of each face, to distinguish faces without colour.
FACE_MARKERS = {"heads": "o", "tails": "s", "side": "^"}
#: Colour of tosses without a face.
UNDECIDED = "#BBBBBB"
#: Colour of tosses that left the table.
LEFT = "#CC79A7"
#: Colour of each mode of motion.
MODES = {"flight": "#6699CC", "sticking": "#997700", "sliding": "#EE99AA", "ended": "#999999"}
#: Reference lines, bands, the ground: readable on white and on black.
NEUTRAL = "#808080"
#: Colours of curves that do not stand for a face.
CYCLE = ["#004488", "#BB5566", "#DDAA33", "#6699CC", "#994455", "#997700", "#999999"]
#: Markers of curves that do not stand for a face.
CYCLE_MARKERS = ["o", "s", "^", "D", "v", "P", "X"]

# The same on dark backgrounds.
_LIGHT = {
    "#004488": "#6699CC",
    "#DDAA33": "#EECC66",
    "#BB5566": "#EE99AA",
    "#994455": "#EE7788",
    "#997700": "#CCBB44",
}


class Palette:
    """The colours on the background of some axes. Made by `colours`.

    Attributes
    ----------
    faces, modes : dict of str to str
        Colour of each face, of each mode of motion.
    cycle : list of str
        Colours of curves that do not stand for a face.
    dark : bool
        Whether the background is dark.
    """

    def __init__(self, dark: bool) -> None:
        def on(colour: str) -> str:
            return _LIGHT.get(colour, colour) if dark else colour

        self.dark: bool = dark
        self.faces: dict[str, str] = {face: on(colour) for face, colour in FACES.items()}
        self.modes: dict[str, str] = {mode: on(colour) for mode, colour in MODES.items()}
        self.cycle: list[str] = [on(colour) for colour in CYCLE]


def colours(ax: Any) -> Palette:
    """Return the colours that are seen on the background of axes.

    Parameters
    ----------
    ax : Axes
        The axes. If they are transparent, their figure is what is behind them.

    Returns
    -------
    Palette

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> from coinmc.plot.style import colours
    >>> ax = Figure(facecolor="black").add_subplot(facecolor="black")
    >>> colours(ax).faces["heads"]
    '#6699CC'
    """
    behind = ax.get_facecolor()
    if behind[3] < 0.5:
        behind = ax.figure.get_facecolor()
    # the share of each primary in the luminance (Rec. 709), of the display's values as they are
    luminance = float(np.dot(to_rgb(behind), (0.2126, 0.7152, 0.0722)))
    return Palette(dark=luminance < 0.4)


def scene_text(table: dict[str, NDArray[Any]]) -> str:
    """Return in a line what is the same in all rows of a result: coin, surface, engine, tosses.

    Examples
    --------
    >>> import numpy as np
    >>> from coinmc.plot.style import scene_text
    >>> scene_text({"ratio": np.array([1.0, 2.0]), "radius_m": np.full(2, 0.01),
    ...             "restitution": np.full(2, 0.5), "engine": np.full(2, "flat")})
    'R = 10 mm, e = 0.5, flat'
    """

    def only(name: str) -> Any:
        values = np.unique(table[name]) if name in table else ()
        return values[0] if len(values) == 1 else None

    parts = []
    for name, symbol, scale, unit in _SCENE:
        value = only(name)
        if value is not None and value == value and (value != 0 or name in _SHOWN_AT_0):
            parts.append(f"{symbol} = {value * scale:.4g}{unit}")
    how = [only(name) for name in ("engine", "law")]
    if any(how):
        parts.append(" ".join(name for name in how if name))
    tosses = only("tosses")
    if tosses:
        parts.append(f"{tosses:,} tosses a point".replace(",", "\u202f"))
    return ", ".join(parts)


# Columns that make a scene: symbol, factor, unit.
_SCENE = (
    ("ratio", "H/R", 1, ""),
    ("radius_m", "R", 1e3, " mm"),
    ("restitution", "e", 1, ""),
    ("friction", "μ", 1, ""),
    ("rolling_friction_m", "ρ_c", 1e3, " mm"),
    ("roughness_slope", "slope", 1, ""),
    ("linear_drag_per_s", "drag", 1, "/s"),
)
_SHOWN_AT_0 = ("restitution", "friction")

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
