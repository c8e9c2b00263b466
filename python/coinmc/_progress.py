"""Progress of long work: tqdm where it is installed, else a line."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

__all__ = ["reporting"]

#: What is told how many tosses are done, and how many there will be.
Report = Callable[[int, int], None]


@contextmanager
def reporting(progress: bool | Report | None, what: str) -> Iterator[Report | None]:
    """Give what long work reports to, and clean up behind it.

    Parameters
    ----------
    progress : bool, callable or None
        True: a bar. None: a bar if a person watches (a terminal or a notebook) and tqdm is
        installed. A callable is called with (done, planned). False: nothing.
    what : str
        What the bar is called.
    """
    if progress is False or (progress is None and not _watched()):
        yield None
        return
    if callable(progress):
        yield progress
        return
    bar = _bar(what)
    if bar is None:
        if progress:
            raise ImportError('progress bars need tqdm: pip install "coinmc[progress]"')
        yield None
        return
    with bar:

        def report(done: int, planned: int) -> None:
            bar.total = planned or None
            bar.update(done - bar.n)

        yield report


def _watched() -> bool:
    return hasattr(sys, "ps1") or (sys.stderr is not None and sys.stderr.isatty())


def _bar(what: str):  # tqdm is optional
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return None
    return tqdm(desc=what, unit=" tosses", unit_scale=True, leave=False)
