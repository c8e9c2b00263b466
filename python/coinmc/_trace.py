"""One toss, watched."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from coinmc import _lib
from coinmc._codes import Face
from coinmc._config import Config, ConfigLike, as_config, plan_of
from coinmc._launches import STATE, as_launches, natural, rows

__all__ = ["EVENT", "SAMPLE", "Trace", "trace"]

_KNOWN = [
    ("time_s", "f8"),
    *((name, "f8", 3) for name in STATE.names),
    ("quaternion", "f8", 4),
    ("energy_j_kg", "f8"),
    ("mode", "U8"),
]

#: The coin at one instant of a trace: time since launch (s), the fields of `STATE`, the orientation
#: as a unit quaternion (w, x, y, z) that turns the body's axes to the laboratory's, mechanical
#: energy a unit of mass (J/kg, 0 for a point at rest on the surface), and what goes on from there
#: on: ``flight``, ``sticking``, ``sliding`` or ``ended``.
SAMPLE = np.dtype(_KNOWN)

#: The same at an event, and which: ``launched``, ``touching``, ``impact``, ``sticking``,
#: ``sliding``, ``lift_off`` or ``ended``.
EVENT = np.dtype([*_KNOWN, ("kind", "U8")])


class Trace:
    """A toss as it was. Made by `trace`.

    Attributes
    ----------
    samples : ndarray of `SAMPLE`
        The launch, the coin at whole multiples of 1/rate, and the end. States come from the engine
        itself, never from interpolation.
    events : ndarray of `EVENT`
        All events, launch and end included; times are exact.
    outcome : str
        The face that shows (``heads``, ``tails``, ``side``), or why there is none
        (``time_limit``, ``never_settles``, ``impact_limit``, ``failed``).
    face : Face
        The face, or ``Face.UNDECIDED``.
    scene : dict
        ``ratio``, ``radius_m``, ``height_m``, ``mass_kg``, ``gravity_m_s2``.
    engine : str
        Who followed the toss.
    rate_hz : float
        Samples a second, 1/s.
    point, toss : int
        Point of the sweep; number of the toss, or None for a launch of one's own.
    impacts, contact_steps, jams : int
        Impacts; steps in sustained contact; impacts in Painlevé configurations.
    complete : bool
        Whether all was recorded; a million records and the end are the most.
    """

    __slots__ = (
        "complete",
        "contact_steps",
        "engine",
        "events",
        "face",
        "impacts",
        "jams",
        "outcome",
        "point",
        "rate_hz",
        "samples",
        "scene",
        "toss",
    )

    def __init__(self, config: Config, point: int, toss: int | None, told: dict[str, Any]) -> None:
        self.point = point
        self.toss = toss
        self.scene = config.scene(point)._asdict()
        self.engine: str = told["engine"]
        self.rate_hz: float = told["rate_hz"]
        self.outcome: str = told["outcome"]
        self.face = Face[(told["face"] or "undecided").upper()]
        self.impacts: int = told["impacts"]
        self.contact_steps: int = told["contact_steps"]
        self.jams: int = told["jams"]
        self.complete = told["samples_until_s"] is None and told["events_until_s"] is None
        self.samples = _records(told["samples"], SAMPLE)
        self.events = _records(told["events"], EVENT)

    @property
    def duration_s(self) -> float:
        """When the toss ended, s since launch."""
        return float(self.events["time_s"][-1])

    def __len__(self) -> int:
        """Give the number of samples."""
        return len(self.samples)

    def __repr__(self) -> str:
        toss = "a launch" if self.toss is None else f"toss {self.toss}"
        return (
            f"<coinmc.Trace {toss} of point {self.point}: {self.outcome} after "
            f"{self.duration_s:.3g} s, {self.impacts} impacts, {len(self)} samples>"
        )


def trace(
    config: ConfigLike,
    toss: int = 0,
    *,
    launch: np.ndarray | None = None,
    point: int = 0,
    rate_hz: float | None = 240.0,
    overrides: Mapping[str, Any] | None = None,
) -> Trace:
    """Watch one toss: any toss of any run, again, bit for bit.

    Parameters
    ----------
    config : path, dict or Config
        What is tossed, and how.
    toss : int, optional
        Number of the toss.
    launch : ndarray of `LAUNCH` with one element, optional
        A launch of your own instead.
    point : int, optional
        Point of the sweep.
    rate_hz : float or None, optional
        Samples a second, 0 for events alone; None: as many as show this toss well.
    overrides : dict, optional
        Values that replace the config's, by dotted key.

    Returns
    -------
    Trace

    Raises
    ------
    coinmc.TraceError
        If there is no such toss or rate.

    Examples
    --------
    >>> import coinmc
    >>> scene = {"coin": {"ratio": 1}, "surface": {"restitution": 0.5, "friction": 0.3},
    ...          "launch": {"preset": "robot"}, "engine": {"flat": {}}, "stop": {"tosses": 100}}
    >>> seen = coinmc.trace(scene, 42)
    >>> seen.events["kind"][:3].tolist()
    ['launched', 'touching', 'impact']
    >>> bool(seen.face == coinmc.toss(scene, 1, first=42).face[0])
    True
    """
    config = as_config(config, overrides)
    toss, point = natural(toss, "toss"), natural(point, "point")
    row = None
    if launch is not None:
        launches = as_launches(launch)
        if len(launches) != 1:
            raise ValueError(f"a trace is of one launch, not of {len(launches)}")
        row = rows(launches)[0]
    rate = None if rate_hz is None else float(rate_hz)
    told = _lib.trace(plan_of(config), point, toss, row, rate)
    return Trace(config, point, None if launch is not None else toss, told)


def _records(told: dict[str, Any], dtype: np.dtype) -> np.ndarray:
    records = np.empty(len(told["time_s"]), dtype)
    for at, name in enumerate(STATE.names):
        records[name] = told["state"][:, 3 * at : 3 * at + 3]
    for name in dtype.names:
        if name not in STATE.names:
            records[name] = told[name]
    return records
