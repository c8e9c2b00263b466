"""Pages that open anywhere: reports of runs, tosses in three dimensions, maps of basins."""

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from coinmc import _lib
from coinmc._config import ConfigLike, as_config, plan_of
from coinmc._launches import natural
from coinmc._results import Result
from coinmc._trace import Trace

__all__ = ["Page", "basins", "replay", "report"]

#: How every page begins, up to what made it.
_START = "<!doctype html>"
_MADE_BY = 'content="coinmc '


class Page:
    """A page in one file, which loads nothing from a network.

    Made by `report`, `replay` and `basins`. Notebooks show it in a frame.

    Attributes
    ----------
    html : str
        The document.
    height_px : int
        Height of the frame in notebooks, pixels.
    """

    def __init__(self, html: str, height_px: int) -> None:
        self.html = html
        self.height_px = height_px

    def save(self, path: str | os.PathLike[str], *, replace: bool = False) -> Path:
        """Write the page into a file.

        Parameters
        ----------
        path : path
            The file.
        replace : bool, optional
            Whether to replace an earlier page there. Anything else is never replaced.

        Returns
        -------
        pathlib.Path
            The file.

        Raises
        ------
        FileExistsError
            If there is a file that is not to be replaced.
        """
        path = Path(path)
        if replace and path.exists():
            with path.open(encoding="utf-8", errors="replace") as file:
                start = file.read(2000)
            if not (start.startswith(_START) and _MADE_BY in start):
                raise FileExistsError(f"{path} is no page of coinmc and is not replaced")
        with path.open("w" if replace else "x", encoding="utf-8") as file:
            file.write(self.html)
        return path

    def _repr_html_(self) -> str:
        return _lib.frame(self.html, self.height_px)

    def __repr__(self) -> str:
        return f"<coinmc.Page, {len(self.html) / 1000:.0f} kB: save it with .save(path)>"


def report(
    *runs: Result | str | os.PathLike[str],
    title: str | None = None,
    point: int | None = None,
    tosses: list[int] | None = None,
) -> Page:
    """Make a page of runs, like ``coinmc report``: plots, maps, tables, tosses in three dimensions.

    Parameters
    ----------
    *runs : Result or path
        Results, or run directories; several stand side by side.
    title : str, optional
        Title of the page; by default the names of the runs.
    point : int, optional
        The point whose tosses are shown; by default the one closest to P(side) = 1/3.
    tosses : list of int, optional
        The tosses that are shown; by default the first that shows each face.

    Returns
    -------
    Page

    Raises
    ------
    coinmc.RunError
        If a path is no run directory, or was written by another version.

    Examples
    --------
    >>> import coinmc
    >>> result = coinmc.estimate("examples/first.toml", tosses=1000)
    >>> page = coinmc.report(result, title="A first look")
    >>> "A first look" in page.html
    True
    """
    if not runs:
        raise ValueError("a report needs a run: give results or run directories")
    asked = [_run(run, number) for number, run in enumerate(runs)]
    chosen = [natural(toss, "toss") for toss in tosses or []]
    at = None if point is None else natural(point, "point")
    return Page(_lib.report(asked, title, at, chosen), 900)


def _run(run: Result | str | os.PathLike[str], number: int) -> tuple[str, Any, Any]:
    if not isinstance(run, Result):
        return str(run), Path(run), None
    if run.path is not None:
        return str(run.path), run.path, None
    return f"estimate {number + 1}", None, run._table


def replay(*traces: Trace) -> Page:
    """Show tosses in three dimensions, several at once: play, turn about, step through the events.

    Parameters
    ----------
    *traces : Trace
        What `coinmc.trace` returned; any number of samples will do, as the page repeats the toss.

    Returns
    -------
    Page

    Examples
    --------
    >>> import coinmc
    >>> page = coinmc.replay(coinmc.trace("examples/first.toml", 42))
    >>> page
    <coinmc.Page, ... kB: save it with .save(path)>
    """
    if not 1 <= len(traces) <= 24:
        raise ValueError(f"a page shows 1 to 24 tosses, not {len(traces)}")
    asked = []
    for trace in traces:
        config, point, toss, row = trace.source
        asked.append((plan_of(config), point, toss, row))
    return Page(_lib.toss_page(asked), 820)


def basins(
    config: ConfigLike,
    x: str,
    y: str,
    extent: tuple[float, float, float, float],
    *,
    shape: tuple[int, int] = (32, 48),
    toss: int = 0,
    point: int = 0,
    overrides: Mapping[str, Any] | None = None,
) -> Page:
    """Map the launches that end on heads, tails and the side; every pixel is a toss to watch.

    `coinmc.plot.basin` draws finer maps, as pictures.

    Parameters
    ----------
    config : path, dict or Config
        Coin, surface and engine.
    x, y : str
        Quantities of the axes, from `coinmc.plot.VARIABLES`.
    extent : tuple of float
        First and last value of `x`, first and last of `y`, at the outer edges of the pixels.
    shape : tuple of int
        Rows and columns, at most 10,000 pixels.
    toss : int, optional
        The toss whose launch gives all other quantities.
    point : int, optional
        Index of the point in the sweep.
    overrides : dict, optional
        Values that replace those of the config, by dotted key.

    Returns
    -------
    Page

    Examples
    --------
    >>> import coinmc
    >>> extent = (0, 30, 0.1, 1)
    >>> page = coinmc.basins("examples/first.toml", "wy_rad_s", "height_m", extent, shape=(4, 6))
    >>> "wy_rad_s" in page.html
    True
    """
    config = as_config(config, overrides)
    rows, columns = (natural(side, "a side of the shape") for side in shape)
    x0, x1, y0, y1 = (float(value) for value in extent)
    sides = [(x, x0, x1, columns), (y, y0, y1, rows)]
    plan = plan_of(config)
    made = _lib.map_page(plan, natural(point, "point"), natural(toss, "toss"), sides)
    return Page(made, 1100)
