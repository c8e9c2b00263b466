"""What Python costs: estimates against the program, arrays against their size, basins, Ctrl-C.

    python benches/python/overhead.py [--tosses 1e7] [--rounds 3] [--program target/release/coinmc]

Needs the installed wheel. Program and wheel take turns, so that a busy machine troubles both alike;
the time compared is that of the processor, the least of all rounds.
"""

import argparse
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from importlib.metadata import distribution
from pathlib import Path

import numpy as np

import coinmc

ROOT = Path(__file__).resolve().parents[2]
SCENE = ROOT / "examples" / "first.toml"
PIXELS = 2048


def main() -> None:
    """Measure everything and print a line each."""
    arguments = parsed()
    tosses = int(arguments.tosses)
    package()
    estimates(tosses, arguments.rounds, arguments.program)
    arrays(tosses)
    basins(arguments.rounds)
    interrupts(arguments.rounds)


def parsed() -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--tosses", type=float, default=1e7)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--program", type=Path, default=ROOT / "target" / "release" / "coinmc")
    return parser.parse_args()


def package() -> None:
    """Size of what is installed, and time of the import."""
    files = distribution("coinmc").files or []
    size = sum(Path(str(file.locate())).stat().st_size for file in files)
    print(f"installed                     {size / 1e6:.1f} MB")
    for module in ("numpy", "coinmc"):
        clock = "time.perf_counter()"
        program = f"import time; t = {clock}; import {module}; print({clock} - t)"
        times = [float(subprocess.check_output([sys.executable, "-c", program])) for _ in range(10)]
        print(f"import {module:<22} {1e3 * min(times):.0f} ms")


def estimates(tosses: int, rounds: int, program: Path) -> None:
    """An estimate in Python against `coinmc run`, in turns."""
    config = coinmc.Config(SCENE, {"coin.ratio": 1.0, "stop": {"tosses": tosses}})
    ours, theirs = [], []
    for _ in range(rounds):
        ours.append(spent(coinmc.estimate, config))
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "toss.toml"
            path.write_text(config.resolved)
            words = [program, "run", path, "--out", Path(folder) / "run", "--quiet"]
            theirs.append(spent(subprocess.check_output, words))
    ours, theirs = np.min(ours, axis=0), np.min(theirs, axis=0)
    print(f"estimate, {tosses:.0e} tosses      {ours[0]:.2f} s, {ours[1]:.2f} s of processor")
    print(f"coinmc run                    {theirs[0]:.2f} s, {theirs[1]:.2f} s of processor")
    print(f"overhead                      {100 * (ours[1] / theirs[1] - 1):+.1f} % of processor")


def arrays(tosses: int) -> None:
    """All columns of many tosses, and their memory. In a process of its own: a peak stays."""
    program = f"""
import resource, time, coinmc
config = coinmc.Config({str(SCENE)!r}, {{"coin.ratio": 1.0}})
coinmc.toss(config, 1000)
peak = lambda: 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
before, begun = peak(), time.perf_counter()
tosses = coinmc.toss(config, {tosses})
taken = time.perf_counter() - begun
columns = (tosses.face, tosses.ended, tosses.impacts, tosses.time_s, tosses.final)
size = sum(column.nbytes for column in columns)
print(taken, peak() - before, size)
"""
    taken, peak, size = map(float, subprocess.check_output([sys.executable, "-c", program]).split())
    print(f"toss, {tosses:.0e} tosses          {taken:.2f} s, arrays {size / 1e6:.0f} MB")
    print(f"peak of memory                {peak / 1e6:.0f} MB, {peak / size:.3f} of the arrays")


def basins(rounds: int) -> None:
    """Launches of one's own: the faces of four million."""
    for name, overrides in (
        ("thin, adhesive", {"coin.ratio": 0.1, "surface.landing": "adhesive"}),
        ("thin, e = 0", {"coin.ratio": 0.1, "surface.restitution": 0.0}),
        ("thick, e = 0.5", {"coin.ratio": 1.0}),
    ):
        config = coinmc.Config(SCENE, overrides)
        launches = np.repeat(coinmc.launches(config, 1), PIXELS * PIXELS)
        tilt = np.repeat(np.linspace(0, np.pi, PIXELS), PIXELS)
        launches["axis"] = np.stack([np.sin(tilt), np.zeros_like(tilt), np.cos(tilt)], axis=1)
        launches["spin_rad_s"][:, 1] = np.tile(np.linspace(0, 30, PIXELS), PIXELS)
        keywords = {"launches": launches, "faces_only": True}
        times = [spent(coinmc.toss, config, **keywords) for _ in range(rounds)]
        wall, processor = np.min(times, axis=0)
        print(f"basin {PIXELS}², {name:<17} {wall:.2f} s, {processor:.2f} s of processor")


def interrupts(rounds: int) -> None:
    """From Ctrl-C to the exception."""
    program = f"""
import signal, time, coinmc
# a shell that runs things in the background has them ignore it
signal.signal(signal.SIGINT, signal.default_int_handler)
print(flush=True)
try:
    coinmc.estimate({str(SCENE)!r}, tosses=10**10)
except KeyboardInterrupt:
    print(time.monotonic())
"""
    delays = []
    for _ in range(4 * rounds):
        words = [sys.executable, "-c", program]
        with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as child:
            child.stdout.readline()
            time.sleep(0.4)
            sent = time.monotonic()
            child.send_signal(signal.SIGINT)
            delays.append(float(child.stdout.read()) - sent)
    typical, longest = 1e3 * np.median(delays), 1e3 * max(delays)
    print(f"Ctrl-C                        {typical:.0f} ms, longest {longest:.0f} ms")


def spent(
    work: Callable[..., object], *arguments: object, **keywords: object
) -> tuple[float, float]:
    """Seconds by the clock and of the processor, child processes included."""

    def processor() -> float:
        times = os.times()
        return times.user + times.system + times.children_user + times.children_system

    clock, before = time.perf_counter(), processor()
    work(*arguments, **keywords)
    return time.perf_counter() - clock, processor() - before


if __name__ == "__main__":
    main()
