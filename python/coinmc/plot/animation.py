"""Animation of a toss, as GIF or MP4."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any, Literal

import numpy as np
from matplotlib.animation import FFMpegWriter, FuncAnimation, PillowWriter
from matplotlib.axes import Axes
from numpy.typing import NDArray

from coinmc.plot.motion import Motion, motion_of
from coinmc.plot.path import draw_coin
from coinmc.plot.style import NEUTRAL, axes_for, colours

__all__ = ["animation"]

# More frames take long to draw and make a file too large for a web page.
_MAX_FRAMES = 2000
# Half the width of a frame that follows the coin, in radii.
_FOLLOWED = 6.0


def animation(
    trace: Any,
    path: str | os.PathLike[str] | None = None,
    *,
    slow: float = 4.0,
    fps: int = 25,
    dpi: float = 80,
    view: Literal["side", "top"] = "side",
    follow: bool = False,
    color: Any = None,
    overwrite: bool = False,
    ax: Axes | None = None,
) -> FuncAnimation:
    """Animate a toss, seen from the side or from above.

    Parameters
    ----------
    trace : coinmc.Trace
        A trace from `coinmc.trace` with at least `fps`/`slow` samples per second.
    path : path, optional
        File to write: ``.gif``, or ``.mp4`` where the program ffmpeg is installed. Nothing is
        written if absent.
    slow : float
        Slow-motion factor.
    fps : int
        Frames per second of the animation, 1 to 50.
    dpi : float
        Dots per inch.
    view : {"side", "top"}
        Direction of view.
    follow : bool
        Let the frame follow the coin, twelve radii wide, so that the coin is seen to turn.
        Otherwise the frame holds the whole path.
    color : color, optional
        Colour of the path.
    overwrite : bool
        Replace an existing file.
    ax : Axes, optional
        Axes to draw into; their whole figure is animated. A new figure if absent.

    Returns
    -------
    FuncAnimation
        Keep a reference to it as long as it is shown.

    Raises
    ------
    FileExistsError
        If the file exists and `overwrite` is not set.
    ValueError
        If the file has another extension, or there are more than 2000 frames.
    RuntimeError
        If an MP4 is requested and ffmpeg is not installed.

    Examples
    --------
    >>> import coinmc
    >>> from coinmc import plot
    >>> toss = coinmc.trace("examples/hand.toml", toss=3)
    >>> film = plot.animation(toss, "toss.gif", slow=1, fps=10)
    """
    motion = motion_of(trace)
    frames = _frames(motion, slow, fps)
    writer = None if path is None else _writer(Path(path), fps, overwrite)
    own, ax = ax is None, axes_for(ax, size=(4.8, 4.8))
    film = _film(ax, motion, frames, view, fps, follow=follow, color=color)
    if own:
        # all frames share the layout: computing it for each takes longer than drawing
        ax.figure.draw_without_rendering()
        ax.figure.set_layout_engine("none")
    if path is not None:
        film.save(os.fspath(path), writer=writer, dpi=dpi)
    return film


def _frames(motion: Motion, slow: float, fps: int) -> NDArray[np.int64]:
    """Return the index of the record shown in each frame: the last one not after it."""
    if not (1 <= fps <= 50):
        raise ValueError(f"fps must be 1 to 50, found {fps}")
    if not (np.isfinite(slow) and slow > 0):
        raise ValueError(f"slow must be positive, found {slow}")
    span = motion.time_s[-1] - motion.time_s[0]
    count = int(np.ceil(span * slow * fps)) + 1
    if count > _MAX_FRAMES:
        raise ValueError(
            f"{count} frames are more than {_MAX_FRAMES}: lower slow (now {slow:g}) or fps ({fps})"
        )
    times = motion.time_s[0] + np.arange(count) / (slow * fps)
    return np.append(
        np.searchsorted(motion.time_s, times[:-1], side="right") - 1, len(motion.time_s) - 1
    )


def _writer(path: Path, fps: int, overwrite: bool) -> Any:
    if path.suffix not in (".gif", ".mp4"):
        raise ValueError(f"{path}: an animation must end in .gif or .mp4")
    if path.exists() and not overwrite:
        raise FileExistsError(f"{path} exists: choose another name, or set overwrite=True")
    if path.suffix == ".gif":
        return PillowWriter(fps=fps)
    if not FFMpegWriter.isAvailable():
        raise RuntimeError(f"{path}: MP4 needs the program ffmpeg; install it, or name a .gif")
    return FFMpegWriter(fps=fps)


def _film(
    ax: Axes,
    motion: Motion,
    frames: NDArray[np.int64],
    view: str,
    fps: int,
    *,
    follow: bool,
    color: Any,
) -> FuncAnimation:
    if view not in ("side", "top"):
        raise ValueError(f"unknown view {view!r}: use side or top")
    up = 2 if view == "side" else 1
    _limits(ax, motion, up)
    color = colours(ax).modes["flight"] if color is None else color
    (trail,) = ax.plot([], [], color=color, linewidth=1)
    if follow:
        # the layout is that of the first frame
        _follow(ax, motion, int(frames[0]), up)
    clock = ax.set_title(" ", fontsize="medium", loc="left")
    drawn: list[Any] = []

    def show(at: int) -> list[Any]:
        for artist in drawn:
            artist.remove()
        drawn[:] = draw_coin(ax, motion, at, view)
        trail.set_data(motion.position_m[: at + 1, 0], motion.position_m[: at + 1, up])
        if follow:
            _follow(ax, motion, at, up)
        hits = int((motion.impacts <= at).sum())
        state = (
            motion.outcome.replace("_", " ") if at == len(motion.time_s) - 1 else motion.mode[at]
        )
        clock.set_text(f"{motion.time_s[at]:.3f} s, {hits} impacts, {state}")
        return [trail, clock, *drawn]

    # the first frame is drawn once for the limits and once for the film
    return FuncAnimation(
        ax.figure, show, frames=frames.tolist(), init_func=list, interval=1000 / fps
    )


def _follow(ax: Axes, motion: Motion, at: int, up: int) -> None:
    """Move the frame to the coin, but not far below the ground."""
    half = _FOLLOWED * max(motion.radius_m, motion.height_m / 2)
    x, y = motion.position_m[at, 0], motion.position_m[at, up]
    if up == 2:
        y = max(y, 0.8 * half)
    ax.set(xlim=(x - half, x + half), ylim=(y - half, y + half))


def _limits(ax: Axes, motion: Motion, up: int) -> None:
    """Set square limits that hold the coin throughout its motion."""
    reach = max(np.hypot(*rim) for rim in motion.rims_m)
    way = motion.position_m[:, [0, up]]
    low, high = way.min(axis=0) - 1.2 * reach, way.max(axis=0) + 1.2 * reach
    if up == 2:
        low[1] = min(low[1], -0.2 * reach)
        ax.axhline(0, color=NEUTRAL, linewidth=1)
        ax.axhspan(-1e3, 0, color=NEUTRAL, alpha=0.25, linewidth=0, zorder=0)
    middle, half = (low + high) / 2, (high - low).max() / 2
    ax.set(
        xlim=(middle[0] - half, middle[0] + half),
        ylim=(middle[1] - half, middle[1] + half),
        xlabel="x, m",
        ylabel="z, m" if up == 2 else "y, m",
    )
    ax.set_aspect("equal")
