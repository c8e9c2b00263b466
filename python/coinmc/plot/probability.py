"""P(face) along an axis of a sweep."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from coinmc import _lib, analytic
from coinmc._intervals import wilson
from coinmc.plot import published as others
from coinmc.plot.style import (
    CYCLE_MARKERS,
    FACE_MARKERS,
    NEUTRAL,
    Palette,
    axes_for,
    axis_label,
    colours,
    face_list,
    scene_text,
)
from coinmc.plot.table import columns, need, parameters, select

__all__ = ["probability"]

Table = Mapping[str, NDArray[Any]]

# The closed forms of a coin that does not bounce, in the plane and in space.
_NO_BOUNCE = {"arc", "zone"}
# The published Unity scene, as columns of a result.
_UNITY_SCENE = {"radius_m": 0.5, "restitution": 0.3, "friction": 10.0, "linear_drag_per_s": 1.0}
# More curves cannot be distinguished.
_MAX_CURVES = 21
_LINES = ["-", "--", "-.", ":"]


def probability(
    result: Any,
    *,
    x: str = "ratio",
    faces: str | Iterable[str] = "side",
    where: Mapping[str, Any] | None = None,
    closed_forms: bool | Iterable[str] = True,
    published: bool = True,
    label: str | None = None,
    color: Any = None,
    ax: Axes | None = None,
) -> Axes:
    """Plot the probability of faces with their intervals against a parameter.

    Parameters
    ----------
    result : table
        A result of `coinmc.run`, `coinmc.estimate` or `coinmc.open`, or any table
        with the columns `x`, ``p_<face>``, ``p_<face>_lo`` and ``p_<face>_hi``. Each combination of
        the other parameters that vary makes a curve.
    x : str
        Column of the horizontal axis.
    faces : str or iterable of str
        One or more of ``heads``, ``tails`` and ``side``.
    where : mapping of str to value, optional
        Use only rows with these values, such as ``{"friction": 0.3}``.
    closed_forms : bool or iterable of str
        Names of the rules of `coinmc.analytic` to draw; True draws the rule for the same kind of
        toss without bounces. Drawn only against the ratio.
    published : bool
        Show published values: fair ratios with their errors and, for results of the same scene, the
        counts of table 1 of arXiv 2401.03557. Drawn only against the ratio.
    label : str, optional
        Name of the result in the legend, before what distinguishes its curves.
    color : color, optional
        Colour of all curves, instead of one for each.
    ax : Axes, optional
        Axes to draw into; a new figure if absent.

    Returns
    -------
    Axes

    Examples
    --------
    >>> from coinmc import plot
    >>> table = {
    ...     "ratio": [1.0, 1.5, 2.0],
    ...     "p_side": [0.07, 0.25, 0.50],
    ...     "p_side_lo": [0.06, 0.24, 0.48],
    ...     "p_side_hi": [0.08, 0.26, 0.52],
    ... }
    >>> ax = plot.probability(table, closed_forms=["arc"])
    >>> ax.get_xlabel(), ax.get_ylabel()
    ('H/R, height over radius', 'P(side)')
    """
    shown = face_list(faces)
    table = select(columns(result), where)
    need(table, [x, *(f"p_{face}{end}" for face in shown for end in ("", "_lo", "_hi"))])
    ax = axes_for(ax)
    curves = _curves(table, x)
    for number, (name, curve) in enumerate(curves):
        for face in shown:
            style = _style(number, face, len(shown), colours(ax))
            if color is not None:
                style["color"] = color
            named = ", ".join(part for part in (label, _label(name, face, shown)) if part)
            _curve(ax, curve, x, face, style, named)
    span = (np.nanmin(table[x]), np.nanmax(table[x]))
    if x == "ratio":
        _closed_forms(ax, _rules(closed_forms, table), span, shown)
        if published:
            _published(ax, table, span, shown)
    _third(ax)
    ax.set(xlabel=axis_label(x), ylabel=_y_label(table, shown), ylim=(0, None))
    if not ax.get_title(loc="left"):
        ax.set_title(scene_text(table), loc="left", fontsize="small", color=NEUTRAL)
    if ax.get_legend_handles_labels()[1]:
        ax.legend(fontsize="small", frameon=False)
    return ax


def _third(ax: Axes) -> None:
    """Draw and name the line of a fair three-sided coin, once."""
    name = "1/3"
    if any(text.get_text() == name for text in ax.texts):
        return
    ax.axhline(1 / 3, color=NEUTRAL, linewidth=0.8, zorder=0)
    ax.annotate(
        name,
        (1, 1 / 3),
        xycoords=ax.get_yaxis_transform(),
        xytext=(3, 0),
        textcoords="offset points",
        va="center",
        fontsize="small",
        color=NEUTRAL,
        annotation_clip=False,
    )


def _curves(table: Table, x: str) -> list[tuple[str, Table]]:
    """Return name and rows of a curve for each combination of the other parameters that vary."""
    named = [name for name in ("engine", "law") if name in table]
    others = [name for name in [*parameters(table), *named] if name != x]
    varied = [name for name in others if len(np.unique(table[name])) > 1]
    combinations = list(dict.fromkeys(zip(*(table[name].tolist() for name in varied), strict=True)))
    if len(combinations) > _MAX_CURVES:
        raise ValueError(
            f"{len(combinations)} curves, one for each {', '.join(varied)}: choose some of them "
            f"with where={{{varied[0]!r}: …}}, or plot a heat map"
        )
    curves = []
    for values in combinations or [()]:
        at = dict(zip(varied, values, strict=True))
        rows = select(table, at)
        order = np.argsort(rows[x], kind="stable")
        named_values = (f"{_short(name)}{_value(value)}" for name, value in at.items())
        curves.append((", ".join(named_values), {key: held[order] for key, held in rows.items()}))
    return curves


def _short(name: str) -> str:
    """Return the text before the value of a parameter in a legend."""
    symbols = {
        "restitution": "e = ",
        "friction": "μ = ",
        "ratio": "H/R = ",
        "engine": "",
        "law": "",
    }
    return symbols.get(name, f"{name} = ")


def _value(value: Any) -> str:
    return value if isinstance(value, str) else f"{value:.6g}"


def _label(name: str, face: str, shown: list[str]) -> str:
    parts = [f"P({face})"] if len(shown) > 1 else []
    return ", ".join(parts + ([name] if name else []))


def _style(number: int, face: str, faces: int, palette: Palette) -> dict[str, Any]:
    """Style a curve: colours by face if there are several faces, else colours by curve."""
    if faces > 1:
        line = _LINES[number % len(_LINES)]
        return {"color": palette.faces[face], "marker": FACE_MARKERS[face], "linestyle": line}
    cycle = palette.cycle
    line = _LINES[number // len(cycle) % len(_LINES)]
    at = number % len(cycle)
    return {"color": cycle[at], "marker": CYCLE_MARKERS[at], "linestyle": line}


def _curve(ax: Axes, curve: Table, x: str, face: str, style: dict[str, Any], label: str) -> None:
    p, low, high = (curve[f"p_{face}{end}"] for end in ("", "_lo", "_hi"))
    ax.errorbar(
        curve[x],
        p,
        # a closed form has no interval; rounding must not make a bar negative
        yerr=np.nan_to_num(np.maximum([p - low, high - p], 0)),
        markersize=3.5,
        linewidth=1,
        elinewidth=1,
        capsize=2,
        label=label or None,
        **style,
    )


def _engines(table: Table) -> list[str]:
    return list(dict.fromkeys(table["engine"].tolist())) if "engine" in table else []


def _rules(wanted: bool | Iterable[str], table: Table) -> list[str]:
    if wanted is True:
        rules = map(_lib.no_bounce_rule, _engines(table))
        return list(dict.fromkeys(rule for rule in rules if rule))
    if wanted is False:
        return []
    return [wanted] if isinstance(wanted, str) else list(wanted)


def _closed_forms(ax: Axes, rules: list[str], span: tuple[float, float], shown: list[str]) -> None:
    ratio = np.linspace(*span, 200)
    for rule, line in zip(rules, itertools.cycle([":", "--", "-.", "-"])):
        p = analytic.rule(rule, ratio)
        for face in shown:
            label = f"{rule} rule, no bounce" if rule in _NO_BOUNCE else f"{rule} rule"
            if len(shown) > 1:
                label = f"P({face}), {label}"
            ax.plot(ratio, getattr(p, face), line, color=NEUTRAL, label=label, zorder=1)


def _published(ax: Axes, table: Table, span: tuple[float, float], shown: list[str]) -> None:
    if "side" in shown:
        for fair in others.fair_ratios(_engines(table)):
            ax.errorbar(
                fair.ratio,
                1 / 3,
                xerr=fair.half_width,
                color=NEUTRAL,
                marker="*",
                markersize=9,
                capsize=3,
                linestyle="none",
                label=f"fair: {fair.source}",
            )
    if _is_unity_scene(table):
        _unity(ax, span, shown)


def _is_unity_scene(table: Table) -> bool:
    return all(
        name in table and (table[name] == value).all() for name, value in _UNITY_SCENE.items()
    )


def _unity(ax: Axes, span: tuple[float, float], shown: list[str]) -> None:
    """Draw the published counts within the sweep, with Wilson's 95 % intervals."""
    counts = others.unity_table1()
    inside = (counts["ratio"] >= span[0]) & (counts["ratio"] <= span[1])
    for face in shown:
        count, tosses = counts[face][inside], counts["tosses"][inside]
        intervals = [wilson(int(k), 0, int(n), 0.95) for k, n in zip(count, tosses, strict=True)]
        share, low, high = np.array(intervals).reshape(-1, 3).T
        name = f"{others.SOURCE}, Unity"
        ax.errorbar(
            counts["ratio"][inside],
            share,
            yerr=[share - low, high - share],
            color=NEUTRAL,
            marker=FACE_MARKERS[face],
            markerfacecolor="none",
            markersize=8,
            capsize=3,
            linestyle="none",
            label=name if len(shown) == 1 else f"P({face}), {name}",
        )


def _y_label(table: Table, shown: list[str]) -> str:
    name = f"P({shown[0]})" if len(shown) == 1 else "P(face)"
    if "confidence" not in table:
        return name
    levels = np.unique(table["confidence"])
    return f"{name}, {100 * levels[0]:g} % intervals" if len(levels) == 1 else name
