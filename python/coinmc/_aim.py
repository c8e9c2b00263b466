"""Which launch forces a face?"""

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

__all__ = ["Aimed", "AimedLaunch", "aim"]

#: Values of a number of which no count is given.
_VALUES = 11


class AimedLaunch(NamedTuple):
    """A launch, and how likely the face is with it. Made by `aim`.

    Attributes
    ----------
    values : dict of str to float
        The numbers that are varied, by their keys.
    p, lo, hi : float
        Probability of the face and its interval.
    tosses : int
        Tosses that tell it.
    spread : float
        Times the spread of the hand; 1 for that of the config.
    """

    values: dict[str, float]
    p: float
    lo: float
    hi: float
    tosses: int
    spread: float = 1.0


class Aimed:
    """The answer of `aim`.

    Attributes
    ----------
    best, worst : AimedLaunch
        The launches with which the face is most and least likely, told by tosses that took no
        part in the choice.
    baseline : AimedLaunch
        The config's own launch.
    clumsy : list of AimedLaunch
        The best launch with more spread.
    map : dict of str to ndarray
        All launches: a column for each number that is varied, and ``p``, ``lo``, ``hi`` and
        ``tosses``.
    document : dict
        All of the answer, as ``coinmc aim --format json`` prints it.
    """

    def __init__(self, document: dict[str, Any]) -> None:
        self._picture = document.pop("picture")
        self.document = document
        self._keys = [parameter["parameter"] for parameter in document["parameters"]]
        self.best: AimedLaunch = self._launch(document["best"])
        self.worst: AimedLaunch = self._launch(document["worst"])
        self.baseline: AimedLaunch = self._launch(document["baseline"])
        self.clumsy: list[AimedLaunch] = [
            self._launch({**hand, "values": document["best"]["values"]}, hand["factor"])
            for hand in document["clumsy"]
        ]
        places = document["map"]
        self.map: dict[str, NDArray[Any]] = {
            key: np.array([place["values"][i] for place in places])
            for i, key in enumerate(self._keys)
        }
        for name in ("p", "lo", "hi", "tosses"):
            self.map[name] = np.array([place[name] for place in places])

    @property
    def face(self) -> str:
        """The face."""
        return self.document["face"]

    @property
    def tosses(self) -> int:
        """All tosses that were made."""
        return self.document["tosses"]

    def __repr__(self) -> str:
        lines = [f"<coinmc.Aimed {self._title()}>"]
        for name, launch in self._rows():
            lines.append(f"  {name}: {_values(launch)}: {_interval(launch)}")
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        heads = ["launch", *self._keys, f"P({self.face})", "interval", "tosses"]
        rows = [
            [
                name,
                *(f"{value:g}" for value in launch.values.values()),
                f"{launch.p:.4f}",
                f"[{launch.lo:.4f}, {launch.hi:.4f}]",
                f"{launch.tosses:,}",
            ]
            for name, launch in self._rows()
        ]
        return f"<p>{html.escape(self._title())}</p>{html_table(heads, rows)}{self._picture}"

    def picture(self) -> str:
        """Return a picture of the map: the text of an SVG file."""
        return self._picture

    def _launch(self, place: Mapping[str, Any], spread: float = 1.0) -> AimedLaunch:
        values = dict(zip(self._keys, place["values"], strict=True))
        return AimedLaunch(values, place["p"], place["lo"], place["hi"], place["tosses"], spread)

    def _rows(self) -> list[tuple[str, AimedLaunch]]:
        rows = [
            ("most likely", self.best),
            ("least likely", self.worst),
            ("the config's own", self.baseline),
        ]
        return rows + [
            (f"most likely, {launch.spread:g} times the spread", launch) for launch in self.clumsy
        ]

    def _title(self) -> str:
        return f"P({self.face}) over {len(self.map['p']):,} launches"


def aim(
    config: ConfigLike | None = None,
    scene: str | None = None,
    *,
    over: Mapping[str, Sequence[float]],
    face: str = "side",
    tosses: int = 256,
    final_tosses: int = 10_000,
    clumsiness: Sequence[float] = (2.0, 4.0),
    threads: int | None = None,
    progress: bool | Callable[[int, int], None] | None = None,
    overrides: Mapping[str, Any] | None = None,
) -> Aimed:
    """Find the launch that forces a face, like ``coinmc aim``.

    Parameters
    ----------
    config : path, dict or Config, optional
        The scene; its ``[stop]`` has no effect.
    scene : str, optional
        Without a config: an everyday scene, by default ``"table"``. `coinmc.scenes` lists them.
    over : dict of str to tuple of float
        One or two numbers of the launch by their keys, each with its first and its last value,
        and how many values (11 if absent).
    face : str, optional
        ``"heads"``, ``"tails"`` or ``"side"``.
    tosses : int, optional
        Tosses of every launch of the map.
    final_tosses : int, optional
        Tosses of the launches in the answer.
    clumsiness : sequence of float, optional
        Times the spread of the hand, for which the best launch is tossed too.
    threads : int, optional
        Number of threads.
    progress : bool or callable, optional
        Whether to show progress.
    overrides : dict, optional
        Values that replace those of the config, by dotted key.

    Returns
    -------
    Aimed

    Examples
    --------
    >>> import coinmc
    >>> answer = coinmc.aim({
    ...     "coin": {"ratio": 1.0},
    ...     "surface": {"restitution": 0.5, "friction": 0.3},
    ...     "launch": {"preset": "robot"},
    ...     "engine": {"flat": {}},
    ... }, over={"launch.height_m": (0.02, 0.5, 5)}, tosses=64, final_tosses=1000)
    >>> answer.worst.p < answer.best.p
    True
    >>> len(answer.map["p"])
    5
    """
    source, sets = source_of(config, scene, overrides)
    asked = {
        "source": source,
        "overrides": sets,
        "face": str(face).lower(),
        "over": [_range(key, values) for key, values in over.items()],
        "tosses": natural(tosses, "tosses"),
        "final_tosses": natural(final_tosses, "final_tosses"),
        "clumsiness": [float(factor) for factor in clumsiness],
        "threads": threads_of(threads),
    }
    with reporting(progress, "aim") as report:
        return Aimed(json.loads(_lib.aim(asked, report)))


def _range(key: str, values: Sequence[float]) -> tuple[str, float, float, int]:
    if len(values) not in (2, 3):
        raise ValueError(f"over[{key!r}] must be (first, last) or (first, last, count)")
    first, last, *count = values
    return key, float(first), float(last), natural(count[0] if count else _VALUES, "count")


def _values(launch: AimedLaunch) -> str:
    return ", ".join(f"{key} = {value:g}" for key, value in launch.values.items())


def _interval(launch: AimedLaunch) -> str:
    return f"{launch.p:.4f} [{launch.lo:.4f}, {launch.hi:.4f}], {launch.tosses:,} tosses"
