"""The board for the table: a ChArUco board, which calibrates the camera and shows the table."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from coinmc.vision._needs import cv2

__all__ = ["Board"]


@dataclass(frozen=True)
class Board:
    """A chessboard with markers in its white squares.

    It fits on a sheet of A4 paper. Its markers are of another family than those of the coin, so
    that neither is taken for the other.

    Attributes
    ----------
    columns, rows : int
        Squares across and down.
    square_mm, marker_mm : float
        Edges of the squares and of the markers in them, as measured on the print.
    """

    columns: int = 9
    rows: int = 6
    square_mm: float = 27.0
    marker_mm: float = 21.0

    def scaled(self, square_mm: float) -> "Board":
        """Return the board with squares of this size, where a printer did not keep the scale."""
        factor = square_mm / self.square_mm
        return Board(self.columns, self.rows, square_mm, self.marker_mm * factor)

    @property
    def size_mm(self) -> tuple[float, float]:
        """Width and height."""
        return self.columns * self.square_mm, self.rows * self.square_mm

    def modules(self) -> np.ndarray:
        """Return the print, black as True: 9 cells across and down each square."""
        cell = 9
        size = (self.columns * cell, self.rows * cell)
        return self._made(9.0, 7.0).generateImage(size, marginSize=0, borderBits=1) < 128

    def detector(self) -> Any:
        """Return OpenCV's detector of the board."""
        return cv2().aruco.CharucoDetector(self._made(self.square_mm, self.marker_mm))

    def _made(self, square: float, marker: float) -> Any:
        aruco = cv2().aruco
        family = aruco.getPredefinedDictionary(aruco.DICT_5X5_100)
        return aruco.CharucoBoard((self.columns, self.rows), square, marker, family)
