"""Draws docs/figures/impact-accuracy.svg from the CSV of a study.

coinmc-studies --csv impact-accuracy.csv impact-accuracy
python docs/figures/impact_accuracy.py impact-accuracy.csv docs/figures/impact-accuracy.svg
"""

import csv
import sys

import matplotlib

matplotlib.use("svg")
# The same picture, byte for byte, from the same results.
matplotlib.rcParams["svg.hashsalt"] = "coinmc"
import matplotlib.pyplot as plt  # noqa: E402

COLOURS = {
    "half-sine": "#009E73",
    "line-contact (no friction)": "#0072B2",
    "line-contact": "#D55E00",
}


def draw(table: str, path: str) -> None:
    """Plots the error after an impact against its run time and against the steps."""
    with open(table, newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["law"] in COLOURS]
    figure, axes = plt.subplots(1, 2, figsize=(8.4, 3.8), sharey=True, layout="constrained")
    for law, colour in COLOURS.items():
        curve = [row for row in rows if row["law"] == law and float(row["median_error"]) > 0]
        error = [float(row["median_error"]) for row in curve]
        worst = [float(row["worst_error"]) for row in curve]
        for axis, name in zip(axes, ["impact_us", "steps"], strict=True):
            work = [float(row[name]) for row in curve]
            axis.loglog(work, error, "o-", color=colour, label=law, markersize=3)
            axis.loglog(work, worst, ":", color=colour)
    axes[0].set(xlabel="µs an impact", ylabel="error over speed of approach")
    axes[1].set(xlabel="steps an impact")
    steps = [10, 200]
    axes[1].loglog(
        steps, [1e-3 * (n / steps[0]) ** -5 for n in steps], color="grey", label="order 5"
    )
    axes[1].legend(fontsize="small", frameon=False)
    figure.suptitle("Median (dotted: worst) error, tolerance 1e-3 to 1e-11", fontsize="medium")
    figure.savefig(path, metadata={"Date": None, "Creator": None})


if __name__ == "__main__":
    draw(*sys.argv[1:])
