"""Calibrating a camera from photos of the board."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from coinmc._errors import VisionError
from coinmc.vision._board import Board
from coinmc.vision._camera import Camera
from coinmc.vision._needs import cv2
from coinmc.vision._photo import read_photo

__all__ = ["calibrate"]

#: Fewest photos, and fewest corners of the board in each.
PHOTOS = 6
CORNERS = 12


def calibrate(
    photos: Sequence[Path | str], table: Path | str, board: Board | None = None
) -> Camera:
    """Calibrate a camera.

    Parameters
    ----------
    photos : sequence of path
        Photos of the board from different sides, at least 6, which fill the image between them.
    table : path
        A photo of the board flat on the table, with the camera where it will take the coin.
    board : Board, optional
        The board as printed.

    Returns
    -------
    Camera

    Raises
    ------
    coinmc.VisionError
        If photos are missing, of different sizes or show too little of the board; the message
        names every such photo.
    """
    board = board or Board()
    if len(photos) < PHOTOS:
        raise VisionError(f"give at least {PHOTOS} photos of the board, not {len(photos)}")
    detector = board.detector()
    size: tuple[int, int] | None = None
    seen: list[tuple[np.ndarray, np.ndarray]] = []
    problems: list[str] = []
    for path in [*photos, table]:
        try:
            grey = read_photo(path)
        except VisionError as error:
            problems.append(str(error))
            continue
        size = size or (grey.shape[1], grey.shape[0])
        corners = _corners(detector, grey)
        if (grey.shape[1], grey.shape[0]) != size:
            problems.append(
                f"{path} is {grey.shape[1]} x {grey.shape[0]}, not {size[0]} x {size[1]}"
            )
        elif corners is None:
            problems.append(f"{path} shows fewer than {CORNERS} corners of the board")
        else:
            seen.append(corners)
    if problems or size is None:
        raise VisionError("; ".join(problems))
    objects, images = zip(*seen, strict=True)
    # k3 is left out: with a lens that does not need it, it makes the others worse
    rms, matrix, distortion, turns, shifts = cv2().calibrateCamera(
        objects, images, size, None, None, flags=cv2().CALIB_FIX_K3
    )
    lies = np.eye(4)
    lies[:3, :3] = cv2().Rodrigues(turns[-1])[0]
    lies[:3, 3] = np.ravel(shifts[-1])
    return Camera(size, matrix, np.ravel(distortion)[:5], _upwards(lies), float(rms))


def _corners(detector, grey: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
    corners, ids, _, _ = detector.detectBoard(grey)
    if ids is None or len(ids) < CORNERS:
        return None
    points, shown = detector.getBoard().matchImagePoints(corners, ids)
    return points.astype(np.float32), shown.astype(np.float32)


def _upwards(board: np.ndarray) -> np.ndarray:
    """Turn the board's frame, whose z points into the table, so that it points up."""
    if (-board[:3, :3].T @ board[:3, 3])[2] > 0.0:
        return board
    return board @ np.diag([1.0, -1.0, -1.0, 1.0])
