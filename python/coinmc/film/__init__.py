"""Drops on film: what Tracker exports, and laws of impact fitted to it.

A camera sees a coin fall, turn and bounce in a vertical plane, and somebody marks its centre and
its angle frame by frame. `read` reads the text that Tracker exports; `fit` finds restitution and
friction from several drops together, and says which law describes them best. Coordinates, methods
and their accuracy are in docs/guide/film.md.
"""

from coinmc.film._drop import Drop, parse, read
from coinmc.film._fit import RESIDUAL, Fit, FittedDrop, Noise, Parameter, Ranked, compare, fit

__all__ = [
    "RESIDUAL",
    "Drop",
    "Fit",
    "FittedDrop",
    "Noise",
    "Parameter",
    "Ranked",
    "compare",
    "fit",
    "parse",
    "read",
]
