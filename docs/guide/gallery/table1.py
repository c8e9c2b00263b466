"""All three faces in space, beside the counts that were published for the same scene.

python docs/guide/gallery/table1.py docs/guide/gallery/table1.png
"""

import sys

import coinmc
from coinmc import plot

ratios = [0.03125, 0.1, 0.25, 0.5, 1.0, 2.0, 3.5, 5.0]
result = coinmc.estimate("examples/table1.toml", tosses=800, overrides={"coin.ratio": ratios})
ax = plot.probability(result, faces=["heads", "side"])
ax.set_xscale("log")

ax.figure.savefig(sys.argv[1], dpi=90)
