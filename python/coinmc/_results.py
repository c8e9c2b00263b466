"""Estimates and runs: a table of all points, for anyone who takes tables."""

import html
import os
import warnings
from collections.abc import Callable, Mapping
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from coinmc import _lib
from coinmc._config import Config, ConfigLike, as_config, default_directory, plan_of
from coinmc._launches import natural, threads_of
from coinmc._progress import reporting

__all__ = ["Crossing", "Result", "estimate", "open", "run"]

#: Rows that a representation shows.
_SHOWN = 12


class Crossing(NamedTuple):
    """Where the probability of a face crosses a target. Made by `Result.fair`.

    Attributes
    ----------
    at : dict of str to float
        The other swept parameters.
    engine, law : str
        Who tossed.
    value : float
        Value of the parameter at which the interpolated curve crosses.
    lo, hi : float or None
        Interval of the value; None where it reaches beyond the sweep.
    confidence : float
        Confidence of the interval.
    rising : bool
        Whether the probability rises there.
    """

    at: dict[str, float]
    engine: str
    law: str
    value: float
    lo: float | None
    hi: float | None
    confidence: float
    rising: bool


class Result:
    """Probabilities with intervals, a row a point. Made by `run`, `estimate` and `open`.

    It is a table to anyone who speaks Arrow, without a copy: ``pyarrow.table(result)``,
    ``polars.DataFrame(result)``, ``duckdb.sql("select … from result")``;
    ``pyarrow.table(result).to_pandas()`` for pandas. Columns are described in
    docs/reference/formats.md.

    Attributes
    ----------
    config : Config
        What was run.
    path : pathlib.Path or None
        The run directory, if there is one.
    """

    def __init__(self, table: _lib.Results, config: Config, path: Path | None = None) -> None:
        self._table = table
        self.config = config
        self.path = path

    @cached_property
    def columns(self) -> dict[str, np.ndarray]:
        """Columns by name, each of shape (points,). A number that is missing is NaN."""
        columns = self._table.columns()
        # texts come as lists
        return {name: np.asarray(column) for name, column in columns.items()}

    @property
    def units(self) -> dict[str, str]:
        """Unit of every column; ``1`` for pure numbers, empty for what is no number."""
        return {name: unit for name, unit, _ in self._table.describe()}

    @property
    def descriptions(self) -> dict[str, str]:
        """What every column means."""
        return {name: text for name, _, text in self._table.describe()}

    @property
    def metadata(self) -> dict[str, str]:
        """What belongs to the whole table: ``axes``, ``config`` (the resolved config), ``format``,
        ``plan_hash``, ``program_version``.
        """
        return self._table.metadata

    @property
    def axes(self) -> list[str]:
        """Columns of the swept parameters; the first varies slowest."""
        return self._table.axes

    @property
    def tosses(self) -> int:
        """Tosses of all points."""
        return self._table.tosses

    @property
    def status(self) -> str:
        """``complete``; ``interrupted`` or ``part``: not all is counted; ``short``: all is done and
        some points had not come to the half width asked for.
        """
        return self._table.status

    def __len__(self) -> int:
        """Give the number of points."""
        return len(self._table)

    def __getitem__(self, name: str) -> np.ndarray:
        """Give a column."""
        return self.columns[name]

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        """Give the table as an Arrow stream (the Arrow PyCapsule interface)."""
        return self._table.__arrow_c_stream__(requested_schema)

    def fair(
        self, target: float = 1 / 3, face: str = "side", along: str = "coin.ratio"
    ) -> list[Crossing]:
        """Find where the probability of a face hits a target between the points of a sweep.

        Parameters
        ----------
        target : float
            The probability, between 0 and 1; 1/3 makes a three-sided coin fair.
        face : {"side", "heads", "tails"}
            Whose.
        along : str
            The parameter that is looked for: a swept one, by its key in the config or its column.

        Returns
        -------
        list of Crossing
            None, one or several for each combination of the other swept parameters. The interval
            covers the error of the points and that of the interpolation.

        Examples
        --------
        >>> import coinmc
        >>> sweep = {"from": 0.5, "to": 2, "steps": 16}
        >>> rule = {"coin": {"ratio": sweep}, "engine": {"analytic": {"rule": "arc"}}}
        >>> [crossing] = coinmc.estimate(rule).fair()
        >>> round(crossing.value, 3)
        1.155
        """
        target = float(target)
        if not 0.0 < target < 1.0:
            raise ValueError(f"a target is a probability between 0 and 1, not {target}")
        column = _column(along)
        if column not in self.axes:
            swept = ", ".join(self.axes) or "nothing"
            raise ValueError(f"{along} is not swept here; swept is {swept}")
        found = self._table.fair(target, face, column)
        return [Crossing(dict(at), *rest) for at, *rest in found]

    def sensitivity(self, parameters: "list[str] | None" = None, **options: Any) -> Any:
        """Find how strongly probabilities depend on parameters: `coinmc.sensitivity` of the config.

        Parameters
        ----------
        parameters : list of str, optional
            As for `coinmc.sensitivity`.
        **options
            Its other options.
        """
        from coinmc._sensitivity import sensitivity

        return sensitivity(self.config, parameters, **options)

    def __repr__(self) -> str:
        state = "" if self.status == "complete" else f", {self.status}"
        where = f" in {self.path}" if self.path else ""
        points = f"{len(self)} point" + ("s" if len(self) != 1 else "")
        head = f"<coinmc.Result {points}, {self.tosses:,} tosses{state}{where}>"
        rows = [self._names(), *self._rows()]
        widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
        lines = [
            "  ".join(cell.rjust(width) for cell, width in zip(row, widths, strict=True))
            for row in rows
        ]
        return "\n".join([head, *lines, *self._more()])

    def _repr_html_(self) -> str:
        def line(cells: list[str], tag: str) -> str:
            return "<tr>" + "".join(f"<{tag}>{html.escape(c)}</{tag}>" for c in cells) + "</tr>"

        body = "".join(line(row, "td") for row in self._rows())
        more = "".join(f"<p>{html.escape(text)}</p>" for text in self._more())
        return (
            f"<table><thead>{line(self._names(), 'th')}</thead><tbody>{body}</tbody></table>{more}"
        )

    def _names(self) -> list[str]:
        axes = self.axes or ["ratio"]
        return [*axes, "tosses", *(f"P({face})" for face in ("heads", "tails", "side"))]

    def _rows(self) -> list[list[str]]:
        columns = self.columns
        axes = self.axes or ["ratio"]
        rows = []
        for row in range(min(len(self), _SHOWN)):
            cells = [f"{columns[axis][row]:.6g}" for axis in axes]
            evaluations = columns["evaluations"][row]
            shown = f"{evaluations:,} evaluations" if evaluations else f"{columns['tosses'][row]:,}"
            cells.append(shown)
            for face in ("heads", "tails", "side"):
                p, lo, hi = (columns[f"p_{face}{end}"][row] for end in ("", "_lo", "_hi"))
                cells.append(f"{p:.5f}" if lo == hi else f"{p:.5f} [{lo:.5f}, {hi:.5f}]")
            rows.append(cells)
        return rows

    def _more(self) -> list[str]:
        return [f"… {len(self) - _SHOWN} more points"] if len(self) > _SHOWN else []

    def __reduce__(self):  # a result is what its directory holds
        if self.path is None:
            raise TypeError("a result without a directory cannot be pickled: take its columns")
        return open, (self.path,)


def estimate(
    config: ConfigLike,
    *,
    tosses: int | None = None,
    threads: int | None = None,
    progress: bool | Callable[[int, int], None] | None = None,
    overrides: Mapping[str, Any] | None = None,
) -> Result:
    """Estimate the probabilities of all points, in memory: nothing is written.

    Parameters
    ----------
    config : path, dict or Config
        What is tossed, and how.
    tosses : int, optional
        Tosses of each point, whatever the config says.
    threads : int, optional
        Threads that toss; without it, one a core. They change nothing but the time.
    progress : bool or callable, optional
        Whether to show progress.
    overrides : dict, optional
        Values that replace the config's, by dotted key.

    Returns
    -------
    Result
        The counts are those of ``coinmc run``, to the last toss.

    Examples
    --------
    >>> import coinmc
    >>> result = coinmc.estimate({
    ...     "coin": {"ratio": [0.5, 2.0]},
    ...     "surface": {"restitution": 0.5, "friction": 0.3},
    ...     "launch": {"preset": "robot"},
    ...     "engine": {"flat": {}},
    ... }, tosses=1000)
    >>> len(result), int(result["tosses"].sum())
    (2, 2000)
    >>> bool(result["p_side"][0] < result["p_side"][1])
    True
    """
    if tosses is not None:
        overrides = {**(overrides or {}), "stop": {"tosses": natural(tosses, "tosses")}}
    config = as_config(config, overrides)
    with reporting(progress, "estimate") as report:
        table, told = _lib.estimate(plan_of(config), threads_of(threads), report)
    _warn(told)
    return Result(table, config)


def run(
    config: ConfigLike,
    out: str | os.PathLike[str] | None = None,
    *,
    threads: int | None = None,
    progress: bool | Callable[[int, int], None] | None = None,
    overrides: Mapping[str, Any] | None = None,
) -> Result:
    """Run a config in a run directory, like ``coinmc run``.

    The same call again goes on where the last one stopped, killed or not, and gives a finished run
    at once.

    Parameters
    ----------
    config : path, dict or Config
        What is tossed, and how.
    out : path, optional
        The run directory: new, empty, or that of the same run. Without it,
        ``runs/NAME-HASH``, as on the command line.
    threads : int, optional
        Threads that toss; without it, one a core.
    progress : bool or callable, optional
        Whether to show progress.
    overrides : dict, optional
        Values that replace the config's, by dotted key.

    Returns
    -------
    Result

    Raises
    ------
    coinmc.RunError
        If the directory is another run's, or cannot be written.
    KeyboardInterrupt
        All that was counted is kept.
    """
    config = as_config(config, overrides)
    path = Path(default_directory(config) if out is None else out)
    with reporting(progress, "run") as report:
        table, told = _lib.run(plan_of(config), path, threads_of(threads), report)
    _warn(told)
    return Result(table, config, path)


def open(path: str | os.PathLike[str]) -> Result:
    """Open a run directory, of `run` or of ``coinmc run``, finished or not.

    Parameters
    ----------
    path : path
        The directory. It is only read.

    Returns
    -------
    Result
        All that is counted so far; `Result.status` says whether it is all.

    Raises
    ------
    coinmc.RunError
        If it is no run directory, or another version's.
    """
    path = Path(path)
    (plan, table), told = _lib.open(path)
    _warn(told)
    return Result(table, Config.from_toml(plan.resolved), path)


def _warn(told: list[str]) -> None:
    for text in told:
        warnings.warn(text, RuntimeWarning, stacklevel=3)


def _column(name: str) -> str:
    """Name of the column of a key: the bare key for what describes the scene."""
    if not isinstance(name, str):
        raise TypeError(f"a parameter is named by a text, not {type(name).__name__}")
    table, _, key = name.partition(".")
    return key if table in ("coin", "surface", "environment") and key else name
