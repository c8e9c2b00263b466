"""Answers of the atlas."""

import numpy as np
import pytest

import coinmc

SCENES = [
    ("hand", "wood", 0.8),
    ("hand", "felt", 1.3),
    ("dropped", "laminate", 1.2),
    ("rolled", "wood", 0.5),
]
LAUNCHES = {
    "hand": {"preset": "hand", "height_m": 0.3},
    "dropped": {"preset": "drop"},
    "rolled": {
        "height_m": 0.0,
        "velocity_m_s": [0.0, 0.5, 0.0],
        "orientation": {"tilt_deg": {"normal": {"mean": 90.0, "sd": 3.0}}},
        "spin": {"about": {"axis": [1, 0, 0], "rate_rad_s": -43.0}},
    },
}


@pytest.mark.parametrize(("launch", "material", "ratio"), SCENES)
def test_tosses_agree_within_the_error_that_is_stated(launch, material, ratio):
    """Four standard errors, of answer and tosses: one false alarm in 4,000 such tests."""
    answer = coinmc.ask(ratio, material, launch)
    result = coinmc.estimate(
        {
            "coin": {"ratio": ratio, "radius_m": 0.011625},
            "surface": {"material": material},
            "launch": LAUNCHES[launch],
            "engine": {"volumetric": {}},
        },
        tosses=4096,
    )
    p = np.array([result[f"p_{face}"][0] for face in ("heads", "tails", "side")])
    error = np.sqrt(answer.error**2 + p * (1 - p) / 4096 + 1e-7)
    assert (abs(answer.p - p) < 4 * error).all()
    assert (answer.error < 0.05).all()


def test_arguments_broadcast_and_numbers_give_numbers():
    one = coinmc.ask(0.8, "wood", friction=0.25)
    assert one.p.shape == (3,)
    assert one.p.sum() == pytest.approx(1)
    many = coinmc.ask([[0.8], [1.2]], "wood", friction=[0.2, 0.25, 0.4])
    assert many.error.shape == (2, 3, 3)
    assert (many.p[0, 1] == one.p).all()
    assert "P(side) = " in repr(one)


def test_the_fair_ratio_is_where_the_side_has_a_third():
    ratio, error = coinmc.ask([1.0, 1.0], "wood", restitution=[0.3, 0.5]).fair()
    assert ratio.shape == error.shape == (2,)
    sides = [
        coinmc.ask(x, "wood", restitution=e).side for x, e in zip(ratio, [0.3, 0.5], strict=True)
    ]
    assert sides == pytest.approx([1 / 3, 1 / 3], abs=1e-6)
    never, _ = coinmc.ask(1.0).fair(0.9999999)
    assert np.isnan(never)


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ({"ratio": 9, "friction": 3}, "ratio from 0.15 to 2.5, not 9\n.*friction from 0.1 to 0.8"),
        ({"ratio": 1, "launch": "thrown"}, "no launch `thrown`: it has hand, dropped, rolled"),
        ({"ratio": 1, "material": "marble"}, "marble"),
        ({"ratio": 1, "fricton": 0.3}, "no `fricton`: it knows restitution"),
        ({"ratio": float("nan")}, "not NaN"),
    ],
)
def test_what_it_does_not_hold_is_said(asked, message):
    with pytest.raises(ValueError, match=message):
        coinmc.ask(**asked)


def test_masked_values_are_refused():
    masked = np.ma.masked_array([1.0, 1.2], [0, 1])
    for asked in ({"ratio": masked}, {"ratio": 1.0, "friction": masked}):
        with pytest.raises(ValueError, match="masked values are not supported"):
            coinmc.ask(**asked)
