"""A long day of the simulated robot with rendered photos and faults, audited against the truth.

    python benches/python/robot_day.py --program target/release/coinmc --folder DIR [--throws 2000]

The robot's line is noisy, it is reset, unplugged and gets stuck; half of the photos are bad, in
some the coin still moves; the host is killed again and again. Afterwards every throw must be in the
journal once, have been released at most once, and be read as it fell or be void. Frequencies are
compared with the engine's probability. Started again, it continues. Needs coinmc[vision].
"""

import argparse
import json
import math
import shutil
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path

import coinmc
from coinmc import experiment

ROOT = Path(__file__).resolve().parents[2]
FAULTS = ["--noise", "0.002", "--stuck", "0.005", "--seed", "26"]
PHOTOS = ["--hard", "0.5", "--moving", "0.05", "--seed", "26"]
#: After every so many throws one of these happens, in turn.
EVERY = 25
MISHAPS = ("reset", "kill", "unplug")
#: A busy machine takes its time.
PATIENCE_S = "55"
#: Tosses for the engine's probability: its error is a tenth of that of the day.
TOSSES = 200_000


def camera() -> str:
    """Return the command of the camera."""
    serve = [sys.executable, "-m", "coinmc.vision", "serve", "--camera", "synthetic"]
    serve += ["--coin", "sheet/coin.json", "--calibration", "rendered/camera.json"]
    return "exec " + " ".join([*serve, "--truth", "truth.jsonl", *PHOTOS])


def prepare(folder: Path) -> None:
    """Make the sheet, the camera's file and the config."""
    if (folder / "rendered" / "camera.json").exists():
        return
    folder.mkdir(parents=True)
    shutil.copy(ROOT / "examples" / "robot.toml", folder)
    vision = [sys.executable, "-m", "coinmc.vision"]
    sheet = ["sheet", "--radius-mm", "12.5", "--ratio", "1.5", "--out", "sheet"]
    render = ["synthetic", "--coin", "sheet/coin.json", "--photos", "1", "--out", "rendered"]
    for words in (sheet, render):
        subprocess.run([*vision, *words], cwd=folder, check=True, stdout=subprocess.DEVNULL)


def resolved(folder: Path) -> int:
    """Return how many throws the journal has resolved."""
    journal = folder / "day" / "journal.txt"
    if not journal.exists():
        return 0
    return sum(line.startswith(("D", "V")) for line in journal.read_text().splitlines())


def throw(program: Path, folder: Path, throws: int) -> int:
    """Throw until all throws are resolved; return the number of mishaps."""
    stop = ["--set", f"stop.tosses={throws}"]
    sim = [program, "robot", "sim", "robot.toml", *stop, "--name", "port", "--truth", "truth.jsonl"]
    more = ["--memory", "memory", "--speed", "200", *FAULTS]
    quiet = ["--quiet", "--max-voids", "20", "--camera-timeout", PATIENCE_S]
    first = [program, "robot", "run", "robot.toml", *stop, "--out", "day", "--port", "port"]
    first += ["--speed", "200", "--camera", camera(), *quiet]
    again = [program, "robot", "resume", "day", "--camera", camera(), *quiet]
    pipe = subprocess.PIPE
    with subprocess.Popen([*sim, *more], cwd=folder, stdin=pipe, stdout=pipe, text=True) as robot:
        robot.stdout.readline()
        started = (folder / "day" / "journal.txt").exists()
        words = again if started else first
        host = subprocess.Popen(words, cwd=folder, stdin=subprocess.DEVNULL)
        mishaps = resolved(folder) // EVERY
        while host.poll() is None:
            time.sleep(0.05)
            if resolved(folder) < (mishaps + 1) * EVERY:
                continue
            mishap = MISHAPS[mishaps % len(MISHAPS)]
            mishaps += 1
            if mishap == "kill":
                host.kill()
                host.wait()
                host = subprocess.Popen(again, cwd=folder, stdin=subprocess.DEVNULL)
            else:
                robot.stdin.write(f"{mishap}\n")
                robot.stdin.flush()
        robot.kill()
    if host.returncode != 0:
        raise SystemExit(f"the host ended with {host.returncode}")
    return mishaps


def audit(folder: Path, throws: int) -> bool:
    """Print what became of the throws; return whether all is well."""
    day = experiment.open(folder / "day")
    lines = (folder / "truth.jsonl").read_text().splitlines()
    truth = [json.loads(line) for line in lines]
    released = Counter(entry["throw_id"] for entry in truth)
    fell = {entry["throw_id"]: entry["face"] for entry in truth}
    done = day["void"] == ""
    read = list(zip(day["id"][done].astype(int).tolist(), day["face"][done], strict=True))
    wrong = [number for number, face in read if fell.get(number) != face]
    lost = throws - len(set(day["id"].astype(int)) & set(range(1, throws + 1)))
    doubled = [number for number, times in released.items() if times > 1]
    print(f"{len(day)} throws, {len(read)} read, void: {day.voids}")
    print(f"lost: {lost}, doubled: {len(doubled)}, wrong faces: {len(wrong)}")
    print(f"photos: {int(day['photos'].sum())}, changed: {len(day.check_photos())}")
    model = coinmc.estimate(day.config, tosses=TOSSES)
    within, seen = True, day.estimate()
    for face in ("heads", "tails", "side"):
        p, count = float(model[f"p_{face}"][0]), day.counts[face]
        sigmas = (count / len(read) - p) / math.sqrt(p * (1.0 - p) / len(read))
        within &= abs(sigmas) < 3.0
        told = f"[{seen[face].lo:.4f}, {seen[face].hi:.4f}]"
        print(f"P({face}): {count / len(read):.4f} of those read, {told} with the void ones; "
              f"engine {p:.4f}, {sigmas:+.2f} sigma")  # fmt: skip
    return not (lost or doubled or wrong) and within


def main() -> int:
    """Throw, audit, and write a page."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--program", type=Path, required=True)
    arguments.add_argument("--folder", type=Path, required=True)
    arguments.add_argument("--throws", type=int, default=2000)
    given = arguments.parse_args()
    prepare(given.folder)
    begun = time.monotonic()
    mishaps = throw(given.program.resolve(), given.folder, given.throws)
    print(f"{time.monotonic() - begun:.0f} s, {mishaps} times {', '.join(MISHAPS)} in turn")
    well = audit(given.folder, given.throws)
    experiment.open(given.folder / "day").page(given.folder / "day.html")
    return 0 if well else 1


if __name__ == "__main__":
    sys.exit(main())
