"""Photos of a coin that carries markers: which face is up?

* `MarkedCoin`: the coin and its markers; `print_sheets` prints them at true scale;
* `calibrate`: the camera, from photos of the board;
* `Classifier`: reads photos: heads, tails, side, leaning or none;
* `synthetic`: rendered photos.

``python -m coinmc.vision`` does the same from the command line, and serves as the camera of
``coinmc robot``. It needs the extra ``coinmc[vision]``: OpenCV, Pillow and matplotlib. The guide is
docs/guide/vision.md.
"""

from coinmc.vision._board import Board
from coinmc.vision._calibrate import calibrate
from coinmc.vision._camera import Camera
from coinmc.vision._classify import Classifier, Reading
from coinmc.vision._coin import MarkedCoin, Marker
from coinmc.vision._photo import read_photo
from coinmc.vision._sheet import print_sheets

__all__ = [
    "Board",
    "Camera",
    "Classifier",
    "MarkedCoin",
    "Marker",
    "Reading",
    "calibrate",
    "print_sheets",
    "read_photo",
]
