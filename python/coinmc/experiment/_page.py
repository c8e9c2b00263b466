"""A page about a day of throws: one file of HTML."""

import base64
import html
import io
from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from coinmc.experiment._misread import FACES, Confusion
from coinmc.experiment._model import Prediction

if TYPE_CHECKING:
    from coinmc.experiment._day import Day

__all__ = ["page"]

_STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; max-width: 60rem; margin: 2rem auto; padding: 0 1rem;
  color: #1b2733; background: #fff }
table { border-collapse: collapse; margin: 1rem 0 }
th, td { padding: .2rem .8rem; text-align: right; border-bottom: 1px solid #d7dee5 }
th:first-child, td:first-child { text-align: left }
figure { margin: 1rem 0 } figcaption, .small { color: #55636f; font-size: 13px }
img { width: 220px; border: 1px solid #d7dee5 }
.photos { display: flex; flex-wrap: wrap; gap: .6rem }
svg { max-width: 100%; height: auto } svg text { font: 12px system-ui, sans-serif; fill: #1b2733 }
@media (prefers-color-scheme: dark) { body { color: #dfe6ec; background: #14191e }
  svg text { fill: #dfe6ec } th, td { border-color: #36414b }
  figcaption, .small { color: #9fb0be } }
"""
# of Okabe and Ito: told apart with any kind of colour vision
_COLORS = {"heads": "#0072b2", "tails": "#e69f00", "side": "#009e73", "": "#999999"}
_PHOTOS = 6
_EDGE = 440


def page(day: "Day", confusion: Confusion | None, prediction: Prediction) -> str:
    """Return the page."""
    name = html.escape(day.path.resolve().name)
    void = day.counts["undecided"]
    some = ", ".join(f"{count} {html.escape(why)}" for why, count in day.voids.items())
    parts = [
        f"<h1>A day of throws: {name}</h1>",
        f"<p>{len(day):,} of {day.planned:,} throws are resolved. {void:,} have no result"
        f"{' (' + some + ')' if some else ''}; they may have shown any face, and widen every "
        "interval.</p>",
        _probabilities(day, confusion, prediction),
        _figure(_map(day), "Every throw by the spin and the start angle that were measured (told, "
                "where none was). Grey: no result."),
        _settings(day),
        _readings(day),
        _photos(day),
    ]  # fmt: skip
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>Throws: {name}</title><style>{_STYLE}</style></head><body>\n"
        + "\n".join(part for part in parts if part)
        + "\n</body></html>\n"
    )


def _probabilities(day: "Day", confusion: Confusion | None, prediction: Prediction) -> str:
    rows = [("experiment, of all throws", _COLORS["heads"], day.estimate())]
    if confusion is not None:
        rows.append(("corrected for wrong readings", _COLORS["side"], day.corrected(confusion)))
    rows.append(("model, same spins and angles", _COLORS["tails"], prediction.estimate()))
    head = "".join(f"<th>P({face})</th>" for face in FACES)
    lines = []
    for title, _, found in rows:
        cells = "".join(
            f"<td>{found[f].p:.4f} [{found[f].lo:.4f}, {found[f].hi:.4f}]</td>" for f in FACES
        )
        lines.append(f"<tr><td>{title}</td>{cells}</tr>")
    table = f"<table><tr><th>95 % intervals</th>{head}</tr>{''.join(lines)}</table>"
    return "<h2>Probabilities</h2>" + table + _figure(_bars(rows), "")


def _bars(rows: list[tuple[str, str, dict]]) -> str:
    wide, left, height = 640, 90, 26
    drawn, y = [], 20
    most = max(found[face].hi for _, _, found in rows for face in FACES)
    scale = (wide - left - 20) / max(most, 1e-9)
    for face in FACES:
        drawn.append(f'<text x="8" y="{y + height * len(rows) / 2 + 4}">{face}</text>')
        for title, color, found in rows:
            p, lo, hi = (left + scale * max(v, 0.0) for v in found[face][:3])
            middle = y + height / 2
            drawn.append(
                f'<g><title>{title}: {found[face].p:.4f}</title><line x1="{lo:.1f}" x2="{hi:.1f}" '
                f'y1="{middle}" y2="{middle}" stroke="{color}" stroke-width="5"/>'
                f'<circle cx="{p:.1f}" cy="{middle}" r="6" fill="{color}"/></g>'
            )
            y += height
        y += 14
    for tick in _ticks(most):
        x = left + scale * tick
        drawn.append(f'<text x="{x:.1f}" y="{y + 6}" text-anchor="middle">{tick:.3g}</text>')
    for place, (title, color, _) in enumerate(rows):
        x = left + place * 190
        drawn.append(f'<circle cx="{x}" cy="{y + 26}" r="6" fill="{color}"/>')
        drawn.append(f'<text x="{x + 12}" y="{y + 30}">{title}</text>')
    return _svg(wide, y + 44, drawn, "Probabilities of the faces with their intervals")


def _map(day: "Day") -> str:
    wide, high, left, low = 640, 360, 50, 40
    spin = np.where(np.isnan(day["measured_spin_rev_s"]), day["spin_rev_s"],
                    day["measured_spin_rev_s"])  # fmt: skip
    angle = np.where(np.isnan(day["measured_angle_deg"]), day["angle_deg"],
                     day["measured_angle_deg"])  # fmt: skip
    most = max(float(spin.max()) if len(spin) else 0.0, 0.1)
    x = left + spin / most * (wide - left - 15)
    y = high - low - angle / 180.0 * (high - low - 15)
    face = np.where(day["void"] == "", day["face"], "")
    drawn = []
    for name, color in _COLORS.items():
        here = face == name
        dots = "".join(f"M{a:.1f} {b:.1f}h0" for a, b in zip(x[here], y[here], strict=True))
        drawn.append(
            f'<path d="{dots}" stroke="{color}" stroke-width="5" stroke-linecap="round" '
            'stroke-opacity=".75" fill="none"/>'
        )
    for tick in range(0, 181, 45):
        at = high - low - tick / 180.0 * (high - low - 15)
        drawn.append(f'<text x="{left - 8}" y="{at + 4:.1f}" text-anchor="end">{tick}°</text>')
    for tick in _ticks(most):
        at = left + tick / most * (wide - left - 15)
        label = f'<text x="{at:.1f}" y="{high - 20}" text-anchor="middle">{tick:.3g}</text>'
        drawn.append(label)
    drawn.append(f'<text x="{wide / 2}" y="{high - 4}" text-anchor="middle">spin, rev/s</text>')
    for place, name in enumerate(FACES):
        at = wide - 190 + 65 * place
        drawn.append(f'<circle cx="{at}" cy="8" r="5" fill="{_COLORS[name]}"/>')
        drawn.append(f'<text x="{at + 9}" y="12">{name}</text>')
    return _svg(wide, high, drawn, "Throws by spin and start angle")


def _settings(day: "Day") -> str:
    spin = day["measured_spin_rev_s"] - day["spin_rev_s"]
    angle = day["measured_angle_deg"] - day["angle_deg"]
    rows = [
        (f"{title}, measured minus told", f"{np.nanmean(off):+.4f}", f"{np.nanstd(off):.4f}", unit)
        for title, off, unit in (("spin", spin, "rev/s"), ("start angle", angle, "degrees"))
        if not np.isnan(off).all()
    ]
    return _table("The robot", ("", "mean", "standard deviation", ""), rows)


def _readings(day: "Day") -> str:
    if "confidence" not in day.columns:
        return ""
    rows = []
    for name in ("photos", "markers", "confidence", "reprojection_px", "deviation_deg"):
        values = day[name][~np.isnan(day[name])]
        if len(values):
            low, middle, high = np.quantile(values, [0.05, 0.5, 0.95])
            rows.append((name, f"{low:.3g}", f"{middle:.3g}", f"{high:.3g}", f"{len(values):,}"))
    wrong = day.check_photos()
    told = "All photos are as they were taken." if not wrong else html.escape("; ".join(wrong[:5]))
    head = ("", "5 %", "median", "95 %", "throws")
    return _table("The readings", head, rows) + f'<p class="small">{told}</p>'


def _photos(day: "Day") -> str:
    """Show the least certain photos: those that a person should look at."""
    try:
        from PIL import Image
    except ImportError:
        return ""
    rows = np.arange(len(day))[day["image"] != ""]
    if "confidence" in day.columns:
        rows = rows[np.argsort(day["confidence"][rows], kind="stable")]
    shown = []
    for row in rows[:_PHOTOS]:
        path = day.path / "photos" / str(day["image"][row])
        try:
            with Image.open(path, formats=("JPEG", "PNG")) as image:
                image.draft("L", (_EDGE, _EDGE))
                image.thumbnail((_EDGE, _EDGE))
                small = io.BytesIO()
                image.convert("L").save(small, "JPEG", quality=70)
        # no photo is worth losing the page
        except (OSError, ValueError, SyntaxError, Image.DecompressionBombError):
            continue
        data = base64.b64encode(small.getvalue()).decode()
        text = f"throw {int(day['id'][row])}: {day['face'][row]}"
        shown.append(
            f'<figure><img alt="{html.escape(text)}" src="data:image/jpeg;base64,{data}">'
            f"<figcaption>{html.escape(text)}</figcaption></figure>"
        )
    if not shown:
        return ""
    return f'<h2>The least certain photos</h2><div class="photos">{"".join(shown)}</div>'


def _table(title: str, head: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> str:
    lines = ["".join(f"<td>{html.escape(cell)}</td>" for cell in row) for row in rows]
    if not lines:
        return ""
    heads = "".join(f"<th>{html.escape(cell)}</th>" for cell in head)
    body = "".join(f"<tr>{line}</tr>" for line in lines)
    return f"<h2>{title}</h2><table><tr>{heads}</tr>{body}</table>"


def _ticks(most: float) -> np.ndarray:
    """Return round numbers from 0 to the greatest value, about five."""
    power = 10.0 ** np.floor(np.log10(most / 4.0))
    step = power * next(factor for factor in (1, 2, 5, 10) if factor * power >= most / 6.0)
    return np.arange(0.0, most + 1e-9, step)


def _figure(drawing: str, caption: str) -> str:
    return f"<figure>{drawing}<figcaption>{caption}</figcaption></figure>"


def _svg(wide: float, high: float, drawn: list[str], title: str) -> str:
    return (
        f'<svg viewBox="0 0 {wide:.0f} {high:.0f}" width="{wide:.0f}" role="img" '
        f'aria-label="{title}">{"".join(drawn)}</svg>'
    )
