"""How the coin lies in a photo: ends of simulated tosses, and traps that show no face."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from coinmc._codes import Face
from coinmc._tosses import toss
from coinmc.vision._rest import rest_pose

__all__ = ["TRAPS", "Ends", "Scene"]

#: A coin that leans less than this from rest is no trap: whether it lies or leans is a matter of
#: taste.
LEAST_LEAN_DEG = 12.0
#: Greatest distance of the coin from the middle of the photo, part of its radius.
_SPREAD = 0.8
_CONFIG = {
    "surface": {"restitution": 0.5, "friction": 0.3},
    "launch": {"preset": "clean"},
    "engine": {"volumetric": {}},
}


@dataclass(frozen=True)
class Scene:
    """What is on the table.

    Attributes
    ----------
    truth : str
        The face that is up, ``leaning``, or ``none`` for an empty table.
    kind : str
        ``rest``, ``wall``, ``balance``, ``moving``, ``against``, ``on``, ``stacked`` or ``empty``.
    pose : ndarray or None
        From the frame of the coin to that of the table, mm.
    wall : tuple or None
        Normal of a wall's foot, and its distance, mm.
    others : list of tuple
        Coins without markers: radius and height in mm, and pose.
    """

    truth: str
    kind: str
    pose: np.ndarray | None
    wall: tuple[np.ndarray, float] | None = None
    others: list[tuple[float, float, np.ndarray]] = field(default_factory=list)


class Ends:
    """Ends of tosses of a coin, by the engine in space.

    Parameters
    ----------
    radius_mm, height_mm : float
        The coin.
    seed : int
        Seed of the tosses.
    tosses : int
        How many; they are used again from the first.
    """

    def __init__(self, radius_mm: float, height_mm: float, seed: int, tosses: int = 4000) -> None:
        self.radius_mm = radius_mm
        self.height_mm = height_mm
        coin = {"ratio": height_mm / radius_mm, "radius_m": radius_mm / 1e3}
        config = {**_CONFIG, "seed": seed, "coin": coin, "stop": {"tosses": tosses}}
        ended = toss(config, threads=1)
        decided = ended.face != Face.UNDECIDED
        self.face: NDArray[np.uint8] = ended.face[decided]
        self.axis: NDArray[np.float64] = ended.final["axis"][decided]
        self.height: NDArray[np.float64] = ended.final["position_m"][decided][:, 2] * 1e3

    def rest(self, number: int, rng: np.random.Generator) -> Scene:
        """Return the coin of a toss at rest."""
        number %= len(self.face)
        return self.lying(Face(self.face[number]).name.lower(), rng, self.axis[number])

    def lying(self, face: str, rng: np.random.Generator, axis: np.ndarray | None = None) -> Scene:
        """Return a coin at rest with this face up.

        Which way its axis points comes from the toss, if there is one, and how it is turned about
        its axis from `rng`.
        """
        about = rng.uniform(0.0, 2.0 * math.pi)
        if axis is not None and math.hypot(axis[0], axis[1]) > 1e-9:
            about = math.atan2(axis[1], axis[0])
        at = np.array([*self._place(rng), about, rng.uniform(0.0, 2.0 * math.pi)])
        if face != "side":
            at[2] += at[3]
        return Scene(face, "rest", rest_pose(face, self.height_mm, self.radius_mm, at))

    def _place(self, rng: np.random.Generator) -> np.ndarray:
        return rng.uniform(-_SPREAD, _SPREAD, 2) * self.radius_mm

    def tilted(
        self, tilt_rad: float, about_rad: float, rng: np.random.Generator, lift_mm: float = 0.0
    ) -> np.ndarray:
        """Return a coin whose axis is tilted, on its rim on the table or above it."""
        up, aside = math.cos(tilt_rad), math.sin(tilt_rad)
        axis = np.array([aside * math.cos(about_rad), aside * math.sin(about_rad), up])
        pose = np.eye(4)
        pose[:3, :3] = _turn_to(axis, rng.uniform(0.0, 2.0 * math.pi))
        pose[:2, 3] = self._place(rng)
        pose[2, 3] = 0.5 * self.height_mm * abs(up) + self.radius_mm * aside + lift_mm
        return pose

    # ---- traps ----

    def moving(self, rng: np.random.Generator, camera_rad: float) -> Scene | None:
        """Return a coin photographed too early, as a toss left it when its face was decided."""
        for number in rng.integers(len(self.face), size=200):
            axis = self.axis[number]
            if _leans(axis[2]):
                about = rng.uniform(0.0, 2.0 * math.pi)
                pose = self.tilted(math.acos(np.clip(axis[2], -1, 1)), about, rng)
                pose[2, 3] = max(pose[2, 3], self.height[number])
                return Scene("leaning", "moving", pose)
        return None

    def balance(self, rng: np.random.Generator, camera_rad: float) -> Scene | None:
        """Return a coin near its balance on the rim; none if that is nearly on its side."""
        middle = math.atan2(2.0 * self.radius_mm, self.height_mm)
        for _ in range(20):
            tilt = middle + math.radians(rng.uniform(-6.0, 6.0))
            if _leans(math.cos(tilt)):
                tilt = tilt if rng.random() < 0.5 else math.pi - tilt
                return Scene("leaning", "balance", self.tilted(tilt, rng.uniform(0, 7), rng))
        return None

    def against(self, rng: np.random.Generator, camera_rad: float) -> Scene | None:
        """Return a coin that leans against a wall behind it."""
        lean = math.radians(LEAST_LEAN_DEG)
        tilt = rng.uniform(lean, 0.5 * math.pi - lean)
        about = camera_rad + rng.uniform(-1.0, 1.0)
        normal = np.array([math.cos(about), math.sin(about)])
        # the upper rim is at the wall, so the axis points away from it, or its back does
        pose = self.tilted(tilt, about + math.pi, rng)
        if rng.random() < 0.5:
            pose[:3, :3] = pose[:3, :3] @ np.diag([1.0, -1.0, -1.0])
        reach = self.radius_mm * math.cos(tilt) + 0.5 * self.height_mm * math.sin(tilt)
        return Scene("leaning", "against", pose, (normal, float(pose[:2, 3] @ normal) + reach))

    def on(self, rng: np.random.Generator, camera_rad: float) -> Scene | None:
        """Return a coin that leans on another one."""
        tilt = math.radians(rng.uniform(LEAST_LEAN_DEG, 40.0))
        about = rng.uniform(0.0, 2.0 * math.pi)
        pose = self.tilted(tilt, about, rng)
        outwards = np.array([math.cos(about), math.sin(about)])
        if rng.random() < 0.5:
            pose[:3, :3] = pose[:3, :3] @ np.diag([1.0, -1.0, -1.0])
        # the lower rim lies on the side to which the axis leans; the other coin holds the rest up
        along = rng.uniform(0.9, 1.7) * self.radius_mm
        rim = pose[:2, 3] + outwards * (
            self.radius_mm * math.cos(tilt) - 0.5 * self.height_mm * math.sin(tilt)
        )
        other = np.eye(4)
        other[:2, 3] = rim - outwards * (along * math.cos(tilt) + self.radius_mm)
        height = along * math.sin(tilt)
        other[2, 3] = 0.5 * height
        return Scene("leaning", "on", pose, None, [(self.radius_mm, height, other)])

    def stacked(self, rng: np.random.Generator, camera_rad: float) -> Scene | None:
        """Return a coin that lies flat on another one: its face is up, but not on the table."""
        scene = self.lying("heads" if rng.random() < 0.5 else "tails", rng)
        height = rng.uniform(0.1, 0.6) * self.radius_mm
        other = np.eye(4)
        other[:3, 3] = (*(scene.pose[:2, 3] + self._place(rng) * 0.5), 0.5 * height)
        scene.pose[2, 3] += height
        return Scene(scene.truth, "stacked", scene.pose, None, [(self.radius_mm, height, other)])

    def empty(self, rng: np.random.Generator, camera_rad: float) -> Scene | None:
        """Return a table with another coin on it, or with none."""
        others = [(self.radius_mm, self.height_mm, self.lying("heads", rng).pose)]
        return Scene("none", "empty", None, None, others * int(rng.integers(2)))

    def trap(self, rng: np.random.Generator, camera_rad: float) -> Scene:
        """Return any trap that this coin can be in."""
        while True:
            made = TRAPS[int(rng.integers(len(TRAPS)))](self, rng, camera_rad)
            if made is not None:
                return made

    def walled(self, scene: Scene, rng: np.random.Generator, camera_rad: float) -> Scene:
        """Put a wall behind a coin at rest, which touches it."""
        about = camera_rad + rng.uniform(-1.0, 1.0)
        normal = np.array([math.cos(about), math.sin(about)])
        axis = scene.pose[:3, 2]
        across = float(np.clip(axis[:2] @ normal, -1.0, 1.0))
        reach = self.radius_mm * math.sqrt(1.0 - across**2) + 0.5 * self.height_mm * abs(across)
        distance = float(scene.pose[:2, 3] @ normal) + reach
        return Scene(scene.truth, "wall", scene.pose, (normal, distance))


#: All traps.
TRAPS: tuple[Callable[[Ends, np.random.Generator, float], Scene | None], ...] = (
    Ends.moving,
    Ends.balance,
    Ends.against,
    Ends.on,
    Ends.stacked,
    Ends.empty,
)


def _leans(up: float) -> bool:
    """Whether an axis with this vertical part is far from every coin at rest."""
    lean = math.radians(LEAST_LEAN_DEG)
    return math.sin(lean) < abs(up) < math.cos(lean)


def _turn_to(axis: np.ndarray, roll: float) -> np.ndarray:
    """Return a rotation that takes z to the axis, after a turn about z."""
    aside = np.array([1.0, 0.0, 0.0]) if abs(axis[0]) < 0.9 else np.array([0.0, 1.0, 0.0])
    x = np.cross(aside, axis)
    x /= np.linalg.norm(x)
    frame = np.column_stack([x, np.cross(axis, x), axis])
    sin, cos = math.sin(roll), math.cos(roll)
    return frame @ np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
