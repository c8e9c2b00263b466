"""At which value of a parameter does a face have a given probability: how thick is a fair coin?"""

import html
import json
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from coinmc import _lib
from coinmc._config import ConfigLike
from coinmc._launches import natural, threads_of
from coinmc._progress import reporting
from coinmc._question import html_table, source_of

__all__ = ["Fair", "FairRoot", "fair"]


class FairRoot(NamedTuple):
    """A value at which the face has the probability asked for. Made by `fair`.

    Attributes
    ----------
    at : dict of str to float
        Values of the parameters that the config sweeps.
    value : float
        The value.
    lo, hi : float or None
        Its interval, statistical; None where it is open.
    slope, slope_error : float
        dP/d(parameter) there, and its standard error.
    reached : bool
        Whether the interval is as narrow as asked for.
    tosses : int
        Tosses of this root; 0 where closed forms or integrals give the probability.
    undecided : int
        Tosses without a face; the interval allows for any that they would have shown.
    numerical : tuple of float or None
        How far finer numerical settings of the engine move the value, with the ends of the
        interval of that shift.
    diameter_m, thickness_m : float
        The coin there, m.
    """

    at: dict[str, float]
    value: float
    lo: float | None
    hi: float | None
    slope: float
    slope_error: float
    reached: bool
    tosses: int
    undecided: int
    numerical: tuple[float, float, float] | None
    diameter_m: float
    thickness_m: float

    @property
    def half_width(self) -> float:
        """The longer arm of the interval; infinite if an end is open."""
        if self.lo is None or self.hi is None:
            return float("inf")
        return max(self.value - self.lo, self.hi - self.value)


class Fair:
    """The answer of `fair`.

    Attributes
    ----------
    roots : list of FairRoot
        The values found, by the other swept parameters and in ascending order; empty if the face
        never has that probability.
    near : list of tuple of float
        Stretches on which the probability cannot be told from the target, without a crossing seen.
    scan : dict of str to ndarray
        The coarse scan of the whole range: ``value``, ``p`` with its interval ``lo`` to ``hi``,
        and ``tosses`` (of all curves).
    assumptions : list of dict
        For everyday scenes: what each assumes (``parameter``, ``name``, ``value``, ``source``),
        from where to where it may be (``low``, ``high``), and about where the first root would
        be then (``root_at_low``, ``root_at_high``, each with ``value`` and ``half_width``).
    document : dict
        All of the answer, as ``coinmc fair --format json`` prints it.
    """

    def __init__(self, document: dict[str, Any]) -> None:
        self.document = document
        curves = document["curves"]
        self.roots: list[FairRoot] = [
            _root(curve["at"], root) for curve in curves for root in curve["roots"]
        ]
        self.near: list[tuple[float, float]] = [
            (n["from"], n["to"]) for curve in curves for n in curve["near"]
        ]
        scan = [point for curve in curves for point in curve["scan"]]
        self.scan: dict[str, NDArray[Any]] = {
            name: np.array([p[name] for p in scan]) for name in ("value", "p", "lo", "hi", "tosses")
        }
        self.assumptions: list[dict[str, Any]] = document["assumptions"]

    @property
    def parameter(self) -> str:
        """Key of the parameter."""
        return self.document["parameter"]

    @property
    def tosses(self) -> int:
        """All tosses that were made."""
        return self.document["tosses"]

    def __repr__(self) -> str:
        lines = [f"<coinmc.Fair {self._title()}>"]
        for root in self.roots:
            lines.append(f"  {_at(root)}{self._name()} = {_interval(root)}")
        if not self.roots:
            ends = (self.scan["p"].argmin(), self.scan["p"].argmax())
            least, most = (self._scanned(int(index)) for index in ends)
            lines.append(f"  none: P from {least} to {most}")
        return "\n".join(lines)

    def _scanned(self, index: int) -> str:
        p, lo, hi = (self.scan[name][index] for name in ("p", "lo", "hi"))
        return f"{p:.4f} [{lo:.4f}, {hi:.4f}]"

    def _repr_html_(self) -> str:
        heads = ["", self._name(), "interval", "dP/d", "tosses", "coin"]
        rows = [
            [
                _at(root),
                f"{root.value:.4f}",
                f"[{_end(root.lo)}, {_end(root.hi)}]",
                f"{root.slope:.3f}",
                f"{root.tosses:,}",
                f"{1e3 * root.diameter_m:.2f} × {1e3 * root.thickness_m:.2f} mm",
            ]
            for root in self.roots
        ]
        text = f"<p>{html.escape(self._title())}</p>{html_table(heads, rows)}"
        if self.assumptions:
            heads = ["assumed", "is", "may be", "answer then", "source"]
            rows = [
                [
                    a["name"],
                    f"{a['value']:g}",
                    f"{a['low']:.3g} to {a['high']:.3g}",
                    f"{a['root_at_low']['value']:.2f} to {a['root_at_high']['value']:.2f}",
                    a["source"],
                ]
                for a in self.assumptions
            ]
            text += html_table(heads, rows)
        return text

    def _name(self) -> str:
        return "H/R" if self.parameter == "coin.ratio" else self.parameter

    def _title(self) -> str:
        scene = self.document["scene"]
        where = f", scene {scene}" if scene else ""
        target = self.document["target"]
        target = "1/3" if target == 1 / 3 else f"{target:g}"
        return f"{self._name()} such that P({self.document['face']}) = {target}{where}"


def fair(
    config: ConfigLike | None = None,
    scene: str | None = None,
    *,
    parameter: str = "coin.ratio",
    between: Sequence[float] | None = None,
    face: str = "side",
    target: float = 1 / 3,
    half_width: float = 0.005,
    max_tosses: int = 10_000_000,
    numerical_tosses: int = 2048,
    assumption_tosses: int = 1024,
    diameter_m: float | None = None,
    volume_m3: float | None = None,
    threads: int | None = None,
    progress: bool | Callable[[int, int], None] | None = None,
    overrides: Mapping[str, Any] | None = None,
) -> Fair:
    """Find the value of a parameter at which a face has a given probability.

    By default: how thick is a coin that lands on its side in a third of the tosses?

    Parameters
    ----------
    config : path, dict or Config, optional
        The scene; its ratio and its ``[stop]`` have no effect.
    scene : str, optional
        Without a config: an everyday scene, by default ``"table"``. `coinmc.scenes` lists them.
    parameter : str, optional
        Key of the parameter that is varied.
    between : pair of float, optional
        Where to search; by default the natural range of the parameter, for a ratio 0.05 to 4.
    face : str, optional
        ``"heads"``, ``"tails"`` or ``"side"``.
    target : float, optional
        Its probability.
    half_width : float, optional
        Search until the interval is no wider than ± this.
    max_tosses : int, optional
        Tosses of each root at which the search stops short of that.
    numerical_tosses : int, optional
        Tosses with finer numerical settings, which show the numerical error; 0 for none.
    assumption_tosses : int, optional
        Tosses of each assumption of an everyday scene; 0 for none.
    diameter_m, volume_m3 : float, optional
        Size of the coin, whatever its ratio; at most one.
    threads : int, optional
        Number of threads.
    progress : bool or callable, optional
        Whether to show progress.
    overrides : dict, optional
        Values that replace those of the config, by dotted key.

    Returns
    -------
    Fair

    Examples
    --------
    >>> import coinmc
    >>> answer = coinmc.fair({
    ...     "surface": {"restitution": 0.5, "friction": 0.3},
    ...     "launch": {"preset": "robot"},
    ...     "engine": {"flat": {}},
    ... }, half_width=0.02)
    >>> [root] = answer.roots
    >>> 1.6 < root.lo < root.value < root.hi < 1.75
    True
    """
    if diameter_m is not None and volume_m3 is not None:
        raise ValueError("give the diameter or the volume, not both")
    source, sets = source_of(config, scene, overrides)
    asked = {
        "source": source,
        "overrides": sets,
        "parameter": parameter,
        "between": None if between is None else [float(end) for end in between],
        "face": str(face).lower(),
        "target": float(target),
        "half_width": float(half_width),
        "max_tosses": natural(max_tosses, "max_tosses"),
        "numerical_tosses": natural(numerical_tosses, "numerical_tosses"),
        "assumption_tosses": natural(assumption_tosses, "assumption_tosses"),
        "diameter_m": None if diameter_m is None else float(diameter_m),
        "volume_m3": None if volume_m3 is None else float(volume_m3),
        "threads": threads_of(threads),
    }
    with reporting(progress, "fair") as report:
        return Fair(json.loads(_lib.fair(asked, report)))


def _root(at: dict[str, float], root: Mapping[str, Any]) -> FairRoot:
    numerical = root["numerical"]
    if numerical is not None:
        numerical = (numerical["shift"], numerical["lo"], numerical["hi"])
    fields = (name for name in FairRoot._fields if name not in ("at", "numerical"))
    return FairRoot(at=at, numerical=numerical, **{name: root[name] for name in fields})


def _at(root: FairRoot) -> str:
    return "".join(f"{name} = {value:g}: " for name, value in root.at.items())


def _interval(root: FairRoot) -> str:
    return f"{root.value:.4f} [{_end(root.lo)}, {_end(root.hi)}], {root.tosses:,} tosses"


def _end(end: float | None) -> str:
    return "open" if end is None else f"{end:.4f}"
