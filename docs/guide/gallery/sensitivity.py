"""What P(side) of a bouncing coin depends on.

python docs/guide/gallery/sensitivity.py docs/guide/gallery/sensitivity.png
"""

import sys

import coinmc
from coinmc import plot

table = coinmc.sensitivity("examples/first.toml", overrides={"coin.ratio": 1.5}, tosses=40_000)
ax = plot.sensitivity(table)

ax.figure.savefig(sys.argv[1], dpi=90)
