"""What the two laws leave over of a drop on film: the first describes it, the second does not.

python docs/guide/gallery/residuals.py docs/guide/gallery/residuals.png
"""

import sys

from matplotlib import pyplot

import coinmc
from coinmc import plot

drop = coinmc.film.read("examples/drop-film.txt")
best = coinmc.film.fit(drop, ratio=1.0, radius_m=0.01)
figure, axes = pyplot.subplots(1, 2, figsize=(9, 3.8), layout="constrained", sharey=True)
for fit, ax in zip(best.all, axes, strict=True):
    plot.residuals(fit, ax=ax).set_title(fit.law)

figure.savefig(sys.argv[1], dpi=90)
