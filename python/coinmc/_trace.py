"""The recorded motion of one toss."""

import os
from collections.abc import Mapping
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from coinmc import _lib
from coinmc._codes import Face
from coinmc._config import Config, ConfigLike, as_config, plan_of
from coinmc._launches import STATE, LaunchesLike, as_launches, natural, rows
from coinmc._table import ArrowTable, flattened

__all__ = ["EVENT", "SAMPLE", "Trace", "trace"]

_FIELDS = [
    ("time_s", "f8"),
    *((name, "f8", 3) for name in STATE.names),
    ("quaternion", "f8", 4),
    ("energy_j_kg", "f8"),
    ("mode", "U8"),
]

#: The coin at one instant of a trace: time since launch (s), the fields of `STATE`, the orientation
#: as a unit quaternion (w, x, y, z) that rotates body axes to laboratory axes, mechanical energy
#: per unit mass (J/kg, 0 for a point at rest on the surface), and the mode of motion from then on:
#: ``flight``, ``sticking``, ``sliding`` or ``ended``.
SAMPLE = np.dtype(_FIELDS)

#: The same at an event, and its kind: ``launched``, ``touching``, ``impact``, ``sticking``,
#: ``sliding``, ``lift_off`` or ``ended``.
EVENT = np.dtype([*_FIELDS, ("kind", "U8")])


class Trace(ArrowTable):
    """The recorded motion of a toss. Made by `trace`.

    Libraries that support Arrow read its samples as a table: ``polars.DataFrame(trace)``.

    Attributes
    ----------
    samples : ndarray of `SAMPLE`
        The state at launch, at multiples of 1/rate, and at the end. States are computed by the
        engine; only in contact with rough ground they are interpolated between its steps.
    events : ndarray of `EVENT`
        All events, including launch and end; times are exact.
    outcome : str
        The face (``heads``, ``tails``, ``side``), or the reason why there is none
        (``left``, ``time_limit``, ``never_settles``, ``impact_limit``, ``failed``).
    face : Face
        The face, ``Face.LEFT`` or ``Face.UNDECIDED``.
    scene : dict
        ``ratio``, ``radius_m``, ``height_m``, ``mass_kg``, ``gravity_m_s2``.
    rims_m : tuple
        Radius and distance from the centre of mass of heads and of tails, m: twice R and H/2 but
        for a conical edge or a load.
    axial_gyration_m2 : float
        Moment of inertia about the axis over the mass, m².
    weight_m_s2 : tuple
        The weight over the mass, m/s²: (0, 0, -g), or in axes of a tilted table, as all vectors
        here are.
    engine : str
        The engine.
    rate_hz : float
        Samples per second, 1/s.
    point, toss : int
        Index of the point in the sweep; index of the toss, or None if a launch was given.
    impacts, contact_steps, jams : int
        Numbers of impacts, of steps in sustained contact, and of impacts in Painlevé
        configurations.
    complete : bool
        Whether everything was recorded. The limit is 200,000 records and the end; samples stop
        when half of them are used.
    source : tuple
        What repeats the toss: config, point, toss, and launch as a row or None.
    """

    __slots__ = (
        "axial_gyration_m2",
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
        "rims_m",
        "samples",
        "scene",
        "source",
        "toss",
        "weight_m_s2",
    )

    def __init__(
        self,
        config: Config,
        point: int,
        toss: int | None,
        row: NDArray[np.float64] | None,
        recorded: dict[str, Any],
    ) -> None:
        self.source: tuple[Config, int, int, NDArray[np.float64] | None]
        self.source = (config, point, toss or 0, row)
        self.point: int = point
        self.toss: int | None = toss
        self.scene: dict[str, float] = config.scene(point)._asdict()
        rims, gyration, weight = plan_of(config).solid(point)
        self.rims_m: tuple[tuple[float, float], ...] = tuple(rims)
        self.axial_gyration_m2: float = gyration
        self.weight_m_s2: tuple[float, ...] = tuple(weight)
        self.engine: str = recorded["engine"]
        self.rate_hz: float = recorded["rate_hz"]
        self.outcome: str = recorded["outcome"]
        left = self.outcome == "left"
        self.face: Face = Face.LEFT if left else Face[(recorded["face"] or "undecided").upper()]
        self.impacts: int = recorded["impacts"]
        self.contact_steps: int = recorded["contact_steps"]
        self.jams: int = recorded["jams"]
        self.complete: bool = (
            recorded["samples_until_s"] is None and recorded["events_until_s"] is None
        )
        self.samples: NDArray[np.void] = _records(recorded["samples"], SAMPLE)
        self.events: NDArray[np.void] = _records(recorded["events"], EVENT)

    @property
    def columns(self) -> dict[str, NDArray[Any]]:
        """The samples as columns of a table, one per component: ``position_x_m``."""
        return flattened(self.samples)

    def save(
        self,
        path: str | os.PathLike[str],
        *,
        encoding: Literal["protobuf", "json"] = "protobuf",
    ) -> None:
        """Save the trace as ``coinmc trace -o`` does.

        Parameters
        ----------
        path : path
            A new file: ``.mcap`` (for Foxglove), ``.csv``, ``.parquet``, ``.jsonl`` or ``.svg``.
        encoding : str, optional
            Of messages in MCAP files: ``"protobuf"``, less than half the size and what most viewers
            draw, or ``"json"``, readable without its schema.

        Raises
        ------
        ValueError
            If the extension or the encoding is unknown.
        FileExistsError
            If the file exists.
        OSError
            If it cannot be written.

        Examples
        --------
        >>> import coinmc
        >>> coinmc.trace("examples/first.toml", 7).save("toss.mcap")
        """
        config, point, toss, row = self.source
        plan = plan_of(config)
        _lib.save_trace(plan, point, toss, row, self.rate_hz, os.fspath(path), encoding)

    @property
    def duration_s(self) -> float:
        """Time at which the toss ended, s since launch."""
        return float(self.events["time_s"][-1])

    def __len__(self) -> int:
        """Return the number of samples."""
        return len(self.samples)

    def _repr_html_(self) -> str:
        """Show the toss in three dimensions, in notebooks."""
        from coinmc._pages import replay

        return replay(self)._repr_html_()

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
    launch: LaunchesLike | None = None,
    point: int = 0,
    rate_hz: float | None = 240.0,
    overrides: Mapping[str, Any] | None = None,
) -> Trace:
    """Repeat any toss of any run, bit-identically, and record its motion.

    Parameters
    ----------
    config : path, dict or Config
        The config.
    toss : int, optional
        Index of the toss.
    launch : ndarray of `LAUNCH` with one element or dict of arrays, optional
        Your own launch, instead of a toss by its index; the config then needs no ``[launch]``.
    point : int, optional
        Index of the point in the sweep.
    rate_hz : float or None, optional
        Samples per second, 0 for events only; None chooses a rate that suits this toss.
    overrides : dict, optional
        Values that replace those of the config, by dotted key.

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
    >>> trace = coinmc.trace(scene, 42)
    >>> trace.events["kind"][:3].tolist()
    ['launched', 'touching', 'impact']
    >>> bool(trace.face == coinmc.toss(scene, 1, first=42).face[0])
    True
    """
    toss, point = natural(toss, "toss"), natural(point, "point")
    absent: dict[str, Any] = {"stop.tosses": toss + 1}
    if launch is not None:
        absent["launch.preset"] = "robot"
    config = as_config(config, overrides, absent)
    row = None
    if launch is not None:
        launches = as_launches(launch)
        if len(launches) != 1:
            raise ValueError(f"a trace needs exactly one launch, not {len(launches)}")
        row = rows(launches)[0]
    rate = None if rate_hz is None else float(rate_hz)
    recorded = _lib.trace(plan_of(config), point, toss, row, rate)
    return Trace(config, point, None if launch is not None else toss, row, recorded)


def _records(columns: dict[str, Any], dtype: np.dtype[np.void]) -> NDArray[np.void]:
    records = np.empty(len(columns["time_s"]), dtype)
    for at, name in enumerate(STATE.names):
        records[name] = columns["state"][:, 3 * at : 3 * at + 3]
    for name in dtype.names:
        if name not in STATE.names:
            records[name] = columns[name]
    return records
