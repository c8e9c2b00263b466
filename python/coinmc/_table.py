"""Tables for other libraries: Arrow, pandas, polars, xarray."""

import difflib
from collections.abc import ItemsView, Iterator, KeysView, ValuesView
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from coinmc import _lib

if TYPE_CHECKING:
    import pandas as pd
    import polars as pl

__all__ = ["ArrowTable", "Described", "flattened"]

#: A column with its unit and its meaning.
Described: TypeAlias = tuple[str, str, str, NDArray[Any]]

_AXES = ("x", "y", "z")


class ArrowTable:
    """Columns that other libraries read as a table.

    Iterating gives the names of the columns, as with a dict: ``dict(table)`` holds them all.
    """

    __slots__ = ()

    @property
    def columns(self) -> dict[str, NDArray[Any]]:
        """Columns by name."""
        raise NotImplementedError

    def __getitem__(self, name: str) -> NDArray[Any]:
        """Return a column."""
        try:
            return self.columns[name]
        except KeyError:
            close = difflib.get_close_matches(str(name), self.columns, 1)
            meant = f": did you mean {close[0]!r}?" if close else ""
            raise KeyError(f"there is no column {name!r}{meant}") from None

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names of the columns."""
        return iter(self.columns)

    def __contains__(self, name: object) -> bool:
        """Whether there is a column of this name."""
        return name in self.columns

    def keys(self) -> KeysView[str]:
        """Return the names of the columns."""
        return self.columns.keys()

    def values(self) -> ValuesView[NDArray[Any]]:
        """Return the columns."""
        return self.columns.values()

    def items(self) -> ItemsView[str, NDArray[Any]]:
        """Return names and columns."""
        return self.columns.items()

    def get(self, name: str, default: Any = None) -> Any:
        """Return a column, or the default if there is none of this name."""
        return self.columns.get(name, default)

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        """Export the table as an Arrow stream (the Arrow PyCapsule interface)."""
        described = [(name, "", "", column) for name, column in self.columns.items()]
        return stream(described)

    def to_pandas(self) -> "pd.DataFrame":
        """Return the table as a pandas DataFrame. Needs pandas."""
        import pandas as pd

        return pd.DataFrame(dict(self.columns))

    def to_polars(self) -> "pl.DataFrame":
        """Return the table as a polars DataFrame. Needs polars."""
        import polars as pl

        return pl.DataFrame(self)


def stream(columns: list[Described], metadata: dict[str, str] | None = None) -> object:
    """Return columns as an Arrow stream capsule."""
    plain = [(name, unit, about, _plain(column)) for name, unit, about, column in columns]
    return _lib.arrow_stream(plain, metadata or {})


def flattened(states: NDArray[Any]) -> dict[str, NDArray[Any]]:
    """Return the fields of a structured array as columns, vectors as one column per component.

    The letter of the component comes before the unit: ``position_m`` becomes ``position_x_m``.
    """
    columns: dict[str, NDArray[Any]] = {}
    for name in states.dtype.names or ():
        field = states[name]
        if field.ndim == 1:
            columns[name] = field
            continue
        letters = _AXES if field.shape[1] == len(_AXES) else ("w", *_AXES)
        stem, _, unit = name.partition("_")
        for at, letter in enumerate(letters):
            column = f"{stem}_{letter}" + (f"_{unit}" if unit else "")
            columns[column] = field[:, at]
    return columns


def _plain(column: NDArray[Any]) -> Any:
    """Return an array of one of the types that cross over, or a list of strings."""
    if column.dtype.kind in "UO":
        return column.tolist()
    if column.dtype.kind == "i":
        column = column.astype(np.int64, copy=False)
    return np.ascontiguousarray(column)
