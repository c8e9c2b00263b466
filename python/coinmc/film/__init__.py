"""Drops on film: reading Tracker exports and fitting impact laws to them.

A camera films a coin that falls, turns and bounces in a vertical plane, and its centre and angle
are marked frame by frame. `read` reads the text that Tracker exports; `fit` estimates restitution
and friction from several drops together and compares laws of impact. Coordinates, methods and
their accuracy are in docs/guide/film.md.
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
