"""Runs on a Dask cluster of processes."""

import os
import signal
import threading
import time

import pytest
from test_executors import STOPS, config_of, files

import coinmc

distributed = pytest.importorskip("distributed")


@pytest.fixture(scope="module")
def client():
    cluster = distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
    )
    with cluster, distributed.Client(cluster) as client:
        yield client


def test_a_cluster_ends_in_the_bytes_of_a_local_run(scene, client, tmp_path):
    for stop in STOPS:
        config = config_of(scene, stop)
        coinmc.run(config, tmp_path / stop)
        for name, executor in {"client": client, "executor": client.get_executor()}.items():
            out = tmp_path / f"{stop}-{name}"
            coinmc.run(config, out, executor=executor)
            assert files(out) == files(tmp_path / stop), (stop, name)


def test_killed_workers_lose_nothing_and_double_nothing(scene, client, tmp_path):
    config = coinmc.Config(config_of(scene, "fixed"), {"stop.tosses": 400_000})
    coinmc.run(config, tmp_path / "whole")
    killed = []
    is_over = threading.Event()

    def kill():
        while not is_over.wait(0.1) and not killed:
            workers = client.run(os.getpid)
            for pid in list(workers.values())[:1]:
                os.kill(pid, signal.SIGKILL)
                killed.append(pid)
            time.sleep(0.5)

    killer = threading.Thread(target=kill)

    def begin(done, planned):
        # once work is under way
        if done and not killer.ident:
            killer.start()

    coinmc.run(config, tmp_path / "run", executor=client, progress=begin)
    is_over.set()
    killer.join()
    assert files(tmp_path / "run") == files(tmp_path / "whole")
    assert killed
