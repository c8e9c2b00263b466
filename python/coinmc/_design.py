"""A fair coin to print."""

import html
import json
import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coinmc import _lib
from coinmc._config import ConfigLike
from coinmc._launches import threads_of
from coinmc._progress import reporting
from coinmc._question import html_table, source_of

__all__ = ["Design", "design"]


class Design:
    """A coin to print. Made by `design`.

    Attributes
    ----------
    diameter_m, thickness_m : float
        Its size.
    ratio, ratio_lo, ratio_hi : float
        H/R and its interval; an open end is NaN.
    mass_kg : float
        Its mass.
    draft_deg : float
        Angle of its side with the axis; above 0 heads is the wider face.
    p_heads, p_tails : float
        With a draft, how often it shows its two faces, which differ; without, half of what the side
        leaves.
    tolerances : dict of str to ndarray
        What an error of the thickness does: ``thickness_error_m``, ``p_side_error``, and
        ``tosses_to_tell`` by a χ² test of 5 % that finds such a coin with 80 %.
    files : dict of str to bytes
        Contents by ending: ``.stl``, ``.3mf`` (both in millimetres), ``.scad`` and ``.svg``, a
        sheet to print.
    document : dict
        All of the answer, as ``coinmc design --format json`` prints it, but for names of files.
    """

    def __init__(self, document: dict[str, Any], files: dict[str, bytes]) -> None:
        self.document = document
        self.files = files
        self.diameter_m: float = document["diameter_m"]
        self.thickness_m: float = document["thickness_m"]
        self.ratio: float = document["ratio"]
        self.ratio_lo: float
        self.ratio_hi: float
        self.ratio_lo, self.ratio_hi = (
            float("nan") if document[end] is None else document[end]
            for end in ("ratio_lo", "ratio_hi")
        )
        self.mass_kg: float = document["mass_kg"]
        self.draft_deg: float = document["draft_deg"]
        faces = document["faces"]
        rest = 0.5 * (1.0 - document["target"])
        self.p_heads: float = faces["heads"]["p"] if faces else rest
        self.p_tails: float = faces["tails"]["p"] if faces else rest
        rows = document["tolerances"]
        self.tolerances: dict[str, NDArray[Any]] = {
            name: np.array([row[name] for row in rows]) for name in rows[0]
        }

    def sheet(self) -> str:
        """Return the page to print and keep with the coin: the text of an SVG file."""
        return self.files[".svg"].decode()

    def write(self, name: str | os.PathLike[str]) -> list[Path]:
        """Write all files under a name without ending; nothing is overwritten.

        Returns
        -------
        list of Path
            The files.
        """
        paths = [Path(f"{os.fspath(name)}{ending}") for ending in self.files]
        for path in paths:
            if path.exists():
                raise FileExistsError(
                    f"{path} exists already: choose another name, or move it away"
                )
        for path, content in zip(paths, self.files.values(), strict=True):
            with path.open("xb") as file:
                file.write(content)
        return paths

    def __repr__(self) -> str:
        return f"<coinmc.Design {self._title()}>"

    def _repr_html_(self) -> str:
        heads = ["thickness off by, mm", "P(side) off by", "tosses to tell"]
        rows = [
            [f"{1e3 * error:g}", f"{abs(change):.4f}", f"{tosses:,}"]
            for error, change, tosses in zip(*self.tolerances.values(), strict=True)
        ]
        return f"<p>{html.escape(self._title())}</p>{html_table(heads, rows)}"

    def _title(self) -> str:
        return (
            f"{1e3 * self.diameter_m:.2f} mm in diameter, {1e3 * self.thickness_m:.2f} mm thick,"
            f" H/R = {self.ratio:.3f} [{self.ratio_lo:.3f}, {self.ratio_hi:.3f}]"
        )


def design(
    config: ConfigLike | None = None,
    scene: str | None = None,
    *,
    diameter_m: float | None = None,
    target: float = 1.0 / 3.0,
    rim_m: float | None = None,
    chamfer_m: float | None = None,
    draft_deg: float | None = None,
    marks: bool = False,
    density_kg_m3: float = 1240.0,
    walls_m: float | None = None,
    infill: float | None = None,
    half_width: float = 0.01,
    threads: int | None = None,
    progress: bool | Callable[[int, int], None] | None = None,
    overrides: Mapping[str, Any] | None = None,
) -> Design:
    """Design a fair coin to print, like ``coinmc design``.

    Parameters
    ----------
    config : path, dict or Config, optional
        The scene; its ratio and its ``[stop]`` have no effect.
    scene : str, optional
        Without a config: an everyday scene, by default ``"table"``. `coinmc.scenes` lists them.
    diameter_m : float, optional
        Diameter, by default that of the config, and 24 mm for an everyday scene.
    target : float, optional
        Probability of the side.
    rim_m, chamfer_m : float, optional
        Radius with which the rims are rounded, or by how much they are cut at 45° (the tosses are
        those of rims rounded with as much then).
    draft_deg : float, optional
        Angle of the side with the axis, by default that of the config: above 0 heads is the wider
        face, of the diameter given. Heads and tails then differ, and the side alone gets its
        probability. With sharp rims, no marks and no infill only.
    marks : bool, optional
        Whether to engrave three marks on heads and six on tails.
    density_kg_m3 : float, optional
        Density of the material.
    walls_m, infill : float, optional
        Of a coin that is not full inside: thickness of its walls, and the share of its inside that
        is full, 0 to 1.
    half_width : float, optional
        Half width of the interval of H/R that is enough.
    threads : int, optional
        Number of threads.
    progress : bool or callable, optional
        Whether to show progress.
    overrides : dict, optional
        Values that replace those of the config, by dotted key.

    Returns
    -------
    Design

    Examples
    --------
    >>> import coinmc
    >>> coin = coinmc.design(scene="felt", diameter_m=0.03, rim_m=0.001, half_width=0.1)
    >>> 0.5 < coin.ratio < 2.5
    True
    >>> sorted(coin.files)
    ['.3mf', '.scad', '.stl', '.svg']
    """
    if rim_m is not None and chamfer_m is not None:
        raise ValueError("the rims are rounded or cut: give rim_m or chamfer_m, not both")
    if (walls_m is None) != (infill is None):
        raise ValueError("walls_m and infill go together")
    source, sets = source_of(config, scene, overrides)
    asked = {
        "source": source,
        "overrides": sets,
        "diameter_m": None if diameter_m is None else float(diameter_m),
        "target": float(target),
        "rim_m": None if rim_m is None else float(rim_m),
        "chamfer_m": None if chamfer_m is None else float(chamfer_m),
        "draft_deg": None if draft_deg is None else float(draft_deg),
        "marks": bool(marks),
        "density_kg_m3": float(density_kg_m3),
        "infill": None if walls_m is None or infill is None else (float(walls_m), float(infill)),
        "half_width": float(half_width),
        "threads": threads_of(threads),
    }
    with reporting(progress, "design") as report:
        document, files = _lib.design(asked, report)
    return Design(json.loads(document), {ending: bytes(content) for ending, content in files})
