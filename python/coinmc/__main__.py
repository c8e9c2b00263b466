"""The command ``coinmc``: ``python -m coinmc`` and the script of that name."""

import signal
import sys

from coinmc import _lib

__all__ = ["main"]


def main() -> int:
    """Do what the command line says, like the program ``coinmc``, and return the exit status."""
    # as in the program: the engine's own handler stops a run, and otherwise Ctrl-C ends the process
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _lib.main(["coinmc", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
