"""The sheet to print: markers of the coin and the board, at true scale, as PDF and SVG."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from coinmc._errors import VisionError
from coinmc.vision._board import Board
from coinmc.vision._coin import MODULES, STRIP_PLACES, MarkedCoin
from coinmc.vision._needs import cv2, matplotlib

__all__ = ["along_strip", "marker_cells", "print_sheets", "remarks"]

_PAPERS = {"A4": (210.0, 297.0), "A3": (297.0, 420.0), "A2": (420.0, 594.0)}
_CUT = {"color": "0.6", "linewidth": 0.2}
_EDGE = 10.0
# Paper that overlaps where the strip closes, and between its pieces.
_OVERLAP = 4.0
_TITLE = 22.0


@dataclass(frozen=True)
class _Page:
    """Where the parts of a coin lie on paper, mm from its lower left corner."""

    paper: str
    size: tuple[float, float]
    faces: list[tuple[float, float]]
    #: From, to along the strip, and the upper edge on paper.
    strips: list[tuple[tuple[float, float], float]]


def print_sheets(coin: MarkedCoin, folder: Path | str, board: Board | None = None) -> list[Path]:
    """Write ``coin.pdf``, ``coin.svg``, ``board.pdf``, ``board.svg`` and ``coin.json``.

    Parameters
    ----------
    coin : MarkedCoin
        The coin.
    folder : path
        A new folder, or one without files of these names.
    board : Board, optional
        The board for the table.

    Returns
    -------
    list of Path
        The files.

    Raises
    ------
    coinmc.VisionError
        If a file exists, cannot be written, or the coin does not fit on A4.
    """
    folder = Path(folder)
    names = ("coin.pdf", "coin.svg", "board.pdf", "board.svg", "coin.json")
    paths = [folder / name for name in names]
    there = [path.name for path in paths if path.exists()]
    if there:
        raise VisionError(f"{folder} contains {', '.join(there)}: give a new folder")
    at, wide = _arranged(coin), _PAPERS["A4"][::-1]
    try:
        folder.mkdir(parents=True, exist_ok=True)
        _save(at.size, paths[:2], lambda page: _coin_page(page, coin, at))
        _save(wide, paths[2:4], lambda page: _board_page(page, board or Board(), wide))
    except OSError as error:
        raise VisionError(f"cannot write the sheets in {folder}: {error.strerror}") from error
    coin.save(paths[4])
    return paths


def _pieces(coin: MarkedCoin, room: float) -> list[tuple[float, float]]:
    """Cut the strip between markers into pieces that fit; from, to along the strip."""
    pitch = 2.0 * math.pi * coin.radius_mm / STRIP_PLACES
    each = int((room - _OVERLAP) // pitch)
    if each < 1:
        return []
    starts = range(0, STRIP_PLACES, each)
    ends = (min(start + each, STRIP_PLACES) for start in starts)
    return [
        ((start - 0.5) * pitch, (end - 0.5) * pitch)
        for start, end in zip(starts, ends, strict=True)
    ]


def _arranged(coin: MarkedCoin) -> _Page:
    """Arrange the coin on the smallest paper that holds it."""
    for name, size in _PAPERS.items():
        room, edge = size[0] - 2.0 * _EDGE, coin.radius_mm + 5.0
        pieces = _pieces(coin, room)
        beside = 4.0 * edge <= room
        if 2.0 * edge > room or not pieces:
            continue
        y = size[1] - _TITLE - edge
        faces = [(_EDGE + edge, y), (_EDGE + 3.0 * edge, y)]
        if not beside:
            faces[1] = (_EDGE + edge, y - 2.0 * edge)
        y = faces[1][1] - edge - 3.0
        strips = [y - place * (coin.height_mm + 8.0) for place in range(len(pieces))]
        if strips[-1] - coin.height_mm >= _EDGE:
            return _Page(name, size, faces, list(zip(pieces, strips, strict=True)))
    raise VisionError(
        f"a coin of radius {coin.radius_mm:g} mm and height {coin.height_mm:g} mm does not fit on "
        f"any of {', '.join(_PAPERS)}"
    )


def _save(size: tuple[float, float], paths: list[Path], draw: Callable[[Any], None]) -> None:
    fixed = {"svg.hashsalt": "coinmc", "svg.fonttype": "path", "pdf.fonttype": 42}
    # edges stay where they are, instead of on whole dots
    fixed["path.snap"] = False
    with matplotlib("").rc_context(fixed):
        figure = matplotlib("figure").Figure(figsize=(size[0] / 25.4, size[1] / 25.4))
        page = figure.add_axes((0, 0, 1, 1))
        page.set(xlim=(0, size[0]), ylim=(0, size[1]))
        page.set_axis_off()
        draw(page)
        for path in paths:
            made = {"CreationDate": None} if path.suffix == ".pdf" else {"Date": None}
            figure.savefig(path, format=path.suffix[1:], metadata=made)


def _coin_page(page: Any, coin: MarkedCoin, at: _Page) -> None:
    height = at.size[1]
    page.text(
        _EDGE,
        height - 9,
        f"Coin of radius {coin.radius_mm:g} mm, height "
        f"{coin.height_mm:.4g} mm (H/R = {coin.ratio:.4g}), paper {at.paper}",
        fontsize=9,
    )
    page.text(
        _EDGE,
        height - 13.5,
        "Print at 100 %, without fitting to the page; the bar is 100 mm. "
        "Cut along grey lines. Glue so that the marks 0 meet.",
        fontsize=7,
    )
    _bar(page, _EDGE, height - 17.0)
    for face, (x, y) in zip(("heads", "tails"), at.faces, strict=True):
        mirror = 1.0 if face == "heads" else -1.0
        for marker in coin.on(face):
            flat = marker.corners_mm[:, :2] * (mirror, 1.0) + (x, y)
            _cells(page, marker_cells(coin.dictionary, marker.id), flat)
        _circle(page, x, y, coin.radius_mm)
        _zero(page, x + mirror * coin.radius_mm, y, (mirror, 0.0))
        page.text(x - coin.radius_mm, y + coin.radius_mm - 2.0, face, fontsize=7, ha="left")
    for (start, end), top in at.strips:
        _strip(page, coin, (start, end), top)


def _strip(page: Any, coin: MarkedCoin, piece: tuple[float, float], top: float) -> None:
    (start, end), left = piece, _EDGE
    middle = top - coin.height_mm / 2.0
    for marker in coin.on("side"):
        flat = along_strip(marker.corners_mm, coin.radius_mm)
        if start < flat[:, 0].mean() < end:
            flat += np.array([left - start, middle])
            _cells(page, marker_cells(coin.dictionary, marker.id), flat)
    right, bottom = left + end - start, top - coin.height_mm
    overlap = right + _OVERLAP
    page.plot([left, overlap, overlap, left, left], [top, top, bottom, bottom, top], **_CUT)
    page.plot([right, right], [top, bottom], linestyle=":", **_CUT)
    if start <= 0.0 <= end:
        _zero(page, left - start, top, (0.0, 1.0))
        _zero(page, left - start, bottom, (0.0, -1.0))
    note = "side: heads above; glue the dotted end under the next"
    page.text(left + 12.0, top + 1.2, note, fontsize=5)


def _board_page(page: Any, board: Board, size: tuple[float, float]) -> None:
    width, height = board.size_mm
    x, y = (size[0] - width) / 2.0, (size[1] - height) / 2.0
    corners = np.array([[x, y + height], [x + width, y + height], [x + width, y], [x, y]])
    _cells(page, board.modules(), corners)
    page.text(
        x,
        y + height + 3.0,
        f"Board for the table: {board.columns} x {board.rows} squares of "
        f"{board.square_mm:g} mm. Print at 100 %; measure a square.",
        fontsize=8,
    )
    _bar(page, x, y - 6.0)


def marker_cells(dictionary: str, number: int) -> np.ndarray:
    """Return the modules of a marker, black as True, with its border; the upper row first."""
    aruco = cv2().aruco
    family = aruco.getPredefinedDictionary(getattr(aruco, dictionary))
    return family.generateImageMarker(number, MODULES) < 128


def along_strip(corners_mm: np.ndarray, radius_mm: float) -> np.ndarray:
    """Unroll corners on the side: along the strip, continuous over each marker, and up."""
    angle = np.unwrap(np.arctan2(corners_mm[:, 1], corners_mm[:, 0]))
    # from just before the first marker on
    angle += 2.0 * math.pi * (angle.mean() < -math.pi / STRIP_PLACES)
    return np.column_stack([angle * radius_mm, corners_mm[:, 2]])


def _cells(page: Any, black: np.ndarray, corners: np.ndarray) -> None:
    """Draw cells: an upright black rectangle, and on it a white one for each run of a row."""
    rows, columns = black.shape
    left, top = corners[0]
    width, height = (corners[1][0] - left) / columns, (top - corners[3][1]) / rows
    runs = []
    for row, line in enumerate(~black):
        edges = np.flatnonzero(np.diff(np.concatenate([[False], line, [False]]).astype(int)))
        for start, end in edges.reshape(-1, 2):
            below = row + 1 < rows and not black[row + 1, start:end].any()
            # over the row below where that is white too: viewers show a hair between them
            deep = height * (1.2 if below else 1.0)
            y = top - row * height
            x, right = left + start * width, left + end * width
            runs.append([(x, y), (right, y), (right, y - deep), (x, y - deep)])
    for shapes, color in (([corners], "black"), (runs, "white")):
        drawn = matplotlib("collections").PolyCollection(shapes, facecolors=color, linewidths=0)
        page.add_collection(drawn, autolim=False)


def _circle(page: Any, x: float, y: float, radius: float) -> None:
    turn = np.linspace(0.0, 2.0 * math.pi, 181)
    page.plot(x + radius * np.cos(turn), y + radius * np.sin(turn), **_CUT)


def _zero(page: Any, x: float, y: float, out: tuple[float, float]) -> None:
    """Mark the angle 0 outside an edge."""
    page.plot([x, x + 1.5 * out[0]], [y, y + 1.5 * out[1]], color="black", linewidth=0.4)
    page.text(x + 2.4 * out[0], y + 2.4 * out[1], "0", fontsize=5, ha="center", va="center")


def _bar(page: Any, x: float, y: float) -> None:
    page.plot([x, x + 100.0], [y, y], color="black", linewidth=0.6, solid_capstyle="butt")
    for end in (x, x + 100.0):
        page.plot([end, end], [y - 1.0, y + 1.0], color="black", linewidth=0.3)


def remarks(coin: MarkedCoin) -> list[str]:
    """Return what to know before printing: how fine a camera must see, and what is missing."""
    side = coin.on("side")
    if not side:
        return [
            f"the side is too low for markers ({coin.height_mm:g} mm): a coin that stands on it is "
            "read only where the camera sees a face"
        ]
    least = min(marker.width_mm for marker in coin.markers)
    # three pixels a module
    return [
        f"the smallest marker is {least:.2g} mm wide: the camera should see at least "
        f"{3.0 * MODULES / least:.2g} pixels per mm"
    ]
