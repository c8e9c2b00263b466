"""Results of estimates and runs, as tables with one row per point."""

import html
import json
import os
import warnings
from collections.abc import Callable, Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from coinmc import _lib
from coinmc._config import Config, ConfigLike, as_config, default_directory, plan_of
from coinmc._errors import ConfigError, advised
from coinmc._launches import natural, threads_of
from coinmc._progress import reporting
from coinmc._table import ArrowTable

if TYPE_CHECKING:
    import xarray as xr

    from coinmc._sensitivity import Sensitivity

__all__ = ["Crossing", "Result", "estimate", "open", "run"]

#: Number of rows shown by `repr`.
_SHOWN = 12
_FACES = ("heads", "tails", "side")
#: Columns that count undecided tosses by their reason.
_UNDECIDED = ("time_limit", "never_settles", "impact_limit", "failed")


class Crossing(NamedTuple):
    """A point at which the probability of a face crosses a target. Made by `Result.fair`.

    Attributes
    ----------
    at : dict of str to float
        Values of the other swept parameters.
    engine, law : str
        The engine and its contact law.
    value : float
        Value of the parameter at which the interpolated curve crosses the target.
    lo, hi : float or None
        Interval of the value; None where it extends beyond the sweep.
    confidence : float
        Confidence level of the interval.
    rising : bool
        Whether the probability increases there.
    """

    at: dict[str, float]
    engine: str
    law: str
    value: float
    lo: float | None
    hi: float | None
    confidence: float
    rising: bool


class Result(ArrowTable):
    """Probabilities with intervals, one row per point. Made by `run`, `estimate` and `open`.

    Libraries that support Arrow read it as a table without copying: ``pyarrow.table(result)``,
    ``polars.DataFrame(result)``, ``duckdb.sql("select … from result")``. It behaves like a dict of
    its columns, described in docs/reference/formats.md, except that its length is the number of
    points. It can be pickled: a result in a directory as the absolute path of that.

    Attributes
    ----------
    config : Config
        The config that was run.
    path : pathlib.Path or None
        The run directory, if there is one.
    """

    def __init__(
        self, table: _lib.Results, config: Config, path: Path | None = None, *, part: bool = False
    ) -> None:
        self._table = table
        self._part = part
        self.config = config
        self.path = path

    @cached_property
    def columns(self) -> dict[str, NDArray[Any]]:
        """Columns by name, each of shape (points,). Missing numbers are NaN."""
        columns = self._table.columns()
        # columns of text are lists
        return {name: np.asarray(column) for name, column in columns.items()}

    @property
    def units(self) -> dict[str, str]:
        """Unit of every column; ``1`` for dimensionless numbers, empty for text."""
        return {name: unit for name, unit, _ in self._table.describe()}

    @property
    def descriptions(self) -> dict[str, str]:
        """Description of every column."""
        return {name: text for name, _, text in self._table.describe()}

    @property
    def metadata(self) -> dict[str, str]:
        """Metadata of the table: ``axes``, ``config`` (the resolved config), ``format``,
        ``plan_hash``, ``program_version``.
        """
        return self._table.metadata

    @property
    def axes(self) -> list[str]:
        """Columns of the swept parameters; the first varies slowest."""
        return self._table.axes

    @property
    def tosses(self) -> int:
        """Total number of tosses of all points."""
        return self._table.tosses

    @property
    def status(self) -> str:
        """``complete``; ``interrupted`` if some tosses are missing; ``part`` in the directory of a
        part of a run that is split; ``short`` if the run is finished but some points did not reach
        the requested half width.
        """
        status = self._table.status
        return "part" if self._part and status == "interrupted" else status

    def __len__(self) -> int:
        """Return the number of points."""
        return len(self._table)

    @property
    def undecided(self) -> NDArray[np.uint64]:
        """Undecided tosses of each point: they have no face, and widen the intervals."""
        return sum((self.columns[name] for name in _UNDECIDED), np.zeros(len(self), np.uint64))

    def to_xarray(self) -> "xr.Dataset":
        """Return the table as an xarray Dataset, with a dimension for each axis of the sweep.

        A result without axes has the dimension ``point``. Units and descriptions are attributes of
        the variables. Needs xarray.
        """
        import xarray as xr

        columns, axes = self.columns, self.axes
        values = {axis: np.array(list(dict.fromkeys(columns[axis].tolist()))) for axis in axes}
        shape = tuple(len(value) for value in values.values())
        if not axes or int(np.prod(shape)) != len(self):
            axes, values, shape = ["point"], {"point": columns["point"]}, (len(self),)
        about = {name: (unit, text) for name, unit, text in self._table.describe()}
        variables = {}
        for name, column in columns.items():
            if name not in axes:
                unit, text = about[name]
                attributes = {"units": unit, "long_name": text}
                variables[name] = (axes, column.reshape(shape), attributes)
        coordinates = {
            axis: (axis, value, {"units": about[axis][0], "long_name": about[axis][1]})
            for axis, value in values.items()
        }
        return xr.Dataset(variables, coordinates, attrs=dict(self.metadata))

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        """Export the table as an Arrow stream (the Arrow PyCapsule interface)."""
        return self._table.__arrow_c_stream__(requested_schema)

    def fair(
        self, target: float = 1 / 3, face: str = "side", along: str = "coin.ratio"
    ) -> list[Crossing]:
        """Find where the probability of a face crosses a target between the points of a sweep.

        Parameters
        ----------
        target : float
            The probability, between 0 and 1; 1/3 makes a three-sided coin fair.
        face : {"side", "heads", "tails"}
            The face.
        along : str
            The swept parameter to solve for, by its config key or its column name.

        Returns
        -------
        list of Crossing
            Zero or more crossings for each combination of the other swept parameters. The interval
            covers the error of the points and of the interpolation.

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
            raise ValueError(f"the target must be a probability between 0 and 1, not {target}")
        column = _column(along)
        if column not in self.axes:
            swept = ", ".join(self.axes) or "nothing"
            raise ValueError(f"{along} is not swept in this result; swept: {swept}")
        crossings = self._table.fair(target, face, column)
        return [Crossing(dict(at), *fields) for at, *fields in crossings]

    def sensitivity(self, parameters: "list[str] | None" = None, **options: Any) -> "Sensitivity":
        """Compute how strongly probabilities depend on parameters, by `coinmc.sensitivity`.

        Parameters
        ----------
        parameters : list of str, optional
            As for `coinmc.sensitivity`.
        **options
            Other options of `coinmc.sensitivity`.
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
        undecided = ["undecided"] if self.undecided.any() else []
        return [*axes, "tosses", *undecided, *(f"P({face})" for face in _FACES)]

    def _rows(self) -> list[list[str]]:
        columns = self.columns
        axes = self.axes or ["ratio"]
        undecided = self.undecided
        rows = []
        for row in range(min(len(self), _SHOWN)):
            cells = [f"{columns[axis][row]:.6g}" for axis in axes]
            evaluations = columns["evaluations"][row]
            shown = f"{evaluations:,} evaluations" if evaluations else f"{columns['tosses'][row]:,}"
            cells.append(shown)
            if undecided.any():
                cells.append(f"{undecided[row]:,}")
            for face in _FACES:
                p, lo, hi = (columns[f"p_{face}{end}"][row] for end in ("", "_lo", "_hi"))
                cells.append(f"{p:.5f}" if lo == hi else f"{p:.5f} [{lo:.5f}, {hi:.5f}]")
            rows.append(cells)
        return rows

    def _more(self) -> list[str]:
        return [f"… {len(self) - _SHOWN} more points"] if len(self) > _SHOWN else []

    def __reduce__(self) -> tuple[Any, ...]:
        if self.path is not None:
            # what is there when it is unpickled: here or in another process, wherever that works
            return open, (self.path.absolute(),)
        return _unpickled, (self.config, self._table.plain())


def _unpickled(config: Config, plain: Any) -> Result:
    return Result(_lib.unpickled(plan_of(config), plain), config)


def estimate(
    config: ConfigLike,
    *,
    tosses: int | None = None,
    threads: int | None = None,
    progress: bool | Callable[[int, int], None] | None = None,
    overrides: Mapping[str, Any] | None = None,
) -> Result:
    """Estimate the probabilities of all points in memory, without writing any file.

    Parameters
    ----------
    config : path, dict or Config
        The config.
    tosses : int, optional
        Tosses per point, instead of the number in the config.
    threads : int, optional
        Number of threads; by default one per core. It does not affect the results.
    progress : bool or callable, optional
        Whether to show progress.
    overrides : dict, optional
        Values that replace those of the config, by dotted key.

    Returns
    -------
    Result
        The counts are exactly those of ``coinmc run``.

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
    try:
        config = as_config(config, overrides)
    except ConfigError as error:
        raise advised(error, {"stop": "tosses"}) from None
    with reporting(progress, "estimate") as report:
        table, messages = _lib.estimate(plan_of(config), threads_of(threads), report)
    _warn(messages)
    return _checked(Result(table, config))


def run(
    config: ConfigLike,
    out: str | os.PathLike[str] | None = None,
    *,
    executor: Any = None,
    threads: int | None = None,
    progress: bool | Callable[[int, int], None] | None = None,
    overrides: Mapping[str, Any] | None = None,
) -> Result:
    """Run a config in a run directory, like ``coinmc run``.

    Calling it again resumes an interrupted or killed run where it stopped, and returns the result
    of a finished run at once.

    Parameters
    ----------
    config : path, dict or Config
        The config.
    out : path, optional
        The run directory: new, empty, or from an earlier call with the same config. By default
        ``runs/NAME-HASH``, as on the command line.
    executor : object, optional
        Who computes the chunks: anything with ``submit(function, *arguments)``
        whose result has ``result()``, such as a ``ProcessPoolExecutor``, or a ``Client`` of
        dask.distributed. Only this process writes the directory. See docs/guide/cluster.md.
    threads : int, optional
        Number of threads; by default one per core. With an executor, that of each chunk: by
        default 1, so that workers with a thread for each core do not overload them.
    progress : bool or callable, optional
        Whether to show progress.
    overrides : dict, optional
        Values that replace those of the config, by dotted key.

    Returns
    -------
    Result

    Raises
    ------
    coinmc.RunError
        If the directory belongs to another run, or cannot be written.
    KeyboardInterrupt
        If interrupted; finished work is kept.
    """
    config = as_config(config, overrides)
    path = Path(default_directory(config) if out is None else out)
    with reporting(progress, "run") as report:
        if executor is None:
            table, messages = _lib.run(plan_of(config), path, threads_of(threads), report)
        else:
            from coinmc._executors import run_with

            table, messages = run_with(executor, threads, config, path, report)
    _warn(messages)
    return _checked(Result(table, config, path))


def open(path: str | os.PathLike[str]) -> Result:
    """Open the run directory of a finished or unfinished `run` or ``coinmc run``.

    Parameters
    ----------
    path : path
        The directory. It is not modified.

    Returns
    -------
    Result
        The counts so far; `Result.status` says whether they are complete.

    Raises
    ------
    coinmc.RunError
        If it is not a run directory, or was written by another version.
    """
    path = Path(path)
    (plan, table), messages = _lib.open(path)
    _warn(messages)
    return Result(table, Config.from_toml(plan.resolved), path, part=_holds_a_part(path))


def _holds_a_part(directory: Path) -> bool:
    """Whether a run directory, which has just been read, is that of a part of a split run."""
    manifest = json.loads((directory / "manifest.json").read_text(encoding="utf-8"))
    return manifest.get("part", "1/1") != "1/1"


def _checked(result: Result) -> Result:
    """Warn of points whose intervals are as wide as they are because of undecided tosses."""
    undecided, tosses = result.undecided, result.columns["tosses"]
    # the width that undecided tosses add, over that of a binomial interval at most
    wide = np.flatnonzero(undecided > np.sqrt(tosses))
    if len(wide):
        worst = wide[np.argmax(undecided[wide] / tosses[wide])]
        share = 100.0 * undecided[worst] / tosses[worst]
        points = f"{len(wide)} point" + ("s" if len(wide) != 1 else "")
        warnings.warn(
            f"at {points} undecided tosses widen the intervals by more than chance does: "
            f"{share:.2g} % of the tosses of point {worst} have no face; the columns "
            f"{', '.join(_UNDECIDED)} say why",
            RuntimeWarning,
            stacklevel=3,
        )
    return result


def _warn(messages: list[str]) -> None:
    for message in messages:
        warnings.warn(message, RuntimeWarning, stacklevel=3)


def _column(name: str) -> str:
    """Return the column of a config key: without its table for coin, surface and environment."""
    if not isinstance(name, str):
        raise TypeError(f"the name of a parameter must be a string, not {type(name).__name__}")
    table, _, key = name.partition(".")
    return key if table in ("coin", "surface", "environment") and key else name
