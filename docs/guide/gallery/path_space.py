"""A toss in space: from the first bounce to the end, where it slides.

python docs/guide/gallery/path_space.py docs/guide/gallery/path_space.png
"""

import sys

import coinmc
from coinmc import plot

toss = coinmc.trace("examples/hand.toml", toss=3, point=1)
ax = plot.path(toss, view="space", times=(1.3, 3.0), coins=24)

ax.figure.savefig(sys.argv[1], dpi=90)
