"""Ctrl-C stops long work at once, and nothing is lost."""

import signal
import subprocess
import sys
import time

import pytest

import coinmc

# s; the promise. A busy machine may hold up a process: the best of a few tries counts
PROMISED = 0.2
TRIES = 4

SCENE = {
    "coin": {"ratio": 1.2},
    "surface": {"restitution": 0.5, "friction": 0.3},
    "launch": {"preset": "robot"},
    "engine": {"flat": {}},
    "stop": {"tosses": 10**9},
}

WORK = {
    "toss": "coinmc.toss(SCENE, 10**8, faces_only=True)",
    "estimate": "coinmc.estimate(SCENE)",
    "run": "coinmc.run(SCENE, sys.argv[1])",
    "sensitivity": "coinmc.sensitivity(SCENE, ['coin.ratio'])",
    "in space": "coinmc.toss({**SCENE, 'engine': {'volumetric': {}}}, 10**7)",
}

PROGRAM = """
import signal, sys, time
import coinmc
# a shell that runs the tests in the background has them ignore it
signal.signal(signal.SIGINT, signal.default_int_handler)
SCENE = {scene!r}
print("begun", flush=True)
try:
    {work}
except KeyboardInterrupt:
    print(time.monotonic(), flush=True)
"""


def delay(work: str, *arguments: str) -> float:
    """Seconds from the signal until Python has the exception."""
    program = PROGRAM.format(scene=SCENE, work=work)
    words = [sys.executable, "-c", program, *arguments]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as child:
        assert child.stdout.readline() == "begun\n"
        time.sleep(0.5)
        sent = time.monotonic()
        child.send_signal(signal.SIGINT)
        heard = float(child.stdout.read())
    assert child.returncode == 0
    return heard - sent


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGINT to send")
@pytest.mark.parametrize("name", WORK)
def test_ctrl_c_acts_at_once(name, tmp_path):
    delays = []
    for attempt in range(TRIES):
        delays.append(delay(WORK[name], str(tmp_path / f"run-{attempt}")))
        if delays[-1] < PROMISED:
            break
    assert min(delays) < PROMISED, delays


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGINT to send")
def test_an_interrupted_run_keeps_its_counts(tmp_path):
    delay(WORK["run"], str(tmp_path / "run"))
    part = coinmc.open(tmp_path / "run")
    assert part.status == "interrupted"
    assert (tmp_path / "run" / "results.partial.csv").exists()


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGINT to send")
def test_ctrl_c_abandons_a_fit(root):
    """A fit cannot be told to stop: Python does not wait for it."""
    work = (
        "from coinmc import film; "
        f"drop = film.read({str(root / 'examples' / 'drop-film.txt')!r}); "
        "film.fit([drop] * 12, ratio=1, radius_m=0.01, bounces=20)"
    )
    assert min(delay(work) for _ in range(2)) < PROMISED
