"""How strongly probabilities depend on parameters."""

import math
import tomllib
from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from coinmc import _lib
from coinmc._codes import Face
from coinmc._config import Config, ConfigLike, as_config, plan_of
from coinmc._errors import ConfigError
from coinmc._intervals import normal_quantile
from coinmc._launches import natural, threads_of
from coinmc._progress import reporting
from coinmc._table import ArrowTable

__all__ = ["Sensitivity", "sensitivity"]

#: Tosses compared at once.
_BLOCK = 1 << 20
_FACES = (Face.HEADS, Face.TAILS, Face.SIDE)
#: Steps to choose from, each twice the one before, and the part of the tosses that tries them out.
_STEPS = (0.025, 0.05, 0.1, 0.2, 0.4)
_PILOT = 20
_MAX_PILOT = 1 << 18
#: Parameters that affect no probability.
_WITHOUT_EFFECT = {"coin.mass_kg"}

#: By step: the smaller and the larger value of a parameter, and the configs with them.
_Pairs: TypeAlias = dict[float, tuple[tuple[float, float], tuple[Config, Config]]]


class Sensitivity(ArrowTable):
    """Derivatives of probabilities, one row per parameter. Made by `sensitivity`.

    Libraries that support Arrow read it as a table.

    Attributes
    ----------
    confidence : float
        Confidence level of the intervals.
    step : float or None
        Relative change of each parameter that was asked for.
    """

    def __init__(self, rows: list[dict[str, Any]], confidence: float, step: float | None) -> None:
        names = rows[0] if rows else ()
        self._columns = {name: np.array([row[name] for row in rows]) for name in names}
        self.confidence = confidence
        self.step = step

    @property
    def columns(self) -> dict[str, NDArray[Any]]:
        """Columns by name.

        ``parameter``, its ``value``, the ``step`` by which it was changed and the two values
        compared, ``from`` and ``to``; ``tosses``, the number compared; ``changed``, the fraction
        of them whose outcome changed; for each face ``d_p_<face>``, the derivative
        dP(face)/d ln(parameter), with its interval ``d_p_<face>_lo`` and ``d_p_<face>_hi``, and
        ``gain_<face>``: how many times more tosses independent ones would need for the same error.
        """
        return self._columns

    def __len__(self) -> int:
        """Return the number of parameters."""
        return len(self.columns.get("parameter", ()))

    def __repr__(self) -> str:
        lines = [f"<coinmc.Sensitivity {len(self)} parameters, dP/d ln(parameter)>"]
        for row in range(len(self)):
            cells = [f"{self['parameter'][row]:<32}"]
            for face in _FACES:
                name = face.name.lower()
                value, lo, hi = (self[f"d_p_{name}{end}"][row] for end in ("", "_lo", "_hi"))
                cells.append(f"{name} {value:+.4f} [{lo:+.4f}, {hi:+.4f}]")
            cells.append(f"step {self['step'][row]:g}, pairs worth {self['gain_side'][row]:.3g}×")
            lines.append("  ".join(cells))
        return "\n".join(lines)


def sensitivity(
    config: ConfigLike,
    parameters: Sequence[str] | None = None,
    *,
    tosses: int | None = None,
    step: float | None = None,
    point: int = 0,
    confidence: float = 0.95,
    threads: int | None = None,
    progress: bool | Callable[[int, int], None] | None = None,
    overrides: Mapping[str, Any] | None = None,
) -> Sensitivity:
    """Compute how strongly probabilities depend on parameters, by paired differences.

    Each parameter is decreased and increased by half a step (by the same factor), and the same
    tosses, with the same random numbers, are computed with both values; where its range ends too
    near, as at a restitution of 1, it is changed by a whole step to the other side. Only the tosses
    whose face changes contribute to the error of the difference. Where a coin bounces often nearly
    every toss changes, and pairs are worth little more than independent tosses; where it does not
    they are worth many times as much. The columns ``changed`` and ``gain_<face>`` say it.

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
        Ratio of the two values minus 1; by default it is chosen for each parameter. The bias of the
        derivative is proportional to the square of the step (to the step where the parameter is
        changed to one side only). Its statistical error falls with the step: as the inverse of the
        square root where few tosses change, as the inverse where most do. So a twentieth of the
        tosses, 2^18 at most, is made with steps from 0.025 to 0.4, and that is taken for which
        variance and squared bias, from the difference of neighbouring steps, are least together.
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
    step, confidence = None if step is None else float(step), float(confidence)
    z = normal_quantile(confidence)
    if step is not None and not 0.0 < step <= 1.0:
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
    for name in names:
        if not isinstance(name, str):
            raise TypeError(f"a parameter is named by its key, as in 'coin.ratio', not {name!r}")
    tried = _STEPS if step is None else (step,)
    ladders = {name: _pairs(config, name, values, tried) for name in names}
    threads = threads_of(threads)
    pilot = 0 if step is not None else min(max(n // _PILOT, 1), _MAX_PILOT)
    planned = 2 * sum(n + pilot * len(pairs) for pairs in ladders.values())
    rows = []
    with reporting(progress, "sensitivity") as report:
        count = _Count(planned, report)
        for name, pairs in ladders.items():
            order = _order(pairs, values[name])
            chosen = step
            if chosen is None:
                tried_out = {step: configs for step, (_, configs) in pairs.items()}
                chosen = _best_step(tried_out, order, pilot, n, threads, count)
            (smaller, larger), configs = pairs[chosen]
            row = {"parameter": name, "value": values[name], "step": chosen}
            row |= {"from": smaller, "to": larger}
            rows.append({**row, **_row(_cross(configs, n, threads, count), chosen, z)})
    return Sensitivity(rows, confidence, step)


class _Count:
    """Counts tosses and reports them."""

    def __init__(self, planned: int, report: Callable[[int, int], None] | None) -> None:
        self.done = 0
        self.planned = planned
        self.report = report

    def add(self, tosses: int) -> None:
        self.done += tosses
        if self.report:
            self.report(self.done, self.planned)


def _order(pairs: _Pairs, value: float) -> int:
    """Return the power of the step that the bias goes by: 2 around a value, 1 beside it."""
    return 1 if any(value in both for both, _ in pairs.values()) else 2


def _best_step(
    pairs: Mapping[float, tuple[Config, Config]],
    order: int,
    pilot: int,
    n: int,
    threads: int | None,
    count: _Count,
) -> float:
    """Return the step of least variance and squared bias together, for the worst face."""
    steps = list(pairs)
    tables = [_cross(pair, pilot, threads, count) for pair in pairs.values()]
    errors = np.zeros(len(steps))
    for face in _FACES:
        found = [_difference(table, face) for table in tables]
        scale = [1.0 / math.log1p(step) for step in steps]
        slope = np.array([a * b for (a, _), b in zip(found, scale, strict=True)])
        variance = np.array([(a * b) ** 2 for (_, a), b in zip(found, scale, strict=True)])
        # twice the step: four times the bias around a value, twice beside it; so slopes differ by
        # three times the bias of the shorter step, or by it. What their noise makes of it is taken
        # off
        growth = 2.0**order
        noise = variance[1:] + variance[:-1]
        squared_bias = np.maximum(np.diff(slope) ** 2 - noise, 0.0) / (growth - 1.0) ** 2
        last = growth**2 * squared_bias[-1:] if len(squared_bias) else np.zeros(1)
        face_errors = variance * pilot / n + np.append(squared_bias, last)
        errors = np.maximum(errors, face_errors)
    # without any change all are alike: the longest sees most
    return steps[len(steps) - 1 - int(np.argmin(errors[::-1]))]


def _cross(
    pair: tuple[Config, Config],
    n: int,
    threads: int | None,
    count: _Count,
) -> NDArray[np.int64]:
    """Count tosses by face with the smaller value (rows) and with the larger value (columns)."""
    table: NDArray[np.int64] = np.zeros((len(Face), len(Face)), np.int64)
    for first in range(0, n, _BLOCK):
        size = min(_BLOCK, n - first)
        faces = np.empty((2, size), np.uint8)
        for row, config in zip(faces, pair, strict=True):
            _lib.toss(plan_of(config), 0, first, None, row, threads, None)
        both = faces[0] * len(Face) + faces[1]
        table += np.bincount(both, minlength=table.size).reshape(table.shape)
        count.add(2 * size)
    return table


def _difference(table: NDArray[np.int64], face: Face) -> tuple[float, float]:
    """Return by how much the share of a face differs, and the standard error of that."""
    n = int(table.sum())
    stays = table[face, face]
    gains, losses = int(table[:, face].sum() - stays), int(table[face].sum() - stays)
    error = math.sqrt(max(gains + losses - (gains - losses) ** 2 / n, 0.0)) / n
    return (gains - losses) / n, error


def _gain(table: NDArray[np.int64], face: Face, error: float) -> float:
    """Return the variance of independent tosses over that of these."""
    n = int(table.sum())
    shares = table[:, face].sum() / n, table[face].sum() / n
    independent = sum(p * (1.0 - p) for p in shares) / n
    return float(independent / error**2) if error > 0.0 else math.inf


def _row(table: NDArray[np.int64], step: float, z: float) -> dict[str, Any]:
    n = int(table.sum())
    row: dict[str, Any] = {"tosses": n, "changed": 1.0 - float(np.trace(table)) / n}
    per_log = 1.0 / math.log1p(step)
    for face in _FACES:
        difference, error = _difference(table, face)
        name = face.name.lower()
        row[f"d_p_{name}"] = difference * per_log
        row[f"d_p_{name}_lo"] = (difference - z * error) * per_log
        row[f"d_p_{name}_hi"] = (difference + z * error) * per_log
        row[f"gain_{name}"] = _gain(table, face, error)
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


def _is_zero(config: Config, path: str) -> bool:
    item: Any = tomllib.loads(config.resolved)
    for key in path.split("."):
        item = item.get(key) if isinstance(item, dict) else None
    return item == 0 and not isinstance(item, bool)


def _is_number(item: Any) -> bool:
    return isinstance(item, (int, float)) and not isinstance(item, bool) and item != 0


def _pairs(
    config: Config, name: str, values: Mapping[str, float], steps: Sequence[float]
) -> _Pairs:
    """Return the smaller and the larger value and their configs, for each step that is allowed.

    They are around the parameter's own value, or beside it where its range ends too near.
    """
    if name not in values:
        known = ", ".join(values)
        if _is_zero(config, name):
            raise ValueError(f"{name} is 0, which no factor changes; choose from {known}")
        raise ValueError(
            f"{name} is not a number of this config that can be varied; choose from {known}"
        )
    base = Config.from_toml(config.resolved)
    value = values[name]
    refused = []
    for ladder in (
        [_around(value, step) for step in steps],
        [(value / (1.0 + step), value) for step in steps],
        [(value, value * (1.0 + step)) for step in steps],
    ):
        try:
            return _allowed(base, name, dict(zip(steps, ladder, strict=True)))
        except ConfigError as error:
            refused.append(error)
    raise refused[0]


def _around(value: float, step: float) -> tuple[float, float]:
    root = math.sqrt(1.0 + step)
    return value / root, value * root


def _allowed(base: Config, name: str, ladder: Mapping[float, tuple[float, float]]) -> _Pairs:
    """Return the configs with the two values of each step, up to the first that is not allowed."""
    pairs: _Pairs = {}
    for step, (smaller, larger) in ladder.items():
        try:
            configs = Config(base, {name: smaller}), Config(base, {name: larger})
        except ConfigError:
            if not pairs:
                raise
            # longer ones are not allowed either
            break
        pairs[step] = (smaller, larger), configs
    return pairs
