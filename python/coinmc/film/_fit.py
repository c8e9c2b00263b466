"""Laws of impact fitted to drops."""

from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np

from coinmc import _lib
from coinmc._config import ConfigLike, as_config, plan_of
from coinmc._launches import natural
from coinmc.film._drop import Drop

__all__ = ["RESIDUAL", "Fit", "FittedDrop", "Noise", "Parameter", "Ranked", "compare", "fit"]

#: Names of the coordinates: centre, m, and angle of the axis from the vertical, rad.
_COORDINATES = np.array(["x_m", "z_m", "theta_rad"])
#: Laws that are told by their names alone.
_LAWS = ("moreau", "chatterjee-ruina")

#: A residual: number of the drop and of the frame, time as in the film (s), coordinate (``x_m``,
#: ``z_m`` or ``theta_rad``), what was seen, seen less predicted (m or rad), the same in standard
#: deviations.
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
        Interval by the profile of the likelihood; None: open.
    """

    name: str
    value: float
    std_error: float | None
    lo: float | None
    hi: float | None


class Noise(NamedTuple):
    """Scatter of a coordinate.

    Attributes
    ----------
    coordinate : str
        ``x_m``, ``z_m`` or ``theta_rad``.
    n : int
        Points of it.
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
    """A drop as fitted.

    Attributes
    ----------
    name : str
        Its name.
    start : tuple of float
        x, x', z above the surface, z', θ, θ' at the first frame: m, m/s, rad, rad/s.
    half_width : tuple of float
        Half the width of the interval of each; NaN where the film says nothing.
    frames, of_frames : int
        Frames that count, and that there are.
    impacts_s : list of float
        Times of the impacts among them since the first frame, s.
    """

    name: str
    start: tuple[float, ...]
    half_width: tuple[float, ...]
    frames: int
    of_frames: int
    impacts_s: list[float]


class Ranked(NamedTuple):
    """One law among several, by Akaike's and Schwarz's criteria.

    Attributes
    ----------
    law : str
        The law.
    aic, bic : float
        The criteria; less is better.
    delta_aic, delta_bic : float
        By how much they exceed the least. Below 2 tells nothing, above 10 decides.
    weight : float
        Akaike weight: exp(-Δ/2), all together 1.
    """

    law: str
    aic: float
    bic: float
    delta_aic: float
    delta_bic: float
    weight: float


class Fit:
    """A law fitted to drops; with several laws, the best, and the others beside it.

    Attributes
    ----------
    law : str
        The law.
    parameters : dict of str to Parameter
        The fitted parameters.
    values : dict of str to float
        All parameters, fitted and given.
    noise : list of Noise
        Scatter of the coordinates.
    drops : list of FittedDrop
        The drops.
    residuals : ndarray of `RESIDUAL`
        Every residual.
    remarks : list of str
        What a reader ought to know.
    n, fitted : int
        Points that count; numbers that were fitted.
    log_likelihood, aic, bic, confidence : float
        Greatest log-likelihood, criteria, confidence of the intervals.
    all : list of Fit
        The fits of all laws, the best by AIC first; this one among them.
    """

    def __init__(self, told: dict[str, Any]) -> None:
        self.law: str = told["law"]
        self.parameters = {row[0]: Parameter(*row) for row in told["parameters"]}
        self.values: dict[str, float] = dict(told["values"])
        self.noise = [Noise(*row) for row in told["noise"]]
        self.drops = [FittedDrop(*row) for row in told["drops"]]
        self.residuals = _residuals(told["residuals"])
        self.remarks: list[str] = told["remarks"]
        self.n: int = told["n"]
        self.fitted: int = told["fitted"]
        self.log_likelihood: float = told["log_likelihood"]
        self.aic: float = told["aic"]
        self.bic: float = told["bic"]
        self.confidence: float = told["confidence"]
        self.all = [self]
        self._rank = Ranked(self.law, *(told[name] for name in Ranked._fields[1:]))

    def compare(self) -> list[Ranked]:
        """Compare the laws that were fitted together, the best first."""
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
    """Fit laws of impact to drops, and say which describes them best.

    All drops share restitution and friction; each has its own first state.

    Parameters
    ----------
    drops : Drop or iterable of Drop
        The films.
    coin : path, dict or Config, optional
        A config whose first point says coin, gravity, restitution and friction.
    ratio, radius_m : float, optional
        H/R and R (m) of the coin, instead of or in place of the config's.
    gravity_m_s2 : float, optional
        Gravity, m/s²; 9.81 unless a config says otherwise.
    laws : list of str, optional
        ``moreau``, ``chatterjee-ruina``; both without it. And the law of the config given,
        ``engine.flat.law``, by its name, with the config's numbers of it.
    free : list of str, optional
        Parameters to fit, as far as a law has them: ``restitution``, ``friction``, ``floor_m``;
        without it, all that are not known beforehand: all but the floor's height.
    restitution, friction, floor_m : float, optional
        Values where they are not fitted; 0.5 and 0.3 unless a config says otherwise, and 0 m.
    bounces : int, optional
        The film counts up to the bounce after this many.
    until_s : float, optional
        And no longer than this after its first frame, s.
    loss : {"square", "huber"}, optional
        What residuals cost: Huber's where points may be marked wrongly.
    confidence : float, optional
        Of the intervals.

    Returns
    -------
    Fit
        The best by Akaike's criterion; ``compare()`` shows the others.

    Raises
    ------
    coinmc.FilmError
        If the drops do not allow a fit, or none is found.
    """
    drops = [drops] if isinstance(drops, Drop) else list(drops)
    if not all(isinstance(drop, Drop) for drop in drops):
        raise TypeError("drops are coinmc.film.Drop, as film.read gives them")
    laws = list(dict.fromkeys([laws] if isinstance(laws, str) else laws))
    if not laws:
        raise ValueError("a fit needs a law")
    asked = {
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
    seen = [
        (drop.name, drop.time_s, np.column_stack([drop.x_m, drop.z_m, drop.theta_rad]))
        for drop in drops
    ]
    config = None if coin is None else plan_of(as_config(coin))
    fits = [Fit(told) for told in _lib.fit_film(seen, asked, config)]
    for made in fits:
        made.all = fits
    return fits[0]


def compare(fits: Iterable[Fit]) -> list[Ranked]:
    """Compare fits of one call of `fit`, the best first."""
    return sorted((made._rank for made in fits), key=lambda rank: rank.aic)


def _number(value: float | None) -> float | None:
    return None if value is None else float(value)


def _residuals(told: dict[str, np.ndarray]) -> np.ndarray:
    residuals = np.empty(len(told["time_s"]), RESIDUAL)
    for name in RESIDUAL.names:
        residuals[name] = _COORDINATES[told[name]] if name == "coordinate" else told[name]
    return residuals
