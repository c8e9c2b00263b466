"""Filmed drops, and reading them from text."""

import os
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coinmc import _lib
from coinmc._errors import FilmError

__all__ = ["Drop", "parse", "read"]

_LENGTHS = {None: None, "m": 1.0, "cm": 1e-2, "mm": 1e-3}
_ANGLES = {None: None, "deg": np.pi / 180, "rad": 1.0}
#: Largest accepted text, bytes; one more byte is read to detect a larger one.
_MAX_BYTES = 16 << 20


class Drop:
    """A filmed drop.

    Parameters
    ----------
    time_s : array_like, shape (n,)
        Times of the frames, s, increasing.
    x_m, z_m : array_like, shape (n,)
        Centre: horizontal position and height, m; NaN where it was not marked.
    theta_rad : array_like, shape (n,)
        Angle of the coin's axis from the vertical, rad: the axis is (sin θ, cos θ) in the plane
        (x, z). Whole turns have no effect.
    name : str, optional
        Name in messages and tables.

    Attributes
    ----------
    time_s, x_m, z_m, theta_rad : ndarray of float64, shape (n,)
        The parameters as arrays.
    used : list of str
        Columns of the file that were used; empty for a drop that was not read from text.
    """

    __slots__ = ("name", "theta_rad", "time_s", "used", "x_m", "z_m")

    def __init__(self, time_s: Any, x_m: Any, z_m: Any, theta_rad: Any, name: str = "drop") -> None:
        self.name: str = str(name)
        self.time_s: NDArray[np.float64]
        self.x_m: NDArray[np.float64]
        self.z_m: NDArray[np.float64]
        self.theta_rad: NDArray[np.float64]
        self.time_s, self.x_m, self.z_m, self.theta_rad = (
            _numbers(values) for values in (time_s, x_m, z_m, theta_rad)
        )
        self.used: list[str] = []
        lengths = {len(values) for values in (self.time_s, self.x_m, self.z_m, self.theta_rad)}
        if len(lengths) > 1:
            raise ValueError(f"columns of a drop must have equal lengths, found {sorted(lengths)}")
        # comparisons with NaN are False
        if not (np.isfinite(self.time_s).all() and (np.diff(self.time_s) > 0).all()):
            raise ValueError("times of a drop must be finite and increase from frame to frame")

    @property
    def columns(self) -> dict[str, NDArray[np.float64]]:
        """The columns by name."""
        names = ("time_s", "x_m", "z_m", "theta_rad")
        return {name: getattr(self, name) for name in names}

    @property
    def rate_hz(self) -> float:
        """Frames per second, from the median time step; 0 for fewer than two frames."""
        return float(1 / np.median(np.diff(self.time_s))) if len(self) > 1 else 0.0

    def __len__(self) -> int:
        """Return the number of frames."""
        return len(self.time_s)

    def __repr__(self) -> str:
        return f"<coinmc.film.Drop {self.name}: {len(self)} frames, {self.rate_hz:.4g}/s>"


def read(path: str | os.PathLike[str], **options: Any) -> Drop:
    """Read a drop from a text file exported by Tracker.

    Parameters
    ----------
    path : path
        The file. Delimiter, decimal mark, encoding, columns and units are detected; see
        docs/guide/film.md.
    **options
        Settings that cannot be detected, as for `parse`.

    Returns
    -------
    Drop

    Raises
    ------
    coinmc.FilmError
        If the text is invalid; the message shows every problem with its location.
    """
    path = Path(path)
    try:
        with path.open("rb") as file:
            content = file.read(_MAX_BYTES + 1)
    except FileNotFoundError as error:
        raise FilmError(f"{path}: there is no such file") from error
    except OSError as error:
        raise FilmError(f"{path}: the file cannot be read: {error.strerror}") from error
    return _drop(str(path), content, options)


def parse(text: str | bytes, *, name: str = "text", **options: Any) -> Drop:
    """Read a drop from a string.

    Parameters
    ----------
    text : str or bytes
        Text exported by Tracker.
    name : str, optional
        Name in messages.
    x, y, angle : str, optional
        Columns, such as ``"x"`` or ``"mass_A.x"``.
    ends : tuple of str, optional
        Two tracks to use instead: points of the coin on opposite sides of its centre, at equal
        distances from it.
    angle_of : {"face", "axis", "tilt"}, optional
        Meaning of the angle: ``face``, the direction of a line along the heads face (the default),
        or ``axis``, that of the axis out of it, both anticlockwise from the right; ``tilt``, the
        angle of the axis clockwise from the vertical.
    length_unit : {"m", "cm", "mm"}, optional
        Unit of lengths; by default that in the header, or metres if it has none.
    angle_unit : {"deg", "rad"}, optional
        Unit of angles; by default that in the header, or degrees if it has none.

    Returns
    -------
    Drop

    Examples
    --------
    >>> from coinmc import film
    >>> drop = film.parse("t;x;y;θ\\n0,00;0,1;0,200;90\\n0,01;0,1;;91\\n")
    >>> drop.z_m
    array([0.2, nan])
    """
    content = text.encode() if isinstance(text, str) else bytes(text)
    return _drop(name, content, options)


def _drop(name: str, content: bytes, options: dict[str, Any]) -> Drop:
    known = ("x", "y", "angle", "ends", "angle_of", "length_unit", "angle_unit")
    unknown = [option for option in options if option not in known]
    if unknown:
        raise TypeError(f"unknown option {unknown[0]}; choose from {', '.join(known)}")
    choices: dict[str, Any] = {key: options.get(key) for key in ("x", "y", "angle", "ends")}
    choices["angle_of"] = options.get("angle_of", "face")
    choices["length_m"] = _unit(_LENGTHS, options.get("length_unit"))
    choices["angle_rad"] = _unit(_ANGLES, options.get("angle_unit"))
    film = _lib.read_film(name, content, choices)
    drop = Drop(film["time_s"], *film["seen"].T, name=film["name"])
    drop.used = film["used"]
    return drop


def _unit(units: dict[str | None, float | None], name: str | None) -> float | None:
    if name not in units:
        known = ", ".join(unit for unit in units if unit)
        raise ValueError(f"unknown unit {name!r}; choose from {known}")
    return units[name]


def _numbers(values: Any) -> NDArray[np.float64]:
    array = np.asarray(values)
    if array.dtype.kind not in "fiu" or array.ndim != 1:
        raise TypeError("a column of a drop must be a 1-D array of real numbers")
    return np.ascontiguousarray(array, np.float64)
