"""Progress bars of long computations, drawn by tqdm."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

__all__ = ["reporting"]

#: Called with the number of tosses done and the number planned.
Report = Callable[[int, int], None]


@contextmanager
def reporting(progress: bool | Report | None, what: str) -> Iterator[Report | None]:
    """Yield the callable to report progress to, or None; close the bar at the end.

    Parameters
    ----------
    progress : bool, callable or None
        True: a bar. None: a bar in a terminal or a notebook if tqdm is installed. A callable is
        called with (done, planned). False: nothing.
    what : str
        Label of the bar.
    """
    if progress is False or (progress is None and not _is_interactive()):
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


def _is_interactive() -> bool:
    return hasattr(sys, "ps1") or (sys.stderr is not None and sys.stderr.isatty())


def _bar(what: str):  # tqdm is optional
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return None
    return tqdm(desc=what, unit=" tosses", unit_scale=True, leave=False)
