"""Peers: what decides their tosses, and how rows become times."""

import importlib.util
import math
import sys
from pathlib import Path

import pytest

PEERS = Path(__file__).resolve().parents[2] / "studies" / "peers"


@pytest.fixture(autouse=True)
def _found(monkeypatch):
    monkeypatch.syspath_prepend(str(PEERS))
    yield
    for name in ("scene", "decide", "errors", "engines"):
        sys.modules.pop(name, None)


@pytest.fixture
def coin():
    """H/R = 1, in its own frame."""
    import scene

    return scene.Scene(height=1.0, restitution=0.5, friction=0.3, rolling=0.0, second=10.0)


def test_energy_decides_and_not_before(coin):
    import decide
    import scene

    # standing on the rim takes g D; a little less than that is decided, a little more is not
    spare = scene.GRAVITY * (coin.rim - 0.5)
    for share, decided in ((0.999, True), (1.001, False)):
        velocity = (math.sqrt(2 * share * spare), 0.0, 0.0)
        face = decide.face(coin, 0.5, velocity, (0.0, 0.0, 1.0), (0.0, 0.0, 0.0))
        assert face == ("heads" if decided else None)
        spin = (0.0, 0.0, math.sqrt(2 * share * spare / coin.axial))
        face = decide.face(coin, 0.5, (0.0, 0.0, 0.0), (0.0, 0.0, -1.0), spin)
        assert face == ("tails" if decided else None)
        spin = (0.0, math.sqrt(2 * share * spare / coin.transverse), 0.0)
        face = decide.face(coin, 0.5, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), spin)
        assert face == ("heads" if decided else None)


def test_the_tilt_names_the_face(coin):
    import decide

    edge = math.atan2(1.0, 0.5)
    still = ((0.0, 0.0), 0.0)
    for angle, face in (
        (0.99 * edge, "heads"),
        (1.01 * edge, "side"),
        (math.pi - 0.99 * edge, "tails"),
        (-1.01 * edge, "side"),
    ):
        assert decide.face_in_plane(coin, 0.4, still[0], angle, still[1]) == face


def test_the_short_turn_takes_up_to_the_axis():
    np = pytest.importorskip("numpy")
    import scene

    for axis in np.array([[0, 0, 1], [0, 0, -1], [1, 0, 0], [0.6, 0, 0.8], [0, -0.28, -0.96]]):
        w, x, y, z = scene.turn_to(axis)
        assert w * w + x * x + y * y + z * z == pytest.approx(1)
        turned = [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)]
        assert turned == pytest.approx(list(axis))


def row(engine, step, p, rate, bias=None, bias_error=None, error=0.001):
    return {
        "engine": engine,
        "step_s": step,
        "tosses": 1000,
        "p_side": p,
        "p_side_error": error,
        "tosses_per_s": rate,
        "bias": bias,
        "bias_error": bias_error,
    }


def test_time_to_an_error_is_the_formula_and_never_below_the_bias():
    import errors

    ours = row("coinmc flat", None, 0.5, 100.0, bias=-0.001, bias_error=0.0005)
    rows = [ours, row("peer", 1e-3, 0.6, 10.0), row("peer", 1e-4, 0.5, 1.0)]
    reckoned = 0.001 + 1.96 * 0.0005
    assert errors.bias(ours, rows) == pytest.approx(reckoned)
    seconds = 0.25 * (1.96 / (0.01 - reckoned)) ** 2 / 100.0
    assert errors.seconds_to(0.01, ours, rows) == pytest.approx(seconds)
    assert errors.seconds_to(0.001, ours, rows) == math.inf
    # the coarse step is 0.1 ± 0.0014 off its engine's finest, which is never off itself
    assert errors.bias(rows[1], rows) == pytest.approx(0.1 - 1.96 * math.sqrt(2) * 0.001)
    assert errors.best(0.01, "peer", rows) == errors.seconds_to(0.01, rows[2], rows)
    text = errors.table(rows)
    assert "| coinmc flat | 2.49 min | 2.56 h | never | never |" in text
    assert "≥ 2.67 h" in text


@pytest.mark.parametrize("name", ["mujoco", "bullet", "physx", "chipmunk"])
def test_an_installed_peer_tosses(name, coin):
    import engines
    import scene

    packages = {"mujoco": "mujoco", "bullet": "pybullet", "physx": "sapien", "chipmunk": "pymunk"}
    if importlib.util.find_spec(packages[name]) is None:
        pytest.skip(f"{packages[name]} is not installed")
    import numpy as np

    module = engines.load(name)
    tosser = module.Tosser(coin, module.STEPS[0])
    # dropped flat from just above the surface, either way up
    for up, face in ((1.0, "heads"), (-1.0, "tails")):
        axis = np.array([0.0, 0.0, up])
        launch = scene.Launch(0.51, np.zeros(3), axis, np.zeros(3))
        assert tosser.toss(launch) == face
