"""What a photo shows: heads, tails, side, a leaning coin, or nothing that can be told."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from coinmc.vision._camera import Camera
from coinmc.vision._coin import FACES, MarkedCoin
from coinmc.vision._detect import Detector, Sightings, looks
from coinmc.vision._photo import read_photo
from coinmc.vision._pose import Fit, free_fit, refined, tolerance_px, vote
from coinmc.vision._rest import deviation_deg, rest_fit

__all__ = ["Classifier", "Reading"]

#: Fewest markers that must agree. One alone is never a face.
MARKERS = 2
#: Greatest angle between the axis and that of a coin at rest, degrees.
MOST_DEVIATION_DEG = 8.0
#: Greatest error of a coin at rest, as a part of the tolerance of one marker's corners.
REST_PART = 0.6


@dataclass(frozen=True)
class Reading:
    """What a photo shows.

    Attributes
    ----------
    shows : str
        ``heads``, ``tails``, ``side`` (the face that is up), ``leaning``, or ``none``.
    confidence : float
        How far the weakest criterion is from its limit: 0 at the limit and for ``none``, towards
        1 far from it. It is not a probability: docs/guide/vision.md has the error rates.
    markers : int
        How many markers agree with the pose.
    others : int
        How many were seen that do not.
    reprojection_px : float
        Root mean square error of their corners, pixels; NaN without a pose.
    deviation_deg : float
        Angle between the axis and that of a coin at rest on the nearest face, degrees; NaN without
        a pose.
    height_mm : float
        Height of the coin's centre above the table; NaN without a pose.
    reason : str
        Why it is not a face; empty for a face.
    pose : ndarray or None, shape (4, 4)
        From the frame of the coin to that of the table, mm.
    """

    shows: str
    confidence: float = 0.0
    markers: int = 0
    others: int = 0
    reprojection_px: float = float("nan")
    deviation_deg: float = float("nan")
    height_mm: float = float("nan")
    reason: str = ""
    pose: np.ndarray | None = None

    @property
    def face(self) -> str:
        """The face, or ``none``: a leaning coin shows none."""
        return self.shows if self.shows in FACES else "none"

    def document(self) -> dict[str, Any]:
        """Return it as what ``python -m coinmc.vision classify`` prints."""

        def number(value: float, digits: int) -> float | None:
            return None if np.isnan(value) else round(value, digits)

        return {
            "face": self.face,
            "shows": self.shows,
            "confidence": round(self.confidence, 3),
            "markers": self.markers,
            "others": self.others,
            "reprojection_px": number(self.reprojection_px, 3),
            "deviation_deg": number(self.deviation_deg, 2),
            "height_mm": number(self.height_mm, 2),
            "reason": self.reason,
        }


class Classifier:
    """Reads photos of one coin by one camera.

    Parameters
    ----------
    coin : MarkedCoin
        The coin.
    camera : Camera
        The camera, calibrated.
    """

    def __init__(self, coin: MarkedCoin, camera: Camera) -> None:
        self.coin = coin
        self.camera = camera
        self._detector = Detector(coin)

    def read(self, path: Path | str) -> Reading:
        """Read a photo in a file.

        Raises
        ------
        coinmc.VisionError
            If the file is not a photo of the camera's size.
        """
        return self.classify(read_photo(path, self.camera.size))

    def classify(self, grey: np.ndarray) -> Reading:
        """Read a photo: an array of uint8 of the camera's size.

        A photo that cannot be read as it is is looked at again in other ways. The first look that
        shows a face, or a leaning coin by several markers, decides.
        """
        seen: Sightings = {}
        reading = Reading("none", reason="no marker of the coin is seen")
        for look in looks(grey):
            more, twice = self._detector.find(grey, look())
            if twice:
                return Reading("none", others=len(more), reason="a marker is seen twice")
            # what earlier looks have seen stays: they see corners more sharply
            if more.keys() <= seen.keys():
                continue
            seen = more | seen
            reading = self._judge(seen)
            if reading.face != "none" or reading.shows == "leaning":
                break
        return reading

    def _judge(self, seen: Sightings) -> Reading:
        free = free_fit(self.coin, self.camera, seen)
        if free is None:
            return Reading("none", others=len(seen), reason="no marker gives a pose")
        if len(free.agreeing) < len(seen):
            free = self._at_rest(seen, free)
        others = len(seen) - len(free.agreeing)
        if len(free.agreeing) < MARKERS:
            reason = "only one marker is seen" if others == 0 else "no two markers agree"
            return self._told("none", free, others, reason=reason)
        if others >= len(free.agreeing):
            return self._told("none", free, others, reason="as many markers disagree as agree")
        return self._face(seen, free, others)

    def _at_rest(self, seen: Sightings, free: Fit) -> Fit:
        """Look for a coin at rest with which more markers agree.

        Where markers are hardly seen, a pose from one of them is too uncertain for the others to
        agree with. At rest it has three numbers instead of six.
        """
        for number in sorted(seen):
            alone = free_fit(self.coin, self.camera, {number: seen[number]})
            if alone is None:
                continue
            for face in FACES:
                rest = rest_fit(self.coin, self.camera, seen, alone, face)
                fit = vote(self.coin, self.camera, seen, rest.pose)
                if len(fit.agreeing) > len(free.agreeing):
                    free = refined(self.coin, self.camera, seen, fit)
        return free

    def _face(self, seen: Sightings, free: Fit, others: int) -> Reading:
        """Tell a coin at rest, which explains all corners, from a leaning one."""
        rests = {face: rest_fit(self.coin, self.camera, seen, free, face) for face in FACES}
        face = min(rests, key=lambda face: rests[face].rms_px)
        rest = rests[face]
        # flat markers have two poses that look alike: the one near the coin at rest is meant
        near = refined(self.coin, self.camera, seen, rest)
        if near.rms_px > 1.5 * free.rms_px + 0.2:
            near = free
        deviation = deviation_deg(face, near.pose)
        most_px = REST_PART * tolerance_px(self.coin, self.camera, rest.pose)
        if rest.rms_px > most_px or deviation > MOST_DEVIATION_DEG:
            reason = f"no coin at rest looks like this: {rest.rms_px:.1f} px off"
            if deviation > MOST_DEVIATION_DEG:
                reason = f"its axis is {deviation:.0f} degrees from that of a coin at rest"
            return self._told("leaning", near, others, reason=reason)
        margin = min(
            1.0 - rest.rms_px / most_px,
            1.0 - deviation / MOST_DEVIATION_DEG,
            1.0 - 0.5 ** (len(free.agreeing) - MARKERS + 1),
            1.0 - others / len(free.agreeing),
        )
        return self._told(face, near, others, confidence=margin, error_px=rest.rms_px)

    def _told(
        self,
        shows: str,
        fit: Fit,
        others: int,
        *,
        reason: str = "",
        confidence: float = 0.0,
        error_px: float | None = None,
    ) -> Reading:
        return Reading(
            shows,
            confidence,
            len(fit.agreeing),
            others,
            fit.rms_px if error_px is None else error_px,
            min(deviation_deg(face, fit.pose) for face in FACES),
            float(fit.pose[2, 3]),
            reason,
            fit.pose,
        )
