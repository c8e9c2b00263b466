"""Heads, tails and side at once: a hand's toss that begins heads up is not symmetric.

python docs/guide/gallery/ternary.py docs/guide/gallery/ternary.png
"""

import sys

import coinmc
from coinmc import plot

ratios = {"from": 0.2, "to": 2.0, "steps": 7}
result = coinmc.estimate("examples/hand.toml", tosses=1500, overrides={"coin.ratio": ratios})
ax = plot.ternary(result)

ax.figure.savefig(sys.argv[1], dpi=90)
