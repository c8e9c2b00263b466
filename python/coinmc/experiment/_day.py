"""The throws of an experiment, as a table and as counts."""

import math
import os
from collections import Counter
from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from coinmc import _lib
from coinmc._config import Config
from coinmc._errors import RunError, VisionError
from coinmc._intervals import Estimate, estimates
from coinmc.experiment._misread import FACES, Confusion, Corrected
from coinmc.experiment._model import LogLikelihood, Prediction, predict
from coinmc.vision._store import digest, logged

__all__ = ["Day", "open"]

_READINGS = (
    ("photos", "1", "Photos taken of the throw."),
    ("confidence", "1", "Of the reading: distance of its weakest criterion from its limit."),
    ("markers", "1", "Markers that agree with the pose."),
    ("reprojection_px", "px", "Root mean square error of their corners."),
    ("deviation_deg", "deg", "Angle between the axis and that of a coin at rest."),
)


class Day:
    """The throws of an experiment. Made by `open`.

    Libraries that support Arrow read it as a table: ``pyarrow.table(day)``,
    ``polars.DataFrame(day)``. Columns are described in docs/guide/robot.md#tables; where
    ``coinmc.vision`` read the photos, those of its readings follow.

    Attributes
    ----------
    path : Path
        Its directory.
    config : Config
        The config of the experiment.
    planned : int
        Throws planned.
    announced : int
        Throws announced so far; the last may not be resolved yet, and is then not in the table.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        if not hasattr(_lib, "Throws"):
            raise RunError("the journal of a robot is read on Linux and macOS only")
        table = _lib.Throws.read(path)
        self.config: Config = Config.from_toml(table.config)
        self.planned: int = table.planned
        self.announced: int = table.announced
        self._log = list(logged(path / "photos"))
        self._table = self._with_readings(table) if self._log else table

    @cached_property
    def columns(self) -> dict[str, np.ndarray]:
        """Columns by name, each of shape (throws,). Missing numbers are NaN, texts empty."""
        return {name: np.asarray(column) for name, column in self._table.columns().items()}

    @property
    def units(self) -> dict[str, str]:
        """Unit of every column."""
        return {name: unit for name, unit, _ in self._table.describe()}

    @property
    def descriptions(self) -> dict[str, str]:
        """Description of every column."""
        return {name: text for name, _, text in self._table.describe()}

    def __len__(self) -> int:
        """Return the number of resolved throws."""
        return len(self.columns["throw"])

    def __getitem__(self, name: str) -> np.ndarray:
        """Return a column."""
        return self.columns[name]

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        """Export the table as an Arrow stream (the Arrow PyCapsule interface)."""
        return self._table.__arrow_c_stream__(requested_schema)

    def __repr__(self) -> str:
        counts = ", ".join(f"{count:,} {face}" for face, count in self.counts.items() if count)
        return (
            f"<coinmc.experiment.Day {len(self):,} of {self.planned:,} throws: {counts or 'none'}>"
        )

    @property
    def counts(self) -> dict[str, int]:
        """Throws by face; ``undecided`` are those without a result."""
        # a throw that was read and then lost is void, and its reading does not count
        face = np.where(self["void"] == "", self["face"], "")
        counted = {name: int(np.sum(face == name)) for name in FACES}
        return {**counted, "undecided": len(self) - sum(counted.values())}

    @property
    def voids(self) -> dict[str, int]:
        """Throws without a result, by reason."""
        return dict(Counter(str(reason) for reason in self["void"] if reason))

    def bounds(self) -> dict[str, tuple[float, float]]:
        """Return the least and the greatest share of each face.

        Throws without a result are counted as none, and as all, of them; without the error of
        sampling.
        """
        counts, n = self.counts, max(len(self), 1)
        void = counts["undecided"]
        return {face: (counts[face] / n, (counts[face] + void) / n) for face in FACES}

    def estimate(self, confidence: float = 0.95) -> dict[str, Estimate]:
        """Estimate the probability of each face.

        Parameters
        ----------
        confidence : float
            Confidence level, between 0 and 1.

        Returns
        -------
        dict of str to Estimate
            By ``heads``, ``tails``, ``side``: the share of all throws, with an interval that covers
            sampling and, as in `bounds`, throws without a result.
        """
        return estimates(self.counts, confidence)

    def corrected(
        self, confusion: Confusion, confidence: float = 0.95, seed: int = 0
    ) -> dict[str, Corrected]:
        """Estimate the probability of each face, corrected for wrong readings.

        Parameters
        ----------
        confusion : Confusion
            Counts of photos of known faces and what was read in them.
        confidence : float
            Confidence level.
        seed : int
            Seed of the draws from the posterior.
        """
        return confusion.corrected(self.counts, confidence, seed)

    def predict(
        self,
        *,
        measured: bool = True,
        repeats: int = 1,
        spin_sd_rev_s: float = 0.0,
        angle_sd_deg: float = 0.0,
        seed: int = 0,
        overrides: Mapping[str, Any] | None = None,
    ) -> Prediction:
        """Toss every throw with the engine of the config, with the same spin and angle.

        Parameters
        ----------
        measured : bool
            With spin and angle as measured at release, where they were; otherwise as told.
        repeats : int
            Tosses of each throw.
        spin_sd_rev_s, angle_sd_deg : float
            Standard deviations of the error of these numbers: each repeat draws it anew. A
            bouncing coin is so sensitive that errors decide its face.
        seed : int
            Seed of these errors: with the same seed, two models are tossed with the same.
        overrides : dict, optional
            Values that replace those of the config, by dotted key, such as
            ``{"surface.restitution": 0.4}``.
        """
        spin, angle = self["spin_rev_s"], self["angle_deg"]
        if measured:
            there = ~np.isnan(self["measured_spin_rev_s"])
            spin = np.where(there, self["measured_spin_rev_s"], spin)
            angle = np.where(there, self["measured_angle_deg"], angle)
        return predict(
            self.config,
            self["throw"].astype(np.int64),
            spin,
            angle,
            planned=self.planned,
            repeats=repeats,
            spin_sd_rev_s=spin_sd_rev_s,
            angle_sd_deg=angle_sd_deg,
            seed=seed,
            overrides=overrides,
        )

    def log_likelihood(self, *, repeats: int = 50, **options: Any) -> LogLikelihood:
        """Return how well a model explains the faces, for calibration.

        Parameters
        ----------
        repeats : int
            Tosses of each throw, from which the probability of its face is taken.
        **options
            Other options of `predict`: the model by ``overrides``.
        """
        face = np.where(self["void"] == "", self["face"], "")
        return self.predict(repeats=repeats, **options).log_likelihood(face)

    def check_photos(self) -> list[str]:
        """Compare the photos with the log of when they were taken; return what is wrong.

        Where ``coinmc.vision`` took the photos, each has a SHA-256 there.
        """
        folder, problems = self.path / "photos", []
        hashes = {entry["image"]: entry["sha256"] for entry in self._log if "sha256" in entry}
        for name, known in sorted(hashes.items()):
            try:
                found = digest(folder / Path(name).name)
            except VisionError as error:
                problems.append(str(error))
                continue
            if found != known:
                problems.append(f"{name} was changed")
        missing = {str(name) for name in self["image"] if name} - hashes.keys()
        return problems + [f"{name} is not in the log" for name in sorted(missing) if hashes]

    def page(
        self,
        path: str | os.PathLike[str],
        *,
        confusion: Confusion | None = None,
        prediction: Prediction | None = None,
    ) -> Path:
        """Write a page about the day: one file of HTML that needs no other.

        Parameters
        ----------
        path : path
            A new file.
        confusion : Confusion, optional
            For probabilities corrected for wrong readings.
        prediction : Prediction, optional
            Beside the experiment; by default `predict()`.

        Raises
        ------
        FileExistsError
            If the file exists.
        """
        from coinmc.experiment._page import page

        html = page(self, confusion, prediction or self.predict())
        with Path(path).open("x", encoding="utf-8") as file:
            file.write(html)
        return Path(path)

    def _with_readings(self, table: _lib.Throws) -> _lib.Throws:
        """Add what was read in the photo of each throw; the last reading of a photo counts."""
        columns = table.columns()
        readings = {
            e["image"]: e["reading"] for e in self._log if isinstance(e.get("reading"), dict)
        }
        throws = (entry.get("throw") for entry in self._log)
        taken = Counter(throw for throw in throws if isinstance(throw, int))
        found = {name: np.full(len(columns["id"]), np.nan) for name, _, _ in _READINGS}
        for row, (number, image) in enumerate(zip(columns["id"], columns["image"], strict=True)):
            found["photos"][row] = taken.get(int(number), 0)
            for name, value in readings.get(image, {}).items():
                if name in found and isinstance(value, int | float):
                    found[name][row] = _float(value)
        more = [(name, unit, text, found[name]) for name, unit, text in _READINGS]
        return table.with_numbers(more)


def _float(value: float) -> float:
    """Return a number of a log, which may have more digits than a float holds; NaN then."""
    try:
        return float(value)
    except OverflowError:
        return math.nan


def open(path: str | os.PathLike[str]) -> Day:
    """Read the experiment in a directory of ``coinmc robot run``.

    Parameters
    ----------
    path : path
        The directory, or its ``journal.txt``. It is only read, and the robot may be throwing.

    Returns
    -------
    Day

    Raises
    ------
    coinmc.RunError
        If there is no experiment, or its journal is damaged.
    """
    path = Path(path)
    return Day(path.parent if path.name == "journal.txt" else path)
