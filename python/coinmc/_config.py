"""Configs: the coin, the surface, the launch, the engine and the number of tosses."""

import os
import tomllib
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

from coinmc import _lib, _toml
from coinmc._errors import ConfigError, Error

__all__ = ["Config", "ConfigLike", "Group", "Scene", "Stop", "check"]


class Scene(NamedTuple):
    """The coin and gravity at a point of the sweep.

    Attributes
    ----------
    ratio : float
        H/R, height over radius.
    radius_m, height_m : float
        R and H, m.
    mass_kg : float
        Mass, kg. It affects a probability only with laws of impact of absolute units
        (docs/methods/impact-laws.md).
    gravity_m_s2 : float
        Acceleration of gravity, m/s².
    """

    ratio: float
    radius_m: float
    height_m: float
    mass_kg: float
    gravity_m_s2: float


class Stop(NamedTuple):
    """When a point has enough tosses.

    Attributes
    ----------
    tosses : int
        Tosses per point; an upper limit if there are targets.
    half_width : float or None
        Half width that every interval must reach, if that is a target.
    relative_error : float or None
        The same as a share of the probability.
    events : int or None
        Number of tosses that must show each face, if that is a target.
    total_tosses : int or None
        Tosses of all points at which the run stops short of its targets.
    max_core_seconds, total_core_seconds : float or None
        The same for the computing time of a point and of all, in seconds of one core.
    face : str or None
        The face that the targets are of; None for each.
    """

    tosses: int
    half_width: float | None
    relative_error: float | None = None
    events: int | None = None
    total_tosses: int | None = None
    max_core_seconds: float | None = None
    total_core_seconds: float | None = None
    face: str | None = None

    @property
    def has_targets(self) -> bool:
        """Whether a point stops once its intervals are short enough or its counts high enough."""
        return (self.half_width, self.relative_error, self.events) != (None, None, None)


class Group(NamedTuple):
    """Points that are computed in the same way.

    Attributes
    ----------
    points : int
        Number of points.
    computed : str
        What is computed for them.
    skipped : list of str
        What is skipped, and why.
    """

    points: int
    computed: str
    skipped: list[str]


class Config:
    """A checked config, with every default and preset spelled out and every sweep expanded.

    Parameters
    ----------
    config : path or dict
        A TOML file, or a dict with the same tables.
    overrides : dict, optional
        Values that replace or add to those of the config, by dotted key, like ``--set`` on the
        command line: ``{"coin.ratio": 1.2}``.

    Raises
    ------
    coinmc.ConfigError
        If the config is invalid; the message shows every problem with its location.

    Examples
    --------
    >>> import coinmc
    >>> config = coinmc.Config({
    ...     "coin": {"ratio": [0.5, 1.0]},
    ...     "surface": {"restitution": 0.5, "friction": 0.3},
    ...     "launch": {"preset": "robot"},
    ...     "engine": {"flat": {}},
    ...     "stop": {"tosses": 1000},
    ... })
    >>> len(config), config.axes, config.parameters(1)["ratio"]
    (2, ['ratio'], 1.0)
    >>> len(coinmc.Config(config, overrides={"coin.ratio": 1.2}))
    1
    """

    __slots__ = ("_overrides", "_plan", "_source")

    def __init__(self, config: "ConfigLike", overrides: Mapping[str, Any] | None = None) -> None:
        if isinstance(config, Config):
            self._source = config._source
            self._overrides = config._overrides + _toml.overrides_of(overrides)
        else:
            self._source = _source(config)
            self._overrides = _toml.overrides_of(overrides)
        self._plan = _read(self._source, self._overrides)

    @classmethod
    def from_toml(cls, text: str, overrides: Mapping[str, Any] | None = None) -> "Config":
        """Read a config from TOML text.

        Parameters
        ----------
        text : str
            The text itself, not a path.
        overrides : dict, optional
            As for the class.

        Examples
        --------
        >>> import coinmc
        >>> coinmc.Config.from_toml("coin.ratio = 1\\nengine.analytic.rule = 'arc'").engine()
        'analytic'
        """
        if not isinstance(text, str):
            raise TypeError(f"TOML text is a str, not {type(text).__name__}")
        config = object.__new__(cls)
        config._source = ("text", text)
        config._overrides = _toml.overrides_of(overrides)
        config._plan = _read(config._source, config._overrides)
        return config

    @property
    def resolved(self) -> str:
        """The config with every default and preset spelled out, TOML."""
        return self._plan.resolved

    @property
    def hash(self) -> str:
        """Hash of the plan: equal if and only if the plans are equal."""
        return self._plan.hash

    @property
    def seed(self) -> int:
        """Seed of all random numbers."""
        return self._plan.seed

    @property
    def paired(self) -> bool:
        """Whether all points share their random numbers."""
        return self._plan.paired

    @property
    def axes(self) -> list[str]:
        """Columns of the swept parameters; the first varies slowest."""
        return self._plan.axes

    @property
    def notes(self) -> list[str]:
        """Remarks on the config that are not errors."""
        return self._plan.notes

    @property
    def stop(self) -> Stop:
        """When a point has enough tosses."""
        plan = self._plan
        targets = (getattr(plan, name) for name in Stop._fields[1:])
        return Stop(plan.tosses, *targets)

    @property
    def confidence(self) -> float:
        """Confidence level of every interval."""
        return self._plan.confidence

    @property
    def interval(self) -> str:
        """Method of the intervals when the number of tosses is fixed."""
        return self._plan.interval

    @property
    def tosses_planned(self) -> int:
        """Upper limit of the tosses of all points together."""
        return self._plan.tosses_planned

    @property
    def groups(self) -> list[Group]:
        """What is computed, what is skipped and why, for each group of points."""
        return [Group(*group) for group in self._plan.explain()]

    def __len__(self) -> int:
        """Return the number of points of the sweep."""
        return len(self._plan)

    def parameters(self, point: int = 0) -> dict[str, float]:
        """Return the parameters of a point by column name (SI units)."""
        return dict(self._plan.parameters(point))

    def engine(self, point: int = 0) -> str:
        """Return the engine of a point: ``flat``, ``volumetric``, ``rapier`` or ``analytic``."""
        return self._plan.engine(point)

    def scene(self, point: int = 0) -> Scene:
        """Return the coin and gravity at a point."""
        return Scene(*self._plan.scene(point))

    def __repr__(self) -> str:
        points = f"{len(self)} point" + ("s" if len(self) != 1 else "")
        sweep = f" over {', '.join(self.axes)}" if self.axes else ""
        return f"<coinmc.Config {self.hash[:8]}: {points}{sweep}, {self.engine()}>"

    def __str__(self) -> str:
        lines = [
            f"plan      {self.hash[:8]}, seed {self.seed}",
            f"points    {len(self):,}" + (f": {', '.join(self.axes)}" if self.axes else ""),
            f"tosses    {self._tosses()}",
        ]
        for group in self.groups:
            points = "1 point" if group.points == 1 else f"{group.points:,} points"
            lines.append(f"computed  {points}: {group.computed}")
            lines += [f"skipped   {reason}" for reason in group.skipped]
        lines += [f"note      {note}" for note in self.notes]
        return "\n".join(lines)

    def _tosses(self) -> str:
        if self.tosses_planned == 0:
            tosses = self._plan.makes_tosses(0)
            return "none: points are integrated" if tosses else "none: closed forms are exact"
        stop = self.stop
        wanted = []
        interval = f"the interval of P({stop.face})" if stop.face else "every interval"
        if stop.half_width is not None:
            wanted.append(f"{interval} is within ±{stop.half_width}")
        if stop.relative_error is not None:
            share = f"{100 * stop.relative_error:g} %"
            wanted.append(f"{interval} is within ±{share} of its probability")
        if stop.events is not None:
            wanted.append(f"{stop.face or 'every face'} was seen {stop.events:,} times")
        if not wanted:
            return f"{stop.tosses:,} a point, {self.tosses_planned:,} in all"
        return f"until {' and '.join(wanted)}: {self.tosses_planned:,} at most"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Config) and self.hash == other.hash

    def __hash__(self) -> int:
        return hash(self.hash)

    def __reduce__(self) -> tuple[Any, ...]:
        return _from_resolved, (self.resolved, self.hash)


#: Anything that a function accepts as a config.
ConfigLike: TypeAlias = Config | str | os.PathLike[str] | Mapping[str, Any]


def check(config: ConfigLike, overrides: Mapping[str, Any] | None = None) -> Config:
    """Check a config and say what would be computed, like ``coinmc check``.

    Parameters
    ----------
    config : path, dict or Config
        The config; a string is a path, never TOML text (use `Config.from_toml` for that).
    overrides : dict, optional
        Values that replace those of the config, by dotted key.

    Returns
    -------
    Config
        The checked config; ``print`` it to read the plan.

    Examples
    --------
    >>> import coinmc
    >>> print(coinmc.check({"coin": {"ratio": 1.5}, "engine": {"analytic": {"rule": "zone"}}}))
    plan      ...
    points    1
    tosses    none: closed forms are exact
    computed  1 point: closed form zone: P(side) = x/sqrt(x² + 4), ...
    """
    return as_config(config, overrides)


def as_config(
    config: ConfigLike,
    overrides: Mapping[str, Any] | None = None,
    absent: Mapping[str, Any] | None = None,
) -> Config:
    """Convert anything accepted as a config to a `Config`.

    Values of `absent`, by dotted key, are used where the config has no such table.
    """
    if isinstance(config, Config):
        return Config(config, overrides) if overrides else config
    if absent and (overrides is None or isinstance(overrides, Mapping)):
        there = {*_tables(config), *(str(key).partition(".")[0] for key in overrides or ())}
        absent = {k: v for k, v in absent.items() if k.partition(".")[0] not in there}
        overrides = {**absent, **(overrides or {})}
    return Config(config, overrides)


def _tables(config: Any) -> set[str]:
    """Return the tables of a config that need not be valid: what is wrong is said elsewhere."""
    if isinstance(config, Mapping):
        return {str(key) for key in config}
    try:
        return set(tomllib.loads(Path(config).read_text(encoding="utf-8")))
    except (OSError, TypeError, ValueError):
        return set()


def plan_of(config: Config) -> _lib.Plan:
    """Return the plan of a config, as the Rust library holds it."""
    return config._plan


def default_directory(config: Config) -> Path:
    """Return the default run directory, as on the command line: config name and plan hash."""
    kind, source = config._source
    stem = Path(source).stem if kind == "path" else "run"
    return Path("runs") / f"{stem}-{config.hash[:8]}"


@lru_cache(maxsize=8)  # a worker gets the same config again and again
def _from_resolved(text: str, hash_: str) -> Config:
    config = Config.from_toml(text)
    if config.hash != hash_:
        raise Error(
            f"this config was pickled by a version of coinmc that understands it differently "
            f"(plan {hash_[:8]}, here {config.hash[:8]}): use the same version on both sides"
        )
    return config


def _source(config: Any) -> tuple[str, str]:
    if isinstance(config, (str, os.PathLike)):
        path = os.fspath(config)
        if not isinstance(path, str):
            raise TypeError("a path is a str or a pathlib.Path, not bytes")
        return "path", path
    return "dict", _toml.document(config)


def _read(source: tuple[str, str], overrides: list[str]) -> _lib.Plan:
    kind, text = source
    if kind == "path":
        try:
            return _lib.Plan.load(text, overrides)
        except ConfigError as error:
            if "=" in text and not Path(text).exists():
                error.add_note("A string is a path; Config.from_toml(text) reads TOML text.")
            raise
    return _lib.Plan.parse("TOML text" if kind == "text" else "config from a dict", text, overrides)
