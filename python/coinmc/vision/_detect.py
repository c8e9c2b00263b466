"""Finding the markers of the coin in a photo."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from coinmc.vision._coin import MarkedCoin
from coinmc.vision._needs import cv2

__all__ = ["Sighting", "Sightings", "looks"]

#: A marker in the photo, by its id: its four corners, pixels.
Sighting = np.ndarray
Sightings = dict[int, Sighting]


def looks(grey: np.ndarray) -> Iterator[Callable[[], np.ndarray]]:
    """Return ways to look at a photo, the cheapest that usually works first.

    As it is; smoothed and at half size, against noise; with local contrast, against glare and
    shadow.
    """

    def contrasted() -> np.ndarray:
        calm = cv2().medianBlur(grey, 3)
        return cv2().createCLAHE(clipLimit=4.0, tileGridSize=(8, 8)).apply(calm)

    yield lambda: grey
    yield lambda: cv2().resize(grey, None, fx=0.5, fy=0.5, interpolation=cv2().INTER_AREA)
    yield contrasted


class Detector:
    """Finds markers of a coin. The settings are those of docs/guide/vision.md."""

    def __init__(self, coin: MarkedCoin) -> None:
        aruco = cv2().aruco
        settings = aruco.DetectorParameters()
        settings.cornerRefinementMethod = aruco.CORNER_REFINE_SUBPIX
        settings.cornerRefinementWinSize = 4
        settings.cornerRefinementMaxIterations = 15
        settings.adaptiveThreshWinSizeMin = 5
        settings.adaptiveThreshWinSizeMax = 37
        settings.adaptiveThreshWinSizeStep = 16
        settings.minMarkerPerimeterRate = 0.025
        # a marker seen obliquely, with a bulging edge
        settings.polygonalApproxAccuracyRate = 0.05
        # one bit of sixteen may be wrong, under dirt: the other markers tell if it is another one
        settings.errorCorrectionRate = 1.0
        settings.maxErroneousBitsInBorderRate = 0.2
        family = aruco.getPredefinedDictionary(getattr(aruco, coin.dictionary))
        self._detector: Any = aruco.ArucoDetector(family, settings)
        self._known = {marker.id for marker in coin.markers}

    def find(self, grey: np.ndarray, shown: np.ndarray) -> tuple[Sightings, bool]:
        """Find markers in one look at a photo; also whether any of them is there twice.

        Parameters
        ----------
        grey : ndarray
            The photo, whose size the corners refer to.
        shown : ndarray
            The look.
        """
        corners, ids, _ = self._detector.detectMarkers(shown)
        scale = np.array(grey.shape[::-1], dtype=float) / shown.shape[::-1]
        found: Sightings = {}
        twice = False
        for number, four in zip(np.ravel(ids) if ids is not None else (), corners, strict=True):
            if int(number) not in self._known:
                continue
            twice |= int(number) in found
            # pixel centres: those of the half size lie between those of the photo
            found[int(number)] = (four.reshape(4, 2) + 0.5) * scale - 0.5
        return found, twice
