"""Rendered photos of a coin with markers, and of what may go wrong.

Rays are cast at a cylinder with its markers through a lens with distortion. Light that falls
unevenly, shadows, glare, dirt, things in the way, motion blur, defocus, noise and JPEG follow. How
the coin lies comes from simulated tosses (`Ends`), or is a trap that shows no face.
"""

import math
from dataclasses import dataclass

import numpy as np

from coinmc.vision._camera import Camera
from coinmc.vision._coin import MarkedCoin
from coinmc.vision.synthetic._effects import Effects, developed, dirtied, jpeg
from coinmc.vision.synthetic._raycast import Cylinder, View, cast
from coinmc.vision.synthetic._scenery import board_picture, shaded, table_picture, walled
from coinmc.vision.synthetic._scenes import TRAPS, Ends, Scene
from coinmc.vision.synthetic._textures import blank, printed

__all__ = [
    "TRAPS",
    "Effects",
    "Ends",
    "Scene",
    "SyntheticCamera",
    "View",
    "board_picture",
    "drawn_camera",
    "jpeg",
    "miscalibrated",
]

#: Photos of the synthetic camera, pixels.
SIZE = (1024, 768)
#: Pixels per radius of the coin, about.
_RADIUS_PX = 165.0


def drawn_camera(radius_mm: float, rng: np.random.Generator, hard: bool = False) -> Camera:
    """Draw a camera that looks down at the coin from the side.

    Parameters
    ----------
    radius_mm : float
        Radius of the coin, which fills a third of the width.
    rng : Generator
        Random numbers.
    hard : bool
        Whether it may also look from nearly above or from low down.
    """
    focal = rng.uniform(1200.0, 1700.0)
    tilt = math.radians(rng.uniform(*((15.0, 52.0) if hard else (25.0, 40.0))))
    about = rng.uniform(0.0, 2.0 * math.pi)
    away = focal * radius_mm / (_RADIUS_PX * rng.uniform(0.92, 1.08))
    back = np.array([math.sin(tilt) * math.cos(about), math.sin(tilt) * math.sin(about)])
    centre = away * np.array([*back, math.cos(tilt)])
    forward = -centre / away
    right = np.cross(forward, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    table = np.eye(4)
    table[:3, :3] = np.stack([right, np.cross(forward, right), forward])
    roll = math.radians(rng.uniform(-5.0, 5.0))
    cos, sin = math.cos(roll), math.sin(roll)
    turn = np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
    table[:3, :3] = turn @ table[:3, :3]
    table[:3, 3] = -table[:3, :3] @ centre
    middle = (np.array(SIZE) - 1) / 2.0 + rng.uniform(-15.0, 15.0, 2)
    matrix = np.array([[focal, 0.0, middle[0]], [0.0, focal, middle[1]], [0.0, 0.0, 1.0]])
    distortion = rng.uniform(-1.0, 1.0, 5) * (0.2, 0.1, 0.001, 0.001, 0.0)
    return Camera(SIZE, matrix, distortion, table)


def miscalibrated(camera: Camera, rng: np.random.Generator) -> Camera:
    """Return a camera as a calibration would find it: a little off."""
    matrix = camera.matrix.copy()
    matrix[[0, 1], [0, 1]] *= 1.0 + rng.normal(0.0, 0.002)
    matrix[:2, 2] += rng.normal(0.0, 1.0, 2)
    table = camera.table.copy()
    lean = np.radians(rng.normal(0.0, 0.25, 2))
    tilt = np.array([[1.0, 0.0, lean[0]], [0.0, 1.0, lean[1]], [-lean[0], -lean[1], 1.0]])
    straight, _ = np.linalg.qr(table[:3, :3] @ tilt)
    # the decomposition leaves the signs of the columns open
    straight *= np.sign(np.sum(straight * table[:3, :3], axis=0))
    table[:3, :3] = straight
    table[:3, 3] *= 1.0 + rng.normal(0.0, 0.001)
    distortion = camera.distortion + rng.normal(0.0, 0.003, 5) * (1.0, 1.0, 0.03, 0.03, 0.0)
    return Camera(camera.size, matrix, distortion, table)


@dataclass
class SyntheticCamera:
    """A camera that renders its photos.

    Attributes
    ----------
    coin : MarkedCoin
        The coin.
    camera : Camera
        The camera as it is; `miscalibrated` is what a calibration finds.
    seed : int
        Seed of the grain of the table.
    """

    coin: MarkedCoin
    camera: Camera
    seed: int = 0

    def __post_init__(self) -> None:
        self._view = View(self.camera)
        self._marked = printed(self.coin)
        self._table = table_picture(self._view, np.random.default_rng(self.seed))

    @property
    def direction_rad(self) -> float:
        """Where it looks, about the vertical: a wall there is behind the coin."""
        centre = self.camera.centre_mm
        return math.atan2(-centre[1], -centre[0])

    def photo(self, scene: Scene, effects: Effects, rng: np.random.Generator) -> np.ndarray:
        """Render a photo; ndarray of uint8, shape (height, width)."""
        picture = self._table
        solids = [
            Cylinder(radius, height, pose, blank(height / radius, float(rng.uniform(0.2, 0.8))))
            for radius, height, pose in scene.others
        ]
        box = None
        if scene.pose is not None:
            marked = Cylinder(self.coin.radius_mm, self.coin.height_mm, scene.pose, self._marked)
            box = self._view.box(marked.outline(), 0)
            solids.append(marked)
        if effects.shadow > 0.0:
            picture = shaded(self._view, solids, picture, effects.shadow)
        if scene.wall is not None:
            picture = walled(self._view, picture, *scene.wall, float(rng.uniform(0.3, 0.8)))
        picture = cast(self._view, solids, picture)
        if picture is self._table:
            picture = picture.copy()
        return developed(dirtied(picture, box, effects, rng), effects, rng)
