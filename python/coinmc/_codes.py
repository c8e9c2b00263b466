"""The integer codes used in arrays of outcomes."""

from enum import IntEnum

__all__ = ["Ended", "Face"]


class Face(IntEnum):
    """The outcome of a toss.

    Examples
    --------
    >>> import coinmc
    >>> coinmc.Face.SIDE, coinmc.Face(0).name
    (<Face.SIDE: 2>, 'HEADS')
    """

    #: The heads face shows: its outward normal points up.
    HEADS = 0
    #: The tails face shows.
    TAILS = 1
    #: The coin lies (in the plane: stands) on its side.
    SIDE = 2
    #: The toss ended without a face; `Ended` says why.
    UNDECIDED = 3
    #: The coin left the table over its edge.
    LEFT = 4


class Ended(IntEnum):
    """Why the engine stopped simulating the toss."""

    #: The face is decided.
    DECIDED = 0
    #: Undecided at the limit of simulated time.
    TIME_LIMIT = 1
    #: It is proven that the coin never settles.
    ENDLESS = 2
    #: Undecided at the limit of impacts or of steps in contact.
    IMPACT_LIMIT = 3
    #: The state became infinite or NaN.
    FAILED = 4
    #: The coin left the table over its edge.
    LEFT = 5
