"""Draws docs/figures/rapier-step.svg: the bias of the engine in time steps against its cost.

coinmc-studies --csv step.csv rapier-step --seconds 4.5 --reference 1e5 --shortest 5e-5
python docs/figures/rapier_step.py step.csv docs/figures/rapier-step.svg
"""

import csv
import sys

import matplotlib

matplotlib.use("svg")
# The same picture, byte for byte, from the same results.
matplotlib.rcParams["svg.hashsalt"] = "coinmc"
import matplotlib.pyplot as plt  # noqa: E402

# Okabe & Ito's colours, told apart by colour-blind eyes too.
COLOURS = {"0.25": "#0072B2", "0.5": "#009E73", "1": "#D55E00", "2": "#CC79A7"}


def draw(path: str, picture: str) -> None:
    """Plots the bias with two standard errors against processor time a toss, a curve a ratio."""
    with open(path, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    figure, axes = plt.subplots(1, 2, figsize=(8.6, 4.0), layout="constrained", sharey=True)
    for panel, scene in zip(axes, ["clean", "table1"], strict=True):
        for ratio, colour in COLOURS.items():
            curve = [row for row in rows if (row["scene"], row["ratio"]) == (scene, ratio)]
            panel.errorbar(
                [1e3 / float(row["tosses_a_second"]) for row in curve],
                [float(row["bias"]) for row in curve],
                yerr=[2 * float(row["std_error"]) for row in curve],
                fmt="o-",
                markersize=3,
                capsize=2,
                color=colour,
                label=f"H/R = {ratio}",
            )
        panel.axhspan(-0.005, 0.005, color="grey", alpha=0.3, linewidth=0)
        panel.axhline(0, color="grey", linewidth=0.6)
        panel.set(xscale="log", xlabel="processor time a toss, ms", title=scene)
        # linear within the error asked for and logarithmic beyond
        panel.set_yscale("symlog", linthresh=0.01)
    axes[0].set_ylabel("P(side) − event-driven, ± 2 standard errors")
    axes[0].legend(fontsize="small", frameon=False)
    figure.savefig(picture, metadata={"Date": None, "Creator": None})


if __name__ == "__main__":
    draw(*sys.argv[1:])
