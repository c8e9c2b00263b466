"""Pictures against pictures that were looked at.

Text is left out: its shapes belong to a release of matplotlib, and what it says is tested as text.
Lines and areas do not: 3.8, 3.10 and 3.11 gave the same pixels.

The measure is matplotlib's: the root mean square difference of all pixels and colours, 0 to 255.
Its square times the 320 x 240 x 3 numbers of a picture bounds what may differ: 1 lets through one
pixel turned from white to black, or a line of 200 pixels moved by an eighth of a pixel. A picture
that is wrong differs by more than twice that, as a test shows for each. To accept a change, run

    COINMC_NEW_PICTURES=1 python -m pytest python/tests/test_plot_images.py

and look at what it wrote into python/tests/images.
"""

import os
from pathlib import Path

import matplotlib as mpl
import numpy as np
import plot_samples as samples
import pytest
from matplotlib.figure import Figure
from matplotlib.testing.compare import compare_images
from matplotlib.text import Text
from PIL import Image

from coinmc import plot

BASELINES = Path(__file__).parent / "images"
DPI = 80
TOLERANCE = 1.0


def swapped(table, one="heads", other="side"):
    """The table with two faces exchanged."""
    names = {one: other, other: one}

    def renamed(name):
        head, _, face = name.partition("_")
        face, _, end = face.partition("_")
        return f"{head}_{names.get(face, face)}" + (f"_{end}" if end else "")

    return {renamed(n) if n.startswith("p_") else n: column for n, column in table.items()}


def drawn(draw, *, space=False):
    """The figure of a plot into axes that are given, without what is written in it."""
    figure = Figure(figsize=(4.0, 3.0))
    ax = figure.add_axes((0.1, 0.1, 0.8, 0.8), projection="3d" if space else None)
    draw(ax)
    if ax.get_legend():
        ax.get_legend().remove()
    for text in figure.findobj(Text):
        text.set_visible(False)
    return figure


def faces_of(kind):
    """Codes as of a toss without bounces: stripes; `kind` exchanges heads and tails."""
    tilt, spin = np.meshgrid(np.linspace(0, np.pi, 60), np.linspace(0, 30, 40))
    axis = np.cos(tilt + 0.3 * spin)
    codes = np.where(np.abs(axis) < 0.3, 2, np.where(axis > 0, 0, 1)).astype(np.uint8)
    return np.array([1, 0, 2], np.uint8)[codes] if kind == "wrong" else codes


def basin(ax, kind):
    """The map, without the engine that computes it."""
    from coinmc.plot.basin import show_faces

    show_faces(faces_of(kind), "tilt_deg", "wy_rad_s", (0, 180, 0, 30), ax)


def exchanged(trace):
    """The trace with heads and tails exchanged."""
    trace.samples["axis"] *= -1
    trace.events["axis"] *= -1
    return trace


def without_impacts(trace):
    """The trace with impacts that are none."""
    trace.events["kind"][trace.events["kind"] == "impact"] = "touching"
    return trace


def flipped_residuals():
    """Residuals whose two coordinates are exchanged."""
    fit = samples.film()
    fit.residuals["coordinate"] = fit.residuals["coordinate"][::-1]
    return fit


# name: (the picture, a wrong one, whether in space)
PICTURES = {
    "probability": (
        lambda ax: plot.probability(samples.sweep(), ax=ax),
        lambda ax: plot.probability(swapped(samples.sweep()), ax=ax),
        False,
    ),
    "probability-faces": (
        lambda ax: plot.probability(samples.line(), faces=("heads", "tails", "side"), ax=ax),
        lambda ax: plot.probability(
            swapped(samples.line()), faces=("heads", "tails", "side"), ax=ax
        ),
        False,
    ),
    "heat": (
        lambda ax: plot.heat(samples.sweep(), bar=False, ax=ax),
        lambda ax: plot.heat(swapped(samples.sweep()), bar=False, ax=ax),
        False,
    ),
    "ternary": (
        lambda ax: plot.ternary(samples.line(), ax=ax),
        lambda ax: plot.ternary(swapped(samples.line()), ax=ax),
        False,
    ),
    "basin": (lambda ax: basin(ax, "right"), lambda ax: basin(ax, "wrong"), False),
    "path": (
        lambda ax: plot.path(samples.trace(), ax=ax),
        lambda ax: plot.path(exchanged(samples.trace()), ax=ax),
        False,
    ),
    "path-space": (
        lambda ax: plot.path(samples.trace(turn=0.5), ax=ax),
        lambda ax: plot.path(exchanged(samples.trace(turn=0.5)), ax=ax),
        True,
    ),
    "energy": (
        lambda ax: plot.energy(samples.trace(), ax=ax),
        lambda ax: plot.energy(without_impacts(samples.trace()), ax=ax),
        False,
    ),
    "residuals": (
        lambda ax: plot.residuals(samples.film(), ax=ax),
        lambda ax: plot.residuals(flipped_residuals(), ax=ax),
        False,
    ),
    "sensitivity": (
        lambda ax: plot.sensitivity(samples.dependence(), ax=ax),
        lambda ax: plot.sensitivity(samples.dependence(), "heads", ax=ax),
        False,
    ),
    "time-against-error": (
        lambda ax: plot.time_against_error(samples.work(), by="engine", ax=ax),
        lambda ax: plot.time_against_error(samples.work(), ax=ax),
        False,
    ),
}


@pytest.fixture(autouse=True)
def plain():
    """Matplotlib's own settings and its own font, whatever the user's are."""
    with mpl.rc_context():
        mpl.rcdefaults()
        mpl.rcParams.update({"font.family": "DejaVu Sans", "text.hinting": "none"})
        yield


def saved(figure, path):
    figure.savefig(path, dpi=DPI, metadata={"Software": None})
    return path


@pytest.mark.parametrize("name", PICTURES)
def test_a_picture_is_unchanged(name, tmp_path):
    right, _, space = PICTURES[name]
    path = saved(drawn(right, space=space), tmp_path / f"{name}.png")
    baseline = BASELINES / f"{name}.png"
    if os.environ.get("COINMC_NEW_PICTURES"):
        Image.open(path).convert("RGB").save(baseline, optimize=True)
        pytest.skip(f"wrote {baseline}: look at it")
    # compare_images leaves its copies beside what it compares
    expected = tmp_path / f"{name}-expected.png"
    Image.open(baseline).convert("RGBA").save(expected)
    found = compare_images(str(expected), str(path), TOLERANCE)
    assert found is None, found


@pytest.mark.parametrize("name", PICTURES)
def test_a_wrong_picture_is_detected(name, tmp_path):
    """Faces exchanged, impacts or intervals gone: twice the tolerance at least."""
    _, wrong, space = PICTURES[name]
    path = saved(drawn(wrong, space=space), tmp_path / f"{name}.png")
    files = (BASELINES / f"{name}.png", path)
    pictures = [np.asarray(Image.open(file).convert("RGB"), float) for file in files]
    first, second = pictures
    assert np.sqrt(((first - second) ** 2).mean()) > 2 * TOLERANCE


# What is written along the axes and in the legend.
WORDS = {
    "probability": (
        "H/R, height over radius",
        "P(side), 95 % intervals",
        [
            "arc rule, no bounce",
            "e = 0.3",
            "e = 0.6",
            "fair: Gaek & Sukhov, arXiv 2401.03557, flat",
        ],
    ),
    "probability-faces": (
        "H/R, height over radius",
        "P(face), 95 % intervals",
        [
            "P(heads), arc rule, no bounce",
            "P(tails), arc rule, no bounce",
            "P(side), arc rule, no bounce",
            "P(heads)",
            "P(tails)",
            "P(side)",
            "fair: Gaek & Sukhov, arXiv 2401.03557, flat",
        ],
    ),
    "heat": (
        "H/R, height over radius",
        "restitution e",
        ["interval holds 1/3", "P(side) = 1/3"],
    ),
    "ternary": ("", "", []),
    "basin": (
        "tilt of the heads normal from the vertical, °",
        "spin about y, rad/s",
        ["heads 32.5 %", "tails 48.2 %", "side 19.2 %"],
    ),
    "path": (
        "x, m",
        "z, m",
        ["flight", "sliding", "2 impacts", "heads", "tails", "ends: heads"],
    ),
    "path-space": (
        "x, m",
        "y, m",
        ["flight", "sliding", "2 impacts", "heads", "tails", "ends: heads"],
    ),
    "energy": (
        "time since launch, s",
        "energy per mass, J/kg",
        ["can tilt the coin", "all energy", "sliding", "impact"],
    ),
    "residuals": (
        "time since the first frame, s",
        "residual, standard deviations",
        ["x", "θ (7 beyond ± 5)", "impact"],
    ),
    "sensitivity": ("dP(side)/d ln(parameter)", "", []),
    "time-against-error": ("time, s", "total error", ["error ~ 1/√time", "flat", "rapier"]),
}


@pytest.mark.parametrize("name", PICTURES)
def test_a_picture_labels_what_it_shows(name):
    draw, _, space = PICTURES[name]
    ax = Figure().add_subplot(projection="3d" if space else None)
    draw(ax)
    legend = ax.get_legend()
    words = [text.get_text() for text in legend.get_texts()] if legend else []
    assert (ax.get_xlabel(), ax.get_ylabel(), words) == WORDS[name]
