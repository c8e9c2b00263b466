"""Do counts of real tosses agree with a model?"""

import html
import json
import os
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coinmc import _lib
from coinmc._intervals import Estimate, _between_0_and_1
from coinmc._launches import natural
from coinmc._question import html_table
from coinmc._results import Result
from coinmc._results import open as open_run

__all__ = ["Comparison", "compare"]

_FACES = ("heads", "tails", "side")


class Comparison:
    """The answer of `compare`, the most likely point first.

    Attributes
    ----------
    counts : dict of str to int
        The counts of ``heads``, ``tails`` and ``side``.
    seen : dict of str to Estimate
        The probabilities by the counts alone, with their intervals.
    columns : dict of str to ndarray
        One entry a point: ``run``, ``point``, ``p_heads``, ``p_tails`` and ``p_side`` of the model,
        ``p_value``, the probability of counts no more probable than these if the point is right;
        ``p_value_at_best``, the same with the faces of its undecided tosses that agree best;
        ``evidence``, log10 of the Bayes factor against a coin of which nothing is known; ``share``,
        the probability of the point if one of them is right; ``tosses_to_tell``, after how many
        tosses a test at 5 % would reject it in 80 % of experiments if the first point is right (for
        that one, if the shares counted are), NaN if never.
    parameters : list of dict
        The parameters of each point.
    document : dict
        All of the answer, as ``coinmc compare --format json`` prints it.
    """

    def __init__(self, document: dict[str, Any]) -> None:
        self.document = document
        self.counts: dict[str, int] = {face: document[face] for face in _FACES}
        n = sum(self.counts.values())
        self.seen: dict[str, Estimate] = {
            face: Estimate(at["p"], at["lo"], at["hi"], n, document["confidence"])
            for face, at in document["seen"].items()
        }
        rows = document["rows"]
        self.parameters: list[dict[str, float]] = [row["parameters"] for row in rows]
        self.columns: dict[str, NDArray[Any]] = {
            name: np.array([row[name] for row in rows]) for name in ("run", "point")
        }
        for face in _FACES:
            self.columns[f"p_{face}"] = np.array([row["model"][face]["p"] for row in rows])
        for name in ("p_value", "p_value_at_best", "evidence", "share", "tosses_to_tell"):
            # null is NaN
            self.columns[name] = np.array([row[name] for row in rows], dtype=float)

    def __repr__(self) -> str:
        return f"<coinmc.Comparison {self._title()}>"

    def _repr_html_(self) -> str:
        heads = list(self.columns)
        columns = [self.columns[name] for name in heads]
        rows = [
            [cell if isinstance(cell, str) else f"{cell:.4g}" for cell in row]
            for row in zip(*columns, strict=True)
        ]
        return f"<p>{html.escape(self._title())}</p>{html_table(heads, rows)}"

    def _title(self) -> str:
        counts = ", ".join(f"{count:,} {face}" for face, count in self.counts.items())
        best = self.columns["p_value"][0]
        return f"{counts}: {len(self.parameters)} points, the most likely has p = {best:.3g}"


def compare(
    counts: Sequence[int] | Mapping[str, int],
    *models: Result | str | os.PathLike[str],
    confidence: float = 0.95,
) -> Comparison:
    """Compare counts of real tosses with the points of results, like ``coinmc compare``.

    Parameters
    ----------
    counts : sequence or dict
        How many tosses showed heads, tails and the side.
    models : Result or path
        Results in memory, or run directories; at least one.
    confidence : float, optional
        Confidence of the intervals of the counts.

    Returns
    -------
    Comparison

    Raises
    ------
    ValueError
        If there are no tosses or more than a million, no model has tosses, or one is given twice.

    Examples
    --------
    >>> import coinmc
    >>> rule = coinmc.estimate({"coin": {"ratio": [0.5, 1.5]},
    ...                         "engine": {"analytic": {"rule": "cross-section"}}})
    >>> answer = coinmc.compare([41, 38, 21], rule)
    >>> answer.parameters[0]["ratio"], float(answer.columns["p_value"][0]) > 0.5
    (0.5, True)
    """
    if not models:
        raise ValueError("give at least one model: a result, or the directory of a run")
    if isinstance(counts, Mapping):
        unknown = set(counts) - set(_FACES)
        if unknown:
            raise ValueError(f"faces are heads, tails and side, not {', '.join(map(str, unknown))}")
        counts = [counts.get(face, 0) for face in _FACES]
    if len(counts) != len(_FACES):
        raise ValueError(f"three counts are needed: heads, tails and side, not {len(counts)}")
    three = [natural(count, face) for count, face in zip(counts, _FACES, strict=True)]
    results = []
    given: set[str | int] = set()
    for place, model in enumerate(models):
        result = model if isinstance(model, Result) else open_run(model)
        name = str(result.path) if result.path else f"result {place}"
        same = os.path.realpath(result.path) if result.path else id(result)
        if same in given:
            raise ValueError(f"{name} is given before, and would count twice")
        given.add(same)
        results.append((name, result._table))
    document = _lib.compare(three, results, _between_0_and_1(confidence))
    return Comparison(json.loads(document))
