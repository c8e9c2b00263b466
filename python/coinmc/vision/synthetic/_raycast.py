"""A ray for every quarter of a pixel, and where it meets cylinders, walls and the table."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coinmc.vision._camera import Camera
from coinmc.vision._needs import cv2
from coinmc.vision.synthetic._textures import Textures

__all__ = ["Cylinder", "View", "cast"]

#: Rays across a pixel.
RAYS = 2
#: Light: from above, a little aside. Part of it comes from everywhere.
LIGHT = np.array([0.35, -0.25, 0.9]) / np.linalg.norm([0.35, -0.25, 0.9])
AMBIENT = 0.45
_FAR = np.float32(1e9)


@dataclass(frozen=True)
class Cylinder:
    """A coin in the frame of the table, mm."""

    radius_mm: float
    height_mm: float
    pose: np.ndarray
    textures: Textures

    def outline(self) -> np.ndarray:
        """Return points of both rims; shape (64, 3)."""
        turn = np.linspace(0.0, 2.0 * np.pi, 32, endpoint=False)
        rim = np.column_stack([self.radius_mm * np.cos(turn), self.radius_mm * np.sin(turn)])
        ends = [np.column_stack([rim, np.full(32, z * self.height_mm)]) for z in (0.5, -0.5)]
        return np.concatenate(ends) @ self.pose[:3, :3].T + self.pose[:3, 3]


class View:
    """The rays of a camera, computed once.

    Attributes
    ----------
    camera : Camera
        The camera, as it really is.
    """

    def __init__(self, camera: Camera) -> None:
        self.camera = camera
        wide, high = camera.size
        across = (np.arange(wide * RAYS, dtype=np.float32) + 0.5) / RAYS - 0.5
        down = (np.arange(high * RAYS, dtype=np.float32) + 0.5) / RAYS - 0.5
        # distortion is smooth: every eighth ray is computed, those between are interpolated
        step = 8
        grid = np.stack(np.meshgrid(_ends(across, step), _ends(down, step)), axis=-1)
        straight = cv2().undistortPoints(
            grid.reshape(-1, 1, 2).astype(np.float64), camera.matrix, camera.distortion
        )
        coarse = straight.reshape(*grid.shape[:2], 2).astype(np.float32)
        columns, rows = np.meshgrid(
            np.arange(len(across), dtype=np.float32) / step,
            np.arange(len(down), dtype=np.float32) / step,
        )
        fine = cv2().remap(coarse, columns, rows, cv2().INTER_LINEAR)
        inside = np.concatenate([fine, np.ones((*fine.shape[:2], 1), np.float32)], axis=2)
        self._rays = inside @ camera.table[:3, :3].astype(np.float32)
        self.centre: NDArray[np.float64] = camera.centre_mm

    def rays(self, box: tuple[int, int, int, int] | None = None) -> np.ndarray:
        """Return the directions of the rays in a box of pixels: left, top, right, bottom."""
        if box is None:
            return self._rays
        left, top, right, bottom = (RAYS * edge for edge in box)
        return self._rays[top:bottom, left:right]

    def box(self, points_mm: np.ndarray, margin: int = 4) -> tuple[int, int, int, int] | None:
        """Return the box of pixels around points; None outside the photo."""
        shown = self.camera.project(points_mm)
        low = np.floor(shown.min(axis=0)).astype(int) - margin
        high = np.ceil(shown.max(axis=0)).astype(int) + margin + 1
        left, top = np.maximum(low, 0)
        right, bottom = np.minimum(high, self.camera.size)
        return (left, top, right, bottom) if left < right and top < bottom else None

    def ground(self) -> np.ndarray:
        """Return where the table is seen, x and y in mm, one for each pixel."""
        rays = self._rays[::RAYS, ::RAYS]
        along = (-self.centre[2] / np.minimum(rays[..., 2], -1e-6)).astype(np.float32)
        return rays[..., :2] * along[..., None] + self.centre[:2].astype(np.float32)


def _ends(values: np.ndarray, step: int) -> np.ndarray:
    """Every step-th value, and enough after the last to interpolate it."""
    pitch = values[1] - values[0]
    return values[0] + pitch * step * np.arange(len(values) // step + 2)


def cast(view: View, solids: list[Cylinder], picture: np.ndarray) -> np.ndarray:
    """Draw cylinders into a picture of grey values; the nearer one hides the other.

    Returns
    -------
    ndarray
        The picture with the cylinders.
    """
    boxes = [view.box(solid.outline()) for solid in solids]
    boxes = [box for box in boxes if box]
    if not boxes:
        return picture
    low, high = np.min(boxes, axis=0)[:2], np.max(boxes, axis=0)[2:]
    box = (int(low[0]), int(low[1]), int(high[0]), int(high[1]))
    rays = view.rays(box)
    nearest = np.full(rays.shape[:2], _FAR, np.float32)
    value = np.zeros(rays.shape[:2], np.float32)
    for solid in solids:
        _meet(view, solid, rays, nearest, value)
    drawn = picture.copy()
    left, top, right, bottom = box
    covered = _mean((nearest < _FAR).astype(np.float32))
    behind = drawn[top:bottom, left:right]
    drawn[top:bottom, left:right] = behind * (1.0 - covered) + _mean(value)
    return drawn


def _mean(rays: np.ndarray) -> np.ndarray:
    return cv2().resize(rays, None, fx=1.0 / RAYS, fy=1.0 / RAYS, interpolation=cv2().INTER_AREA)


def _meet(
    view: View, solid: Cylinder, rays: np.ndarray, nearest: np.ndarray, value: np.ndarray
) -> None:
    """Find where rays meet a cylinder, in its own frame, and look up what is printed there."""
    turn = solid.pose[:3, :3]
    start = turn.T @ (view.centre - solid.pose[:3, 3])
    way = rays @ turn.astype(np.float32)
    x, y, z = (way[..., axis] for axis in range(3))
    light = turn.T @ LIGHT
    if abs(start[2]) > 0.5 * solid.height_mm:
        face, end = ("heads", 0.5) if start[2] > 0.0 else ("tails", -0.5)
        along = np.float32(end * solid.height_mm - start[2]) / np.where(z == 0.0, 1e-12, z)
        right, up = x * along + np.float32(start[0]), y * along + np.float32(start[1])
        met = (right * right + up * up <= solid.radius_mm**2) & (along > 0.0) & (along < nearest)
        if face == "tails":
            right = -right
        texture = getattr(solid.textures, face)
        scale = np.float32(texture.shape[0] / (2.0 * solid.radius_mm))
        middle = np.float32(texture.shape[0] / 2.0 - 0.5)
        shown = _look_up(texture, right * scale + middle, middle - up * scale)
        shade = AMBIENT + (1.0 - AMBIENT) * max(0.0, float(light[2]) * np.sign(end))
        nearest[met] = along[met]
        value[met] = shown[met] * np.float32(shade)
    square = x * x + y * y
    half = x * np.float32(start[0]) + y * np.float32(start[1])
    away = np.float32(start[0] ** 2 + start[1] ** 2 - solid.radius_mm**2)
    if away <= 0.0:
        return
    under = half * half - square * away
    along = (-half - np.sqrt(np.maximum(under, 0.0))) / np.maximum(square, 1e-12)
    up = z * along + np.float32(start[2])
    met = (under > 0.0) & (np.abs(up) <= 0.5 * solid.height_mm) & (along > 0.0) & (along < nearest)
    right, front = x * along + np.float32(start[0]), y * along + np.float32(start[1])
    strip = solid.textures.strip
    angle = np.arctan2(front, right)
    angle[angle < 0.0] += np.float32(2.0 * np.pi)
    columns = angle * np.float32(strip.shape[1] / (2.0 * np.pi)) - np.float32(0.5)
    rows = (np.float32(0.5) - up / np.float32(solid.height_mm)) * strip.shape[0] - np.float32(0.5)
    shown = _look_up(strip, columns, rows)
    lit = (right * np.float32(light[0]) + front * np.float32(light[1])) / solid.radius_mm
    shade = AMBIENT + (1.0 - AMBIENT) * np.maximum(lit, 0.0)
    nearest[met] = along[met]
    value[met] = (shown * shade)[met]


def _look_up(texture: np.ndarray, columns: np.ndarray, rows: np.ndarray) -> np.ndarray:
    return cv2().remap(
        texture,
        columns.astype(np.float32),
        rows.astype(np.float32),
        cv2().INTER_LINEAR,
        borderMode=cv2().BORDER_REPLICATE,
    )
