"""Coins in sound recordings, and what they tell of the surface."""

import json
import os
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, Literal

from coinmc import _lib
from coinmc._config import ConfigLike
from coinmc._launches import natural, threads_of
from coinmc._progress import reporting
from coinmc._question import html_table, source_of

__all__ = ["Listened", "listen"]


class Listened:
    """The result of `listen`.

    Attributes
    ----------
    recordings : list of dict
        What is heard in each recording: its ``onsets``, the times of its bounces (``bounces_s``),
        its ``whirr``, whether it is taken for a ``"drop"`` or a ``"spin"``, and ``doubts``.
    parameters : dict of str to dict
        Median and 95 % ``interval`` of each parameter of the surface by drops, with the share of
        the prior's spread that is left. Empty without a config, or without drops.
    rolling_friction_m : tuple of float or None
        The rolling friction length by whirrs, m, and its standard error.
    doubts : list of str
        Why the answer might be wrong: of the recordings, of drops and of whirrs.
    config : str
        Lines for a config of `calibrate`.
    document : dict
        All of it, as ``coinmc listen --format json`` prints it.
    """

    def __init__(self, document: dict[str, Any]) -> None:
        self.document = document
        self.recordings: list[dict[str, Any]] = document["recordings"]
        self.config: str = document["config"]
        surface = document["surface"] or {}
        drops, whirrs = surface.get("drops"), surface.get("whirrs")
        self.parameters: dict[str, dict[str, Any]] = {
            row["name"]: row for row in (drops["parameters"] if drops else [])
        }
        self.rolling_friction_m: tuple[float, float] | None = (
            (whirrs["rolling_friction_m"], whirrs["error_m"]) if whirrs else None
        )
        self.doubts: list[str] = [
            *(f"{one['name']}: {doubt}" for one in self.recordings for doubt in one["doubts"]),
            *(drops["doubts"] if drops else []),
            *surface.get("doubts", []),
        ]

    def __repr__(self) -> str:
        return f"<coinmc.Listened {', '.join(_words(one) for one in self.recordings)}>"

    def _repr_html_(self) -> str:
        rows = [[one["name"], _words(one)] for one in self.recordings]
        return html_table(["recording", "heard"], rows)


def _words(one: dict[str, Any]) -> str:
    if one["taken_for"] == "drop":
        return f"{len(one['bounces_s'])} bounces"
    return f"a whirr of {len(one['whirr']['readings'])} readings"


def listen(
    files: str | os.PathLike[str] | Iterable[str | os.PathLike[str]],
    config: ConfigLike | None = None,
    *,
    of: Literal["drop", "spin"] | None = None,
    surfaces: int = 20_000,
    seed: int = 1,
    threads: int | None = None,
    progress: bool | Callable[[int, int], None] | None = None,
    overrides: Mapping[str, Any] | None = None,
) -> Listened:
    """Hear a dropped or spun coin in sound recordings, like ``coinmc listen``.

    Parameters
    ----------
    files : path or iterable of path
        Recordings (WAV) of the same coin and launch: docs/guide/listen.md.
    config : path, dict or Config, optional
        Coin, launch and what is believed of the surface, as for `calibrate`. Without it, only times
        are told.
    of : {"drop", "spin"}, optional
        What the recordings are of. By default a spin if it whirrs, else a drop.
    surfaces : int, optional
        Surfaces, drawn from the prior, on which drops are simulated.
    seed : int, optional
        Seed of all random numbers.
    threads : int, optional
        Number of threads.
    progress : bool or callable, optional
        Whether to show progress.
    overrides : dict, optional
        Values that replace those of the config, by dotted key.

    Returns
    -------
    Listened

    Raises
    ------
    ValueError
        A file is no recording or is given twice, no coin is heard in it, or the engine knows no
        friction lengths.
    """
    if overrides and config is None:
        raise ValueError("overrides replace values of a config: give one")
    source, sets = (None, []) if config is None else source_of(config, None, overrides)
    paths = [files] if isinstance(files, str | os.PathLike) else list(files)
    if not paths:
        raise ValueError("no recordings were given")
    asked = {
        "files": [os.fspath(path) for path in paths],
        "source": source,
        "overrides": sets,
        "folder": str(Path.cwd()),
        "of": of,
        "surfaces": natural(surfaces, "surfaces"),
        "seed": natural(seed, "seed"),
        "threads": threads_of(threads),
    }
    with reporting(progress, "listen") as report:
        return Listened(json.loads(_lib.listen(asked, report)))
