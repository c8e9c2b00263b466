"""Coins at rest on the table: flat on a face, or on the side."""

import math

import numpy as np

from coinmc.vision._camera import Camera
from coinmc.vision._coin import MarkedCoin
from coinmc.vision._detect import Sightings
from coinmc.vision._pose import Fit, stacked

__all__ = ["axis_of", "deviation_deg", "rest_fit", "rest_pose"]

_ROUNDS = 8
#: Steps of the derivative: mm and radians.
_STEP = 1e-4


def rest_pose(face: str, height_mm: float, radius_mm: float, at: np.ndarray) -> np.ndarray:
    """Return the pose of a coin at rest.

    Parameters
    ----------
    face : str
        The face that is up.
    height_mm, radius_mm : float
        The coin.
    at : ndarray
        x and y of its centre, mm, and its angle about the vertical, rad; on its side also the
        angle about its axis.
    """
    pose = np.eye(4)
    turn = _about_z(at[2])
    if face == "side":
        # the axis lies along x before the turn
        turn = turn @ np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])
        turn = turn @ _about_z(at[3])
    elif face == "tails":
        turn = turn @ np.diag([1.0, -1.0, -1.0])
    pose[:3, :3] = turn
    pose[:3, 3] = (at[0], at[1], radius_mm if face == "side" else height_mm / 2.0)
    return pose


def _about_z(angle: float) -> np.ndarray:
    sin, cos = math.sin(angle), math.cos(angle)
    return np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])


def axis_of(pose: np.ndarray) -> np.ndarray:
    """Return the outward normal of the heads face in the frame of the table."""
    return pose[:3, 2]


def deviation_deg(face: str, pose: np.ndarray) -> float:
    """Return the angle between the axis and that of a coin at rest with this face up, degrees."""
    up = float(np.clip(axis_of(pose)[2], -1.0, 1.0))
    if face == "side":
        return abs(math.degrees(math.asin(up)))
    return math.degrees(math.acos(up if face == "heads" else -up))


def _start(face: str, pose: np.ndarray) -> np.ndarray:
    """Return the parameters of the coin at rest that is nearest to a pose."""
    turn = pose[:3, :3]
    if face == "side":
        axis = axis_of(pose)
        about = math.atan2(axis[1], axis[0])
        flat = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])
        rolled = flat.T @ _about_z(about).T @ turn
        roll = math.atan2(rolled[1, 0] - rolled[0, 1], rolled[0, 0] + rolled[1, 1])
        return np.array([pose[0, 3], pose[1, 3], about, roll])
    if face == "tails":
        turn = turn @ np.diag([1.0, -1.0, -1.0])
    about = math.atan2(turn[1, 0] - turn[0, 1], turn[0, 0] + turn[1, 1])
    return np.array([pose[0, 3], pose[1, 3], about])


def rest_fit(coin: MarkedCoin, camera: Camera, seen: Sightings, free: Fit, face: str) -> Fit:
    """Fit a coin at rest with this face up to the markers that agree with a free fit.

    Three numbers, four on the side, are fitted by Gauss and Newton's method.
    """
    points, shown = stacked(coin, seen, free.agreeing)

    def residuals(at: np.ndarray) -> np.ndarray:
        pose = rest_pose(face, coin.height_mm, coin.radius_mm, at)
        placed = points @ pose[:3, :3].T + pose[:3, 3]
        return np.ravel(camera.project(placed) - shown)

    at = _start(face, free.pose)
    now = residuals(at)
    for _ in range(_ROUNDS):
        slopes = [(residuals(at + step) - now) / _STEP for step in _STEP * np.eye(len(at))]
        change = np.linalg.lstsq(np.column_stack(slopes), -now, rcond=None)[0]
        then = residuals(at + change)
        if not then @ then < now @ now:
            break
        done = now @ now - then @ then < 1e-6 * (now @ now)
        at, now = at + change, then
        if done:
            break
    pose = rest_pose(face, coin.height_mm, coin.radius_mm, at)
    return Fit(pose, free.agreeing, float(math.sqrt(now @ now / len(points))))
