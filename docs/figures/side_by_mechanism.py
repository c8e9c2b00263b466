"""P(side) of examples/hand.toml, one thing changed at a time: data and picture of
docs/guide/why-answers-differ.md.

python docs/figures/side_by_mechanism.py run coinmc runs/side     writes data/validation/side-*.csv
python docs/figures/side_by_mechanism.py draw                     writes side-by-mechanism.svg
"""

import csv
import json
import subprocess
import sys
from math import atan, pi, sqrt
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
DATA = ROOT / "data/validation"

# Every ratio of the picture, and those that a fair ratio and the real coins ask for.
ALL = [0.05, 0.1, 0.15, 0.184, 0.2, 0.25, 0.3, 0.4, 0.5, 0.7071, 0.85, 1, 1.1547, 1.5, 2]
FEW = [0.184, 0.7071, 0.85, 1, 1.1547, 1.5, 2]

# What the patch of wood has at μ = 0.3: another μ shall not move it.
PIVOTING = "surface.pivoting_friction_m=8.3e-6"
PLANE = "surface.roughness_slope=0"
# A launch in a vertical plane, as the engine of the flat toss needs it.
RATE = "rate_rad_s={normal={mean=238.6,sd=23.86}}"
FLAT = ["engine={flat={}}", "launch.spin={about={axis=[0,1,0]," + RATE + "}}"]

# Cause, name, what replaces the values of the example.
CURVES = [
    ("", "wood", []),
    ("bounce", "wood, e falls with speed", ["surface.restitution_exponent=0.25"]),
    ("table", "wood, half the slope", ["surface.roughness_slope=0.025"]),
    ("rolling", "plane, ρ_p = 5.3 µm", [PLANE, "surface.contact_patch_m=3e-5"]),
    ("rolling", "plane, ρ_p = 50 µm", [PLANE, "surface.pivoting_friction_m=5e-5"]),
]
CHANGES = [
    ("launch", "ψ = 90°: no precession", ["launch.spin.precessing.psi_deg=90"]),
    ("launch", "ψ = 60°", ["launch.spin.precessing.psi_deg=60"]),
    ("launch", "`clean`: any orientation, any spin", ['launch={preset="clean"}']),
    ("launch", "`drop`: any orientation, no spin", ['launch={preset="drop"}']),
    ("launch", "`robot`: at most 5 turns a second", ['launch={preset="robot"}']),
    ("launch", "in the plane (`engine.flat`), ψ = 90°", FLAT),
    ("bounce", "e = 0.3", ["surface.restitution=0.3"]),
    ("bounce", "e = 0.7", ["surface.restitution=0.7"]),
    ("bounce", "e = 0.85", ["surface.restitution=0.85"]),
    ("bounce", "e = 0, on a plane", ["surface.restitution=0", PLANE]),
    ("bounce", "μ = 0.1", ["surface.friction=0.1", PIVOTING]),
    ("rolling", "ρ_p = 50 µm", ["surface.pivoting_friction_m=5e-5"]),
    ("rolling", "ρ_c = 200 µm", ["surface.rolling_friction_m=2e-4"]),
    ("rolling", "ρ_c = 10 µm", ["surface.rolling_friction_m=1e-5"]),
    ("table", "a plane", [PLANE]),
    ("table", "λ = 1 mm", ["surface.roughness_wavelength_m=1e-3"]),
    ("table", "λ = 10 mm", ["surface.roughness_wavelength_m=1e-2"]),
    ("table", "`glass`", ['surface.material="glass"']),
    ("launch", "ψ = 90°, on a plane", ["launch.spin.precessing.psi_deg=90", PLANE]),
]
# Fair at a lower ratio than the others.
THIN = [("bounce", "μ = 0.6", ["surface.friction=0.6", PIVOTING])]
LOW = [0.184, 0.3, 0.4, 0.5, 0.7071, 1.1547]

# Ratios of side-causes.csv, and how its columns name them.
COLUMNS = {"0.184": "nickel", "0.7071": "0707", "1.1547": "1155"}
CAUSES = ["", "launch", "bounce", "rolling", "table"]

# Ratio, who says it, tosses, and how many ended on the side.
REAL = [
    ("0.184", "US nickel: no counted series is known", 0, 0),
    ("0.7071", "Parker & Hunt, 2018, by hand", 1000, 132),
    ("1.1547", "Parker & Hunt, 2018, by hand", 1000, 410),
]
# Okabe & Ito's colours, told apart by colour-blind eyes too.
COLOURS = ["#0072B2", "#56B4E9", "#009E73", "#D55E00", "#CC79A7"]
# Published fair ratios: ratio, half width, name, and where the picture names it.
FAIR = [
    (0.70711, None, "zone rule", (0.53, 0.42)),
    (0.8, 0.05, "Gaek & Sukhov, Unity", (0.53, 0.53)),
    (1.1547, None, "arc rule", (1.22, 0.25)),
    (1.5, 0.05, "Gaek & Sukhov, flat", (1.52, 0.25)),
]


def wilson(hits: int, of: int) -> tuple[float, float]:
    """The 95 % interval of a share."""
    z = 1.959964
    middle, spread = hits + z * z / 2, z * sqrt(hits * (of - hits) / of + z * z / 4)
    return (middle - spread) / (of + z * z), (middle + spread) / (of + z * z)


def tossed(program: str, folder: str, changes: list[str], ratios: list[float], tosses: int) -> dict:
    """What the program answers; it goes on where an earlier run stopped."""
    command = [program, "run", str(ROOT / "examples/hand.toml"), "--out", folder, "--quiet"]
    for change in [f"coin.ratio={ratios}", f"stop.tosses={tosses}", *changes]:
        command += ["--set", change]
    command += ["--threads", "1", "--format", "json"]
    return json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)


def write(name: str, rows: list[dict]) -> None:
    with (DATA / name).open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def beside(row: dict, source: str, of: int, hits: int) -> dict:
    """A real coin and a simulated one; z as in docs/guide/scenes.md."""
    line = {"ratio": row["ratio"], "source": source}
    line |= dict.fromkeys(["real", "real_lo", "real_hi", "real_tosses", "z"], "")
    if of:
        lo, hi = wilson(hits, of)
        share = (hits + row["side"]) / (of + row["tosses"])
        error = sqrt(share * (1 - share) * (1 / of + 1 / row["tosses"]))
        line |= {"real": hits / of, "real_lo": f"{lo:.4f}", "real_hi": f"{hi:.4f}"}
        line |= {"real_tosses": of, "z": f"{(float(row['p_side']) - hits / of) / error:+.1f}"}
    return line | {key: row[key] for key in ("tosses", "side", "p_side", "lo", "hi")}


def run(program: str, folder: str) -> None:
    """Tosses every variant and writes the three files."""
    curves, fair = [], []
    plan = [(*curve, ALL, 10_000) for curve in CURVES]
    plan += [(*change, FEW, 4_000) for change in CHANGES]
    plan += [(*change, LOW, 4_000) for change in THIN]
    for number, (cause, name, changes, ratios, tosses) in enumerate(plan):
        result = tossed(program, f"{folder}/{number}", changes, ratios, tosses)
        rows = [
            {
                "variant": name,
                "ratio": f"{row['ratio']:g}",
                **{key: row[key] for key in ("tosses", "heads", "tails", "side", "undecided")},
                "p_side": f"{row['p_side']:.5f}",
                "lo": f"{row['p_side_lo']:.5f}",
                "hi": f"{row['p_side_hi']:.5f}",
                "rolled_1_m": row["rolled_1_m"],
            }
            for row in result["rows"]
        ]
        if ratios is ALL:
            curves += rows
        [crossing] = result["fair_ratios"]
        line = {"cause": cause, "change": name, "tosses": tosses}
        for row in rows:
            if short := COLUMNS.get(row["ratio"]):
                line |= {f"{key}_{short}": row[key] for key in ("p_side", "lo", "hi")}
        fair.append(line | {key: f"{crossing[key]:.4f}" for key in ("ratio", "lo", "hi")})
    write("side-by-mechanism.csv", curves)
    write("side-causes.csv", sorted(fair, key=lambda line: CAUSES.index(line["cause"])))
    wood = {row["ratio"]: row for row in curves if row["variant"] == "wood"}
    write("side-real.csv", [beside(wood[ratio], *real) for ratio, *real in REAL])


def draw() -> None:
    """Thin coins on a logarithmic scale, thick ones beside real and published ones."""
    import matplotlib

    matplotlib.use("svg")
    # The same picture, byte for byte, from the same results.
    matplotlib.rcParams["svg.hashsalt"] = "coinmc"
    import matplotlib.pyplot as plt

    with (DATA / "side-by-mechanism.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    figure, (thin, thick) = plt.subplots(1, 2, figsize=(9.2, 4.4), layout="constrained")
    for (_, name, _), colour in zip(CURVES, COLOURS, strict=True):
        curve = [row for row in rows if row["variant"] == name]
        x = [float(row["ratio"]) for row in curve]
        p, lo, hi = ([float(row[key]) for row in curve] for key in ("p_side", "lo", "hi"))
        for panel in (thin, thick):
            # No toss on the side: only the upper end of the interval is known.
            shown = [value or float("nan") for value in p]
            panel.plot(x, shown, "o-", markersize=3, color=colour, label=name)
            panel.fill_between(x, lo, hi, color=colour, alpha=0.2, linewidth=0)
        none = [(a, b) for a, b, value in zip(x, hi, p, strict=True) if not value]
        thin.plot(*zip(*none, strict=True) if none else ([], []), "v", markersize=4, color=colour)
    thin.plot([0.184] * 2, [1 / 2147, 1 / 6000], "k+", markersize=8, label="models of a nickel")
    thin.set(xscale="log", yscale="log", xlim=(0.045, 0.55), ylim=(8e-5, 0.4), ylabel="P(side)")
    ticks = [0.05, 0.1, 0.2, 0.3, 0.5]
    thin.set_xticks(ticks, [f"{x:g}" for x in ticks])
    thin.set_xticks([], minor=True)
    thin.legend(fontsize="x-small", frameon=False, loc="lower right")

    x = [0.5 + 0.01 * i for i in range(151)]
    thick.plot(x, [a / sqrt(a * a + 4) for a in x], ":", color="grey", label="zone rule, no bounce")
    thick.plot(
        x, [2 / pi * atan(a / 2) for a in x], "--", color="grey", label="arc rule, no bounce"
    )
    for ratio, _, of, hits in REAL[1:]:
        lo, hi = wilson(hits, of)
        error = [[hits / of - lo], [hi - hits / of]]
        name = "real tosses by hand" if ratio == REAL[1][0] else None
        thick.errorbar(
            float(ratio), hits / of, error, fmt="ks", markersize=5, capsize=3, zorder=3, label=name
        )
    thick.axhline(1 / 3, color="grey", linewidth=0.6)
    for ratio, half, name, place in FAIR:
        thick.errorbar(ratio, 1 / 3, xerr=half, fmt="kD", mfc="white", markersize=5, capsize=3)
        arrow = {"arrowstyle": "-", "linewidth": 0.6, "shrinkB": 4}
        text = f"{name}\n{ratio:.4g}"
        thick.annotate(text, (ratio, 1 / 3), place, fontsize="x-small", arrowprops=arrow)
    thick.set(xlim=(0.5, 2), ylim=(0, 1))
    handles, labels = thick.get_legend_handles_labels()
    thick.legend(handles[5:], labels[5:], fontsize="x-small", frameon=False, loc="upper left")
    for panel in (thin, thick):
        panel.set_xlabel("H/R, height over radius")
    figure.savefig(HERE / "side-by-mechanism.svg", metadata={"Date": None, "Creator": None})


if __name__ == "__main__":
    {"run": run, "draw": draw}[sys.argv[1]](*sys.argv[2:])
