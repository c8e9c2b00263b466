"""What is printed on a coin, as pictures that rays look up."""

from dataclasses import dataclass

import numpy as np

from coinmc.vision._coin import MODULES, MarkedCoin
from coinmc.vision._needs import cv2
from coinmc.vision._sheet import along_strip, marker_cells

__all__ = ["Textures", "blank", "printed"]

#: Grey values of paper and ink.
PAPER, INK = 0.86, 0.07
#: Pixels along a radius.
_FINE = 320


@dataclass(frozen=True)
class Textures:
    """The three surfaces of a cylinder, grey values from 0 to 1.

    Attributes
    ----------
    heads, tails : ndarray, float32
        The faces as one sees them, 2 R wide and high, the upper row first.
    strip : ndarray, float32
        The side unrolled, 2 pi R wide and H high, from the angle 0 on.
    """

    heads: np.ndarray
    tails: np.ndarray
    strip: np.ndarray


def _papers(radius_mm: float, height_mm: float, value: float) -> Textures:
    face = np.full((2 * _FINE, 2 * _FINE), value, np.float32)
    # a thin strip is drawn finer, or its markers would be blurred
    tall = max(32, round(_FINE * height_mm / radius_mm))
    strip = np.full((tall, round(2.0 * np.pi * _FINE)), value, np.float32)
    return Textures(face, face.copy(), strip)


def blank(ratio: float, value: float) -> Textures:
    """Return a coin without markers."""
    return _papers(1.0, ratio, value)


def printed(coin: MarkedCoin) -> Textures:
    """Return a coin with its markers."""
    drawn = _papers(coin.radius_mm, coin.height_mm, PAPER)
    for marker in coin.markers:
        cells = marker_cells(coin.dictionary, marker.id)
        if marker.on == "side":
            wide, tall = drawn.strip.shape[1], drawn.strip.shape[0]
            flat = along_strip(marker.corners_mm, coin.radius_mm)
            scale = (wide / (2.0 * np.pi * coin.radius_mm), tall / coin.height_mm)
            at = (flat[:, 0] * scale[0], (0.5 * coin.height_mm - flat[:, 1]) * scale[1])
            for turn in (0, wide):
                # the marker at the angle 0 is on both ends
                _draw(drawn.strip, cells, np.column_stack([at[0] + turn, at[1]]))
            continue
        picture = getattr(drawn, marker.on)
        mirror = 1.0 if marker.on == "heads" else -1.0
        scale = _FINE / coin.radius_mm
        right = _FINE + mirror * marker.corners_mm[:, 0] * scale
        _draw(picture, cells, np.column_stack([right, _FINE - marker.corners_mm[:, 1] * scale]))
    return drawn


def _draw(picture: np.ndarray, cells: np.ndarray, corners: np.ndarray) -> None:
    """Draw cells into the rectangle with these corners, blurred by less than a pixel."""
    fine = 8
    big = np.kron(np.where(cells, INK, PAPER), np.ones((fine, fine))).astype(np.float32)
    edge = MODULES * fine
    ends = np.array([[0, 0], [edge, 0], [edge, edge], [0, edge]], np.float32) - 0.5
    warp = cv2().getPerspectiveTransform(ends, (corners - 0.5).astype(np.float32))
    cv2().warpPerspective(
        big,
        warp,
        picture.shape[::-1],
        dst=picture,
        flags=cv2().INTER_LINEAR,
        borderMode=cv2().BORDER_TRANSPARENT,
    )
