"""``python -m coinmc.experiment DIR``: what a day of throws says, and a page about it."""

import argparse
import sys
from pathlib import Path

from coinmc._errors import Error
from coinmc.experiment import open as open_day

__all__ = ["main"]


def main(words: list[str] | None = None) -> int:
    """Print the counts and probabilities of a day; return the exit status."""
    parser = argparse.ArgumentParser(prog="python -m coinmc.experiment", description=__doc__)
    parser.add_argument("directory", type=Path, metavar="DIR")
    parser.add_argument("--page", type=Path, metavar="FILE", help="write a page of HTML")
    given = parser.parse_args(words)
    try:
        day = open_day(given.directory)
        prediction = day.predict()
        print(f"{len(day)} of {day.planned} throws, {day.counts['undecided']} without a result")
        print(f"{'':6} {'throws':>8}  {'P':24} {'model, same throws'}")
        for face, seen in day.estimate().items():
            own = prediction.estimate()[face]
            both = [f"{e.p:.4f} [{e.lo:.4f}, {e.hi:.4f}]" for e in (seen, own)]
            print(f"{face:6} {day.counts[face]:8,}  {both[0]:24} {both[1]}")
        for problem in day.check_photos():
            print(f"coinmc: {problem}", file=sys.stderr)
        if given.page is not None:
            print(f"Page: {day.page(given.page, prediction=prediction)}")
    except FileExistsError:
        print(f"error: {given.page} exists: give a new name", file=sys.stderr)
        return 2
    except (Error, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
