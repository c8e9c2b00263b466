"""What else is in the photo: the table, a wall, the board."""

import numpy as np

from coinmc.vision._board import Board
from coinmc.vision._needs import cv2
from coinmc.vision.synthetic._raycast import LIGHT, RAYS, Cylinder, View
from coinmc.vision.synthetic._textures import INK, PAPER

__all__ = ["board_picture", "shaded", "table_picture", "walled"]


def table_picture(view: View, rng: np.random.Generator) -> np.ndarray:
    """Return a table with some grain, in grey values of 0 to 1."""
    cells, size_mm = 512, 400.0
    grain = rng.standard_normal((cells, cells)).astype(np.float32)
    grain = cv2().GaussianBlur(grain, (0, 0), sigmaX=12.0, sigmaY=1.5)
    grain *= rng.uniform(0.01, 0.06) / max(float(grain.std()), 1e-6)
    grain += np.float32(rng.uniform(0.25, 0.55))
    at = view.ground() * np.float32(cells / size_mm) + np.float32(cells / 2)
    mode = cv2().BORDER_REFLECT
    return cv2().remap(grain, at[..., 0], at[..., 1], cv2().INTER_LINEAR, borderMode=mode)


def walled(
    view: View, picture: np.ndarray, normal: np.ndarray, distance_mm: float, value: float
) -> np.ndarray:
    """Draw a vertical wall: its foot is the line on the table with this normal and distance."""
    rays = view.rays()[::RAYS, ::RAYS]
    towards = rays[..., 0] * np.float32(normal[0]) + rays[..., 1] * np.float32(normal[1])
    room = np.float32(distance_mm - view.centre[:2] @ normal)
    along = room / np.where(towards == 0.0, 1e-9, towards)
    # the foot is where the table and the wall are equally far
    hit = (along > 0.0) & (view.centre[2] + rays[..., 2] * along > 0.0)
    shade = np.float32(value) * (1.0 - 0.002 * (view.centre[2] + rays[..., 2] * along).clip(0, 100))
    return np.where(hit, shade, picture).astype(np.float32)


def shaded(view: View, solids: list[Cylinder], picture: np.ndarray, depth: float) -> np.ndarray:
    """Darken the table where cylinders keep the light off, with a soft edge."""
    dark = np.zeros(picture.shape, np.uint8)
    for solid in solids:
        points = solid.outline()
        points = points - LIGHT * (points[:, 2:] / LIGHT[2])
        shown = view.camera.project(points).astype(np.float32)
        if np.isfinite(shown).all() and np.abs(shown).max() < 1e4:
            cv2().fillConvexPoly(dark, cv2().convexHull(shown).astype(np.int32), 255)
    soft = cv2().boxFilter(dark, cv2().CV_32F, (15, 15)) / np.float32(255.0)
    return picture * (1.0 - np.float32(depth) * soft)


def board_picture(view: View, board: Board, pose: np.ndarray) -> np.ndarray:
    """Return a photo of the board alone.

    Parameters
    ----------
    pose : ndarray, shape (4, 4)
        From the frame of the board (mm, z out of the print, origin at its lower left corner) to
        that of the table.
    """
    turn = pose[:3, :3]
    start = turn.T @ (view.centre - pose[:3, 3])
    way = view.rays() @ turn.astype(np.float32)
    along = np.float32(-start[2]) / np.where(way[..., 2] == 0.0, 1e-9, way[..., 2])
    fine = 6
    print_ = np.kron(np.where(board.modules(), INK, PAPER), np.ones((fine, fine)))
    print_ = np.pad(print_, 6 * fine, constant_values=PAPER).astype(np.float32)
    per_mm = (print_.shape[0] - 12 * fine) / board.size_mm[1]
    columns = (way[..., 0] * along + np.float32(start[0])) * per_mm + 6 * fine - 0.5
    rows = print_.shape[0] - 6 * fine - (way[..., 1] * along + np.float32(start[1])) * per_mm - 0.5
    columns[along < 0.0] = -1e4
    shown = cv2().remap(
        print_,
        np.clip(columns, -1e4, 1e4).astype(np.float32),
        np.clip(rows, -1e4, 1e4).astype(np.float32),
        cv2().INTER_LINEAR,
        borderMode=cv2().BORDER_CONSTANT,
        borderValue=0.4,
    )
    scale = 1.0 / RAYS
    return cv2().resize(shown, None, fx=scale, fy=scale, interpolation=cv2().INTER_AREA)
