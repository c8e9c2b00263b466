"""Claims, public data sets and engines, each with its verdict."""

import html
import json
import os
from collections.abc import Callable, Iterable
from typing import Any

from coinmc import _lib
from coinmc._launches import natural, threads_of
from coinmc._progress import reporting
from coinmc._question import html_table

__all__ = ["Validation", "validate"]


class Validation:
    """The result of `validate`.

    Attributes
    ----------
    verdicts : dict of str to str
        ``"holds"``, ``"holds only where"``, ``"rejected"``, ``"not rejected"`` or
        ``"not validated"``, by the name of the claim or data set.
    conditions : dict of str to str
        Where a claim holds, or why it was not validated.
    p_values : dict of str to float
        The p-value of each data set that was predicted.
    not_rejected : int
        How many of these the data do not contradict, by a test at 1 %.
    rows : list of dict
        One for each claim, each number of its evidence and each of a data set: what
        ``coinmc validate --csv`` writes.
        ``pandas.DataFrame(rows)`` is a table.
    document : dict
        All of it, with the evidence, as ``coinmc validate --format json`` prints it.
    """

    def __init__(self, document: dict[str, Any], rows: list[dict[str, Any]]) -> None:
        self.document = document
        self.rows = rows
        entries = [*document["claims"], *document["sets"]]
        self.verdicts: dict[str, str] = {entry["name"]: entry["verdict"] for entry in entries}
        self.conditions: dict[str, str] = {
            entry["name"]: entry["condition"] for entry in entries if entry["condition"] is not None
        }
        self.p_values: dict[str, float] = {
            entry["name"]: entry["p_value"]
            for entry in document["sets"]
            if entry["p_value"] is not None
        }
        self.not_rejected: int = document["not_rejected"]

    def __repr__(self) -> str:
        return f"<coinmc.Validation {self._title()}>"

    def _repr_html_(self) -> str:
        rows = [
            [name, verdict, self.conditions.get(name, "")]
            for name, verdict in self.verdicts.items()
        ]
        table = html_table(["claim or data set", "verdict", "where, or why"], rows)
        return f"<p>{html.escape(self._title())}</p>{table}"

    def _title(self) -> str:
        claims, sets = len(self.document["claims"]), len(self.p_values)
        return f"{claims} claims, {self.not_rejected} of {sets} predicted data sets not rejected"


def validate(
    only: Iterable[str] = (),
    *,
    full: bool = False,
    out: str | os.PathLike[str] | None = None,
    seed: int = 1,
    threads: int | None = None,
    progress: bool | Callable[[int, int], None] | None = None,
) -> Validation:
    """Check claims, public data sets and engines, like ``coinmc validate``.

    Parameters
    ----------
    only : iterable of str, optional
        Names of claims and data sets; by default all of them.
    full : bool, optional
        Many more tosses. Give ``out``, so that it can be stopped and go on.
    out : path, optional
        Directory in which all tosses are kept; by default none.
    seed : int, optional
        Key of all random numbers.
    threads : int, optional
        Number of threads.
    progress : bool or callable, optional
        Whether to show progress.

    Returns
    -------
    Validation

    Examples
    --------
    Kerrich's 5,067 heads in 10,000 tosses do not contradict a fair coin.

    >>> import coinmc
    >>> found = coinmc.validate(["kerrich", "contact-time"])
    >>> found.verdicts["kerrich"], round(found.p_values["kerrich"], 2)
    ('not rejected', 0.18)
    >>> found.conditions["contact-time"]
    'PLA on rubber, 3 and 0.005 GPa'
    """
    if isinstance(only, str):
        raise ValueError("give the names as a list")
    asked = {
        "only": [str(name) for name in only],
        "full": bool(full),
        "seed": natural(seed, "seed"),
        "out": None if out is None else os.fspath(out),
        "threads": threads_of(threads),
    }
    with reporting(progress, "validate") as report:
        document, rows = _lib.validate(asked, report)
    return Validation(json.loads(document), json.loads(rows)["rows"])
