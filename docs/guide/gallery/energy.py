"""What the impacts and the sliding of that toss take from its energy.

python docs/guide/gallery/energy.py docs/guide/gallery/energy.png
"""

import sys

import coinmc
from coinmc import plot

toss = coinmc.trace("examples/hand.toml", toss=3, point=1)
ax = plot.energy(toss)

ax.figure.savefig(sys.argv[1], dpi=90)
