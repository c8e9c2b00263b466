"""Error rates and speed of the classifier of photos, on a held-out set of rendered ones.

    python benches/python/vision.py --out FILE [--set held-out] [--part 1]

The set is fixed by its seed, and was first rendered when the settings of python/coinmc/vision had
been fixed, on the set `tuning`, whose seed is another. Every finished batch of photos, all by one
camera, is a line of FILE; started again, the command continues. The table is printed at the end.
Times are those of the processor, in one thread. Needs coinmc[vision].
"""

import argparse
import json
import math
import time
from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np

from coinmc.vision import Classifier, MarkedCoin
from coinmc.vision.synthetic import (
    Effects,
    Ends,
    SyntheticCamera,
    drawn_camera,
    jpeg,
    miscalibrated,
)

SEEDS = {"held-out": 2026_11_24, "tuning": 1}
RATIOS = (0.1, 0.2, 0.354, 0.577, 1.0, 1.5)
RADIUS_MM = 25.0
#: Photos by one camera.
BATCH = 25
#: Batches of each ratio: coins at rest in good and in bad photos, traps in bad ones; and coins of
#: few tosses, at rest on their side. Faces of the first three are as tosses give them.
BATCHES = {"easy": 32, "hard": 28, "traps": 8, "sides": 2}
#: The highest ratio of which sides are photographed apart.
THIN = 0.4
#: In a bad photo a coin at rest touches a wall this often.
WALLS = 0.2


def batches(part: float) -> Iterator[tuple[int, str, int]]:
    """Name all batches: index of the ratio, kind, number."""
    for kind, count in BATCHES.items():
        for number in range(math.ceil(count * part)):
            for index, ratio in enumerate(RATIOS):
                if kind != "sides" or ratio < THIN:
                    yield index, kind, number


def measure(seed: int, index: int, kind: str, number: int) -> list[dict]:
    """Render and read the photos of a batch."""
    rng = np.random.default_rng([seed, index, list(BATCHES).index(kind), number])
    height = RADIUS_MM * RATIOS[index]
    coin = MarkedCoin.of(RADIUS_MM, RATIOS[index])
    ends = Ends(RADIUS_MM, height, seed=int(rng.integers(1 << 31)), tosses=400)
    hard = kind in ("hard", "traps")
    camera = drawn_camera(RADIUS_MM, rng, hard)
    renderer = SyntheticCamera(coin, camera, int(rng.integers(1 << 31)))
    classifier = Classifier(coin, miscalibrated(camera, rng))
    rows = []
    for place in range(BATCH):
        if kind == "traps":
            scene = ends.trap(rng, renderer.direction_rad)
        elif kind == "sides":
            scene = ends.lying("side", rng)
        else:
            scene = ends.rest(place, rng)
            if hard and rng.random() < WALLS:
                scene = ends.walled(scene, rng, renderer.direction_rad)
        effects = Effects.drawn(rng, hard)
        begun = time.process_time()
        photo = renderer.photo(scene, effects, rng)
        photo = cv2.imdecode(np.frombuffer(jpeg(photo, effects.quality), np.uint8), 0)
        rendered = time.process_time()
        reading = classifier.classify(photo)
        read = time.process_time()
        row = {
            "truth": scene.truth,
            "kind": scene.kind,
            "shows": reading.shows,
            "markers": reading.markers,
            "confidence": round(reading.confidence, 3),
            "rendered_ms": round(1e3 * (rendered - begun), 2),
            "read_ms": round(1e3 * (read - rendered), 2),
        }
        if reading.face != "none" and scene.pose is not None:
            off = reading.pose[:3, 3] - scene.pose[:3, 3]
            along = float(np.clip(reading.pose[:3, 2] @ scene.pose[:3, 2], -1.0, 1.0))
            row["error_mm"] = round(float(np.linalg.norm(off)), 3)
            row["error_deg"] = round(math.degrees(math.acos(along)), 3)
        rows.append(row)
    return rows


def wrong(row: dict) -> bool:
    """Whether a photo was read as a face that it does not show."""
    return row["shows"] in ("heads", "tails", "side") and row["shows"] != row["truth"]


def upper(events: int, n: int) -> float:
    """Upper end of the one-sided 95 % interval of Clopper and Pearson."""
    low, high = events / n, 1.0
    for _ in range(60):
        p = 0.5 * (low + high)
        terms = (math.comb(n, k) * p**k * (1.0 - p) ** (n - k) for k in range(events + 1))
        low, high = (p, high) if sum(terms) > 0.05 else (low, p)
    return high


def show(rows: list[dict]) -> None:
    """Print the rates."""
    errors = [row for row in rows if wrong(row)]
    print(f"{len(rows)} photos, wrong faces: {len(errors)}", end="")
    print(f" (95 % upper bound {upper(len(errors), len(rows)):.2g})")
    for row in errors:
        print("  ", {key: row[key] for key in ("ratio", "batch", "kind", "truth", "shows")})
    print(f"{'':10}" + "".join(f"{ratio:>14g}" for ratio in RATIOS))
    for kind in ("easy", "hard", "sides"):
        cells = []
        for ratio in (*RATIOS, None):
            here = [r for r in rows if r["batch"] == kind and ratio in (None, r["ratio"])]
            unread = sum(row["shows"] not in ("heads", "tails", "side") for row in here)
            cells.append(f"{unread}/{len(here)}" if here else "-")
        print(f"{'unread':7}{kind:5}" + "".join(f"{cell:>13}" for cell in cells))
    for name in ("read_ms", "rendered_ms", "error_mm", "error_deg"):
        values = np.array([row[name] for row in rows if name in row])
        told = f"mean {values.mean():.3g}, median {np.median(values):.3g}"
        print(f"{name}: {told}, p95 {np.quantile(values, 0.95):.3g}, max {values.max():.3g}")
    for kind in sorted({row["kind"] for row in rows if row["batch"] == "traps"}):
        here = [row for row in rows if row["kind"] == kind and row["batch"] == "traps"]
        told = {s: sum(r["shows"] == s for r in here) for s in sorted({r["shows"] for r in here})}
        print(f"trap {kind}: {told}")


def main() -> None:
    """Render, read and print."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--out", type=Path, required=True)
    arguments.add_argument("--set", choices=SEEDS, default="held-out")
    arguments.add_argument(
        "--part", type=float, default=1.0, help="part of the set, from its begin"
    )
    given = arguments.parse_args()
    cv2.setNumThreads(1)
    lines = given.out.read_text().splitlines() if given.out.exists() else []
    done = [json.loads(line) for line in lines]
    finished = {(line["set"], line["index"], line["batch"], line["number"]) for line in done}
    with given.out.open("a") as file:
        for index, kind, number in batches(given.part):
            if (given.set, index, kind, number) in finished:
                continue
            rows = measure(SEEDS[given.set], index, kind, number)
            line = {"set": given.set, "index": index, "batch": kind, "number": number, "rows": rows}
            file.write(json.dumps(line) + "\n")
            file.flush()
            done.append(line)
    show(
        [
            {"ratio": RATIOS[line["index"]], "batch": line["batch"], **row}
            for line in done
            if line["set"] == given.set
            for row in line["rows"]
        ]
    )


if __name__ == "__main__":
    main()
