"""Drops as they were filmed, and the texts they are read from."""

import os
from pathlib import Path
from typing import Any

import numpy as np

from coinmc import _lib
from coinmc._errors import FilmError

__all__ = ["Drop", "parse", "read"]

_LENGTHS = {None: None, "m": 1.0, "cm": 1e-2, "mm": 1e-3}
_ANGLES = {None: None, "deg": np.pi / 180, "rad": 1.0}
#: Longest text, bytes; one more is read to see that it is longer.
_MOST = 16 << 20


class Drop:
    """A drop as it was filmed.

    Parameters
    ----------
    time_s : array_like, shape (n,)
        Times of the frames, s, rising.
    x_m, z_m : array_like, shape (n,)
        Centre: horizontal position and height, m; NaN where it was not marked.
    theta_rad : array_like, shape (n,)
        Angle of the coin's axis from the vertical, rad: the axis is (sin θ, cos θ) in the plane
        (x, z). Whole turns do not matter.
    name : str, optional
        What messages and tables call it.

    Attributes
    ----------
    time_s, x_m, z_m, theta_rad : ndarray of float64, shape (n,)
        The same.
    used : list of str
        Columns of the file that were taken; empty for a drop that was not read.
    """

    __slots__ = ("name", "theta_rad", "time_s", "used", "x_m", "z_m")

    def __init__(self, time_s: Any, x_m: Any, z_m: Any, theta_rad: Any, name: str = "drop") -> None:
        self.name = str(name)
        self.time_s, self.x_m, self.z_m, self.theta_rad = (
            _numbers(values) for values in (time_s, x_m, z_m, theta_rad)
        )
        self.used: list[str] = []
        lengths = {len(values) for values in (self.time_s, self.x_m, self.z_m, self.theta_rad)}
        if len(lengths) > 1:
            raise ValueError(f"columns of a drop are equally long, found {sorted(lengths)}")
        # NaN is not above
        if not (np.isfinite(self.time_s).all() and (np.diff(self.time_s) > 0).all()):
            raise ValueError("times of a drop are finite and rise from frame to frame")

    @property
    def columns(self) -> dict[str, np.ndarray]:
        """The columns by name."""
        names = ("time_s", "x_m", "z_m", "theta_rad")
        return {name: getattr(self, name) for name in names}

    @property
    def rate_hz(self) -> float:
        """Frames a second: the median step, inverted; 0 for fewer than two frames."""
        return float(1 / np.median(np.diff(self.time_s))) if len(self) > 1 else 0.0

    def __len__(self) -> int:
        """Give the number of frames."""
        return len(self.time_s)

    def __repr__(self) -> str:
        return f"<coinmc.film.Drop {self.name}: {len(self)} frames, {self.rate_hz:.4g}/s>"


def read(path: str | os.PathLike[str], **options: Any) -> Drop:
    """Read a drop from a text that Tracker exported.

    Parameters
    ----------
    path : path
        The file. Delimiter, decimal mark, encoding, columns and units are found out; see
        docs/guide/film.md.
    **options
        What the file does not say, as for `parse`.

    Returns
    -------
    Drop

    Raises
    ------
    coinmc.FilmError
        With every problem found, each with its place and a caret under it.
    """
    path = Path(path)
    try:
        with path.open("rb") as file:
            content = file.read(_MOST + 1)
    except FileNotFoundError as error:
        raise FilmError(f"{path}: there is no such file") from error
    except OSError as error:
        raise FilmError(f"{path}: the file cannot be read: {error.strerror}") from error
    return _drop(str(path), content, options)


def parse(text: str | bytes, *, name: str = "text", **options: Any) -> Drop:
    """Read a drop from the text itself.

    Parameters
    ----------
    text : str or bytes
        What Tracker exported.
    name : str, optional
        What messages call it.
    x, y, angle : str, optional
        Columns, as ``"x"`` or ``"mass_A.x"``.
    ends : tuple of str, optional
        Two tracks instead: points of the coin on either side of its centre, equally far.
    angle_of : {"face", "axis", "tilt"}, optional
        What the angle is the direction of: a line along the heads face (the default), the axis out
        of it, both anticlockwise from the right; or that axis clockwise from the vertical.
    length_unit : {"m", "cm", "mm"}, optional
        Unit of lengths; without it that of the header, else metres.
    angle_unit : {"deg", "rad"}, optional
        Unit of angles; without it that of the header, else degrees.

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
        raise TypeError(f"no option is called {unknown[0]}; there are {', '.join(known)}")
    told: dict[str, Any] = {key: options.get(key) for key in ("x", "y", "angle", "ends")}
    told["angle_of"] = options.get("angle_of", "face")
    told["length_m"] = _unit(_LENGTHS, options.get("length_unit"))
    told["angle_rad"] = _unit(_ANGLES, options.get("angle_unit"))
    found = _lib.read_film(name, content, told)
    drop = Drop(found["time_s"], *found["seen"].T, name=found["name"])
    drop.used = found["used"]
    return drop


def _unit(units: dict[str | None, float | None], name: str | None) -> float | None:
    if name not in units:
        known = ", ".join(unit for unit in units if unit)
        raise ValueError(f"no unit is called {name!r}; there are {known}")
    return units[name]


def _numbers(values: Any) -> np.ndarray:
    array = np.asarray(values)
    if array.dtype.kind not in "fiu" or array.ndim != 1:
        raise TypeError("a column of a drop is an array of real numbers of one dimension")
    return np.ascontiguousarray(array, np.float64)
