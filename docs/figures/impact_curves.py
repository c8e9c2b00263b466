"""Draws docs/figures/impact-curves.svg from the CSV of a study.

coinmc-studies --csv impact-curves.csv impact-curves
python docs/figures/impact_curves.py impact-curves.csv docs/figures/impact-curves.svg
"""

import csv
import sys
from math import atan, pi

import matplotlib

matplotlib.use("svg")
# The same picture, byte for byte, from the same results.
matplotlib.rcParams["svg.hashsalt"] = "coinmc"
import matplotlib.pyplot as plt  # noqa: E402

# Okabe & Ito's colours, told apart by colour-blind eyes too.
COLOURS = ["#0072B2", "#009E73", "#D55E00", "#CC79A7", "#E69F00", "#56B4E9"]
RESTITUTION = "0.5"


def draw(table: str, path: str) -> None:
    """Plots P(side) against H/R: Gaek & Sukhov's law by η on the left, the others on the right."""
    with open(table, newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["restitution"] == RESTITUTION]
    figure, (left, right) = plt.subplots(
        1, 2, figsize=(9.6, 4.2), sharey=True, layout="constrained"
    )
    of_paper = [row for row in rows if row["law"].startswith("gaek-sukhov")]
    etas = sorted({float(row["law"].split()[2]) for row in of_paper})
    for lever, style in [("height", "-"), ("corner", ":")]:
        for eta, colour in zip(etas, COLOURS, strict=True):
            curve = [
                row
                for row in of_paper
                if row["law"].startswith(f"paper {lever}") and float(row["law"].split()[2]) == eta
            ]
            label = f"η = {eta:g} N s" if lever == "height" else None
            plot(left, curve, style, colour, label)
    left.set_title("Gaek & Sukhov's law (dotted: the corner's lever)", fontsize="medium")
    others = ["moreau", "half-sine 1e-3 s", "half-sine 1e-4 s", "line-contact"]
    for friction, style in [("0", "-"), ("0.3", "--")]:
        for law, colour in zip(others, COLOURS, strict=False):
            curve = [row for row in rows if row["law"] == law and row["friction"] == friction]
            plot(right, curve, style, colour, f"{law}, μ = {friction}")
    right.set_title("Other laws", fontsize="medium")
    ratio = sorted({float(row["ratio"]) for row in rows})
    for axes in (left, right):
        axes.plot(ratio, [2 / pi * atan(x / 2) for x in ratio], color="black", linewidth=0.8)
        axes.axhline(1 / 3, color="grey", linewidth=0.8)
        axes.axvspan(1.45, 1.55, color="grey", alpha=0.2, linewidth=0)
        axes.set(xlabel="H/R, height over radius", xlim=(ratio[0], ratio[-1]), ylim=(0, 0.8))
        axes.legend(fontsize="small", frameon=False)
    left.set_ylabel("P(side), 95 % intervals")
    figure.suptitle(
        "Robot's toss, e = √k = 0.5; grey: published 1.5 ± 0.05; black: arc rule", fontsize="medium"
    )
    figure.savefig(path, metadata={"Date": None, "Creator": None})


def plot(axes, curve, style, colour, label) -> None:
    """Draws one curve with its band."""
    ratio = [float(row["ratio"]) for row in curve]
    column = {
        name: [float(row[name]) for row in curve] for name in ["p_side", "p_side_lo", "p_side_hi"]
    }
    axes.plot(ratio, column["p_side"], style, color=colour, label=label)
    axes.fill_between(
        ratio, column["p_side_lo"], column["p_side_hi"], color=colour, alpha=0.2, linewidth=0
    )


if __name__ == "__main__":
    draw(*sys.argv[1:])
