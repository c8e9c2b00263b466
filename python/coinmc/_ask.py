"""Ask for the faces of coins without a toss."""

from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from coinmc import _lib
from coinmc._launches import plain
from coinmc._progress import shown_digits

__all__ = ["Asked", "ask"]

Launch: TypeAlias = Literal["hand", "dropped", "rolled"]


class Asked:
    """The answer of `ask`.

    Attributes
    ----------
    p : ndarray
        P(heads), P(tails) and P(side) along the last axis; the other axes are those of the
        arguments.
    error : ndarray
        Their standard errors.
    """

    def __init__(self, asked: dict[str, Any], shape: tuple[int, ...]) -> None:
        self._asked = asked
        self._shape = shape
        found = _lib.ask(asked).reshape(*shape, 2, 3)
        self.p: NDArray[np.float64] = found[..., 0, :]
        self.error: NDArray[np.float64] = found[..., 1, :]

    @property
    def heads(self) -> NDArray[np.float64]:
        """P(heads)."""
        return self.p[..., 0]

    @property
    def tails(self) -> NDArray[np.float64]:
        """P(tails)."""
        return self.p[..., 1]

    @property
    def side(self) -> NDArray[np.float64]:
        """P(side)."""
        return self.p[..., 2]

    def fair(self, target: float = 1 / 3) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Find the ratio at which the side has this probability on the same surfaces.

        Parameters
        ----------
        target : float, optional
            The probability.

        Returns
        -------
        tuple of ndarray
            H/R, the least one of the atlas, and its standard error; NaN where there is none.
        """
        found = _lib.ask_root(self._asked, float(target)).reshape(*self._shape, 2)
        return found[..., 0], found[..., 1]

    def __repr__(self) -> str:
        if self._shape:
            return f"<coinmc.Asked {self._shape}>"
        faces = ("heads", "tails", "side")
        words = (
            f"P({face}) = {p:.{digits}f} ± {1.96 * error:.{digits}f}"
            for face, p, error in zip(faces, self.p, self.error, strict=True)
            for digits in [shown_digits(1.96 * float(error))]
        )
        return f"<coinmc.Asked {', '.join(words)}>"


def ask(
    ratio: ArrayLike,
    material: str = "laminate",
    launch: Launch = "hand",
    **numbers: ArrayLike,
) -> Asked:
    """Ask for the faces of coins of the size of a euro without a toss, like ``coinmc ask``.

    Parameters
    ----------
    ratio : array_like
        Height over radius, H/R.
    material : str, optional
        What they land on, as in ``[surface] material``.
    launch : str, optional
        ``"hand"``, ``"dropped"`` or ``"rolled"``.
    **numbers : array_like
        Numbers of ``[surface]`` that replace the material's, by key.

    Returns
    -------
    Asked
        All arguments broadcast against each other.

    Raises
    ------
    ValueError
        If the atlas does not hold a number, with the limits of each.

    Examples
    --------
    >>> import coinmc
    >>> answer = coinmc.ask(ratio=[0.2, 0.8, 1.4], material="wood", friction=0.25)
    >>> answer.side.shape, bool((answer.side[1:] > answer.side[:-1]).all())
    ((3,), True)
    """
    columns = np.broadcast_arrays(
        *(np.asarray(plain(values), dtype=float) for values in (ratio, *numbers.values()))
    )
    shape = columns[0].shape
    rows = np.stack([column.ravel() for column in columns], axis=-1)
    asked = {"launch": launch, "material": material, "keys": list(numbers), "rows": rows}
    return Asked(asked, shape)
