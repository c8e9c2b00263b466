"""P(side) against H/R, with intervals, the rule without bounces, and the published fair ratio.

python docs/guide/gallery/probability.py docs/guide/gallery/probability.png
"""

import sys

import coinmc
from coinmc import plot

result = coinmc.estimate(
    "examples/flat-fair.toml",
    tosses=4000,
    overrides={"surface.restitution": [0.3, 0.7], "surface.friction": 0.3},
)
ax = plot.probability(result)

ax.figure.savefig(sys.argv[1], dpi=90)
