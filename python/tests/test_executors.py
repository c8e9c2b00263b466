"""Runs whose chunks other processes compute end in the bytes of a local run."""

import os
import pickle
import signal
import subprocess
import sys
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import pytest

import coinmc
from coinmc import _executors, _lib

#: 12 chunks; and some hundred stages, of which each decides the next.
STOPS = {"fixed": {"tosses": 40_000}, "adaptive": {"half_width": 0.006}}


#: Who made a run, and in what time: not the same when it is made again.
PROVENANCE = "provenance.jsonl"


def config_of(scene, stop):
    return coinmc.Config({**scene, "coin": {"ratio": [0.8, 1.2, 1.6, 2.0]}, "stop": STOPS[stop]})


def files(path: Path) -> dict[str, bytes]:
    all_files = path.iterdir()
    return {file.name: file.read_bytes() for file in all_files if file.name != PROVENANCE}


class Silent:
    """Jobs that neither call back nor say whether they are done."""

    class Job:
        def __init__(self, function, arguments):
            self._call = (function, arguments)

        def result(self):
            function, arguments = self._call
            return function(*arguments)

    def submit(self, function, *arguments):
        # as if another process did it
        return self.Job(*pickle.loads(pickle.dumps((function, arguments))))


class Asked(Silent):
    """Jobs that say when they are done, and no more, as submitit's: the last comes first."""

    class Job(Silent.Job):
        asked = 0

        def done(self):
            Asked.Job.asked += 1
            return Asked.Job.asked % 3 == 0


def test_every_executor_ends_in_the_bytes_of_a_local_run(scene, tmp_path):
    spawn = get_context("spawn")
    with ProcessPoolExecutor(2, mp_context=spawn) as processes, ThreadPoolExecutor(3) as threads:
        executors = {
            "processes": processes,
            "threads": threads,
            "silent": Silent(),
            "asked": Asked(),
        }
        for stop in STOPS:
            config = config_of(scene, stop)
            local = coinmc.run(config, tmp_path / stop)
            for name, executor in executors.items():
                out = tmp_path / f"{stop}-{name}"
                result = coinmc.run(config, out, executor=executor)
                assert result.status == "complete"
                assert result.tosses == local.tosses
                assert files(out) == files(tmp_path / stop), (stop, name)


def test_a_chunk_may_use_several_threads(scene, tmp_path):
    for stop in STOPS:
        config = config_of(scene, stop)
        coinmc.run(config, tmp_path / stop)
        out = tmp_path / f"{stop}-threads"
        coinmc.run(config, out, executor=Silent(), threads=3)
        assert files(out) == files(tmp_path / stop)
    assert coinmc.chunk(config_of(scene, "fixed"), 2, threads=5) == coinmc.chunk(
        config_of(scene, "fixed"), 2
    )


def test_local_and_remote_runs_resume_each_other(scene, command, tmp_path):
    config = config_of(scene, "fixed")
    coinmc.run(config, tmp_path / "whole")
    (tmp_path / "toss.toml").write_text(config.resolved)

    class Broken(Silent):
        left = 5
        max_workers = 1

        def submit(self, function, *arguments):
            if not self.left:
                raise ConnectionError("the cluster is gone")
            self.left -= 1
            return super().submit(function, *arguments)

    for _ in range(2):
        with pytest.raises(ConnectionError):
            coinmc.run(config, tmp_path / "run", executor=Broken())
    assert coinmc.open(tmp_path / "run").status == "interrupted"
    command("run", tmp_path / "toss.toml", "--out", tmp_path / "run")
    assert files(tmp_path / "run") == files(tmp_path / "whole")
    # and a run that is finished needs no worker
    Broken.left = 0
    assert coinmc.run(config, tmp_path / "run", executor=Broken()).status == "complete"


def test_no_more_chunks_are_in_flight_than_workers_can_hold(scene, tmp_path):
    class Counting(Silent):
        max_workers = 3
        waiting = most = 0

        def submit(self, function, *arguments):
            Counting.waiting += 1
            Counting.most = max(Counting.most, Counting.waiting)
            job = super().submit(function, *arguments)
            result = job.result

            def counted():
                Counting.waiting -= 1
                return result()

            job.result = counted
            return job

    coinmc.run(config_of(scene, "fixed"), tmp_path / "run", executor=Counting())
    assert Counting.most == 2 * 3


def test_what_fails_on_a_worker_is_told_and_finished_work_is_kept(scene, tmp_path, monkeypatch):
    config = config_of(scene, "fixed")

    class Failing(Silent):
        submitted = 0

        def submit(self, function, *arguments):
            self.submitted += 1
            if self.submitted == 4:
                return super().submit(os.stat, "/no/such/file")
            return super().submit(function, *arguments)

    with pytest.raises(coinmc.RunError, match=r"point 1.*FileNotFoundError.*run again") as caught:
        coinmc.run(config, tmp_path / "run", executor=Failing())
    assert isinstance(caught.value.__cause__, FileNotFoundError)
    # another build on the worker
    other = "0.0.1 (1234567 2020-01-01)"
    with pytest.raises(coinmc.RunError, match=r"has coinmc .* the client 0\.0\.1 \(1234567"):
        _executors.compute(config, config.hash, other, 1, (0, 0, 16_384))
    with pytest.raises(coinmc.RunError, match="arrived as"):
        _executors.compute(config, "f00", _lib.__build__, 1, (0, 0, 16_384))
    with pytest.raises(TypeError, match="submit"):
        coinmc.run(config, tmp_path / "other", executor=object())
    with pytest.raises(ValueError, match="threads"):
        coinmc.run(config, tmp_path / "other", executor=Silent(), threads=0)


def test_a_chunk_is_a_pure_function_and_a_damaged_one_is_refused(scene, tmp_path):
    config = config_of(scene, "fixed")
    text = coinmc.chunk(config, 4)
    assert text == coinmc.chunk(config, (1, 16_384, 32_768)) == coinmc.chunk(config, 4)
    for wrong in (-1, 12, 10**30):
        with pytest.raises((ValueError, OverflowError)):
            coinmc.chunk(config, wrong)
    with pytest.raises(coinmc.RunError, match="outside the plan"):
        coinmc.chunk(config, (9, 0, 1))
    session = _lib.Session(config._plan, tmp_path / "run")
    places, _ = session.take(3)
    assert places == [(0, 0, 16_384), (0, 16_384, 32_768), (0, 32_768, 40_000)]
    good, note_of_good = _lib.chunk_with_note(config._plan, *places[0], 1)
    assert good == coinmc.chunk(config, places[0])
    for bad in (b"", good[:-9], good.replace(b"heads ", b"heads 1"), good + good):
        with pytest.raises(coinmc.RunError, match="cannot be used"):
            session.accept([(bad, b"")])
    for note in (b"{}", note_of_good.replace(b"wall_us", b"wall"), b" " * 5000):
        with pytest.raises(coinmc.RunError, match="its note"):
            session.accept([(good, note)])
    # what comes twice, or unasked, counts once, or not at all
    session.accept([(good, note_of_good), (coinmc.chunk(config, 11), b"")])
    session.accept([(good, note_of_good)])
    assert session.progress()[0] == 16_384
    assert session.conclude()[0].status == "interrupted"


CLIENT = """
import sys
from concurrent.futures import ThreadPoolExecutor
import coinmc
coinmc.run(sys.argv[1], sys.argv[2], executor=ThreadPoolExecutor(2))
"""


def test_ctrl_c_keeps_what_is_finished(scene, tmp_path):
    config = coinmc.Config(config_of(scene, "fixed"), {"stop.tosses": 3_000_000})
    (tmp_path / "toss.toml").write_text(config.resolved)
    words = [sys.executable, "-c", CLIENT, tmp_path / "toss.toml", tmp_path / "run"]
    client = subprocess.Popen(words, stderr=subprocess.PIPE, text=True)
    tallies = tmp_path / "run" / "tallies.txt"
    while not tallies.exists() and client.poll() is None:
        time.sleep(0.01)
    client.send_signal(signal.SIGINT)
    assert "KeyboardInterrupt" in client.communicate(timeout=60)[1]
    opened = coinmc.open(tmp_path / "run")
    assert opened.status == "interrupted"
    assert opened.tosses > 0
    assert (tmp_path / "run" / "results.partial.csv").exists()
