"""How well `coinmc check` forecasts: core-seconds of runs, over those that it told before.

    python benches/python/forecast.py --program target/release/coinmc

Examples with their points and tosses, and sweeps of 100 points. The forecast comes first, then the
run, on one thread; its processor time is what the operating system counted. Ratios above 1: the run
took longer than forecast. Runs shorter than a tenth of a second are shown, but not judged. Other
work on the machine changes the pace of a core between the two, so measure on an idle one.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

SWEEP = "{from = 0.1, to = 2.5, steps = 100}"
SURFACES = ("{from = 0, to = 0.9, steps = 10}", "{from = 0.05, to = 0.6, steps = 10}")
EXAMPLES = {
    "first": (),
    "clean": (),
    "hand": (),
    "drop": (),
    "robot": (),
    "precise": (),
    "adhesive": (),
    "flat-fair": (),
    "closed-forms": (),
    "own-launch": (),
    "table1": ("stop.tosses=500",),
    "rapier": ("stop.tosses=100",),
}
SWEEPS = {
    "clean over H/R": ("clean", f"coin.ratio={SWEEP}", "stop.tosses=20000"),
    "hand over H/R": ("hand", f"coin.ratio={SWEEP}", "stop.tosses=1000"),
    "drop over H/R": ("drop", f"coin.ratio={SWEEP}", "stop.tosses=1000"),
    "robot over H/R": ("robot", f"coin.ratio={SWEEP}", "stop.tosses=20000"),
    "flat over e and μ": (
        "flat-fair",
        "coin.ratio=1",
        f"surface.restitution={SURFACES[0]}",
        f"surface.friction={SURFACES[1]}",
        "stop.tosses=20000",
    ),
    "clean over e and μ": (
        "clean",
        "coin.ratio=0.5",
        f"surface.restitution={SURFACES[0]}",
        f"surface.friction={SURFACES[1]}",
        "stop.tosses=5000",
    ),
    "hand over e and μ": (
        "hand",
        "coin.ratio=0.7",
        f"surface.restitution={SURFACES[0]}",
        f"surface.friction={SURFACES[1]}",
        "stop.tosses=1000",
    ),
    "clean to a half width": ("clean", f"coin.ratio={SWEEP}", "stop={half_width=0.01}"),
}
#: Starting the program counts for much in less than this.
SHORT_S = 0.1


def forecast(program: Path, config: list[str]) -> tuple[float, bool]:
    """Return the core-seconds told, and whether the program calls itself unsure."""
    words = [program, "check", *config, "--format", "json"]
    told = subprocess.run(words, check=True, capture_output=True, text=True).stdout
    cost = json.loads(told)["cost"]
    return cost["core_s"], cost["unsure"]


def taken(program: Path, config: list[str], folder: str) -> float:
    """Return the processor time of the run."""
    words = [program, "run", *config, "--threads", "1", "--out", folder]
    child = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, used = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    # 3: the run ended at its limit before its targets
    if child.returncode not in (0, 3):
        raise SystemExit(f"exit status {child.returncode}: {words}")
    return used.ru_utime + used.ru_stime


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=Path, required=True)
    options = parser.parse_args()
    cases = {name: (name, *sets) for name, sets in EXAMPLES.items()} | SWEEPS
    worst = 1.0
    print("forecast, s  taken, s  taken/forecast")
    for title, (name, *sets) in cases.items():
        config = [f"examples/{name}.toml", *(word for one in sets for word in ("--set", one))]
        with tempfile.TemporaryDirectory() as folder:
            told, unsure = forecast(options.program, config)
            used = taken(options.program, config, f"{folder}/run")
        short = max(told, used) < SHORT_S
        ratio = used / told if told > 0 else float("nan")
        word = " (short)" * short + " (unsure)" * unsure
        print(f"{told:11.2f} {used:9.2f} {ratio:15.2f}  {title}{word}", flush=True)
        if not (short or unsure):
            worst = max(worst, ratio, 1 / ratio)
    print(f"{len(cases)} configs; worst factor of those not short or unsure: {worst:.2f}")
    sys.exit(worst > 1.5)


if __name__ == "__main__":
    main()
