"""The camera: lens, and where the table lies in front of it."""

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from coinmc._errors import VisionError
from coinmc.vision._files import document, new_file
from coinmc.vision._needs import cv2

__all__ = ["Camera"]

FORMAT = "coinmc-camera"
VERSION = 1
_MOST_PIXELS = 20_000


@dataclass(frozen=True)
class Camera:
    """A calibrated camera above a table.

    Attributes
    ----------
    size : tuple of int
        Width and height of its photos, pixels.
    matrix : ndarray, shape (3, 3)
        Focal lengths and centre of the image, pixels.
    distortion : ndarray, shape (5,)
        OpenCV's k1, k2, p1, p2, k3.
    table : ndarray, shape (4, 4)
        From the frame of the table (mm; z up, its surface z = 0) to that of the camera.
    rms_px : float
        Root mean square error of the calibration, pixels.
    """

    size: tuple[int, int]
    matrix: np.ndarray
    distortion: np.ndarray
    table: np.ndarray
    rms_px: float = 0.0

    @property
    def centre_mm(self) -> np.ndarray:
        """Where the camera is, in the frame of the table."""
        return -self.table[:3, :3].T @ self.table[:3, 3]

    def project(self, points_mm: np.ndarray) -> np.ndarray:
        """Project points of the table's frame into the photo; shapes (n, 3) and (n, 2)."""
        turn = cv2().Rodrigues(self.table[:3, :3])[0]
        shown, _ = cv2().projectPoints(
            np.ascontiguousarray(points_mm, dtype=float),
            turn,
            self.table[:3, 3],
            self.matrix,
            self.distortion,
        )
        return shown.reshape(-1, 2)

    def save(self, path: Path | str) -> None:
        """Write the camera file, as docs/reference/vision.md says; no file is replaced.

        Raises
        ------
        coinmc.VisionError
            If the file exists or cannot be written.
        """
        described = {
            "format": FORMAT,
            "version": VERSION,
            "size_px": list(self.size),
            "matrix_px": self.matrix.tolist(),
            "distortion": self.distortion.tolist(),
            "table_to_camera_mm": self.table.tolist(),
            "rms_px": self.rms_px,
        }
        with new_file(path) as file:
            json.dump(described, file, indent=1)
            file.write("\n")

    @classmethod
    def load(cls, path: Path | str) -> "Camera":
        """Read a camera file.

        Raises
        ------
        coinmc.VisionError
            If it is not one; the message names all problems.
        """
        read = document(path, FORMAT, VERSION)
        problems: list[str] = []

        def numbers(key: str, shape: tuple[int, ...]) -> np.ndarray:
            try:
                array = np.array(read.get(key), dtype=float)
            except (TypeError, ValueError, OverflowError):
                array = np.array(np.nan)
            if array.shape != shape or not np.isfinite(array).all():
                wanted = f"{' x '.join(map(str, shape))} numbers" if shape else "a number"
                problems.append(f"{key} must be {wanted}")
                return np.zeros(shape)
            return array

        size = numbers("size_px", (2,))
        matrix, distortion = numbers("matrix_px", (3, 3)), numbers("distortion", (5,))
        table, rms = numbers("table_to_camera_mm", (4, 4)), numbers("rms_px", ())
        if not problems:
            problems.extend(_implausible(size, matrix, table))
        if problems:
            raise VisionError(f"{path}: " + "; ".join(problems))
        return cls((int(size[0]), int(size[1])), matrix, distortion, table, float(rms))


def _implausible(size: np.ndarray, matrix: np.ndarray, table: np.ndarray) -> list[str]:
    problems = []
    if not ((size >= 1).all() and (size <= _MOST_PIXELS).all() and (size % 1 == 0).all()):
        problems.append(f"size_px must be whole numbers from 1 to {_MOST_PIXELS}")
    if not (matrix[0, 0] > 0.0 and matrix[1, 1] > 0.0 and matrix[2, 2] == 1.0):
        problems.append("matrix_px must have positive focal lengths and 1 in its corner")
    turn = table[:3, :3]
    rigid = np.allclose(turn @ turn.T, np.eye(3), atol=1e-6) and np.linalg.det(turn) > 0.0
    if not rigid or not np.array_equal(table[3], (0.0, 0.0, 0.0, 1.0)):
        problems.append("table_to_camera_mm must be a rotation and a translation")
    elif (-turn.T @ table[:3, 3])[2] <= 0.0:
        problems.append("the camera must be above the table")
    return problems
