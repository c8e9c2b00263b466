"""Launches, the initial states of tosses, as structured arrays."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from coinmc import _lib
from coinmc._config import ConfigLike, as_config, plan_of

__all__ = ["LAUNCH", "STATE", "launches"]

#: The coin at one instant: position of the centre (m; z is its height above the surface), velocity
#: (m/s), axis (unit vector out of the heads face), angular velocity (rad/s); each x, y, z in the
#: laboratory frame, z up.
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

_NUMBERS = STATE.itemsize // 8


def launches(
    config: ConfigLike,
    n: int,
    *,
    first: int = 0,
    point: int = 0,
    overrides: Mapping[str, Any] | None = None,
) -> np.ndarray:
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
    plan = plan_of(as_config(config, overrides))
    drawn = np.empty(natural(n, "n"), LAUNCH)
    _lib.launches(plan, natural(point, "point"), natural(first, "first"), rows(drawn))
    return drawn


def as_launches(given: Any) -> np.ndarray:
    """Check launches given by the user and return them as a contiguous array of `LAUNCH`.

    An array that is already in that form is not copied.
    """
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


def plain(given: Any) -> np.ndarray:
    """Convert to a plain array, dropping what subclasses add."""
    if np.any(getattr(given, "mask", False)):
        raise ValueError("masked values are not supported: fill or drop them")
    return np.asarray(given)


def _converted(array: np.ndarray) -> np.ndarray:
    launches = np.empty(array.shape, LAUNCH)
    for name in LAUNCH.names:
        field = array[name]
        if field.dtype.kind not in "fiu" or field.shape != launches[name].shape:
            raise TypeError(f"the field {name} of a launch must be three real numbers")
        launches[name] = field
    return launches


def rows(states: np.ndarray) -> np.ndarray:
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
        raise ValueError(f"{name} must not be negative or exceed 2^63 - 1")
    return whole


def threads_of(threads: Any) -> int | None:
    """Check a number of threads and return it."""
    most = 1024
    if threads is None:
        return None
    threads = natural(threads, "threads")
    if not 1 <= threads <= most:
        raise ValueError(f"threads must be from 1 to {most}, not {threads}")
    return threads
