"""The pose of the coin from all its markers, and from those alone that agree."""

from dataclasses import dataclass

import numpy as np

from coinmc.vision._camera import Camera
from coinmc.vision._coin import MarkedCoin
from coinmc.vision._detect import Sightings
from coinmc.vision._needs import cv2

__all__ = ["Fit", "errors_px", "free_fit", "refined", "stacked", "tolerance_px", "vote"]

#: A marker agrees with a pose if none of its corners is further away than this part of the
#: coin's radius in the photo, and never less than some pixels.
AGREES_RADII = 0.04
AGREES_PX = 2.5


@dataclass(frozen=True)
class Fit:
    """A pose of the coin.

    Attributes
    ----------
    pose : ndarray, shape (4, 4)
        From the frame of the coin to that of the table, mm.
    agreeing : tuple of int
        The markers that agree with it.
    rms_px : float
        Root mean square distance of their corners from where they should be, pixels.
    """

    pose: np.ndarray
    agreeing: tuple[int, ...]
    rms_px: float


def stacked(
    coin: MarkedCoin, seen: Sightings, ids: tuple[int, ...]
) -> tuple[np.ndarray, np.ndarray]:
    """Return the corners of markers on the coin and in the photo; shapes (4 n, 3) and (4 n, 2)."""
    points = np.concatenate([coin.marker(number).corners_mm for number in ids])
    return points, np.concatenate([seen[number] for number in ids])


def errors_px(
    camera: Camera, pose: np.ndarray, points: np.ndarray, shown: np.ndarray
) -> np.ndarray:
    """Return how far each corner is from where a pose puts it, pixels."""
    placed = points @ pose[:3, :3].T + pose[:3, 3]
    return np.linalg.norm(camera.project(placed) - shown, axis=1)


def tolerance_px(coin: MarkedCoin, camera: Camera, pose: np.ndarray) -> float:
    """Return how far a corner of an agreeing marker may be off, pixels."""
    distance = float(np.linalg.norm(camera.centre_mm - pose[:3, 3]))
    radius_px = float(camera.matrix[0, 0]) * coin.radius_mm / max(distance, 1e-6)
    return max(AGREES_PX, AGREES_RADII * radius_px)


def free_fit(coin: MarkedCoin, camera: Camera, seen: Sightings) -> Fit | None:
    """Find the pose with which most markers agree; None if there are none.

    Every marker proposes poses by itself, the others vote, and all that agree settle it together.
    """
    best: Fit | None = None
    for number in sorted(seen):
        for pose in _proposals(coin, camera, seen, number):
            fit = vote(coin, camera, seen, pose)
            if best is None or _merit(fit) > _merit(best):
                best = fit
    if best is None or not best.agreeing:
        return None
    again = refined(coin, camera, seen, best)
    final = vote(coin, camera, seen, again.pose)
    return refined(coin, camera, seen, final) if final.agreeing else again


def refined(coin: MarkedCoin, camera: Camera, seen: Sightings, fit: Fit) -> Fit:
    """Minimise the error of the agreeing markers over all poses near this one."""
    points, shown = stacked(coin, seen, fit.agreeing)
    inside = camera.table @ fit.pose
    turn, shift = cv2().solvePnPRefineLM(
        points,
        shown,
        camera.matrix,
        camera.distortion,
        cv2().Rodrigues(inside[:3, :3])[0],
        inside[:3, 3].reshape(3, 1).copy(),
    )
    pose = _on_table(camera, turn, shift)
    error = errors_px(camera, pose, points, shown)
    return Fit(pose, fit.agreeing, float(np.sqrt(np.mean(error**2))))


def _merit(fit: Fit) -> tuple[int, float]:
    return len(fit.agreeing), -fit.rms_px


def _proposals(coin: MarkedCoin, camera: Camera, seen: Sightings, number: int) -> list[np.ndarray]:
    """Both poses that a flat square allows."""
    corners = coin.marker(number).corners_mm
    # the solver of flat figures wants them in the plane z = 0, about their centre
    middle = corners.mean(axis=0)
    across, up = corners[1] - corners[0], corners[0] - corners[3]
    frame = np.eye(4)
    frame[:3, 0] = across / np.linalg.norm(across)
    normal = np.cross(frame[:3, 0], up)
    frame[:3, 2] = normal / np.linalg.norm(normal)
    frame[:3, 1] = np.cross(frame[:3, 2], frame[:3, 0])
    frame[:3, 3] = middle
    flat = (corners - middle) @ frame[:3, :3]
    flat[:, 2] = 0.0
    _, turns, shifts, _ = cv2().solvePnPGeneric(
        flat, seen[number], camera.matrix, camera.distortion, flags=cv2().SOLVEPNP_IPPE
    )
    inverse = np.linalg.inv(frame)
    return [
        _on_table(camera, turn, shift) @ inverse for turn, shift in zip(turns, shifts, strict=True)
    ]


def _on_table(camera: Camera, turn: np.ndarray, shift: np.ndarray) -> np.ndarray:
    inside = np.eye(4)
    inside[:3, :3] = cv2().Rodrigues(turn)[0]
    inside[:3, 3] = np.ravel(shift)
    return np.linalg.inv(camera.table) @ inside


def vote(coin: MarkedCoin, camera: Camera, seen: Sightings, pose: np.ndarray) -> Fit:
    """Return which markers agree with a pose."""
    ids = tuple(sorted(seen))
    points, shown = stacked(coin, seen, ids)
    error = errors_px(camera, pose, points, shown).reshape(-1, 4)
    agrees = error.max(axis=1) <= tolerance_px(coin, camera, pose)
    agreeing = tuple(np.array(ids)[agrees].tolist())
    rms = float(np.sqrt(np.mean(error[agrees] ** 2))) if agreeing else np.inf
    return Fit(pose, agreeing, rms)
