"""P(side) over H/R and restitution: the fair coin is a line, known to within the hatched cells.

python docs/guide/gallery/heat.py docs/guide/gallery/heat.png
"""

import sys

import coinmc
from coinmc import plot

sweep = {
    "paired": True,  # the same tosses at every point: smoother
    "coin.ratio": {"from": 0.5, "to": 2.5, "steps": 17},
    "surface.restitution": {"from": 0.0, "to": 0.9, "steps": 10},
}
result = coinmc.estimate("examples/first.toml", tosses=8000, overrides=sweep)
ax = plot.heat(result, x="ratio", y="restitution", face="side")

ax.figure.savefig(sys.argv[1], dpi=90)
