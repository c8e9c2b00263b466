"""A toss in the plane: all of it, and its last bounces.

python docs/guide/gallery/path.py docs/guide/gallery/path.png
"""

import sys

from matplotlib import pyplot

import coinmc
from coinmc import plot

toss = coinmc.trace("examples/own-launch.toml", toss=3, overrides={"coin.ratio": 1.0})
figure, (left, right) = pyplot.subplots(
    1, 2, figsize=(9, 4.4), layout="constrained", width_ratios=[1, 2.2]
)
plot.path(toss, ax=left).get_legend().remove()
plot.path(toss, times=(0.48, 1.0), coins=18, ax=right)

figure.savefig(sys.argv[1], dpi=90)
