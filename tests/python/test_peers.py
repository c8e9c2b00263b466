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


def face(coin, z, velocity, axis, spin):
    """What decides for one coin."""
    import decide

    np = pytest.importorskip("numpy")
    state = (np.array([part], dtype=float) for part in (z, velocity, axis, spin))
    (code,) = decide.faces(coin, *state)
    return None if code == decide.UNDECIDED else decide.FACES[code]


def test_energy_decides_and_not_before(coin):
    import scene

    # standing on the rim takes g D; a little less than that is decided, a little more is not
    spare = scene.GRAVITY * (coin.rim - 0.5)
    for share, decided in ((0.999, True), (1.001, False)):
        velocity = (math.sqrt(2 * share * spare), 0.0, 0.0)
        found = face(coin, 0.5, velocity, (0.0, 0.0, 1.0), (0.0, 0.0, 0.0))
        assert found == ("heads" if decided else None)
        spin = (0.0, 0.0, math.sqrt(2 * share * spare / coin.axial))
        found = face(coin, 0.5, (0.0, 0.0, 0.0), (0.0, 0.0, -1.0), spin)
        assert found == ("tails" if decided else None)
        spin = (0.0, math.sqrt(2 * share * spare / coin.transverse), 0.0)
        found = face(coin, 0.5, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), spin)
        assert found == ("heads" if decided else None)


def test_the_tilt_names_the_face(coin):
    edge = math.atan2(1.0, 0.5)
    still = (0.0, 0.0, 0.0)
    for angle, expected in (
        (0.99 * edge, "heads"),
        (1.01 * edge, "side"),
        (math.pi - 0.99 * edge, "tails"),
        (-1.01 * edge, "side"),
    ):
        axis = (math.sin(angle), 0.0, math.cos(angle))
        assert face(coin, 0.4, still, axis, still) == expected


def test_free_flight_is_skipped_to_where_the_rim_may_touch(coin):
    np = pytest.importorskip("numpy")
    import scene

    axis, velocity = np.array([0.6, 0.0, 0.8]), np.array([0.3, -0.2, 4.0])
    launch = scene.Launch(30.0, velocity, axis, np.array([1.0, -2.0, 3.0]))
    end = scene.fallen(launch, coin)
    assert end.height == pytest.approx(coin.rim + scene.MARGIN)
    assert end.velocity[2] < 0.0

    # Euler's equations in the laboratory: dL/dt = 0, du/dt = ω × u, in ten thousand midpoint steps
    along, across = coin.axial, coin.transverse
    momentum = across * launch.spin + (along - across) * (launch.spin @ axis) * axis

    def spin(u):
        return momentum / across + (1 / along - 1 / across) * (momentum @ u) * u

    step = (velocity[2] - end.velocity[2]) / scene.GRAVITY / 10_000
    for _ in range(10_000):
        middle = axis + 0.5 * step * np.cross(spin(axis), axis)
        axis = axis + step * np.cross(spin(middle), middle)
    # of second order: some (5 rad/s · 0.3 ms)² a radian turned
    assert end.axis == pytest.approx(axis, abs=1e-4)
    assert end.spin == pytest.approx(spin(axis), abs=1e-3)

    below = scene.Launch(coin.rim, velocity, axis, launch.spin)
    assert scene.fallen(below, coin) is below


class Waiting:
    """A world of coins that end as launched, after as many looks as their height says."""

    def __init__(self, coin, coins):
        np = pytest.importorskip("numpy")
        self.coin, self.coins, self.left, self.np = coin, coins, np.full(coins, 0), np
        self.up, self.placed = np.zeros(coins), 0

    def place(self, coin, launch):
        self.left[coin] = launch.height
        self.up[coin] = launch.axis[2]
        self.placed += 1

    def advance(self, steps):
        self.left -= 1

    def states(self):
        np = self.np
        z = np.where(self.left > 0, 10.0, 0.4)
        axis = np.column_stack((np.sqrt(1 - self.up**2), 0 * self.up, self.up))
        return z, np.zeros((self.coins, 3)), axis, np.zeros((self.coins, 3))


def test_every_toss_that_is_begun_is_followed_to_its_end(coin):
    np = pytest.importorskip("numpy")
    import decide
    import scene

    still = np.zeros(3)
    rng = np.random.default_rng(3)
    ups = rng.choice([1.0, 0.0, -1.0], size=500)
    lengths = rng.integers(1, 60, size=500)
    launches = [
        scene.Launch(float(length), still, np.array([0.0, 0.0, up]), still)
        for length, up in zip(lengths, ups, strict=True)
    ]
    expected = np.select([ups == 1.0, ups == -1.0], [0, 1], default=2)
    for coins in (1, 7, 64):
        # time for all launches; time for no more than those that the world begins with
        tossed = decide.follow(coin, 1e-3, Waiting(coin, coins), launches, 60.0)
        assert tossed.faces.tolist() == expected.tolist()
        world = Waiting(coin, coins)
        tossed = decide.follow(coin, 1e-3, world, launches, 0.0)
        assert len(tossed.faces) == world.placed < 500
        assert tossed.faces.tolist() == expected[: world.placed].tolist()
        assert tossed.seconds > 0.0


def test_what_never_ends_is_given_up(coin):
    np = pytest.importorskip("numpy")
    import decide
    import scene

    launches = [scene.Launch(1e9, np.zeros(3), np.array([0.0, 0.0, 1.0]), np.zeros(3))] * 3
    tossed = decide.follow(coin, 1e-3, Waiting(coin, 2), launches, 60.0)
    assert tossed.faces.tolist() == [decide.UNDECIDED] * 3


def test_the_short_turn_takes_up_to_the_axis():
    np = pytest.importorskip("numpy")
    import scene

    for axis in np.array([[0, 0, 1], [0, 0, -1], [1, 0, 0], [0.6, 0, 0.8], [0, -0.28, -0.96]]):
        w, x, y, z = scene.turn_to(axis)
        assert w * w + x * x + y * y + z * z == pytest.approx(1)
        turned = [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)]
        assert turned == pytest.approx(list(axis))
        assert list(scene.axis_of(w, x, y, z)) == pytest.approx(list(axis))


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
    import decide
    import engines
    import scene

    packages = {"mujoco": "mujoco", "bullet": "pybullet", "physx": "sapien", "chipmunk": "pymunk"}
    if importlib.util.find_spec(packages[name]) is None:
        pytest.skip(f"{packages[name]} is not installed")
    import numpy as np

    module = engines.load(name)
    # dropped flat from just above the surface, either way up, side by side
    launches = [
        scene.Launch(0.51, np.zeros(3), np.array([0.0, 0.0, up]), np.zeros(3))
        for up in (1.0, -1.0, -1.0, 1.0, 1.0)
    ]
    world = module.World(coin, module.STEPS[0], 3)
    tossed = decide.follow(coin, module.STEPS[0], world, launches, 60.0)
    assert [decide.FACES[code] for code in tossed.faces] == [
        "heads",
        "tails",
        "tails",
        "heads",
        "heads",
    ]
