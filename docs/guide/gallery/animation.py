"""A toss, slowed down twice.

python docs/guide/gallery/animation.py docs/guide/gallery/animation.gif
"""

import sys

import coinmc
from coinmc import plot

toss = coinmc.trace("examples/own-launch.toml", toss=3, overrides={"coin.ratio": 1.0})
film = plot.animation(toss, sys.argv[1], slow=2, fps=12, dpi=60, follow=True, overwrite=True)
