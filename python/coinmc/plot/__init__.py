"""Plots of results, tosses, films and launches, with matplotlib.

Every function draws into the axes given as ``ax``, or into a new figure, and returns the axes; save
the figure with ``ax.figure.savefig(...)``. Intervals are always drawn. A result can be a
`coinmc.Result` or any table with the same columns.

==================== ==================================================================
`probability`        P(face) against a parameter, closed forms and published data
`heat`               P(face) over two parameters, with the contour at 1/3
`ternary`            P(heads), P(tails) and P(side) in one triangle
`basin`              the face as a function of two quantities of the launch
`basin_faces`        the same as an array
`path`               a trajectory, in the plane or in space
`energy`             energy against time
`animation`          a toss as GIF or MP4
`residuals`          residuals of a fit to film
`sensitivity`        how a probability depends on parameters
`time_against_error` run time against error
==================== ==================================================================

Needs matplotlib: ``pip install coinmc[plot]``.
"""

try:
    import matplotlib  # noqa: F401
except ModuleNotFoundError as _missing:
    raise ModuleNotFoundError(
        "coinmc.plot needs matplotlib: pip install 'coinmc[plot]'", name="matplotlib"
    ) from _missing

from coinmc.plot.accuracy import time_against_error
from coinmc.plot.animation import animation
from coinmc.plot.basin import VARIABLES, basin, basin_faces
from coinmc.plot.energy import energy
from coinmc.plot.heat import heat
from coinmc.plot.path import path
from coinmc.plot.probability import probability
from coinmc.plot.residuals import residuals
from coinmc.plot.sensitivity import sensitivity
from coinmc.plot.style import FACES, MODES
from coinmc.plot.ternary import ternary

__all__ = [
    "FACES",
    "MODES",
    "VARIABLES",
    "animation",
    "basin",
    "basin_faces",
    "energy",
    "heat",
    "path",
    "probability",
    "residuals",
    "sensitivity",
    "ternary",
    "time_against_error",
]
