"""Launches, the initial states of tosses, as structured arrays."""

import os
from collections.abc import Mapping
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from coinmc import _lib
from coinmc._config import ConfigLike, as_config, plan_of

__all__ = ["LAUNCH", "STATE", "LaunchesLike", "launches"]

#: The coin at one instant: position of the centre (m; z is its height above the surface), velocity
#: (m/s), axis (unit vector out of the heads face), angular velocity (rad/s); each x, y, z in the
#: laboratory frame, z up, with the origin in the middle of the table.
STATE = np.dtype(
    [
        ("position_m", "f8", 3),
        ("velocity_m_s", "f8", 3),
        ("axis", "f8", 3),
        ("spin_rad_s", "f8", 3),
    ]
)

#: A launch is the initial state of a toss.
LAUNCH = STATE

#: Anything that a function accepts as launches: an array with the fields of `LAUNCH`, or a dict of
#: arrays of shape (n, 3), or (3,) for all, by the names of these fields.
LaunchesLike: TypeAlias = NDArray[Any] | Mapping[str, ArrayLike]

_NUMBERS = STATE.itemsize // 8
#: What says how many threads toss where `threads=` does not.
_VARIABLE = "COINMC_THREADS"


def launches(
    config: ConfigLike,
    n: int,
    *,
    first: int = 0,
    point: int = 0,
    threads: int | None = None,
    overrides: Mapping[str, Any] | None = None,
) -> NDArray[np.void]:
    """Draw the launches of tosses ``first`` to ``first + n - 1`` of a point.

    Parameters
    ----------
    config : path, dict or Config
        The config.
    n : int
        Number of launches.
    first : int, optional
        Index of the first toss.
    point : int, optional
        Index of the point in the sweep.
    threads : int, optional
        Number of threads; by default what the environment variable ``COINMC_THREADS`` says, or one
        per core.
    overrides : dict, optional
        Values that replace those of the config, by dotted key.

    Returns
    -------
    ndarray, shape (n,), dtype `LAUNCH`
        The launches; x and y are 0. A coin that would start inside the surface is lifted until it
        touches only when it is tossed, not here.

    Examples
    --------
    >>> import coinmc
    >>> scene = {"coin": {"ratio": 1}, "surface": {"restitution": 0.5, "friction": 0.3},
    ...          "launch": {"preset": "robot"}, "engine": {"flat": {}}, "stop": {"tosses": 100}}
    >>> drawn = coinmc.launches(scene, 100)
    >>> drawn["velocity_m_s"].shape
    (100, 3)
    >>> bool((coinmc.toss(scene, launches=drawn).face == coinmc.toss(scene, 100).face).all())
    True
    """
    n, threads = natural(n, "n"), threads_of(threads)
    plan = plan_of(as_config(config, overrides, absent={"stop.tosses": max(n, 1)}))
    drawn = np.empty(n, LAUNCH)
    _lib.launches(plan, natural(point, "point"), natural(first, "first"), rows(drawn), threads)
    return drawn


def as_launches(given: Any) -> NDArray[np.void]:
    """Check launches given by the user and return them as a contiguous array of `LAUNCH`.

    An array that is already in that form is not copied.
    """
    if isinstance(given, Mapping):
        return _from_dict(given)
    array = plain(given)
    if array.dtype.names is None or set(array.dtype.names) != set(LAUNCH.names):
        raise TypeError(
            f"launches must be a structured array with the fields {', '.join(LAUNCH.names)}"
        )
    if array.ndim > 1:
        raise ValueError(f"launches must be a 1-D array, not {array.ndim}-D: call ravel()")
    array = np.atleast_1d(array)
    if array.dtype == LAUNCH and array.flags.c_contiguous and array.flags.aligned:
        return array
    return _converted(array)


def _from_dict(given: Mapping[str, Any]) -> NDArray[np.void]:
    missing = [name for name in LAUNCH.names if name not in given]
    unknown = [str(name) for name in given if name not in LAUNCH.names]
    if missing or unknown:
        told = [f"lacks {', '.join(missing)}"] if missing else []
        told += [f"has {', '.join(unknown)}"] if unknown else []
        wanted = ", ".join(LAUNCH.names)
        raise TypeError(f"a dict of launches has the arrays {wanted}: this {' and '.join(told)}")
    arrays = {name: np.atleast_2d(plain(given[name])) for name in LAUNCH.names}
    for name, array in arrays.items():
        if array.dtype.kind not in "fiu" or array.ndim != 2 or array.shape[1] != 3:
            raise TypeError(f"{name} must be an array of real numbers of shape (n, 3) or (3,)")
    lengths = {name: len(array) for name, array in arrays.items()}
    n = max(lengths.values())
    if any(length not in (1, n) for length in lengths.values()):
        told = ", ".join(f"{length} of {name}" for name, length in lengths.items())
        raise ValueError(f"the arrays of launches must be equally long, not {told}")
    launches = np.empty(n, LAUNCH)
    for name, array in arrays.items():
        launches[name] = array
    return launches


def plain(given: Any) -> NDArray[Any]:
    """Convert to a plain array, dropping what subclasses add."""
    # a pandas Series has a method of the name `mask`
    if np.ma.is_masked(given):
        raise ValueError("masked values are not supported: fill or drop them")
    return np.asarray(given)


def _converted(array: NDArray[Any]) -> NDArray[np.void]:
    launches = np.empty(array.shape, LAUNCH)
    for name in LAUNCH.names:
        field = array[name]
        if field.dtype.kind not in "fiu" or field.shape != launches[name].shape:
            raise TypeError(f"the field {name} of a launch must be three real numbers")
        launches[name] = field
    return launches


def rows(states: NDArray[Any]) -> NDArray[np.float64]:
    """Return a view of states as rows of twelve numbers, without copying."""
    return states.view(np.float64).reshape(len(states), _NUMBERS)


def natural(number: Any, name: str) -> int:
    """Check a non-negative integer and return it."""
    try:
        whole = number.__index__()
    except (AttributeError, TypeError):
        if isinstance(number, float) and number.is_integer() and abs(number) < 1 << 53:
            whole = int(number)  # 1e6 is a natural way to write a million
        else:
            raise TypeError(f"{name} must be a whole number, not {number!r}") from None
    if not 0 <= whole < 1 << 63:
        raise ValueError(f"{name} must be from 0 to 2^63 - 1, not {whole}")
    return whole


def threads_of(threads: Any) -> int | None:
    """Check a number of threads and return it; None is what the environment says, if it does."""
    most, name = 1024, "threads"
    if threads is None:
        said = os.environ.get(_VARIABLE, "").strip()
        if not said:
            return None
        if not (said.isascii() and said.isdigit() and len(said) < 9):
            raise ValueError(f"{_VARIABLE} must be from 1 to {most}, not {said!r}")
        threads, name = int(said), _VARIABLE
    if not isinstance(threads, int):
        threads = natural(threads, name)
    if not 1 <= threads <= most:
        raise ValueError(f"{name} must be from 1 to {most}, not {threads}")
    return threads
