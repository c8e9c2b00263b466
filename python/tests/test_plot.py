"""What plots promise beside their looks."""

import doctest
import importlib
import pkgutil
import shutil
import subprocess
import sys
from pathlib import Path

import matplotlib as mpl
import numpy as np
import plot_samples as samples
import pytest
from matplotlib.animation import FFMpegWriter
from matplotlib.figure import Figure

import coinmc
from coinmc import plot
from coinmc.plot import published
from coinmc.plot.motion import motion_of
from coinmc.plot.outline import rims
from coinmc.plot.table import columns

mpl.use("Agg")
ROOT = Path(__file__).resolve().parents[2]

DRAWN = {
    "probability": lambda **to: plot.probability(samples.sweep(), **to),
    "heat": lambda **to: plot.heat(samples.sweep(), bar=False, **to),
    "ternary": lambda **to: plot.ternary(samples.line(), **to),
    "path": lambda **to: plot.path(samples.trace(), **to),
    "energy": lambda **to: plot.energy(samples.trace(), **to),
    "residuals": lambda **to: plot.residuals(samples.film(), **to),
    "sensitivity": lambda **to: plot.sensitivity(samples.dependence(), **to),
    "time_against_error": lambda **to: plot.time_against_error(samples.work(), by="engine", **to),
}


def python(code):
    """What a fresh interpreter prints."""
    command = [sys.executable, "-c", code]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()


@pytest.mark.parametrize("name", DRAWN)
def test_given_axes_are_used_and_returned(name):
    from matplotlib import pyplot

    ax = Figure().add_subplot()
    before = pyplot.get_fignums()
    assert DRAWN[name](ax=ax) is ax
    assert ax.has_data()
    assert pyplot.get_fignums() == before


@pytest.mark.parametrize("name", DRAWN)
def test_without_axes_there_is_a_new_figure(name):
    from matplotlib import pyplot

    before = len(pyplot.get_fignums())
    assert DRAWN[name]().has_data()
    assert len(pyplot.get_fignums()) == before + 1
    pyplot.close("all")


def test_coinmc_loads_no_matplotlib_and_given_axes_no_pyplot():
    heavy = "print(sorted(n for n in ('matplotlib', 'pyarrow', 'pandas') if n in sys.modules))"
    assert python(f"import sys, coinmc; {heavy}") == "[]"
    drawn = (
        "import sys; from coinmc import plot; from matplotlib.figure import Figure; "
        "plot.sensitivity({'parameter': ['a'], 'd_p_side': [1.0], 'd_p_side_lo': [0.9], "
        "'d_p_side_hi': [1.1]}, ax=Figure().add_subplot()); "
        "print('matplotlib.pyplot' in sys.modules)"
    )
    assert python(drawn) == "False"


def test_without_matplotlib_the_message_says_what_to_install():
    code = (
        "import sys; sys.modules['matplotlib'] = None\n"
        "try:\n    import coinmc.plot\nexcept ModuleNotFoundError as error:\n    print(error)"
    )
    assert python(code) == "coinmc.plot needs matplotlib: pip install 'coinmc[plot]'"


def test_every_exported_name_exists_and_is_documented():
    for name in plot.__all__:
        there = getattr(plot, name)
        assert isinstance(there, dict) or "Returns\n    -------" in there.__doc__, name


@pytest.mark.parametrize(
    "name",
    [name for _, name, _ in pkgutil.iter_modules(plot.__path__)],
)
def test_examples_in_the_documentation_run(name, tmp_path, monkeypatch):
    """Every module's doctests, where the examples of the repository are at hand."""
    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    monkeypatch.chdir(tmp_path)
    found = doctest.testmod(importlib.import_module(f"coinmc.plot.{name}"))
    assert found.failed == 0
    sys.modules["matplotlib.pyplot"].close("all") if "matplotlib.pyplot" in sys.modules else None


def test_the_published_data_are_those_of_the_repository():
    folder = Path(plot.__file__).parent / "data"
    for path in folder.iterdir():
        assert path.read_bytes() == (ROOT / "data" / path.name).read_bytes(), path.name
    assert {"README.md", "unity-table1.csv", "fair-ratios.csv"} <= {
        p.name for p in folder.iterdir()
    }
    assert published.unity_table1()["tosses"].tolist() == [601949, 11500, 1103, 2531]


def test_published_counts_are_shown_only_for_their_scene():
    table = samples.line()
    count = len(table["ratio"])
    table |= {"engine": np.full(count, "volumetric"), "radius_m": np.full(count, 0.5)}
    table |= {
        name: np.full(count, value) for name, value in (("restitution", 0.3), ("friction", 10))
    }
    table |= {"linear_drag_per_s": np.full(count, 1.0)}
    there = [text.get_text() for text in plot.probability(table).get_legend().get_texts()]
    assert "Gaek & Sukhov, arXiv 2401.03557, Unity" in there
    table["friction"] = np.full(count, 0.3)
    there = [text.get_text() for text in plot.probability(table).get_legend().get_texts()]
    assert "Gaek & Sukhov, arXiv 2401.03557, Unity" not in there


def test_every_curve_has_its_intervals():
    ax = plot.probability(
        samples.sweep(), closed_forms=False, published=False, ax=Figure().add_subplot()
    )
    table = samples.sweep()
    bars = np.concatenate([np.array(bar.get_segments()) for bar in ax.collections])
    ends = {(x, low, high) for x, low, high in zip(*bars.reshape(-1, 4).T[[0, 1, 3]], strict=True)}
    wanted = zip(table["ratio"], table["p_side_lo"], table["p_side_hi"], strict=True)
    rounded = {tuple(np.round(end, 12)) for end in ends}
    assert rounded == {tuple(np.round(end, 12)) for end in wanted}


def test_hatched_cells_are_those_whose_interval_holds_a_third():
    ax = plot.heat(samples.sweep(), bar=False, ax=Figure().add_subplot())
    (hatched,) = (item for item in ax.collections if item.get_hatch())
    table = samples.sweep()
    holds = (table["p_side_lo"] <= 1 / 3) & (table["p_side_hi"] >= 1 / 3)
    assert len(hatched.get_paths()) == holds.sum() > 0


def test_a_region_of_the_triangle_is_where_all_intervals_hold():
    from coinmc.plot.ternary import _CORNERS, _region

    low, high = np.array([0.3, 0.2, 0.1]), np.array([0.5, 0.6, 0.35])
    corners = _region(low, high)
    shares = np.linalg.solve(
        np.vstack([_CORNERS.T, np.ones(3)]), np.vstack([corners.T, np.ones(len(corners))])
    )
    assert (low - 1e-12 <= shares.T).all()
    assert (high + 1e-12 >= shares.T).all()
    # its area against points thrown at the triangle: 200,000, so 5 sigma are .004 at most
    thrown = np.random.default_rng(1).dirichlet([1, 1, 1], 200_000)
    inside = ((thrown >= low) & (thrown <= high)).all(axis=1).mean()
    x, y = corners.T
    area = abs(x @ np.roll(y, 1) - y @ np.roll(x, 1)) / 2 / (np.sqrt(3) / 4)
    assert abs(area - inside) < 0.0055


def test_rims_lie_on_the_coin():
    axis = np.array([0.6, -0.48, 0.64])
    centre = np.array([1.0, 2.0, 3.0])
    faces = ((0.3, 0.1), (0.2, 0.15))
    for ring, sign, face in zip(rims(centre, axis, faces), (1, -1), faces, strict=True):
        along = (ring - centre) @ axis
        across = np.linalg.norm(ring - centre - along[:, None] * axis, axis=1)
        np.testing.assert_allclose(along, sign * face[1], atol=1e-15)
        np.testing.assert_allclose(across, face[0], rtol=1e-14)


def test_impacts_are_marked_where_the_coin_touches():
    motion = motion_of(samples.trace(turn=0.3))
    feet = motion.feet_m()[motion.impacts]
    np.testing.assert_allclose(feet[:, 2], 0, atol=1e-9)
    # no point of the rims lies lower than the foot, at any instant
    for at, foot in enumerate(motion.feet_m()):
        rings = rims(motion.position_m[at], motion.axis[at], motion.rims_m)
        lowest = min(ring[:, 2].min() for ring in rings)
        # of 36 points of a rim none need be the lowest: 1 - cos(5 degrees) of the radius
        assert foot[2] - 1e-10 <= lowest <= foot[2] + 0.004 * motion.radius_m


def in_space(toss, **overrides):
    """A trace of examples/clean.toml at H/R = 0.85 with these numbers."""
    given = {"coin.ratio": 0.85, **overrides}
    return coinmc.trace(ROOT / "examples/clean.toml", toss, overrides=given)


def test_a_conical_coin_touches_with_either_rim_and_rests_at_its_levels():
    for toss in range(4):
        motion = motion_of(in_space(toss, **{"coin.draft_deg": 12.0}))
        feet = motion.feet_m()
        np.testing.assert_allclose(feet[motion.impacts][:, 2], 0, atol=1e-9)
        assert feet[:, 2].min() > -1e-9
    (heads, above), (tails, below) = motion.rims_m
    assert heads == 0.01 > tails
    assert above < below
    ax = plot.energy(in_space(0, **{"coin.draft_deg": 12.0}))
    texts = {text.get_text() for text in ax.texts}
    assert {"balanced on the rim of heads", "at rest, tails up"} <= texts


def test_a_loaded_coin_touches_with_either_rim_and_rests_at_its_levels():
    loaded = {"coin.centre_of_mass_over_height": 0.2}
    for toss in range(4):
        motion = motion_of(in_space(toss, **loaded))
        feet = motion.feet_m()
        np.testing.assert_allclose(feet[motion.impacts][:, 2], 0, atol=1e-9)
        assert feet[:, 2].min() > -1e-9
    assert np.array(motion.rims_m) == pytest.approx(np.array([[0.01, 0.00255], [0.01, 0.00595]]))
    texts = {text.get_text() for text in plot.energy(in_space(0, **loaded)).texts}
    assert {"balanced on the rim of heads", "at rest, tails up"} <= texts


def test_energy_on_a_tilted_table_is_that_above_the_table():
    tilted = in_space(1, **{"surface.table_tilt_deg": 8.0, "surface.table_downhill_deg": 30.0})
    assert tilted.weight_m_s2[2] == pytest.approx(-9.81 * np.cos(np.radians(8)))
    ax = plot.energy(tilted, barriers=False)
    whole, tilting = (line.get_ydata() for line in ax.lines[:2])

    def both(name):
        return np.concatenate([tilted.samples[name], tilted.events[name]])

    # kinetic energy without sliding and spinning, and the height above the table
    spin, axis = both("spin_rad_s"), both("axis")
    across = (spin**2).sum(axis=1) - (spin * axis).sum(axis=1) ** 2
    transverse = 1e-4 * (3 + 0.85**2) / 12
    height = -tilted.weight_m_s2[2] * both("position_m")[:, 2]
    expected = height + both("velocity_m_s")[:, 2] ** 2 / 2 + transverse * across / 2
    order = np.lexsort((-both("energy_j_kg"), both("time_s")))
    np.testing.assert_allclose(tilting, expected[order], rtol=1e-9)
    np.testing.assert_allclose(whole, both("energy_j_kg")[order])


def test_modes_follow_from_the_events():
    motion = motion_of(samples.trace())
    modes = [mode for mode, _ in motion.phases()]
    assert modes in (["flight", "sliding"], ["flight", "sliding", "ended"])
    sliding = motion.phases()[1][1]
    np.testing.assert_allclose(motion.time_s[sliding][[0, -1]], [0.6, 0.7])


def test_tables_are_read_from_every_source(tmp_path):
    wanted = {"ratio": [0.5, 1.0], "p_side": [0.1, np.nan], "law": ["moreau", "stronge"]}
    (tmp_path / "t.csv").write_text("ratio,p_side,law\n0.5,0.1,moreau\n1.0,,stronge\n")
    rows = np.array([(0.5, 0.1, "moreau"), (1.0, np.nan, "stronge")], "f8,f8,U9")
    rows.dtype.names = tuple(wanted)
    held = [wanted, tmp_path / "t.csv", str(tmp_path / "t.csv"), rows]
    pyarrow = pytest.importorskip("pyarrow")
    held.append(pyarrow.table({**wanted, "p_side": [0.1, None]}))
    for table in held:
        found = columns(table)
        assert list(found) == list(wanted)
        for name, column in wanted.items():
            np.testing.assert_array_equal(found[name], column)


MISTAKES = {
    "no column": (lambda: plot.probability({"ratio": [1.0]}), "no column p_side"),
    "no table": (lambda: plot.probability(3), "int is not a table"),
    "lengths": (lambda: plot.probability({"ratio": [1.0], "p_side": [1, 2]}), "equal lengths"),
    "no face": (lambda: plot.probability(samples.sweep(), faces="edge"), "unknown face edge"),
    "no rule": (lambda: plot.probability(samples.sweep(), closed_forms=["arcs"]), "arcs"),
    "no row": (lambda: plot.heat(samples.sweep(), where={"restitution": 0.5}), "no row has"),
    "many rows": (lambda: plot.heat(samples.sweep(), y="radius_m"), "fix restitution"),
    "gap": (lambda: plot.heat({n: c[:-1] for n, c in samples.sweep().items()}), "not a full grid"),
    "view": (lambda: plot.path(samples.trace(), view="below"), "unknown view 'below'"),
    "flat axes": (
        lambda: plot.path(samples.trace(), view="space", ax=Figure().add_subplot()),
        'projection="3d"',
    ),
    "times": (lambda: plot.path(samples.trace(), times=(7, 8)), "nothing was recorded"),
    "ending": (lambda: plot.animation(samples.trace(), "toss.avi"), "must end in .gif or .mp4"),
    "frames": (lambda: plot.animation(samples.trace(), slow=1e4), "frames are more than 2000"),
    "quantity": (lambda: plot.basin({}, "tilt", "vx_m_s", (0, 1, 0, 1)), "unknown quantity"),
    "same": (lambda: plot.basin({}, "tilt_rad", "tilt_deg", (0, 1, 0, 1)), "the same quantity"),
    "extent": (lambda: plot.basin({}, "vx_m_s", "tilt_deg", (0, 0, 0, 1)), "is empty"),
    "infinite": (lambda: plot.basin({}, "vx_m_s", "tilt_deg", (0, np.inf, 0, 1)), "finite"),
    "launches": (
        lambda: plot.basin(
            ROOT / "examples/first.toml",
            "vx_m_s",
            "tilt_deg",
            (0, 1, 0, 1),
            launch=np.zeros(2, coinmc.LAUNCH),
        ),
        "exactly one launch, not 2",
    ),
    "whole": (
        lambda: plot.basin({}, "vx_m_s", "tilt_deg", (0, 1, 0, 1), shape=(2.5, 5)),
        "integer",
    ),
    "shape": (
        lambda: plot.basin({}, "vx_m_s", "tilt_deg", (0, 1, 0, 1), shape=(0, 5)),
        "shape must be",
    ),
}


@pytest.mark.parametrize("name", MISTAKES)
def test_mistakes_are_reported(name):
    call, message = MISTAKES[name]
    with pytest.raises((ValueError, TypeError)) as caught:
        call()
    assert message in str(caught.value)


def test_a_film_is_written_once(tmp_path):
    from PIL import Image

    path = tmp_path / "toss.gif"
    plot.animation(samples.trace(), path, slow=1, fps=20, dpi=40)
    with Image.open(path) as film:
        # 0.7 s at 20 frames a second, both ends included; frames last 50 ms
        assert (film.n_frames, film.info["duration"]) == (15, 50)
    with pytest.raises(FileExistsError, match="overwrite=True"):
        plot.animation(samples.trace(), path)


def test_mp4_is_written_if_ffmpeg_is_installed_and_rejected_otherwise(tmp_path):
    path = tmp_path / "toss.mp4"
    if FFMpegWriter.isAvailable():
        plot.animation(samples.trace(), path, slow=0.5, fps=20, dpi=40)
        assert path.stat().st_size > 1000
    else:
        with pytest.raises(RuntimeError, match="ffmpeg; install it, or name a"):
            plot.animation(samples.trace(), path)
        assert not path.exists()


def test_every_pixel_of_a_basin_equals_a_toss():
    config, extent = "examples/first.toml", (0, 180, 0, 30)
    faces = plot.basin_faces(ROOT / config, "tilt_deg", "wy_rad_s", extent, shape=(5, 7), threads=1)
    launches = np.repeat(coinmc.launches(ROOT / config, 1), 35).reshape(5, 7)
    for row, spin in enumerate(np.linspace(3, 27, 5)):
        for column, tilt in enumerate(np.deg2rad(180 * (np.arange(7) + 0.5) / 7)):
            launches[row, column]["axis"] = np.sin(tilt), 0, np.cos(tilt)
            launches[row, column]["spin_rad_s"] = 0, spin, 0
    wanted = coinmc.toss(ROOT / config, launches=launches.reshape(-1)).face.reshape(5, 7)
    np.testing.assert_array_equal(faces, wanted)


def test_a_basin_does_not_depend_on_its_blocks(monkeypatch):
    from coinmc.plot import basin_faces

    module = sys.modules["coinmc.plot.basin"]
    made = []
    for block in (1 << 18, 25):
        monkeypatch.setattr(module, "_BLOCK", block)
        made.append(
            basin_faces(
                ROOT / "examples/first.toml", "tilt_deg", "wy_rad_s", (0, 180, 0, 30), shape=(9, 10)
            )
        )
    np.testing.assert_array_equal(*made)


def test_without_bounces_a_basin_follows_from_the_landing_angle():
    """A thin coin that stays where it lands: side if |u_z| < sin atan(x/2) when it touches."""
    ratio = 0.4
    config = {
        "coin": {"ratio": ratio, "radius_m": 0.01},
        "surface": {"restitution": 0.0, "friction": 0.3, "landing": "adhesive"},
        "launch": {"preset": "robot"},
        "engine": {"flat": {}},
        "stop": {"tosses": 1},
    }
    # all but without spin it lands as it starts, from any height
    launch = coinmc.launches(config, 1)
    launch["spin_rad_s"] = 0, 1e-9, 0
    extent = (0, 180, 0.1, 0.5)
    faces = plot.basin_faces(config, "tilt_deg", "height_m", extent, shape=(3, 360), launch=launch)
    tilt = np.deg2rad((np.arange(360) + 0.5) / 2)
    side = np.abs(np.cos(tilt)) < np.sin(np.arctan(ratio / 2))
    wanted = np.where(side, 2, np.where(np.cos(tilt) > 0, 0, 1))
    np.testing.assert_array_equal(faces, [wanted] * 3)
    assert set(wanted) == {0, 1, 2}


def test_drawn_coins_do_not_pile_up(examples):
    """Rolling out on the spot, a coin would be drawn again and again in one place."""
    trace = coinmc.trace(examples / "hand.toml", toss=3, point=1)
    bodies = [p for p in plot.path(trace, view="top", coins=60).patches if p.get_fill()]
    middles = np.array([body.get_xy()[:-1].mean(axis=0) for body in bodies])
    ends = trace.samples["position_m"][[0, -1], :2]
    assert np.abs(middles[[0, -1]] - ends).max() < 1e-3
    assert 8 < len(bodies) < 30
    steps = np.linalg.norm(np.diff(middles, axis=0), axis=1)
    assert np.median(steps) > 0.3 * 0.0116
