"""Fits of impact laws to drops."""

import warnings
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from coinmc import _lib
from coinmc._config import Config, ConfigLike, as_config, plan_of
from coinmc._launches import natural
from coinmc.film._drop import Drop

__all__ = ["RESIDUAL", "Fit", "FittedDrop", "Noise", "Parameter", "Ranked", "compare", "fit"]

#: Names of the coordinates: centre, m, and angle of the axis from the vertical, rad.
_COORDINATES = np.array(["x_m", "z_m", "theta_rad"])
#: Laws without parameters of their own.
_LAWS = ("moreau", "chatterjee-ruina")

#: A residual: index of the drop and of the frame, time as in the film (s), coordinate (``x_m``,
#: ``z_m`` or ``theta_rad``), observed value, observed minus predicted value (m or rad), and the
#: same in standard deviations.
RESIDUAL = np.dtype(
    [
        ("drop", "i8"),
        ("frame", "i8"),
        ("time_s", "f8"),
        ("coordinate", "U9"),
        ("seen", "f8"),
        ("residual", "f8"),
        ("standardised", "f8"),
    ]
)


class Parameter(NamedTuple):
    """A fitted parameter.

    Attributes
    ----------
    name : str
        ``restitution``, ``friction`` or ``floor_m``.
    value : float
        The best value.
    std_error : float or None
        Standard error by linear theory, if there is one.
    lo, hi : float or None
        Ends of the profile likelihood interval; None where it is open.
    """

    name: str
    value: float
    std_error: float | None
    lo: float | None
    hi: float | None


class Noise(NamedTuple):
    """Estimated noise of a coordinate.

    Attributes
    ----------
    coordinate : str
        ``x_m``, ``z_m`` or ``theta_rad``.
    n : int
        Number of observations.
    sigma : float
        Standard deviation, m or rad.
    correlation : float
        Correlation of the residuals of successive frames.
    """

    coordinate: str
    n: int
    sigma: float
    correlation: float


class FittedDrop(NamedTuple):
    """The fitted motion of a drop.

    Attributes
    ----------
    name : str
        Name of the drop.
    start : tuple of float
        x, x', z above the surface, z', θ, θ' at the first frame: m, m/s, rad, rad/s.
    half_width : tuple of float
        Half the width of the interval of each; NaN where the film does not determine it.
    frames, of_frames : int
        Number of frames used, and number of frames in the film.
    impacts_s : list of float
        Times of the impacts within the used frames, s since the first frame.
    """

    name: str
    start: tuple[float, ...]
    half_width: tuple[float, ...]
    frames: int
    of_frames: int
    impacts_s: list[float]


class Ranked(NamedTuple):
    """A law ranked by Akaike's and Schwarz's information criteria.

    Attributes
    ----------
    law : str
        The law.
    aic, bic : float
        The criteria; lower is better.
    delta_aic, delta_bic : float
        Differences from the lowest values. Below 2 is inconclusive, above 10 is decisive.
    weight : float
        Akaike weight: exp(-Δ/2), normalized to a sum of 1.
    """

    law: str
    aic: float
    bic: float
    delta_aic: float
    delta_bic: float
    weight: float


class Fit:
    """A law fitted to drops; of several laws the best, with the others in `all`.

    Attributes
    ----------
    law : str
        The law.
    parameters : dict of str to Parameter
        The fitted parameters.
    values : dict of str to float
        All parameters, fitted and fixed.
    noise : list of Noise
        Noise of the coordinates.
    drops : list of FittedDrop
        The drops.
    residuals : ndarray of `RESIDUAL`
        Every residual.
    remarks : list of str
        Remarks on the quality of the fit.
    n, fitted : int
        Number of observations; number of fitted parameters.
    log_likelihood, aic, bic, confidence : float
        Maximum log-likelihood, criteria, confidence level of the intervals.
    all : list of Fit
        The fits of all laws, including this one, the best by AIC first.
    """

    def __init__(self, fields: dict[str, Any]) -> None:
        self.law: str = fields["law"]
        self.parameters: dict[str, Parameter] = {
            row[0]: Parameter(*row) for row in fields["parameters"]
        }
        self.values: dict[str, float] = dict(fields["values"])
        self.noise: list[Noise] = [Noise(*row) for row in fields["noise"]]
        self.drops: list[FittedDrop] = [FittedDrop(*row) for row in fields["drops"]]
        self.residuals: NDArray[np.void] = _residuals(fields["residuals"])
        self.remarks: list[str] = fields["remarks"]
        self.n: int = fields["n"]
        self.fitted: int = fields["fitted"]
        self.log_likelihood: float = fields["log_likelihood"]
        self.aic: float = fields["aic"]
        self.bic: float = fields["bic"]
        self.confidence: float = fields["confidence"]
        self.all: list[Fit] = [self]
        self._rank = Ranked(self.law, *(fields[name] for name in Ranked._fields[1:]))

    def compare(self) -> list[Ranked]:
        """Return the laws that were fitted together, the best first."""
        return compare(self.all)

    def __repr__(self) -> str:
        lines = [f"<coinmc.film.Fit {self.law}, {len(self.drops)} drops, {self.n} points>"]
        for name, value, error, lo, hi in self.parameters.values():
            ends = ", ".join("open" if end is None else f"{end:.5g}" for end in (lo, hi))
            spread = "" if error is None else f" ± {error:.2g}"
            lines.append(f"{name} = {value:.5g}{spread}  [{ends}]")
        return "\n".join(lines + self.remarks)


def fit(
    drops: Drop | Iterable[Drop],
    coin: ConfigLike | None = None,
    *,
    ratio: float | None = None,
    radius_m: float | None = None,
    gravity_m_s2: float | None = None,
    laws: Sequence[str] | str = _LAWS,
    free: Sequence[str] | str | None = None,
    restitution: float | None = None,
    friction: float | None = None,
    floor_m: float = 0.0,
    bounces: int = 2,
    until_s: float = np.inf,
    loss: str = "square",
    confidence: float = 0.95,
) -> Fit:
    """Fit impact laws to drops and compare them.

    All drops share restitution and friction; each has its own initial state.

    Parameters
    ----------
    drops : Drop or iterable of Drop
        The films.
    coin : path, dict or Config, optional
        A config whose first point gives coin, gravity, restitution and friction.
    ratio, radius_m : float, optional
        H/R and R (m) of the coin; they override those of the config.
    gravity_m_s2 : float, optional
        Gravity, m/s²; by default that of the config, or 9.81 without a config.
    laws : list of str, optional
        Laws to fit: ``moreau``, ``chatterjee-ruina`` (by default both), and the law of the config,
        ``engine.flat.law``, with its parameters as in the config.
    free : list of str, optional
        Parameters to fit, if the law has them: ``restitution``, ``friction``, ``floor_m``; by
        default all but the height of the floor.
    restitution, friction, floor_m : float, optional
        Values of parameters that are not fitted; by default those of the config, or 0.5 and 0.3
        without a config, and 0 m.
    bounces : int, optional
        Number of bounces to use: frames count until the bounce after these.
    until_s : float, optional
        Frames later than this after the first frame, s, are not used.
    loss : {"square", "huber"}, optional
        Loss function of the residuals; ``huber`` if some points may be marked wrongly.
    confidence : float, optional
        Confidence level of the intervals.

    Returns
    -------
    Fit
        The best fit by Akaike's criterion; ``compare()`` lists the others.

    Raises
    ------
    coinmc.FilmError
        If the drops do not determine the parameters, or the fit does not converge.
    """
    drops = [drops] if isinstance(drops, Drop) else list(drops)
    if not all(isinstance(drop, Drop) for drop in drops):
        raise TypeError("drops must be coinmc.film.Drop objects, as film.read returns them")
    laws = list(dict.fromkeys([laws] if isinstance(laws, str) else laws))
    if not laws:
        raise ValueError("a fit needs a law")
    options = {
        "ratio": _number(ratio),
        "radius_m": _number(radius_m),
        "gravity_m_s2": _number(gravity_m_s2),
        "restitution": _number(restitution),
        "friction": _number(friction),
        "laws": laws,
        "free": [free] if isinstance(free, str) else free if free is None else list(free),
        "floor_m": float(floor_m),
        "bounces": natural(bounces, "bounces"),
        "until_s": float(until_s),
        "loss": loss,
        "confidence": float(confidence),
    }
    films = [
        (drop.name, drop.time_s, np.column_stack([drop.x_m, drop.z_m, drop.theta_rad]))
        for drop in drops
    ]
    config = None if coin is None else as_config(coin)
    if config is not None:
        _warn_of_other_coins(config, given=(ratio, radius_m, gravity_m_s2))
    plan = None if config is None else plan_of(config)
    fits = [Fit(fields) for fields in _lib.fit_film(films, options, plan)]
    for fit_of_law in fits:
        fit_of_law.all = fits
    return fits[0]


def _warn_of_other_coins(config: Config, given: Sequence[float | None]) -> None:
    """Warn if the config is a sweep over coins: that of the film may not be the first."""
    scenes = [config.scene(point) for point in range(len(config))]
    swept = [
        f"{name} = {first:g}"
        for name, value, first in zip(
            ("ratio", "radius_m", "gravity_m_s2"),
            given,
            (scenes[0].ratio, scenes[0].radius_m, scenes[0].gravity_m_s2),
            strict=True,
        )
        if value is None and len({getattr(scene, name) for scene in scenes}) > 1
    ]
    if swept:
        warnings.warn(
            f"the config has several coins: this fit is for the first, {', '.join(swept)}; if "
            "another was filmed, give it",
            UserWarning,
            stacklevel=3,
        )


def compare(fits: Iterable[Fit]) -> list[Ranked]:
    """Rank the fits from one call of `fit`, the best first."""
    return sorted((each._rank for each in fits), key=lambda rank: rank.aic)


def _number(value: float | None) -> float | None:
    return None if value is None else float(value)


def _residuals(columns: dict[str, NDArray[Any]]) -> NDArray[np.void]:
    residuals = np.empty(len(columns["time_s"]), RESIDUAL)
    for name in RESIDUAL.names:
        residuals[name] = _COORDINATES[columns[name]] if name == "coordinate" else columns[name]
    return residuals
