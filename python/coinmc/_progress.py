"""Progress bars of long computations, drawn by tqdm."""

import math
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import Any

__all__ = ["reporting"]

#: Called with the number of tosses done and the number planned.
Report = Callable[[int, int], None]


class _NoBar:
    """A bar for those who would not see it."""

    n = 0
    total: int | None = None

    def close(self) -> None:
        pass

    def update(self, more: int) -> None:
        self.n += more

    def set_postfix_str(self, text: str, refresh: bool = True) -> None:
        pass


class _Shown:
    """What reports to a bar."""

    def __init__(self, bar: Any) -> None:
        self._bar = bar

    def __call__(self, done: int, planned: int) -> None:
        bar = self._bar
        bar.total = planned or None
        # whoever read it may be gone: that is no reason to stop
        with suppress(OSError, ValueError):
            bar.update(done - bar.n)

    def so_far(self, face: str, p: float, lo: float, hi: float) -> None:
        """Show what the point that is tossed has shown so far."""
        digits = shown_digits(max(hi - p, p - lo))
        numbers = f"{p:.{digits}f} [{lo:.{digits}f}, {hi:.{digits}f}]"
        with suppress(OSError, ValueError):
            self._bar.set_postfix_str(f"P({face}) {numbers}")


def shown_digits(error: float) -> int:
    """Return the decimals that show two digits of an error, from three to seven."""
    if not 0.0 < error < 1.0:
        return 3
    return min(max(1 - math.floor(math.log10(error)), 3), 7)


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
    try:
        bar = _bar(what)
    except OSError:
        # the descriptor is closed
        bar = _NoBar()
    if bar is None:
        if progress:
            raise ImportError('progress bars need tqdm: pip install "coinmc[progress]"')
        yield None
        return
    try:
        yield _Shown(bar)
    finally:
        with suppress(OSError, ValueError):
            bar.close()


def _is_interactive() -> bool:
    return hasattr(sys, "ps1") or (_has_stderr() and sys.stderr.isatty())


def _has_stderr() -> bool:
    """Whether there is a standard error to write to: services close it."""
    return sys.stderr is not None and not sys.stderr.closed


def _bar(what: str) -> Any:  # tqdm is optional
    if not _has_stderr():
        return _NoBar()
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return None
    return tqdm(desc=what, unit=" tosses", unit_scale=True, leave=False)
