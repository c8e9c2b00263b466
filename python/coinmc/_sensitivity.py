"""How strongly probabilities depend on parameters."""

import math
import tomllib
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from coinmc import _lib
from coinmc._codes import Face
from coinmc._config import Config, ConfigLike, as_config, plan_of
from coinmc._intervals import normal_quantile
from coinmc._launches import natural, threads_of
from coinmc._progress import reporting

__all__ = ["Sensitivity", "sensitivity"]

#: Tosses compared at once.
_BLOCK = 1 << 20
_FACES = (Face.HEADS, Face.TAILS, Face.SIDE)
#: Parameters that affect no probability.
_WITHOUT_EFFECT = {"coin.mass_kg"}


class Sensitivity:
    """Derivatives of probabilities, one row per parameter. Made by `sensitivity`.

    Attributes
    ----------
    columns : dict of str to ndarray
        ``parameter`` and its ``value``; ``tosses``, the number compared; for each face
        ``d_p_<face>``, the derivative dP(face)/d ln(parameter), with its interval
        ``d_p_<face>_lo`` and ``d_p_<face>_hi``; and ``changed``, the fraction of tosses whose
        outcome changed.
    confidence : float
        Confidence level of the intervals.
    step : float
        Relative change of each parameter.
    """

    def __init__(self, rows: list[dict[str, Any]], confidence: float, step: float) -> None:
        names = rows[0] if rows else ()
        self.columns = {name: np.array([row[name] for row in rows]) for name in names}
        self.confidence = confidence
        self.step = step

    def __len__(self) -> int:
        """Return the number of parameters."""
        return len(self.columns.get("parameter", ()))

    def __getitem__(self, name: str) -> np.ndarray:
        """Return a column."""
        return self.columns[name]

    def __repr__(self) -> str:
        lines = [f"<coinmc.Sensitivity {len(self)} parameters, dP/d ln(parameter)>"]
        for row in range(len(self)):
            cells = [f"{self['parameter'][row]:<32}"]
            for face in _FACES:
                name = face.name.lower()
                value, lo, hi = (self[f"d_p_{name}{end}"][row] for end in ("", "_lo", "_hi"))
                cells.append(f"{name} {value:+.4f} [{lo:+.4f}, {hi:+.4f}]")
            lines.append("  ".join(cells))
        return "\n".join(lines)


def sensitivity(
    config: ConfigLike,
    parameters: Sequence[str] | None = None,
    *,
    tosses: int | None = None,
    step: float = 0.05,
    point: int = 0,
    confidence: float = 0.95,
    threads: int | None = None,
    progress: bool | Callable[[int, int], None] | None = None,
    overrides: Mapping[str, Any] | None = None,
) -> Sensitivity:
    """Compute how strongly probabilities depend on parameters, by paired differences.

    Each parameter is decreased and increased by half a step (by the same factor), and the same
    tosses, with the same random numbers, are computed with both values. Only the tosses whose face
    changes contribute to the difference, so its error is far smaller than that of two independent
    estimates.

    Parameters
    ----------
    config : path, dict or Config
        The config.
    parameters : list of str, optional
        Keys of non-zero numbers in the config, such as ``"surface.restitution"``; by default all
        of coin, surface, environment and launch.
    tosses : int, optional
        Tosses with each value; by default the number per point in the config.
    step : float, optional
        Ratio of the two values minus 1. The discretization error of the derivative is proportional
        to the square of the step, the statistical error to the inverse of its square root.
    point : int, optional
        Index of the point in the sweep: every swept parameter takes its value there.
    confidence : float, optional
        Confidence level of the intervals, between 0 and 1.
    threads : int, optional
        Number of threads.
    progress : bool or callable, optional
        Whether to show progress.
    overrides : dict, optional
        Values that replace those of the config, by dotted key.

    Returns
    -------
    Sensitivity

    Notes
    -----
    If b of n tosses gain the face and c lose it, the difference is d = (b - c)/n and its variance
    (b + c - (b - c)²/n)/n², as in McNemar's test of paired proportions. Undecided tosses count as
    showing no face. The interval assumes a normal distribution and is rough with fewer than about
    ten changed tosses.

    Examples
    --------
    >>> import coinmc
    >>> table = coinmc.sensitivity({
    ...     "coin": {"ratio": 1.2}, "surface": {"restitution": 0.5, "friction": 0.3},
    ...     "launch": {"preset": "robot"}, "engine": {"flat": {}},
    ... }, ["coin.ratio", "surface.friction"], tosses=20_000)
    >>> table["parameter"].tolist()
    ['coin.ratio', 'surface.friction']
    >>> bool(table["d_p_side_lo"][0] > 0)
    True
    """
    step, confidence = float(step), float(confidence)
    z = normal_quantile(confidence)
    if not 0.0 < step <= 1.0:
        raise ValueError(f"the step must be greater than 0 and at most 1, not {step}")
    if isinstance(parameters, str):
        parameters = [parameters]
    if tosses is not None:
        if natural(tosses, "tosses") == 0:
            raise ValueError("a sensitivity needs at least one toss")
        overrides = {**(overrides or {}), "stop": {"tosses": natural(tosses, "tosses")}}
    config = _at_point(as_config(config, overrides), natural(point, "point"))
    n = config.stop.tosses
    values = _numbers(config)
    names = list(values) if parameters is None else list(parameters)
    pairs = {name: _pair(config, name, values, step) for name in names}
    rows = []
    with reporting(progress, "sensitivity") as report:
        for number, (name, pair) in enumerate(pairs.items()):
            table = _cross(pair, n, threads_of(threads), report, (number, len(pairs)))
            rows.append({"parameter": name, "value": values[name], **_row(table, step, z)})
    return Sensitivity(rows, confidence, step)


def _cross(
    pair: tuple[Config, Config],
    n: int,
    threads: int | None,
    report: Callable[[int, int], None] | None,
    place: tuple[int, int],
) -> np.ndarray:
    """Count tosses by face with the smaller value (rows) and with the larger value (columns)."""
    table = np.zeros((len(Face), len(Face)), np.int64)
    number, pairs = place
    for first in range(0, n, _BLOCK):
        size = min(_BLOCK, n - first)
        faces = np.empty((2, size), np.uint8)
        for row, config in zip(faces, pair, strict=True):
            _lib.toss(plan_of(config), 0, first, None, row, None, threads, None)
        both = faces[0] * len(Face) + faces[1]
        table += np.bincount(both, minlength=table.size).reshape(table.shape)
        if report:
            report(2 * (number * n + first + size), 2 * pairs * n)
    return table


def _row(table: np.ndarray, step: float, z: float) -> dict[str, Any]:
    n = int(table.sum())
    row: dict[str, Any] = {"tosses": n, "changed": 1.0 - float(np.trace(table)) / n}
    for face in _FACES:
        stays = table[face, face]
        gains, losses = table[:, face].sum() - stays, table[face].sum() - stays
        difference = (gains - losses) / n
        error = math.sqrt(max(gains + losses - (gains - losses) ** 2 / n, 0.0)) / n
        per_log = 1.0 / math.log1p(step)
        name = f"d_p_{face.name.lower()}"
        row[name] = float(difference * per_log)
        row[f"{name}_lo"] = float((difference - z * error) * per_log)
        row[f"{name}_hi"] = float((difference + z * error) * per_log)
    return row


def _at_point(config: Config, point: int) -> Config:
    """Return the config with every swept parameter fixed at its value at a point."""
    at = config.parameters(point)
    swept = {_key(config, axis): at[axis] for axis in config.axes}
    return Config(Config.from_toml(config.resolved), swept) if swept else config


def _key(config: Config, column: str) -> str:
    """Return the config key of a column; columns of the scene lack the name of their table."""
    if "." in column:
        return column
    tables = tomllib.loads(config.resolved)
    found = (
        table for table in ("coin", "surface", "environment") if column in tables.get(table, {})
    )
    return f"{next(found, 'coin')}.{column}"


def _numbers(config: Config) -> dict[str, float]:
    """Return all non-zero numbers of the scene and the launch, by dotted key."""
    tables = tomllib.loads(config.resolved)
    found: dict[str, float] = {}
    for table in ("coin", "surface", "environment", "launch"):
        _collect(tables.get(table, {}), table, found)
    return found


def _collect(item: Any, path: str, found: dict[str, float]) -> None:
    if isinstance(item, dict):
        for key, inner in item.items():
            _collect(inner, f"{path}.{key}", found)
    elif path not in _WITHOUT_EFFECT and _is_number(item):
        found[path] = float(item)


def _is_number(item: Any) -> bool:
    return isinstance(item, (int, float)) and not isinstance(item, bool) and item != 0


def _pair(
    config: Config, name: str, values: Mapping[str, float], step: float
) -> tuple[Config, Config]:
    if name not in values:
        known = ", ".join(values)
        raise ValueError(
            f"{name} is not a number of this config that can be varied; choose from {known}"
        )
    base = Config.from_toml(config.resolved)
    root = math.sqrt(1.0 + step)
    smaller, larger = values[name] / root, values[name] * root
    return Config(base, {name: smaller}), Config(base, {name: larger})
