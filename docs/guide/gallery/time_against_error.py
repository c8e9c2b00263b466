"""Impact by impact against step by step: time buys one engine accuracy, the other precision.

The error of an estimate is how far the further end of its interval lies from a reference, made of
many more tosses of the event-driven engine.

python docs/guide/gallery/time_against_error.py docs/guide/gallery/time_against_error.png
"""

import sys
from time import perf_counter

import coinmc
from coinmc import plot

rows = {"engine": [], "time_s": [], "total_error": []}
scene = coinmc.Config("examples/clean.toml", {"coin.ratio": 1})
[true] = coinmc.estimate(scene, tosses=100_000)["p_side"]
for engine, settings, counts in [
    ("event-driven", {"volumetric": {}}, [300, 3000, 30_000]),
    ("steps of 5 ms", {"rapier": {"step_s": 5e-3}}, [30, 300, 3000]),
]:
    for tosses in counts:
        begin = perf_counter()
        result = coinmc.estimate(scene, tosses=tosses, threads=1, overrides={"engine": settings})
        rows["time_s"].append(perf_counter() - begin)
        ends = result["p_side_lo"][0], result["p_side_hi"][0]
        rows["total_error"].append(max(abs(end - true) for end in ends))
        rows["engine"].append(engine)
ax = plot.time_against_error(rows, by="engine")

ax.figure.savefig(sys.argv[1], dpi=90)
