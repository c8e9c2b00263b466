"""Run time against total error, from the rows of run.py.

    python studies/peers/errors.py peers.jsonl [times.svg]

The total error of P(side) after N tosses is |bias| + 1.96 sqrt(p(1 − p)/N), so an engine of rate r
needs

    T(ε) = p(1 − p) (1.96/(ε − |bias|))²/r,

and never gets there if |bias| ≥ ε. The bias of coinmc is its difference from the same tosses at
ten times tighter settings, *plus* 1.96 standard errors. That of a peer at a step is its difference
from its own finest step, *less* 1.96 standard errors of both: what cannot be denied. A peer whose
contact law is another one is not blamed for that. So its times are lower bounds and ours upper
bounds.
"""

from __future__ import annotations

import json
import math
import sys
from pathlib import Path

ERRORS = (0.01, 0.003, 0.001, 0.0003)
FINE = tuple(0.1 * 10 ** (-step / 6) for step in range(19))
"""Errors of the picture, 0.1 to 1e-4."""
NORMAL = 1.96


def bias(row: dict, rows: list[dict]) -> float:
    """|bias| to reckon with, as above."""
    if row["bias"] is not None:
        return abs(row["bias"]) + NORMAL * row["bias_error"]
    own = [other for other in rows if other["engine"] == row["engine"]]
    finest = min(own, key=lambda other: other["step_s"])
    if finest is row:
        return 0.0
    difference = abs(row["p_side"] - finest["p_side"])
    error = math.hypot(row["p_side_error"], finest["p_side_error"])
    return max(0.0, difference - NORMAL * error)


def seconds_to(error: float, row: dict, rows: list[dict]) -> float:
    """T(ε) of one engine at one step; infinity where the bias is in the way."""
    left = error - bias(row, rows)
    if left <= 0.0:
        return math.inf
    p = row["p_side"]
    return p * (1.0 - p) * (NORMAL / left) ** 2 / row["tosses_per_s"]


def best(error: float, engine: str, rows: list[dict]) -> float:
    """The least T(ε) over an engine's steps."""
    return min(seconds_to(error, row, rows) for row in rows if row["engine"] == engine)


def duration(seconds: float) -> str:
    """Three digits and a unit that suits them."""
    if math.isinf(seconds):
        return "never"
    for unit, size in (("d", 86400.0), ("h", 3600.0), ("min", 60.0), ("s", 1.0)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{1e3 * seconds:.3g} ms"


def table(rows: list[dict]) -> str:
    """Rates beside the first row's, and the time to each error, as Markdown."""
    first = rows[0]
    lines = [
        "| engine | step, s | tosses | P(side) | tosses/s | coinmc is faster by |",
        "|---|---|---|---|---|---|",
    ]
    for row in rows:
        step = "–" if row["step_s"] is None else f"{row['step_s']:g}"
        p = f"{row['p_side']:.4f} ± {NORMAL * row['p_side_error']:.4f}"
        ratio = first["tosses_per_s"] / row["tosses_per_s"]
        lines.append(
            f"| {row['engine']} | {step} | {row['tosses']} | {p} "
            f"| {row['tosses_per_s']:.3g} | {ratio:.3g} |"
        )
    lines += [
        "",
        "| time to a total error of | " + " | ".join(f"{error:g}" for error in ERRORS) + " |",
        "|---|" + "---|" * len(ERRORS),
    ]
    for engine in dict.fromkeys(row["engine"] for row in rows):
        least = "" if engine.startswith("coinmc") else "≥ "
        cells = [best(error, engine, rows) for error in ERRORS]
        shown = [least * math.isfinite(cell) + duration(cell) for cell in cells]
        lines.append(f"| {engine} | " + " | ".join(shown) + " |")
    return "\n".join(lines)


def picture(rows: list[dict], path: Path) -> None:
    """Draws the time to each error of `FINE`, a curve an engine, as far as it gets."""
    from coinmc import plot

    drawn: dict[str, list] = {"engine": [], "time_s": [], "total_error": []}
    for engine in dict.fromkeys(row["engine"] for row in rows):
        for error in FINE:
            seconds = best(error, engine, rows)
            if math.isfinite(seconds):
                drawn["engine"].append(engine)
                drawn["time_s"].append(seconds)
                drawn["total_error"].append(error)
    axes = plot.time_against_error(drawn, by="engine", slope=False)
    axes.set_xlabel("processor time on one core, s")
    axes.figure.savefig(path)


def main() -> None:
    rows = [json.loads(line) for line in Path(sys.argv[1]).read_text().splitlines()]
    print(table(rows))
    for path in sys.argv[2:]:
        picture(rows, Path(path))


if __name__ == "__main__":
    main()
