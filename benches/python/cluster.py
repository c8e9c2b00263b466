"""Runs on many workers: what they cost, what kills do to them, and a thousand cores, simulated.

    python benches/python/cluster.py kills [--workers 50] [--clients 10]   Dask, killed at random
    python benches/python/cluster.py overhead [--rounds 3] [--threads 2]   Dask and `coinmc run`
    python benches/python/cluster.py shards [--shards 1000]                a merge of many parts
    python benches/python/cluster.py points [--points 1000000]             a sweep of many points
    python benches/python/cluster.py simulate [--cores 1000]               1e13 tosses

Needs the installed wheel and dask.distributed. `--program`, before the study, names the program.
"""

import argparse
import heapq
import json
import os
import random
import resource
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import coinmc
from coinmc import _lib

ROOT = Path(__file__).resolve().parents[2]
SCENE = {
    "seed": 7,
    "coin": {"ratio": 1.2},
    "surface": {"restitution": 0.5, "friction": 0.3},
    "launch": {"preset": "robot"},
    "engine": {"flat": {}},
}


#: Who made a run, and in what time: not the same when it is made again.
PROVENANCE = "provenance.jsonl"


def main() -> None:
    """Run the study that was asked for."""
    arguments = parsed()
    with tempfile.TemporaryDirectory() as folder:
        arguments.study(arguments, Path(folder))


def parsed() -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=Path, default=ROOT / "target" / "release" / "coinmc")
    studies = parser.add_subparsers(required=True)
    for study, options in {
        kills: {"workers": 50, "clients": 10, "chunks": 1000},
        client: {"config": "", "out": "", "address": ""},
        overhead: {"rounds": 3, "chunks": 40, "threads": 2},
        shards: {"shards": 1000},
        points: {"points": 1_000_000},
        simulate: {"cores": 1000, "tosses": 1e13, "lost": 0.01},
    }.items():
        sub = studies.add_parser(study.__name__)
        sub.set_defaults(study=study)
        for name, default in options.items():
            sub.add_argument(f"--{name}", type=type(default), default=default)
    return parser.parse_args()


def config_of(chunks: int, tosses: int) -> coinmc.Config:
    """Build a config of so many points, each a chunk of so many tosses."""
    ratio = {"from": 0.6, "to": 2.0, "steps": chunks}
    return coinmc.Config({**SCENE, "coin": {"ratio": ratio}, "stop": {"tosses": tosses}})


def files(path: Path) -> dict[str, bytes]:
    """Read every file of a run directory."""
    all_files = path.iterdir()
    return {file.name: file.read_bytes() for file in all_files if file.name != PROVENANCE}


def kills(arguments: argparse.Namespace, folder: Path) -> None:
    """Kill workers and clients, spread over a run; compare with an undisturbed local run."""
    from distributed import Client, LocalCluster

    config = config_of(arguments.chunks, 40_000)
    (folder / "toss.toml").write_text(config.resolved)
    coinmc.run(config, folder / "whole")
    chance = random.Random(1)
    victims = ["worker"] * arguments.workers + ["client"] * arguments.clients
    chance.shuffle(victims)
    step, killed, waited = arguments.chunks // (len(victims) + 1), 0, time.perf_counter()
    cluster = LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None)
    with cluster, Client(cluster) as observer:
        words = [sys.executable, __file__, "client", "--config", folder / "toss.toml"]
        words += ["--out", folder / "run", "--address", cluster.scheduler_address]
        process = subprocess.Popen(words)
        begun = time.perf_counter()
        while process.poll() is None:
            # at a random instant, once enough chunks have been made since the last
            time.sleep(chance.uniform(0.05, 0.2))
            if time.perf_counter() - waited > 60:
                # a nanny whose worker is killed while it starts gives up
                cluster.scale(0)
                cluster.scale(2)
                waited = time.perf_counter()
            if killed == len(victims) or made(folder / "run") < step * (killed + 1):
                continue
            if victims[killed] == "client":
                process.kill()
                process.wait()
                process = subprocess.Popen(words)
            else:
                ids = list(observer.run(os.getpid, on_error="ignore").values())
                if not ids:
                    continue
                os.kill(chance.choice(ids), signal.SIGKILL)
            killed, waited = killed + 1, time.perf_counter()
        assert process.returncode == 0, process.returncode
    same = files(folder / "whole") == files(folder / "run")
    text = (folder / "run" / "tallies.txt").read_text()
    places = [line for line in text.splitlines() if line.startswith(("point ", "tosses "))]
    chunks = list(zip(places[::2], places[1::2], strict=True))
    workers, clients = (victims[:killed].count(kind) for kind in ("worker", "client"))
    print(
        f"{workers} workers, {clients} clients killed in "
        f"{time.perf_counter() - begun:.0f} s: {len(chunks)} chunks, {len(set(chunks))} different, "
        f"{'the bytes of a local run' if same else 'NOT the bytes of a local run'}"
    )
    assert same


def made(path: Path) -> int:
    """Count the chunks that a run directory holds."""
    tallies = path / "tallies.txt"
    return tallies.read_text().count("crc32 ") if tallies.exists() else 0


def client(arguments: argparse.Namespace, _: Path) -> None:
    """Run a config on a cluster; what `kills` starts and kills."""
    from distributed import Client

    with Client(arguments.address) as cluster:
        coinmc.run(arguments.config, arguments.out, executor=cluster, progress=False)


def overhead(arguments: argparse.Namespace, folder: Path) -> None:
    """Compare a run by Dask workers, each of one thread, with `coinmc run` on as many threads.

    Time by the clock tells little on a busy machine. Processor time beyond that of the chunks,
    which the run directory records, is what the run costs all processes together.
    """
    from distributed import Client, LocalCluster

    # chunks grow with the tosses that were made: the last ones are of 2^19 or more
    tosses = arguments.chunks * (1 << 19)
    config = coinmc.Config({**SCENE, "stop": {"half_width": 1e-7, "max_tosses": tosses}})
    (folder / "toss.toml").write_text(config.resolved)
    threads = arguments.threads
    clock: dict[str, list[float]] = {"coinmc run": [], "dask": []}
    extra: dict[str, list[float]] = {"coinmc run": [], "dask": []}

    def of_all(distributed: Client) -> float:
        # the scheduler lives in this process
        workers = distributed.run(os.times).values()
        return sum(times[0] + times[1] for times in (os.times(), *workers))

    cluster = LocalCluster(n_workers=threads, threads_per_worker=1, dashboard_address=None)
    with cluster, Client(cluster) as distributed:
        for number in range(arguments.rounds):
            local, remote = folder / f"local-{number}", folder / f"dask-{number}"
            before, begun = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
            words = [arguments.program, "run", folder / "toss.toml", "--threads", str(threads)]
            done = subprocess.run([*words, "--out", local, "--quiet"], stdout=subprocess.DEVNULL)
            assert done.returncode in (0, 3), done.returncode
            clock["coinmc run"].append(time.perf_counter() - begun)
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
            extra["coinmc run"].append(used / chunks_of(local)[1] - 1)
            used, begun = of_all(distributed), time.perf_counter()
            coinmc.run(config, remote, executor=distributed)
            clock["dask"].append(time.perf_counter() - begun)
            extra["dask"].append((of_all(distributed) - used) / chunks_of(remote)[1] - 1)
            assert files(local) == files(remote)
    chunks, time_s = chunks_of(folder / "dask-0")
    print(f"{chunks} chunks, {time_s / chunks:.2f} s of a processor each; {threads} threads")
    for name in clock:
        rounds = ", ".join(f"{100 * share:.1f}" for share in extra[name])
        by_clock = ", ".join(f"{taken:.1f}" for taken in clock[name])
        print(f"{name:<12} beyond the chunks {rounds} %; by the clock {by_clock} s")
    ratios = [dask / local for dask, local in zip(clock["dask"], clock["coinmc run"], strict=True)]
    print(f"by the clock, Dask by local: {', '.join(f'{ratio:.3f}' for ratio in ratios)}")


def chunks_of(path: Path) -> tuple[int, float]:
    """Count the chunks that a run directory records, and add up their processor time, s."""
    lines = map(json.loads, (path / PROVENANCE).read_text().splitlines())
    chunks = [chunk for line in lines for chunk in line.get("chunks", ())]
    return len(chunks), sum(chunk[4] for chunk in chunks) / 1e6


def shards(arguments: argparse.Namespace, folder: Path) -> None:
    """Merge a run of so many parts."""
    config = config_of(4 * arguments.shards, 100)
    (folder / "toss.toml").write_text(config.resolved)
    parts = [folder / f"part-{i}" for i in range(1, arguments.shards + 1)]
    for i, part in enumerate(parts, 1):
        words = [arguments.program, "run", folder / "toss.toml", "--shard"]
        words += [f"{i}/{arguments.shards}", "--threads", "1", "--quiet", "--out", part]
        subprocess.run(words, check=True, stdout=subprocess.DEVNULL)
    begun = time.perf_counter()
    words = [arguments.program, "merge", *parts, "--out", folder / "merged"]
    subprocess.run(words, check=True, stdout=subprocess.DEVNULL)
    used = time.perf_counter() - begun
    memory = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
    print(f"merge of {arguments.shards} parts: {used:.2f} s, at most {memory:.0f} MB")


def points(arguments: argparse.Namespace, folder: Path) -> None:
    """Run a sweep of so many points of one toss: all its time goes into what is not tossing."""
    config = config_of(arguments.points, 1)
    (folder / "toss.toml").write_text(config.resolved)
    words = [arguments.program, "run", folder / "toss.toml", "--threads", "1", "--quiet"]
    words += ["--plot", "none", "--out", folder / "run"]
    begun = time.perf_counter()
    subprocess.run(words, check=True, stdout=subprocess.DEVNULL)
    took = time.perf_counter() - begun
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    user, system = (1e6 * time_s / arguments.points for time_s in (used.ru_utime, used.ru_stime))
    sizes = {file.name: file.stat().st_size for file in (folder / "run").iterdir()}
    print(
        f"{arguments.points} points: {took:.0f} s, a point {user:.1f} µs of processor time and "
        f"{system:.1f} µs in the system; at most {used.ru_maxrss / 1024:.0f} MB; {len(sizes)} files"
    )
    print(", ".join(f"{name} {size / 1e6:.0f} MB" for name, size in sorted(sizes.items())))


def simulate(arguments: argparse.Namespace, _: Path) -> None:
    """Drive the scheduler of a run with simulated workers."""
    #: Tosses a second and core; time of a restart of a worker, s; time of a message, s.
    speed, restart_s, message_s = 1e6, 600.0, 0.01
    for name, stop in {
        "a fixed number": {"tosses": int(arguments.tosses)},
        "to targets": {"half_width": 1e-7, "max_tosses": int(arguments.tosses)},
    }.items():
        config = coinmc.Config({**SCENE, "stop": stop})
        plan, chance = config._plan, random.Random(1)
        session = _lib.Session(plan, None)
        mean_life_s = 3600 / arguments.lost
        # worker's next free instant; who is lost comes back later
        free = [(0.0, worker) for worker in range(arguments.cores)]
        heapq.heapify(free)
        events: list[tuple[float, int, tuple[int, int, int] | None, int]] = []
        lost = chunks = order = 0
        again: list[tuple[int, int, int]] = []
        now, busy_s, is_done, real_s = 0.0, 0.0, False, time.perf_counter()
        while True:
            while free and free[0][0] <= now:
                places = [again.pop()] if again else [] if is_done else None
                if places is None:
                    places, is_done = session.take(1)
                if not places:
                    break
                _, worker = heapq.heappop(free)
                [place] = places
                takes_s = (place[2] - place[1]) / speed * chance.uniform(0.8, 1.2)
                life_s = chance.expovariate(1 / mean_life_s)
                order += 1
                end = now + min(takes_s, life_s) + message_s
                heapq.heappush(events, (end, order, place, worker if life_s > takes_s else ~worker))
                busy_s += takes_s if life_s > takes_s else 0.0
            if not events:
                if free and free[0][0] > now and again:
                    now = free[0][0]
                    continue
                break
            # the next chunk that comes back, or worker that does
            if free and now < free[0][0] < events[0][0] and (again or not is_done):
                now = free[0][0]
                continue
            now, _, place, worker = heapq.heappop(events)
            if worker < 0:
                lost += 1
                again.append(place)
                heapq.heappush(free, (now + restart_s, ~worker))
                continue
            chunks += 1
            third = (place[2] - place[1]) // 3
            session.accept([(_lib.tally_of(plan, place, third, third), b"")])
            heapq.heappush(free, (now, worker))
        real_s = time.perf_counter() - real_s
        done, _ = session.progress()
        print(
            f"{name}: {done:.3g} tosses in {chunks} chunks on {arguments.cores} cores, "
            f"{lost} workers lost: {now / 3600:.2f} h, "
            f"efficiency {100 * busy_s / (now * arguments.cores):.1f} %, "
            f"{1e6 * real_s / chunks:.0f} µs of the client a chunk"
        )


if __name__ == "__main__":
    main()
