"""This coin, this table: surfaces from measurements."""

import html
import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from coinmc import _lib
from coinmc._config import ConfigLike
from coinmc._launches import natural, threads_of
from coinmc._progress import reporting
from coinmc._question import html_table, source_of

__all__ = ["Calibration", "CalibrationModel", "calibrate"]


class CalibrationModel:
    """The probability of what was measured, as a function of the parameters of the surface.

    For samplers and optimisers: it is smooth, holds no random number, and takes many rows of
    parameters at once. `calibrate` needs no sampler.

    Parameters
    ----------
    config : path, dict or Config
        A scene and tables of measurements: docs/reference/calibrate.md.
    points, tosses : int, optional
        Surfaces, drawn from the prior, on which coins are tossed, and tosses on each.
    draws : int, optional
        Draws of the posterior of `Calibration`.
    predicted : int, optional
        Tosses of its prediction.
    threads : int, optional
        Number of threads.
    progress : bool or callable, optional
        Whether to show progress.
    overrides : dict, optional
        Values that replace those of the config, by dotted key.

    Attributes
    ----------
    parameters : list of str
        Keys of the parameters, in the order of the columns of ``theta``.
    priors : dict of str to tuple
        Lower and upper end of the central 95 % of each prior, and its source.
    measured : ndarray
        What was measured: heads, tails and side of each of the counts, then the other numbers.
    measured_names : list of str
        What these are.

    Examples
    --------
    >>> import coinmc
    >>> model = coinmc.CalibrationModel({
    ...     "coin": {"ratio": 1.2},
    ...     "surface": {"restitution": 0.5, "friction": 0.3},
    ...     "launch": {"preset": "robot"},
    ...     "engine": {"flat": {}},
    ...     "tilt": {"angle_deg": [16, 17, 18]},
    ... }, points=64, tosses=32)
    >>> model.parameters
    ['restitution', 'friction']
    >>> likely, unlikely = model.log_prob([[0.5, 0.3], [0.5, 0.4]])
    >>> bool(likely > unlikely + 20)
    True
    """

    def __init__(
        self,
        config: ConfigLike,
        *,
        points: int = 1024,
        tosses: int = 256,
        draws: int = 4000,
        predicted: int = 32_768,
        threads: int | None = None,
        progress: bool | Callable[[int, int], None] | None = None,
        overrides: Mapping[str, Any] | None = None,
    ) -> None:
        source, sets = source_of(config, None, overrides)
        asked = {
            "source": source,
            "overrides": sets,
            "folder": str(Path.cwd()),
            "points": natural(points, "points"),
            "tosses": natural(tosses, "tosses"),
            "draws": natural(draws, "draws"),
            "predicted": natural(predicted, "predicted"),
            "threads": threads_of(threads),
        }
        with reporting(progress, "calibrate") as report:
            self._model = _lib.CalibrationModel(asked, report)
        self.parameters: list[str] = self._model.parameters
        self.priors: dict[str, tuple[float, float, str]] = dict(
            zip(self.parameters, self._model.priors, strict=True)
        )
        measured, names = self._model.measured
        self.measured: NDArray[np.float64] = np.array(measured)
        self.measured_names: list[str] = names

    def log_prob(self, theta: ArrayLike) -> Any:
        """Return ln of the posterior density, but for a constant.

        Parameters
        ----------
        theta : array_like
            Parameters, or rows of them.

        Returns
        -------
        float or ndarray
            −∞ where no surface has such parameters.
        """
        return self._log("prob", theta)

    def log_prior(self, theta: ArrayLike) -> Any:
        """Return ln of the prior density, per unit of each parameter."""
        return self._log("prior", theta)

    def log_likelihood(self, theta: ArrayLike) -> Any:
        """Return ln of the probability of what was measured, but for a constant."""
        return self._log("likelihood", theta)

    def prior_transform(self, uniforms: ArrayLike) -> NDArray[np.float64]:
        """Return parameters from uniform numbers in (0, 1), for nested samplers."""
        rows, single = self._rows(uniforms)
        out = np.empty_like(rows)
        self._model.of_uniforms(rows, out)
        return out[0] if single else out

    def simulate(self, theta: ArrayLike, *, seed: int = 1) -> NDArray[np.float64]:
        """Return what could have been measured on surfaces with these parameters.

        Counts are those of real tosses, as many as were counted; other numbers have their errors.

        Parameters
        ----------
        theta : array_like
            Parameters, or rows of them.
        seed : int, optional
            The same seed gives the same.

        Returns
        -------
        ndarray
            Numbers in the order of `measured`, or rows of them.
        """
        rows, single = self._rows(theta)
        simulated = np.array(self._model.simulate(rows, natural(seed, "seed")))
        return simulated[0] if single else simulated

    def __repr__(self) -> str:
        return f"<coinmc.CalibrationModel of {', '.join(self.parameters)}>"

    def _rows(self, theta: ArrayLike) -> tuple[NDArray[np.float64], bool]:
        rows = np.ascontiguousarray(theta, dtype=np.float64)
        single = rows.ndim == 1
        rows = np.atleast_2d(rows)
        if rows.ndim != 2 or rows.shape[1] != len(self.parameters):
            raise ValueError(f"theta must have {len(self.parameters)} columns: {self.parameters}")
        return rows, single

    def _log(self, what: str, theta: ArrayLike) -> Any:
        rows, single = self._rows(theta)
        out = np.empty(len(rows))
        self._model.log(what, rows, out)
        return float(out[0]) if single else out


class Calibration:
    """The answer of `calibrate`.

    Attributes
    ----------
    model : CalibrationModel
        The likelihood.
    draws : dict of str to ndarray
        Draws of the posterior: the parameters, ``p_heads``, ``p_tails`` and ``p_side`` of the scene
        to predict, ``log_prior`` and ``log_likelihood``.
    document : dict
        All of the answer, as ``coinmc calibrate --format json`` prints it.
    """

    def __init__(self, model: CalibrationModel, calibrated: tuple[str, Any, Any]) -> None:
        document, columns, likelihoods = calibrated
        self.model = model
        self.document: dict[str, Any] = json.loads(document)
        self.draws: dict[str, NDArray[np.float64]] = {
            name: np.array(values) for name, values in columns
        }
        self._likelihoods = np.array(likelihoods)

    @property
    def parameters(self) -> dict[str, dict[str, Any]]:
        """Mean, sd, median, lo, hi, contraction and prior of each parameter."""
        return {row["name"]: row for row in self.document["parameters"]}

    @property
    def faces(self) -> dict[str, dict[str, Any]]:
        """Probability of each face, with its interval and each error apart."""
        return {row["face"]: row for row in self.document["prediction"]["faces"]}

    @property
    def fair(self) -> dict[str, Any] | None:
        """The fair ratio H/R with its interval; None if no coin is fair on this surface."""
        return self.document["fair"]

    @property
    def next(self) -> list[dict[str, Any]]:
        """Further measurements, the one that sharpens P(side) most first."""
        return self.document["next"]

    @property
    def remarks(self) -> list[str]:
        """What does not fit, and what stays open."""
        return [row["words"] for row in self.document["conflicts"]] + self.document["remarks"]

    def to_arviz_dict(self) -> dict[str, dict[str, NDArray[np.float64]]]:
        """Return the groups that ``arviz.from_dict`` takes: one chain of draws.

        They are ``posterior``, ``posterior_predictive`` (probabilities of the faces),
        ``log_likelihood`` (one variable a measurement), ``sample_stats`` (``lp``), ``prior`` and
        ``observed_data``.
        """
        names = self.model.parameters
        chain = {name: values[np.newaxis] for name, values in self.draws.items()}
        size = len(self.draws[names[0]])
        uniforms = np.random.default_rng(1).uniform(size=(size, len(names)))
        prior = self.model.prior_transform(uniforms)
        measurements = [row["name"].replace(" ", "_") for row in self.document["measurements"]]
        unique = _unique(measurements)
        return {
            "posterior": {name: chain[name] for name in names},
            "posterior_predictive": {
                name: chain[name] for name in ("p_heads", "p_tails", "p_side")
            },
            "log_likelihood": {
                name: self._likelihoods[np.newaxis, :, k] for k, name in enumerate(unique)
            },
            "sample_stats": {"lp": chain["log_prior"] + chain["log_likelihood"]},
            "prior": {name: prior[np.newaxis, :, k] for k, name in enumerate(names)},
            "observed_data": {"measured": self.model.measured},
        }

    def __repr__(self) -> str:
        side = self.faces["side"]
        return (
            f"<coinmc.Calibration P(side) = {side['p']:.3f} [{side['lo']:.3f}, {side['hi']:.3f}]>"
        )

    def _repr_html_(self) -> str:
        heads = ["", "median", "interval"]
        rows = [
            [name, f"{row['median']:.3g}", f"[{row['lo']:.3g}, {row['hi']:.3g}]"]
            for name, row in self.parameters.items()
        ]
        return f"<p>{html.escape(repr(self))}</p>{html_table(heads, rows)}"


def calibrate(
    config: ConfigLike,
    *,
    points: int = 1024,
    tosses: int = 256,
    draws: int = 4000,
    predicted: int = 32_768,
    threads: int | None = None,
    progress: bool | Callable[[int, int], None] | None = None,
    overrides: Mapping[str, Any] | None = None,
) -> Calibration:
    """Find the surface and P(face) from measurements, like ``coinmc calibrate``.

    Parameters
    ----------
    config : path, dict or Config
        A scene and tables of measurements: docs/reference/calibrate.md.
    points, tosses, draws, predicted, threads, progress, overrides
        As for `CalibrationModel`.

    Returns
    -------
    Calibration

    Examples
    --------
    >>> import coinmc
    >>> found = coinmc.calibrate({
    ...     "coin": {"ratio": 1.2},
    ...     "surface": {"restitution": 0.5, "friction": 0.3},
    ...     "launch": {"preset": "robot"},
    ...     "engine": {"flat": {}},
    ...     "tilt": {"angle_deg": [16, 17, 18]},
    ... }, points=64, tosses=64, predicted=2048)
    >>> friction = found.parameters["friction"]
    >>> friction["lo"] < 0.306 < friction["hi"]
    True
    >>> found.remarks
    ['nothing measured says much of the restitution: what is shown is its prior']
    """
    model = CalibrationModel(
        config,
        points=points,
        tosses=tosses,
        draws=draws,
        predicted=predicted,
        threads=threads,
        progress=progress,
        overrides=overrides,
    )
    with reporting(progress, "calibrate") as report:
        return Calibration(model, model._model.calibrate(report))


def _unique(names: list[str]) -> list[str]:
    """Return names of which no two are the same: a film measures two numbers."""
    seen: dict[str, int] = {}
    unique = []
    for name in names:
        seen[name] = seen.get(name, 0) + 1
        unique.append(name if seen[name] == 1 else f"{name}_{seen[name]}")
    return unique
