"""The coin and its markers: where each corner lies, and the file that says so."""

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from coinmc._errors import VisionError
from coinmc.vision._files import document, new_file

__all__ = ["FACES", "MarkedCoin", "Marker"]

FORMAT = "coinmc-coin"
VERSION = 1
#: OpenCV's name of the family of markers: 4 x 4 bits, so that each bit is as large as possible.
DICTIONARY = "DICT_4X4_50"
#: Modules along the edge of a marker: four bits and the black border.
MODULES = 6
FACES = ("heads", "tails", "side")
#: Places for markers along the strip.
STRIP_PLACES = 12

_MARKERS = {"DICT_4X4_50": 50, "DICT_4X4_100": 100}
_LARGEST = "DICT_4X4_100"
_RADII_MM = (2.0, 90.0)
_RATIOS = (0.02, 10.0)
# Of the largest marker of the side: a wider one bulges too much to be read as a square.
_WIDEST = 0.35
# White rim that a detector needs around a marker, modules.
_QUIET = 1.0
#: A narrower marker cannot be printed: at 600 dots per inch a module has five dots.
NARROWEST_MM = 1.2


@dataclass(frozen=True)
class Marker:
    """One marker.

    Attributes
    ----------
    id : int
        Its number in the dictionary.
    on : str
        ``heads``, ``tails`` or ``side``.
    corners_mm : ndarray, shape (4, 3)
        Its corners in the frame of the coin: origin at the centre, z out of the heads face.
        Clockwise as printed, from the upper left one.
    """

    id: int
    on: str
    corners_mm: np.ndarray

    @property
    def width_mm(self) -> float:
        """Length of its edge."""
        return float(np.linalg.norm(self.corners_mm[3] - self.corners_mm[0]))


@dataclass(frozen=True)
class MarkedCoin:
    """A coin with its markers.

    Attributes
    ----------
    radius_mm, height_mm : float
        The coin, as it is: with its paper.
    markers : tuple of Marker
        All markers; ids are distinct.
    dictionary : str
        OpenCV's name of their family.

    Examples
    --------
    >>> from coinmc.vision import MarkedCoin
    >>> coin = MarkedCoin.of(radius_mm=25, ratio=0.577)
    >>> [sum(marker.on == face for marker in coin.markers) for face in ("heads", "tails", "side")]
    [4, 4, 12]
    """

    radius_mm: float
    height_mm: float
    markers: tuple[Marker, ...]
    dictionary: str = DICTIONARY

    @property
    def ratio(self) -> float:
        """Height over radius."""
        return self.height_mm / self.radius_mm

    @classmethod
    def of(cls, radius_mm: float, ratio: float) -> "MarkedCoin":
        """Place markers on a coin: four on each face, and one or two rows of twelve on the side.

        Parameters
        ----------
        radius_mm : float
            Radius, 2 to 90 mm.
        ratio : float
            Height over radius, 0.02 to 10.

        Raises
        ------
        coinmc.VisionError
            If either is out of range; the message names all problems.
        """
        problems = [
            f"the {name} must be from {lo:g} to {hi:g}, not {value:g}"
            for name, value, (lo, hi) in (
                ("radius in mm", radius_mm, _RADII_MM),
                ("ratio H/R", ratio, _RATIOS),
            )
            if not lo <= value <= hi
        ]
        if problems:
            raise VisionError("; ".join(problems))
        height_mm = radius_mm * ratio
        markers = [*_on_faces(radius_mm, height_mm), *_on_side(radius_mm, height_mm)]
        return cls(float(radius_mm), float(height_mm), tuple(markers))

    def marker(self, number: int) -> Marker | None:
        """Return the marker with this id."""
        return next((marker for marker in self.markers if marker.id == number), None)

    def on(self, face: str) -> list[Marker]:
        """Return the markers of ``heads``, ``tails`` or ``side``."""
        return [marker for marker in self.markers if marker.on == face]

    def save(self, path: Path | str) -> None:
        """Write the description, as docs/reference/vision.md says; no file is replaced.

        Raises
        ------
        coinmc.VisionError
            If the file exists or cannot be written.
        """
        markers = [
            {"id": m.id, "on": m.on, "corners_mm": np.round(m.corners_mm, 6).tolist()}
            for m in self.markers
        ]
        described = {
            "format": FORMAT,
            "version": VERSION,
            "radius_mm": self.radius_mm,
            "height_mm": self.height_mm,
            "dictionary": self.dictionary,
            "markers": markers,
        }
        with new_file(path) as file:
            json.dump(described, file, indent=1)
            file.write("\n")

    @classmethod
    def load(cls, path: Path | str) -> "MarkedCoin":
        """Read a description.

        Raises
        ------
        coinmc.VisionError
            If it is not one; the message names all problems.
        """
        return cls._checked(document(path, FORMAT, VERSION), str(path))

    @classmethod
    def _checked(cls, read: dict[str, Any], name: str) -> "MarkedCoin":
        problems: list[str] = []
        radius, height = (_length(read, key, problems) for key in ("radius_mm", "height_mm"))
        dictionary = read.get("dictionary")
        if not isinstance(dictionary, str) or dictionary not in _MARKERS:
            dictionary = _LARGEST
            problems.append(f"dictionary must be one of {', '.join(_MARKERS)}")
        listed = read.get("markers")
        if not isinstance(listed, list) or not 1 <= len(listed) <= _MARKERS[_LARGEST]:
            problems.append("markers must be a list of 1 to 100 markers")
            listed = []
        most = _MARKERS[dictionary]
        markers = [_marker(entry, place, most, problems) for place, entry in enumerate(listed)]
        ids = [marker.id for marker in markers if marker]
        if len(set(ids)) < len(ids):
            problems.append("each id may be used once")
        reach = 1.05 * math.hypot(radius, height / 2.0)
        if any(np.linalg.norm(m.corners_mm, axis=1).max() > reach for m in markers if m):
            problems.append("a marker lies outside the coin")
        if problems:
            raise VisionError(f"{name}: " + "; ".join(problems))
        return cls(radius, height, tuple(m for m in markers if m), dictionary)


def _length(read: dict[str, Any], key: str, problems: list[str]) -> float:
    value = read.get(key)
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0.01 <= value <= 1e3:
        problems.append(f"{key} must be a number from 0.01 to 1000")
        return 1.0
    return float(value)


def _marker(entry: Any, place: int, most: int, problems: list[str]) -> Marker | None:
    try:
        number, face = entry["id"], entry["on"]
        corners = np.array(entry["corners_mm"], dtype=float)
    except (KeyError, TypeError, ValueError, OverflowError):
        problems.append(f"marker {place} must have id, on and corners_mm")
        return None
    good = (
        isinstance(number, int)
        and 0 <= number < most
        and face in FACES
        and corners.shape == (4, 3)
        and bool(np.isfinite(corners).all())
    )
    if not good:
        problems.append(
            f"marker {place} must have an id below {most}, on = heads, tails or side, and four "
            "corners of three numbers"
        )
        return None
    return Marker(number, face, corners)


def _square(x: float, y: float, width: float) -> np.ndarray:
    """Corners of a square on paper, clockwise from the upper left one."""
    left, right, low, high = (at + width * side for at in (x, y) for side in (-0.5, 0.5))
    return np.array([[left, high], [right, high], [right, low], [left, low]])


def _on_faces(radius_mm: float, height_mm: float) -> list[Marker]:
    # four squares with two modules between them, as large as the circle holds with its white rim
    reach = 0.97 * radius_mm
    gap = 2.0 / MODULES
    width = reach / (math.sqrt(2.0) * (1.0 + gap / 2.0))
    offset = width * (1.0 + gap) / 2.0
    markers = []
    for number in range(8):
        face = FACES[number // 4]
        right, up = ((-1, 1), (1, 1), (1, -1), (-1, -1))[number % 4]
        flat = _square(right * offset, up * offset, width)
        markers.append(Marker(number, face, from_face(flat, face, height_mm)))
    return markers


def from_face(flat: np.ndarray, face: str, height_mm: float) -> np.ndarray:
    """Place points of a face's paper, right and up, on the coin."""
    mirror, z = (1.0, 0.5) if face == "heads" else (-1.0, -0.5)
    return np.column_stack([mirror * flat[:, 0], flat[:, 1], np.full(len(flat), z * height_mm)])


def from_strip(flat: np.ndarray, radius_mm: float) -> np.ndarray:
    """Wrap points of the strip's paper, along and up from its middle, around the coin."""
    angle = flat[:, 0] / radius_mm
    return np.column_stack([radius_mm * np.cos(angle), radius_mm * np.sin(angle), flat[:, 1]])


def _on_side(radius_mm: float, height_mm: float) -> list[Marker]:
    count, room = STRIP_PLACES, 1.0 + 2.0 * _QUIET / MODULES
    pitch = 2.0 * math.pi * radius_mm / count
    rows = 2 if height_mm >= 2.0 * room * _WIDEST * radius_mm else 1
    width = min(_WIDEST * radius_mm, height_mm / (rows * room), pitch / room)
    if width < NARROWEST_MM:
        return []
    markers = []
    for number in range(count * rows):
        row, place = divmod(number, count)
        # one above the other, so that a cut between them meets no marker
        along = place * pitch
        up = 0.0 if rows == 1 else (row - 0.5) * height_mm / 2.0
        corners = from_strip(_square(along, up, width), radius_mm)
        markers.append(Marker(8 + number, "side", corners))
    return markers
