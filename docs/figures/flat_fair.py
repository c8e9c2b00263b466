"""Draws docs/figures/flat-fair.svg from the results of examples/flat-fair.toml.

coinmc run examples/flat-fair.toml --out runs/flat-fair
python docs/figures/flat_fair.py runs/flat-fair docs/figures/flat-fair.svg
"""

import sys
from math import atan, pi

import matplotlib
import pyarrow.parquet as pq

matplotlib.use("svg")
# The same picture, byte for byte, from the same results.
matplotlib.rcParams["svg.hashsalt"] = "coinmc"
import matplotlib.pyplot as plt  # noqa: E402

# Paul Tol's high contrast, told apart by colour-blind eyes and in grey; a marker each.
LOOKS = {0.3: ("#004488", "o"), 0.5: ("#BB5566", "s"), 0.7: ("#DDAA33", "^")}


def draw(run: str, path: str) -> None:
    """Plots P(side) with its interval against H/R, a curve a restitution and friction; open markers
    have no friction."""
    rows = pq.read_table(f"{run}/results.parquet").to_pylist()
    figure, axes = plt.subplots(figsize=(7.2, 4.2), layout="constrained")
    for friction, style in [(0.0, "-"), (0.3, "--")]:
        for restitution, (colour, marker) in LOOKS.items():
            curve = [
                row
                for row in rows
                if row["restitution"] == restitution and row["friction"] == friction
            ]
            ratio = [row["ratio"] for row in curve]
            p = [row["p_side"] for row in curve]
            axes.errorbar(
                ratio,
                p,
                yerr=[
                    [row["p_side"] - row["p_side_lo"] for row in curve],
                    [row["p_side_hi"] - row["p_side"] for row in curve],
                ],
                linestyle=style,
                linewidth=1,
                color=colour,
                marker=marker,
                markersize=3.5,
                markerfacecolor=colour if friction else "white",
                capsize=1.5,
                label=f"e = {restitution}, μ = {friction}",
            )
    ratio = sorted({row["ratio"] for row in rows})
    axes.plot(
        ratio,
        [2 / pi * atan(x / 2) for x in ratio],
        ":",
        color="black",
        label="arc rule, no bounce",
    )
    axes.axhline(1 / 3, color="grey", linewidth=0.8)
    axes.annotate(
        "1/3",
        (1, 1 / 3),
        xycoords=axes.get_yaxis_transform(),
        xytext=(3, 0),
        textcoords="offset points",
        va="center",
        color="grey",
        annotation_clip=False,
    )
    axes.axvspan(1.45, 1.55, color="grey", alpha=0.2, linewidth=0, label="Gaek & Sukhov 1.5 ± 0.05")
    axes.set(
        xlabel="H/R, height over radius",
        ylabel="P(side), 95 % intervals",
        xlim=(ratio[0], ratio[-1]),
        ylim=(0, 0.75),
        title="A coin of R = 10 mm tossed by the robot, flat toss, 50 000 tosses a point",
    )
    axes.legend(fontsize="small", frameon=False)
    figure.savefig(path, metadata={"Date": None, "Creator": None})


if __name__ == "__main__":
    draw(*sys.argv[1:])
