"""Tables for plots: named columns read from various sources."""

from __future__ import annotations

import csv
import os
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["columns", "need", "parameters", "select"]

# Columns of results before the counts that are not parameters.
_NOT_PARAMETERS = ("point",)


def columns(source: Any) -> dict[str, NDArray[Any]]:
    """Return the columns of a table, by name.

    Parameters
    ----------
    source : table
        A `coinmc.Result` or anything with a mapping ``columns``, a mapping of names to
        arrays, a structured array, the path of a CSV file, or any Arrow table (pyarrow, polars,
        pandas, …; needs pyarrow).

    Returns
    -------
    dict of str to ndarray
        Columns of equal length. Empty cells in a CSV column of numbers are NaN.

    Raises
    ------
    TypeError
        If the source is none of these.
    ValueError
        If the columns have different lengths.

    Examples
    --------
    >>> from coinmc.plot.table import columns
    >>> columns({"ratio": [0.5, 1.0], "p_side": [0.01, 0.07]})["ratio"]
    array([0.5, 1. ])
    """
    found = _columns(source)
    lengths = {len(column) for column in found.values()}
    if len(lengths) > 1:
        raise ValueError(f"columns of a table must have equal lengths, found {sorted(lengths)}")
    return found


def _columns(source: Any) -> dict[str, NDArray[Any]]:
    if isinstance(source, Mapping):
        return {str(name): np.atleast_1d(column) for name, column in source.items()}
    if isinstance(source, np.ndarray) and source.dtype.names:
        return {name: source[name] for name in source.dtype.names}
    if isinstance(source, str | os.PathLike):
        return _read_csv(source)
    held = getattr(source, "columns", None)
    if isinstance(held, Mapping):
        return {str(name): np.atleast_1d(column) for name, column in held.items()}
    if hasattr(source, "__arrow_c_stream__"):
        import pyarrow

        table = pyarrow.table(source)
        return {name: table[name].to_numpy() for name in table.column_names}
    raise TypeError(
        f"{type(source).__name__} is not a table: give a result, a mapping of names to arrays, a "
        "structured array, an Arrow table or the path of a CSV file"
    )


def _read_csv(path: str | os.PathLike[str]) -> dict[str, NDArray[Any]]:
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    if not rows:
        raise ValueError(f"{os.fspath(path)}: no header line")
    names, cells = rows[0], rows[1:]
    ragged = [number for number, row in enumerate(cells, 2) if len(row) != len(names)]
    if ragged:
        raise ValueError(f"{os.fspath(path)}: line {ragged[0]} does not have {len(names)} cells")
    return {name: _numbers([row[at] for row in cells]) for at, name in enumerate(names)}


def _numbers(cells: list[str]) -> NDArray[Any]:
    """Return numbers if all cells are numbers or empty, else text."""
    try:
        return np.array([float(cell) if cell else np.nan for cell in cells])
    except ValueError:
        return np.array(cells)


def need(table: Mapping[str, NDArray[Any]], names: Iterable[str]) -> list[NDArray[Any]]:
    """Return the columns with these names, in order.

    Raises
    ------
    ValueError
        If one is missing; the message lists the columns of the table.
    """
    names = list(names)
    missing = [name for name in names if name not in table]
    if missing:
        raise ValueError(f"the table has no column {', '.join(missing)}; it has {', '.join(table)}")
    return [table[name] for name in names]


def parameters(table: Mapping[str, NDArray[Any]]) -> list[str]:
    """Return the names of the columns of parameters: in results, those before ``engine``."""
    names = list(table)
    if "engine" in names:
        names = names[: names.index("engine")]
    return [
        name
        for name in names
        if name not in _NOT_PARAMETERS
        and not name.startswith("p_")
        and np.issubdtype(table[name].dtype, np.number)
    ]


def select(
    table: Mapping[str, NDArray[Any]], where: Mapping[str, Any] | None
) -> dict[str, NDArray[Any]]:
    """Return the rows with these values; numbers may differ by rounding.

    Raises
    ------
    ValueError
        If there is no such column, or no row with that value.
    """
    kept = dict(table)
    for name, value in (where or {}).items():
        (column,) = need(kept, [name])
        number = np.issubdtype(column.dtype, np.number)
        rows = np.isclose(column, value, rtol=1e-9, atol=0) if number else column == value
        if not rows.any():
            there = ", ".join(str(item) for item in np.unique(column)[:12])
            raise ValueError(f"no row has {name} = {value}; values: {there}")
        kept = {key: held[rows] for key, held in kept.items()}
    return kept
