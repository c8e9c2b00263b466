"""Tosses the same launches with coinmc and with whatever peers are installed, in one run.

    python studies/peers/run.py examples/clean.toml --ratio 0.85 --seconds 20 > peers.jsonl

One JSON line an engine and time step goes to standard output as it is measured, a table of ratios
and of the time to reach an error to standard error at the end. Every engine runs on one core, and
time is processor time of the tosses alone. See README.md beside this file.
"""

from __future__ import annotations

import argparse
import itertools
import json
import sys
import time
from dataclasses import asdict, dataclass
from pathlib import Path

import engines
import numpy as np
import scene as scenes
from decide import FACES, follow
from errors import picture, table

import coinmc

# coinmc's tolerances: its defaults, as multiples of which it is measured.
TOLERANCES = {
    "volumetric": {"tolerance": 2e-4, "zeno": 2e-2, "stick_speed": 1e-2, "smoothing_time": 1e-2},
    "flat": {"tolerance": 1e-6, "zeno": 1e-2},
}
TENFOLD = (1.0, 0.1, 0.01)


@dataclass
class Row:
    """What one engine made of the launches at one step; the JSON lines have these names."""

    engine: str
    version: str
    scene: str
    ratio: float
    step_s: float | None
    tosses: int
    heads: int
    tails: int
    side: int
    undecided: int
    seconds: float
    tosses_per_s: float
    p_side: float
    p_side_error: float
    coins: int | None = None
    bias: float | None = None
    bias_error: float | None = None


def row(engine, version, args, step, codes, seconds, **more) -> Row:
    """Counts and rate of one measurement; errors are standard errors."""
    counts = {face: int(np.count_nonzero(codes == code)) for code, face in enumerate(FACES)}
    tosses = len(codes)
    p = counts["side"] / tosses
    return Row(
        engine=engine,
        version=version,
        scene=args.config.stem,
        ratio=args.ratio,
        step_s=step,
        tosses=tosses,
        **counts,
        undecided=tosses - sum(counts.values()),
        seconds=seconds,
        tosses_per_s=tosses / seconds,
        p_side=p,
        # add one toss of either kind: nothing is certain of a share that was 0
        p_side_error=float(np.sqrt((p * (1 - p) + 1 / tosses) / tosses)),
        **more,
    )


def ours(args, config: dict, launches: np.ndarray) -> list[Row]:
    """coinmc's event-driven engine of the config, by default and with a tenth of its tolerances.

    The bias of either is its difference from the same tosses done another ten times as tightly.
    """
    (engine,) = config["engine"]
    tossed = []
    for share in TENFOLD:
        settings = {
            f"engine.{engine}.{key}": share * value for key, value in TOLERANCES[engine].items()
        }
        begun = time.process_time()
        codes = coinmc.toss(
            config, launches=launches, threads=1, overrides=settings, faces_only=True
        )
        tossed.append((share, codes, time.process_time() - begun))
    rows = []
    side = FACES.index("side")
    for (share, codes, seconds), (_, reference, _) in itertools.pairwise(tossed):
        difference = (codes == side).astype(float) - (reference == side)
        name = f"coinmc {engine}" + (", tight" if share < 1.0 else "")
        rows.append(
            row(
                name,
                f"coinmc {coinmc.__version__}",
                args,
                None,
                codes,
                seconds,
                bias=float(difference.mean()),
                bias_error=float(difference.std() / np.sqrt(len(difference))),
            )
        )
        show(rows[-1])
    return rows


def peer(args, name: str, scene: scenes.Scene, launches: list[scenes.Launch]) -> list[Row]:
    """One peer at each of its steps, as many tosses as the time for each allows."""
    module = engines.load(name)
    if module is None:
        print(f"{name}: not installed", file=sys.stderr)
        return []
    rows = []
    version = engines.version(module)
    coins = max(1, min(args.coins or module.COINS, len(launches)))
    for step in module.STEPS:
        world = module.World(scene, step, coins)
        tossed = follow(scene, step, world, launches, args.seconds)
        measured = row(module.NAME, version, args, step, tossed.faces, tossed.seconds, coins=coins)
        rows.append(measured)
        show(measured)
    return rows


def show(found: Row) -> None:
    """A row as a JSON line."""
    print(json.dumps(asdict(found)), flush=True)


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("config", type=Path, help="a config without drag, as examples/clean.toml")
    parser.add_argument("--ratio", type=float, default=0.85, help="H/R [0.85]")
    parser.add_argument("--tosses", type=int, default=100_000, help="launches at most [100000]")
    parser.add_argument("--seconds", type=float, default=20.0, help="for each peer and step [20]")
    parser.add_argument(
        "--peers", nargs="*", default=list(engines.MODULES), help="which [all that are installed]"
    )
    parser.add_argument("--coins", type=int, help="in one world [what makes each peer fastest]")
    parser.add_argument("--plot", type=Path, help="draw run time against error to this file")
    return parser.parse_args()


def main() -> None:
    args = arguments()
    scene, config = scenes.read(args.config, args.ratio)
    in_plane = "flat" in config["engine"]
    launches = coinmc.launches(config, args.tosses)
    rows = ours(args, config, launches)
    flown = [scenes.fallen(launch, scene) for launch in scenes.scaled(launches, scene)]
    for name in args.peers:
        module = engines.load(name)
        if module is None or module.in_plane == in_plane:
            rows += peer(args, name, scene, flown)
    found = [asdict(one) for one in rows]
    print(table(found), file=sys.stderr)
    if args.plot:
        picture(found, args.plot)


if __name__ == "__main__":
    main()
