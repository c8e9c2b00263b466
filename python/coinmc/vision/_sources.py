"""Where photos come from: a camera, a file, or the renderer."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from coinmc._errors import VisionError
from coinmc.vision._camera import Camera
from coinmc.vision._coin import FACES, MarkedCoin
from coinmc.vision._files import open_plain
from coinmc.vision._needs import cv2
from coinmc.vision._photo import MOST_BYTES
from coinmc.vision.synthetic import Effects, Ends, Scene, SyntheticCamera, jpeg

__all__ = ["DeviceSource", "FileSource", "Source", "SyntheticSource"]

# Frames that a camera holds back: they may show the table before the coin came.
_STALE = 4
_LONGEST_TRUTH = 512
_EMPTY = Scene("none", "empty", None)


class Source(Protocol):
    """Gives photos: the bytes of a file, and its extension."""

    def take(self, throw: int, name: str) -> tuple[bytes, str]:
        """Take a photo of a throw (0: before the first), which will have this name."""
        ...


class DeviceSource:
    """A camera of the computer, by its number."""

    def __init__(self, device: int, size: tuple[int, int]) -> None:
        self._capture: Any = cv2().VideoCapture(device)
        if not self._capture.isOpened():
            raise VisionError(f"camera {device} cannot be opened")
        self._capture.set(cv2().CAP_PROP_FRAME_WIDTH, size[0])
        self._capture.set(cv2().CAP_PROP_FRAME_HEIGHT, size[1])

    def take(self, throw: int, name: str) -> tuple[bytes, str]:
        """Take a photo now."""
        for _ in range(_STALE):
            self._capture.grab()
        done, frame = self._capture.read()
        if not done:
            raise VisionError("the camera gives no picture")
        return jpeg(frame, 95), "jpg"


@dataclass
class FileSource:
    """A photo that another program writes, such as one for a camera without a driver."""

    path: Path

    def take(self, throw: int, name: str) -> tuple[bytes, str]:
        """Copy the photo as it is now."""
        try:
            with open_plain(self.path) as file:
                content = file.read(MOST_BYTES + 1)
        except OSError as error:
            raise VisionError(f"{self.path} cannot be read: {error.strerror}") from error
        if len(content) > MOST_BYTES:
            raise VisionError(f"{self.path} is larger than {MOST_BYTES >> 20} MiB")
        return content, "png" if content.startswith(b"\x89PNG") else "jpg"


class SyntheticSource:
    """Photos of the coin of the simulated robot.

    Parameters
    ----------
    coin, camera
        The coin and the camera.
    truth : Path
        The truth file of the simulated robot.
    seed : int
        Photos of a face depend on the seed and their names alone.
    hard, moving : float
        Shares of bad photos, and of photos in which the coin still moves.
    """

    def __init__(
        self,
        coin: MarkedCoin,
        camera: Camera,
        truth: Path,
        seed: int,
        hard: float,
        moving: float,
    ) -> None:
        self._truth = truth
        self._seed = seed
        self._hard, self._moving = hard, moving
        self._renderer = SyntheticCamera(coin, camera, seed)
        self._ends = Ends(coin.radius_mm, coin.height_mm, seed, tosses=500)

    def take(self, throw: int, name: str) -> tuple[bytes, str]:
        """Render a photo of the coin as it lies now; of an empty table before the first throw."""
        # the throw would not do: after a restart its photo must differ from the one before
        rng = np.random.default_rng([self._seed, *name.encode(errors="surrogatepass")])
        effects = Effects.drawn(rng, rng.random() < self._hard)
        scene = _EMPTY if throw == 0 else self._scene(rng)
        photo = self._renderer.photo(scene, effects, rng)
        return jpeg(photo, effects.quality), "jpg"

    def _scene(self, rng: np.random.Generator) -> Scene:
        early = rng.random() < self._moving
        face = self._face()
        if face is None or early:
            trap = self._ends.moving(rng, self._renderer.direction_rad)
            if trap is not None:
                return trap
        if face is None:
            return _EMPTY
        like = np.flatnonzero(self._ends.face == FACES.index(face))
        axis = self._ends.axis[rng.choice(like)] if len(like) else None
        return self._ends.lying(face, rng, axis)

    def _face(self) -> str | None:
        """Return the face of the last throw in the truth file."""
        try:
            with self._truth.open("rb") as file:
                length = file.seek(0, 2)
                file.seek(max(0, length - _LONGEST_TRUTH))
                lines = file.read().rpartition(b"\n")[0].splitlines()
            face = json.loads(lines[-1])["face"]
        except (OSError, ValueError, LookupError, TypeError) as error:
            raise VisionError(f"{self._truth} tells of no throw: {error}") from error
        return face if face in FACES else None
