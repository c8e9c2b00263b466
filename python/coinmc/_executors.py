"""Runs whose chunks are computed elsewhere: in other processes, by Dask, on a cluster.

Workers compute chunks (`chunk`) and hand back their tallies; only this process writes the run
directory. What comes next is decided by the same scheduler as in a local run (`_lib.Session`).
"""

import platform
import queue
import time
from collections import deque
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple, TypeAlias

from coinmc import _lib
from coinmc._config import Config, ConfigLike, as_config, plan_of
from coinmc._errors import RunError
from coinmc._launches import threads_of

__all__ = ["Place", "chunk", "run_with"]

#: Point, first toss and the one after the last of a chunk.
Place: TypeAlias = tuple[int, int, int]

#: How often a chunk is handed out again whose worker was lost.
RETRIES = 10
#: How often Dask tries a chunk again that raised an exception.
RETRIES_OF_DASK = 2
#: How often Dask is asked how many workers it has, s.
ASK_S = 1.0
#: Chunks in flight for each worker: one that is computed, and one that waits.
A_WORKER = 2
#: Chunks in flight where the executor does not say how many workers it has.
UNKNOWN_WORKERS = 64
#: How often jobs are asked whether they are done that do not say so by themselves, s.
POLL_S = 0.05


def chunk(config: ConfigLike, i: int | Place, *, threads: int = 1) -> bytes:
    """Compute one chunk of a run and return its tally.

    A pure function: the same chunk has the same tally on every machine. `coinmc.run` with an
    ``executor`` calls it on the workers.

    Parameters
    ----------
    config : path, dict or Config
        The config. A `Config` is sent to other processes as a short text.
    i : int or tuple
        The number of the chunk, from 0 (with a fixed number of tosses), or the point, the first
        toss and the one after the last.
    threads : int, optional
        Number of threads. The tally does not depend on it.

    Returns
    -------
    bytes
        The text of the tally, as a run directory holds it.

    Examples
    --------
    >>> import coinmc
    >>> config = coinmc.Config({
    ...     "coin": {"ratio": [0.5, 2.0]},
    ...     "surface": {"restitution": 0.5, "friction": 0.3},
    ...     "launch": {"preset": "robot"},
    ...     "engine": {"flat": {}},
    ...     "stop": {"tosses": 1000},
    ... })
    >>> coinmc.chunk(config, 1).split(b"\\n")[2:4]
    [b'point 1', b'tosses 0 1000']
    >>> coinmc.chunk(config, (1, 0, 1000)) == coinmc.chunk(config, 1)
    True
    """
    plan = plan_of(as_config(config))
    if isinstance(i, int):
        place = _lib.chunk_of_number(plan, i) if i >= 0 else None
        if place is None:
            raise ValueError(
                f"there is no chunk {i}: chunks are numbered from 0 where the number of tosses is "
                "fixed; otherwise give point, first toss and the one after the last"
            )
        i = place
    return _lib.chunk(plan, *i, _threads(threads))


def _threads(threads: int | None) -> int:
    """Check the threads of a chunk: one unless told, also where the environment says another."""
    return 1 if threads is None else threads_of(threads) or 1


def compute(
    config: Config, hash_: str, build: str, threads: int, place: Place
) -> tuple[bytes, bytes]:
    """Compute a chunk for a client of this build, and note who made it. Workers call it."""
    if build != _lib.__build__:
        raise RunError(
            f"the worker on {platform.node() or 'another machine'} has coinmc {_lib.__build__}, "
            f"the client {build}: install the same build on both"
        )
    if config.hash != hash_:
        raise RunError(f"the plan {hash_[:8]} arrived as {config.hash[:8]}")
    return _lib.chunk_with_note(plan_of(config), *place, threads)


class Done(NamedTuple):
    """A chunk that came back: its tally and who made it, or why there is none."""

    place: Place
    result: tuple[bytes, bytes] | None
    error: BaseException | None


def run_with(
    executor: Any,
    threads: int | None,
    config: Config,
    out: Any,
    report: Callable[[int, int], None] | None,
) -> tuple[_lib.Results, list[str]]:
    """Run a config in a run directory; `executor` computes chunks, on one thread unless told."""
    session = _lib.Session(plan_of(config), out)
    pool = _pool(executor, (config, config.hash, _lib.__build__, _threads(threads)))
    try:
        _work(session, pool, report)
    except BaseException:
        # what has come back was stored; the rest is computed when the run goes on
        pool.cancel()
        session.conclude()
        raise
    return session.conclude()


def _work(session: _lib.Session, pool: "_Pool", report: Callable[[int, int], None] | None) -> None:
    is_done, tries = False, {}
    while True:
        room = pool.most - pool.in_flight
        if room > 0 and not is_done:
            places, is_done = session.take(room)
            for place in places:
                pool.submit(place)
        if report is not None:
            report(*session.progress())
        if pool.in_flight == 0:
            return
        results, lost = [], []
        for done in pool.wait():
            if done.result is not None:
                results.append(done.result)
            else:
                lost.append(done)
        # one sync for all that came together
        session.accept(results)
        for place, _, error in lost:
            tries[place] = tries.get(place, 0) + 1
            if tries[place] > RETRIES or not pool.is_lost(error):
                raise error if isinstance(error, RunError) else _failure(place, error)
            pool.submit(place)


def _failure(place: Place, error: BaseException | None) -> RunError:
    point, start, end = place
    failure = RunError(
        f"point {point}, tosses {start}..{end}: the worker failed "
        f"({type(error).__name__}: {error}). Finished work is kept; run again to go on"
    )
    failure.__cause__ = error
    return failure


class _Pool:
    """What every kind of executor is made to look like."""

    #: Chunks that may be in flight.
    most: int

    @property
    def in_flight(self) -> int:
        raise NotImplementedError

    def submit(self, place: Place) -> None:
        raise NotImplementedError

    def wait(self) -> Iterator[Done]:
        """Wait for at least one chunk, and yield all that are back."""
        raise NotImplementedError

    def is_lost(self, error: BaseException | None) -> bool:
        """Whether the worker is to blame, not the chunk."""
        return False

    def cancel(self) -> None:
        raise NotImplementedError


def _pool(executor: Any, arguments: tuple[Config, str, str, int]) -> _Pool:
    if not callable(getattr(executor, "submit", None)):
        raise TypeError(
            "the executor must have submit(function, *arguments), whose result has result(): "
            f"{type(executor).__name__} does not"
        )
    if callable(getattr(executor, "scheduler_info", None)):
        return _Dask(executor, arguments)
    return _Futures(executor, arguments)


class _Futures(_Pool):
    """Anything with ``submit(...).result()``."""

    def __init__(self, executor: Any, arguments: tuple[Config, str, str, int]) -> None:
        self._executor = executor
        self._arguments = arguments
        self.most = A_WORKER * _workers(executor)
        self._futures: dict[Place, Any] = {}
        #: Places of futures that call back when they are done.
        self._back: queue.SimpleQueue[Place] = queue.SimpleQueue()
        #: Places of jobs that have to be asked, in the order in which they were handed out.
        self._silent: deque[Place] = deque()

    @property
    def in_flight(self) -> int:
        return len(self._futures)

    def submit(self, place: Place) -> None:
        future = self._executor.submit(compute, *self._arguments, place)
        self._futures[place] = future
        if callable(getattr(future, "add_done_callback", None)):
            future.add_done_callback(lambda _: self._back.put(place))
        else:
            self._silent.append(place)

    def wait(self) -> Iterator[Done]:
        places = self._asked() if self._silent else [self._back.get()]
        while True:
            try:
                places.append(self._back.get_nowait())
            except queue.Empty:
                break
        for place in places:
            future = self._futures.pop(place)
            try:
                yield Done(place, future.result(), None)
            except Exception as error:
                yield Done(place, None, error)

    def _asked(self) -> list[Place]:
        """Ask jobs that do not call back; wait for the oldest if they cannot even be asked."""
        while True:
            can_be_asked = [
                place
                for place in self._silent
                if callable(getattr(self._futures[place], "done", None))
            ]
            if not can_be_asked:
                return [self._silent.popleft()]
            done = [place for place in can_be_asked if self._futures[place].done()]
            if done:
                self._silent = deque(place for place in self._silent if place not in set(done))
                return done
            time.sleep(POLL_S)

    def cancel(self) -> None:
        for future in self._futures.values():
            if callable(getattr(future, "cancel", None)):
                future.cancel()


def _workers(executor: Any) -> int:
    for name in ("_max_workers", "max_workers", "num_workers"):
        workers = getattr(executor, name, None)
        if isinstance(workers, int) and workers > 0:
            return workers
    client = getattr(executor, "_client", None)  # of dask's ClientExecutor
    if client is not None and callable(getattr(client, "nthreads", None)):
        return max(1, sum(client.nthreads().values()))
    return UNKNOWN_WORKERS // A_WORKER


class _Lost(Exception):
    """Dask forgot a chunk."""


class _Dask(_Pool):
    """A ``Client`` of dask.distributed."""

    def __init__(self, client: Any, arguments: tuple[Config, str, str, int]) -> None:
        from distributed import as_completed

        self._client = client
        self._arguments = arguments
        self._places: dict[str, Place] = {}
        self._back = as_completed(with_results=True, raise_errors=False)
        self._most, self._asked_at = 1, -ASK_S

    @property
    def most(self) -> int:
        # workers come and go
        now = time.monotonic()
        if now - self._asked_at > ASK_S:
            threads = self._client.nthreads().values()
            self._most, self._asked_at = A_WORKER * max(1, sum(threads)), now
        return self._most

    @property
    def in_flight(self) -> int:
        return len(self._places)

    def submit(self, place: Place) -> None:
        _, hash_, _, _ = self._arguments
        # it says what is computed: whoever asks for the same chunk gets the same result
        key = "coinmc-{}-{}-{}-{}".format(hash_, *place)
        self._places[key] = place
        future = self._client.submit(
            compute,
            *self._arguments,
            place,
            key=key,
            pure=True,
            retries=RETRIES_OF_DASK,
        )
        if future.status in ("error", "lost"):
            future.retry()
        self._back.add(future)

    def wait(self) -> Iterator[Done]:
        for future, result in self._back.next_batch(block=True):
            place = self._places.pop(future.key)
            if future.status == "finished":
                yield Done(place, result, None)
            elif future.status == "error":
                yield Done(place, None, future.exception())
            else:
                yield Done(place, None, _Lost(f"{future.key} was {future.status}"))

    def is_lost(self, error: BaseException | None) -> bool:
        from distributed.scheduler import KilledWorker

        return isinstance(error, _Lost | KilledWorker)

    def cancel(self) -> None:
        self._client.cancel(list(self._back.futures), force=True)
