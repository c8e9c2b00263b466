"""Basins: the face as a function of two quantities of the launch, pixel by pixel."""

from __future__ import annotations

from collections.abc import Mapping
from operator import index
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.image import AxesImage
from matplotlib.patches import Patch
from numpy.typing import NDArray

from coinmc._config import Config, ConfigLike
from coinmc._launches import as_launches, launches
from coinmc._tosses import toss
from coinmc.plot.style import FACES, LEFT, UNDECIDED, axes_for, axis_label

__all__ = ["VARIABLES", "basin", "basin_faces", "show_faces"]

# Launches computed at once: enough to keep all cores busy, in some tens of megabytes.
_BLOCK = 1 << 18
# Largest number of pixels along either side.
_MAX_SIDE = 1 << 14

#: Quantities of the launch that an axis can show: field of the launch, and its component.
VARIABLES: Mapping[str, tuple[str, int | None]] = {
    "height_m": ("position_m", 2),
    "vx_m_s": ("velocity_m_s", 0),
    "vy_m_s": ("velocity_m_s", 1),
    "vz_m_s": ("velocity_m_s", 2),
    "wx_rad_s": ("spin_rad_s", 0),
    "wy_rad_s": ("spin_rad_s", 1),
    "wz_rad_s": ("spin_rad_s", 2),
    "tilt_rad": ("axis", None),
    "tilt_deg": ("axis", None),
}


def basin_faces(
    config: ConfigLike,
    x: str,
    y: str,
    extent: tuple[float, float, float, float],
    *,
    shape: tuple[int, int] = (2048, 2048),
    launch: Any = None,
    point: int = 0,
    threads: int | None = None,
    overrides: Mapping[str, Any] | None = None,
) -> NDArray[np.uint8]:
    """Compute the face of every launch of a grid of two quantities.

    Parameters
    ----------
    config : path, Config or dict
        Coin, surface and engine, as for `coinmc.toss`.
    x, y : str
        Quantities of the axes, from `VARIABLES`: height of the centre, components of velocity
        and spin, or tilt of the heads normal from the vertical towards x.
    extent : tuple of float
        First and last value of `x`, first and last of `y`, at the outer edges of the pixels.
    shape : tuple of int
        Rows and columns.
    launch : structured array of one launch, optional
        A launch from `coinmc.launches` that gives all other quantities; by default toss 0 of the
        config.
    point : int
        Index of the point in the sweep.
    threads : int, optional
        Number of threads; by default one per core.
    overrides : mapping, optional
        Values that replace those of the config, such as ``{"coin.ratio": 1.2}``.

    Returns
    -------
    ndarray of uint8, `shape`
        Codes of `coinmc.Face`, row 0 at the first value of `y`.

    Raises
    ------
    ValueError
        If an axis, the extent or the shape is invalid.

    Examples
    --------
    >>> from coinmc import plot
    >>> faces = plot.basin_faces(
    ...     "examples/first.toml", "tilt_deg", "wy_rad_s", (0, 180, 0, 30), shape=(4, 6)
    ... )
    >>> faces.shape, faces.dtype
    ((4, 6), dtype('uint8'))
    """
    rows, across = _checked(x, y, extent, shape)
    config = Config(config, overrides)
    x_values = _centres(extent[0], extent[1], across)
    y_values = _centres(extent[2], extent[3], rows)
    base = launches(config, 1, point=point) if launch is None else as_launches(launch)
    if len(base) != 1:
        raise ValueError(f"a basin needs exactly one launch, not {len(base)}")
    at_once = max(1, _BLOCK // across)
    block = np.repeat(base, at_once * across).reshape(at_once, across)
    _set(block, x, x_values[None, :])
    faces = np.empty((rows, across), np.uint8)
    for first in range(0, rows, at_once):
        part = block[: min(at_once, rows - first)]
        _set(part, y, y_values[first : first + len(part), None])
        part_faces = toss(
            config,
            launches=part.reshape(-1),
            point=point,
            threads=threads,
            progress=False,
            faces_only=True,
        )
        faces[first : first + len(part)] = part_faces.reshape(len(part), across)
    return faces


def basin(
    config: ConfigLike,
    x: str,
    y: str,
    extent: tuple[float, float, float, float],
    *,
    shape: tuple[int, int] = (2048, 2048),
    launch: Any = None,
    point: int = 0,
    threads: int | None = None,
    overrides: Mapping[str, Any] | None = None,
    ax: Axes | None = None,
) -> tuple[AxesImage, Axes]:
    """Map the launches that end on heads, on tails and on the side.

    Every pixel is one toss, and nothing is random. If the coin bounces, the basins are very finely
    interleaved; colours mix in proportion where a pixel of the screen covers several of the map.

    Parameters
    ----------
    config, x, y, extent, shape, launch, point, threads, overrides
        As for `basin_faces`.
    ax : Axes, optional
        Axes to draw into; a new figure if absent.

    Returns
    -------
    image : AxesImage
        Its array (``image.get_array()``) holds the codes of the faces.
    ax : Axes

    Examples
    --------
    >>> from coinmc import plot
    >>> image, ax = plot.basin(
    ...     "examples/first.toml", "tilt_deg", "wy_rad_s", (0, 180, 0, 30), shape=(40, 60)
    ... )
    >>> ax.get_ylabel()
    'spin about y, rad/s'
    """
    faces = basin_faces(
        config,
        x,
        y,
        extent,
        shape=shape,
        launch=launch,
        point=point,
        threads=threads,
        overrides=overrides,
    )
    return show_faces(faces, x, y, extent, ax)


def show_faces(
    faces: NDArray[np.uint8],
    x: str,
    y: str,
    extent: tuple[float, float, float, float],
    ax: Axes | None = None,
) -> tuple[AxesImage, Axes]:
    """Draw faces computed by `basin_faces`.

    Parameters
    ----------
    faces : ndarray of uint8, (rows, columns)
        Codes of `coinmc.Face`.
    x, y, extent
        As given to `basin_faces`.
    ax : Axes, optional
        Axes to draw into; a new figure if absent.

    Returns
    -------
    image : AxesImage
    ax : Axes
    """
    ax = axes_for(ax, size=(6.4, 5.6))
    image = ax.imshow(
        faces,
        extent=extent,
        origin="lower",
        aspect="auto",
        cmap=ListedColormap([*FACES.values(), UNDECIDED, LEFT]),
        vmin=-0.5,
        vmax=4.5,
        # average colours, not codes
        interpolation_stage="rgba",
    )
    ax.set(xlabel=axis_label(x), ylabel=axis_label(y))
    ax.legend(
        handles=_key(faces),
        loc="lower center",
        bbox_to_anchor=(0.5, 1.0),
        ncols=5,
        fontsize="small",
        frameon=False,
    )
    return image, ax


def _checked(
    x: str, y: str, extent: tuple[float, float, float, float], shape: tuple[int, int]
) -> tuple[int, int]:
    for name in (x, y):
        if name not in VARIABLES:
            raise ValueError(f"unknown quantity {name!r}: use {', '.join(VARIABLES)}")
    if VARIABLES[x] == VARIABLES[y]:
        raise ValueError(f"both axes are the same quantity, {x}")
    if len(extent) != 4 or not np.isfinite(extent).all():
        raise ValueError(f"extent must be four finite numbers x0, x1, y0, y1, found {extent}")
    if extent[0] == extent[1] or extent[2] == extent[3]:
        raise ValueError(f"extent {extent} is empty")
    rows, across = (index(side) for side in shape)
    if not (1 <= rows <= _MAX_SIDE and 1 <= across <= _MAX_SIDE):
        raise ValueError(f"shape must be 1 to {_MAX_SIDE} rows and columns, found {shape}")
    return rows, across


def _centres(first: float, last: float, count: int) -> NDArray[np.float64]:
    return first + (np.arange(count) + 0.5) * ((last - first) / count)


def _set(launches: NDArray[Any], name: str, values: NDArray[np.float64]) -> None:
    """Set one quantity of all launches, with broadcasting."""
    field, component = VARIABLES[name]
    if component is not None:
        launches[field][..., component] = values
        return
    tilt = np.deg2rad(values) if name == "tilt_deg" else values
    launches["axis"][..., 0] = np.sin(tilt)
    launches["axis"][..., 1] = 0.0
    launches["axis"][..., 2] = np.cos(tilt)


def _key(faces: NDArray[np.uint8]) -> list[Patch]:
    """Make the legend: the faces that occur, with their share of the pixels."""
    counts = np.bincount(faces.ravel(), minlength=5)
    names = [*FACES, "undecided", "left"]
    colours = [*FACES.values(), UNDECIDED, LEFT]
    return [
        Patch(color=colour, label=f"{name} {100 * count / faces.size:.1f} %")
        for name, colour, count in zip(names, colours, counts, strict=True)
        if count
    ]
