"""What lens, light, sensor and file do to a picture."""

from dataclasses import dataclass

import numpy as np

from coinmc.vision._needs import cv2

__all__ = ["Effects", "developed", "dirtied", "jpeg"]

_NOISE = (1200, 1600)


@dataclass(frozen=True)
class Effects:
    """Disturbances of one photo. The default is a perfect sensor.

    Attributes
    ----------
    exposure, unevenness : float
        Factor of the light, and by how much of it the light falls from one end to the other.
    unevenness_rad : float
        Direction of the fall.
    noise : float
        Standard deviation of a pixel, grey values of 0 to 1.
    blur_px, blur_rad : float
        Length and direction of motion blur.
    defocus_px : float
        Standard deviation of the blur of the lens.
    glare, shadow : float
        Strength of a reflection, added, and depth of shadows.
    occlusion, dirt : float
        Parts of the coin's outline that something hides and that are dirty.
    quality : int
        JPEG quality.
    """

    exposure: float = 1.0
    unevenness: float = 0.0
    unevenness_rad: float = 0.0
    noise: float = 0.0
    blur_px: float = 0.0
    blur_rad: float = 0.0
    defocus_px: float = 0.0
    glare: float = 0.0
    shadow: float = 0.0
    occlusion: float = 0.0
    dirt: float = 0.0
    quality: int = 95

    @classmethod
    def drawn(cls, rng: np.random.Generator, hard: bool) -> "Effects":
        """Draw the disturbances of a photo: of a good set-up, or of a bad one."""
        if not hard:
            return cls(
                exposure=rng.uniform(0.8, 1.1),
                unevenness=rng.uniform(0.0, 0.2),
                unevenness_rad=rng.uniform(0.0, 2.0 * np.pi),
                noise=rng.uniform(0.003, 0.012),
                defocus_px=rng.uniform(0.3, 0.7),
                shadow=rng.uniform(0.2, 0.5),
                quality=int(rng.integers(85, 96)),
            )
        often = rng.random(5)
        return cls(
            exposure=rng.uniform(0.45, 1.3),
            unevenness=rng.uniform(0.0, 0.6),
            unevenness_rad=rng.uniform(0.0, 2.0 * np.pi),
            noise=rng.uniform(0.01, 0.05),
            blur_px=rng.uniform(0.0, 4.0) * (often[0] < 0.5),
            blur_rad=rng.uniform(0.0, np.pi),
            defocus_px=rng.uniform(0.3, 1.3),
            glare=rng.uniform(0.2, 0.9) * (often[1] < 0.5),
            shadow=rng.uniform(0.2, 0.8),
            occlusion=rng.uniform(0.02, 0.25) * (often[2] < 0.3),
            dirt=rng.uniform(0.0, 0.06) * (often[3] < 0.5),
            quality=int(rng.integers(40, 90)),
        )


def dirtied(
    picture: np.ndarray,
    box: tuple[int, int, int, int] | None,
    effects: Effects,
    rng: np.random.Generator,
) -> np.ndarray:
    """Put dirt, something that hides a part, and a reflection on the coin in a box of pixels."""
    if box is None:
        return picture
    left, top, right, bottom = box
    wide, high = right - left, bottom - top
    area = wide * high
    dirty = 0.0
    while dirty < effects.dirt * area:
        radius = rng.uniform(0.005, 0.03) * max(wide, high)
        at = (int(rng.uniform(left, right)), int(rng.uniform(top, bottom)))
        axes = (max(1, round(radius)), max(1, round(radius * rng.uniform(0.4, 1.0))))
        value = float(rng.choice([0.12, 0.3, 0.8]))
        cv2().ellipse(picture, at, axes, rng.uniform(0, 180), 0, 360, value, -1)
        dirty += np.pi * axes[0] * axes[1]
    if effects.occlusion > 0.0:
        _hide(picture, box, effects.occlusion, rng)
    if effects.glare > 0.0:
        spread = rng.uniform(0.08, 0.3) * max(wide, high)
        x, y = rng.uniform(left, right), rng.uniform(top, bottom)
        columns = np.exp(-(((np.arange(left, right) - x) / spread) ** 2))
        rows = np.exp(-(((np.arange(top, bottom) - y) / (spread * rng.uniform(0.4, 1.0))) ** 2))
        spot = (effects.glare * np.outer(rows, columns)).astype(np.float32)
        picture[top:bottom, left:right] += spot
    return picture


def _hide(
    picture: np.ndarray, box: tuple[int, int, int, int], part: float, rng: np.random.Generator
) -> None:
    """Lay a bar, such as a cable or the gripper's finger, over the edge of a box."""
    left, top, right, bottom = box
    side, depth = int(rng.integers(4)), part * np.array([right - left, bottom - top])
    wide = {0: (left, left + depth[0]), 1: (right - depth[0], right)}.get(side, (left, right))
    high = {2: (top, top + depth[1]), 3: (bottom - depth[1], bottom)}.get(side, (top, bottom))
    corners = np.column_stack([(*wide, *wide[::-1]), np.repeat(high, 2)])
    corners += rng.normal(0.0, 0.02 * (right - left), corners.shape)
    cv2().fillConvexPoly(picture, corners.astype(np.int32), float(rng.uniform(0.05, 0.7)))


def developed(picture: np.ndarray, effects: Effects, rng: np.random.Generator) -> np.ndarray:
    """Return the photo as the sensor gives it, uint8."""
    high, wide = picture.shape
    direction = (np.cos(effects.unevenness_rad), np.sin(effects.unevenness_rad))
    across = np.linspace(-0.5, 0.5, wide, dtype=np.float32) * np.float32(direction[0])
    down = np.linspace(-0.5, 0.5, high, dtype=np.float32) * np.float32(direction[1])
    light = np.float32(effects.exposure) * (
        1.0 + np.float32(effects.unevenness) * (across[None, :] + down[:, None])
    )
    shown = picture * light
    if effects.blur_px >= 1.0:
        shown = cv2().filter2D(shown, -1, _streak(effects.blur_px, effects.blur_rad))
    if effects.defocus_px > 0.0:
        shown = cv2().GaussianBlur(shown, (0, 0), effects.defocus_px)
    if effects.noise > 0.0:
        shown += np.float32(effects.noise) * _noise(high, wide, rng)
    return (np.clip(shown, 0.0, 1.0) * np.float32(255.0) + np.float32(0.5)).astype(np.uint8)


def _streak(length: float, direction: float) -> np.ndarray:
    size = 2 * int(np.ceil(length / 2.0)) + 3
    kernel = np.zeros((size, size), np.float32)
    for along in np.linspace(-0.5, 0.5, 33) * length:
        x = size // 2 + along * np.cos(direction)
        y = size // 2 + along * np.sin(direction)
        left, top = int(np.floor(x)), int(np.floor(y))
        for row, column in ((0, 0), (0, 1), (1, 0), (1, 1)):
            weight = (1.0 - abs(x - left - column)) * (1.0 - abs(y - top - row))
            kernel[top + row, left + column] += weight
    return kernel / kernel.sum()


_FIELD: list[np.ndarray] = []


def _noise(high: int, wide: int, rng: np.random.Generator) -> np.ndarray:
    """Return normal noise: a window of a field that is drawn once: drawing takes long."""
    if not _FIELD:
        drawn = np.random.default_rng(0).standard_normal(_NOISE)
        _FIELD.append(drawn.astype(np.float32))
    field = _FIELD[0]
    if high >= field.shape[0] or wide >= field.shape[1]:
        return rng.standard_normal((high, wide)).astype(np.float32)
    top = int(rng.integers(field.shape[0] - high))
    left = int(rng.integers(field.shape[1] - wide))
    window = field[top : top + high, left : left + wide]
    return window[:: rng.choice([-1, 1]), :: rng.choice([-1, 1])]


def jpeg(photo: np.ndarray, quality: int) -> bytes:
    """Return a photo as a JPEG file."""
    done, content = cv2().imencode(".jpg", photo, [cv2().IMWRITE_JPEG_QUALITY, quality])
    assert done, "an 8-bit picture can be encoded"
    return content.tobytes()
