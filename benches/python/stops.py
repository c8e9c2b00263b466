"""What a stop costs: a point of 1e10 tosses, stopped at random seconds by three signals.

    python benches/python/stops.py --program target/release/coinmc --folder DIR [--stops 100]

SIGINT, SIGTERM and SIGKILL in turn. Two scenes, a fast one in the plane and a slow one by hand on
wood, each one run that every process goes on with. The tosses that a process has added to what is
stored are compared with its processor time. What is missing of the fastest rate is called lost:
start-up and noise included, so it is an upper bound. Counts must never fall. Started again in the
same folder, it goes on with the runs.
"""

import argparse
import json
import os
import random
import signal
import subprocess
import sys
import time
from collections import defaultdict
from pathlib import Path

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGKILL)
SCENES = {
    "flat": "[surface]\nrestitution = 0.5\nfriction = 0.3\n"
    "[launch]\npreset = 'robot'\n[engine.flat]\n",
    "hand": "[surface]\nmaterial = 'wood'\n[launch]\npreset = 'hand'\n[engine.volumetric]\n",
}
#: Seconds after which a process is stopped.
LEAST_S, MOST_S = 1.0, 20.0


def config(scene: str) -> str:
    """Return the text of a scene's config."""
    return f"seed = 27\n[coin]\nratio = 1.0\n{SCENES[scene]}[stop]\ntosses = 10_000_000_000\n"


def stored(program: Path, run: Path) -> int:
    """Return the tosses that a run directory holds."""
    words = [program, "status", run, "--format", "json"]
    told = subprocess.run(words, check=True, capture_output=True, text=True).stdout
    return json.loads(told)["runs"][0]["tosses"]


def stop(program: Path, folder: Path, scene: str, how: signal.Signals, after_s: float):
    """Toss for so long and stop; return the tosses gained, processor time and clock time."""
    toml, run = folder / f"{scene}.toml", folder / scene
    toml.write_text(config(scene))
    before = stored(program, run) if run.exists() else 0
    words = [program, "run", toml, "--out", run, "--threads", "1"]
    begun = time.monotonic()
    child = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    time.sleep(after_s)
    child.send_signal(how)
    clock = time.monotonic() - begun
    _, status, used = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    expected = 130 if how != signal.SIGKILL else -signal.SIGKILL
    if child.returncode != expected:
        raise SystemExit(f"{scene}: exit status {child.returncode} after {how.name}")
    gained = stored(program, run) - before
    if gained < 0:
        raise SystemExit(f"{scene}: {-gained} tosses vanished after {how.name}")
    return gained, used.ru_utime + used.ru_stime, clock


def main() -> None:
    """Stop, and print what was lost."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--program", type=Path, required=True)
    arguments.add_argument("--folder", type=Path, required=True)
    arguments.add_argument("--stops", type=int, default=100)
    arguments.add_argument("--seed", type=int, default=27)
    given = arguments.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    program, draw = given.program.resolve(), random.Random(given.seed)
    seen = defaultdict(list)
    for number in range(given.stops):
        scene, how = list(SCENES)[number // 3 % 2], SIGNALS[number % 3]
        after_s = draw.uniform(LEAST_S, MOST_S)
        gained, used, clock = stop(program, given.folder, scene, how, after_s)
        seen[scene].append((how.name, gained, used, clock))
        rate = max(gained / used for _, gained, used, _ in seen[scene])
        lost = used - gained / rate
        print(
            f"{scene} {how.name} after {clock:.1f} s: {gained} tosses, {lost:.2f} s lost",
            flush=True,
        )
    for scene, stops in seen.items():
        rate = max(gained / used for _, gained, used, _ in stops)
        for how in SIGNALS:
            lost = [used - gained / rate for name, gained, used, _ in stops if name == how.name]
            if lost:
                mean = sum(lost) / len(lost)
                print(
                    f"{scene}, {how.name}: {len(lost)} stops, at most {max(lost):.2f} s of tossing "
                    f"lost, {mean:.2f} s on average, at {rate:.0f} tosses/s"
                )
    worst = max(
        used - gained / max(g / u for _, g, u, _ in stops)
        for stops in seen.values()
        for _, gained, used, _ in stops
    )
    if worst > 10.0:
        sys.exit(f"{worst:.1f} s of tossing were lost")


if __name__ == "__main__":
    main()
