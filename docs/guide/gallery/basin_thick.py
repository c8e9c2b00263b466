"""The same map of a thick coin that bounces: every impact folds the basins once more.

python docs/guide/gallery/basin_thick.py docs/guide/gallery/basin_thick.png
"""

import sys

from coinmc import plot

image, ax = plot.basin(
    "examples/first.toml",
    "tilt_deg",
    "wy_rad_s",
    (0, 60, 0, 12),
    shape=(512, 512),
    overrides={"coin.ratio": 1.5, "surface.restitution": 0.3},
)

ax.figure.savefig(sys.argv[1], dpi=90)
