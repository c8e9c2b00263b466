"""Published data to compare with results, from the folder ``data``, with provenance."""

from __future__ import annotations

import csv
from collections.abc import Iterable
from dataclasses import dataclass
from importlib.resources import files

import numpy as np
from numpy.typing import NDArray

__all__ = ["SOURCE", "FairRatio", "fair_ratios", "provenance", "unity_table1"]

#: Source of the counts of `unity_table1`.
SOURCE = "Gaek & Sukhov, arXiv 2401.03557"


@dataclass(frozen=True)
class FairRatio:
    """A published ratio at which P(side) = 1/3.

    Attributes
    ----------
    engine : str
        The engine that computes the same kind of toss.
    ratio, half_width : float
        H/R and its published error.
    source : str
        Authors, reference and model.
    """

    engine: str
    ratio: float
    half_width: float
    source: str


def _rows(name: str) -> list[dict[str, str]]:
    text = files(__package__).joinpath("data", name).read_text(encoding="utf-8")
    return list(csv.DictReader(text.splitlines()))


def provenance() -> str:
    """Return sources, licences and columns of the data (Markdown).

    Examples
    --------
    >>> from coinmc.plot.published import provenance
    >>> "arxiv.org/abs/2401.03557" in provenance()
    True
    """
    return files(__package__).joinpath("data", "README.md").read_text(encoding="utf-8")


def unity_table1() -> dict[str, NDArray[np.float64]]:
    """Return the outcomes of the published Unity scene.

    Returns
    -------
    dict of str to ndarray
        ``ratio``, ``tosses`` and the counts ``heads``, ``tails``, ``side``, ``unidentified``.

    Examples
    --------
    >>> from coinmc.plot.published import unity_table1
    >>> table = unity_table1()
    >>> (table["side"] / table["tosses"]).round(3)
    array([0.   , 0.057, 0.449, 0.95 ])
    """
    rows = _rows("unity-table1.csv")
    table = {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}
    counts = [table[name] for name in ("heads", "tails", "side", "unidentified")]
    table["tosses"] = np.sum(counts, axis=0)
    return table


def fair_ratios(engines: Iterable[str]) -> list[FairRatio]:
    """Return the published fair ratios for the kinds of toss that these engines compute.

    Examples
    --------
    >>> from coinmc.plot.published import fair_ratios
    >>> [(fair.ratio, fair.half_width) for fair in fair_ratios(["flat"])]
    [(1.5, 0.05)]
    """
    wanted = set(engines)
    return [
        FairRatio(
            engine=row["engine"],
            ratio=float(row["fair_ratio"]),
            half_width=float(row["half_width"]),
            source=f"{row['authors']}, {row['reference']}, {row['model']}",
        )
        for row in _rows("fair-ratios.csv")
        if row["engine"] in wanted
    ]
