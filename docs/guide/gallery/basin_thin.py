"""The face of a thin coin that stays where it lands, over start angle and spin.

python docs/guide/gallery/basin_thin.py docs/guide/gallery/basin_thin.png
"""

import sys

from coinmc import plot

thin = {
    "coin": {"ratio": 0.3},
    "surface": {"restitution": 0.0, "friction": 0.3, "landing": "adhesive"},
    "launch": {"preset": "robot"},
    "engine": {"flat": {}},
    "stop": {"tosses": 1},
}
image, ax = plot.basin(thin, "tilt_deg", "wy_rad_s", (0, 180, 0, 60), shape=(512, 512))

ax.figure.savefig(sys.argv[1], dpi=90)
