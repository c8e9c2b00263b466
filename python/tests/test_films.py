"""Films: read and fitted as on the command line."""

import json

import numpy as np
import pytest

import coinmc
from coinmc import film


@pytest.fixture(scope="module")
def drop(root):
    """The drop of the examples."""
    return film.read(root / "examples" / "drop-film.txt")


@pytest.fixture(scope="module")
def fit(root, drop):
    """Its fit."""
    with pytest.warns(UserWarning, match=r"for the first, ratio = 0\.5"):
        return film.fit(drop, root / "examples" / "drop.toml")


def test_a_fit_equals_that_of_the_command_line(fit, command, examples, tmp_path):
    laws = ",".join(law.law for law in fit.all)
    arguments = ("--config", examples / "drop.toml", "--law", laws, "--format", "json")
    residuals = tmp_path / "residuals.csv"
    printed = command(
        "film", "fit", examples / "drop-film.txt", *arguments, "--residuals", residuals
    ).stdout
    theirs = json.loads(printed)
    text = json.dumps(theirs)
    for law in fit.all:
        for parameter in law.parameters.values():
            assert json.dumps(parameter.value) in text
            assert json.dumps(parameter.lo) in text
    table = np.genfromtxt(residuals, delimiter=",", names=True, dtype=None, encoding="utf-8")
    ours = fit.residuals
    table = table[table["law"] == fit.law]
    assert len(table) == len(ours) == fit.n
    np.testing.assert_array_equal(table["coordinate"], ours["coordinate"])
    # written with as many digits as they mean something
    np.testing.assert_allclose(table["standardised"], ours["standardised"], atol=5.1e-5, rtol=1e-4)


def test_laws_are_compared(fit):
    ranked = fit.compare()
    assert [rank.law for rank in ranked] == [law.law for law in fit.all]
    assert ranked[0].delta_aic == 0.0
    assert ranked[0].aic < ranked[1].aic
    assert sum(rank.weight for rank in ranked) == pytest.approx(1.0)
    assert ranked[0].aic == fit.aic
    assert "restitution" in repr(fit)


def test_known_parameters_are_recovered():
    """A drop followed in the computer and given as arrays: what went in comes out."""
    scene = {
        "coin": {"ratio": 1.0, "radius_m": 0.01},
        "surface": {"restitution": 0.6, "friction": 0.15},
        "launch": {"preset": "robot"},
        "engine": {"flat": {"zeno": 1e-3}},
        "stop": {"tosses": 10},
    }
    launch = np.zeros(1, coinmc.LAUNCH)
    launch["position_m"] = (0.0, 0.0, 0.2)
    launch["axis"] = (np.sin(0.4), 0.0, np.cos(0.4))
    launch["velocity_m_s"] = (0.1, 0.0, 0.0)
    launch["spin_rad_s"] = (0.0, 3.0, 0.0)
    seen = coinmc.trace(scene, launch=launch, rate_hz=240).samples[:130]
    noise = np.random.default_rng(5).normal(0, 2e-4, (3, len(seen)))
    theta = np.arctan2(seen["axis"][:, 0], seen["axis"][:, 2])
    x, _, z = seen["position_m"].T
    drop = film.Drop(seen["time_s"], x + noise[0], z + noise[1], theta + 10 * noise[2], "made")
    fit = film.fit(drop, scene, laws="moreau", confidence=0.999)
    assert fit.parameters["restitution"].value == pytest.approx(0.6, abs=0.02)
    assert fit.parameters["restitution"].lo < 0.6 < fit.parameters["restitution"].hi
    assert len(fit.drops[0].impacts_s) >= 2


def test_problems_in_a_text_are_reported_with_their_location(tmp_path):
    with pytest.raises(coinmc.FilmError) as caught:
        film.parse("t\ty\ttheta\n0\t0.2\t1,5,0\n", name="a.txt")
    assert (caught.value.problems[0].line, caught.value.problems[0].column) == (2, 7)
    assert "^^^^^" in str(caught.value)
    with pytest.raises(coinmc.FilmError, match="there is no such file"):
        film.read(tmp_path / "none.txt")
    with pytest.raises(coinmc.FilmError, match="cannot be read"):
        film.read(tmp_path)


def test_options_and_units():
    text = "t;x;y;phi\n0;1;20;0.1\n0.01;1;19;0.2\n"
    plain = film.parse(text, length_unit="cm", angle_unit="rad")
    assert plain.z_m.tolist() == [0.2, 0.19]
    tilt = film.parse(text, angle_unit="rad", angle_of="tilt")
    np.testing.assert_allclose(tilt.theta_rad, [0.1, 0.2])
    with pytest.raises(ValueError, match="unknown unit 'km'"):
        film.parse(text, length_unit="km")
    with pytest.raises(ValueError, match="face, axis or tilt"):
        film.parse(text, angle_of="edge")
    with pytest.raises(TypeError, match="unknown option hight"):
        film.parse(text, hight="y")


def test_invalid_drops_are_rejected(drop):
    with pytest.raises(ValueError, match="equal lengths"):
        film.Drop([0, 1], [0], [0, 1], [0, 1])
    with pytest.raises(ValueError, match="increase"):
        film.Drop([0, 0], [0, 1], [0, 1], [0, 1])
    with pytest.raises(TypeError, match="real numbers"):
        film.Drop(["a"], [0], [0], [0])
    with pytest.raises(ValueError, match="say what was dropped"):
        film.fit(drop)
    with pytest.raises(ValueError, match='there is no law "hertz" here'):
        film.fit(drop, ratio=1, radius_m=0.01, laws=["hertz"])
    with pytest.raises(coinmc.FilmError, match="1 to 64 drops"):
        film.fit([], ratio=1, radius_m=0.01)
    with pytest.raises(coinmc.FilmError, match="between 0 and 1"):
        film.fit(drop, ratio=1, radius_m=0.01, confidence=2.0)
    short = film.Drop([0, 0.1], [0, 0], [1, 1], [0, 0])
    with pytest.raises(coinmc.FilmError, match="free flight"):
        film.fit(short, ratio=1, radius_m=0.01)


def test_the_law_of_the_config_is_fitted_by_name(drop, root):
    config = {
        "coin": {"ratio": 1.0, "radius_m": 0.01},
        "surface": {"restitution": 0.5, "friction": 0.0},
        "launch": {"preset": "robot"},
        "engine": {"flat": {"law": {"gaek-sukhov": {"eta_n_s": 1e-3}}}},
        "stop": {"tosses": 1},
    }
    fit = film.fit(drop, config, laws=["gaek-sukhov", "moreau"], free="restitution", until_s=0.25)
    assert {law.law for law in fit.all} == {"gaek-sukhov", "moreau"}
    with pytest.raises(ValueError, match="there is no law"):
        film.fit(drop, root / "examples" / "drop.toml", laws=["gaek-sukhov"])
