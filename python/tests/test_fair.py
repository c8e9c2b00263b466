"""How thick is a fair coin: Rust tests the answers, these tests what Python makes of them."""

import math

import pytest

import coinmc

ROBOT = {
    "surface": {"restitution": 0.5, "friction": 0.3},
    "launch": {"preset": "robot"},
    "engine": {"flat": {}},
}


def test_an_answer_has_its_interval_its_slope_and_the_coin():
    answer = coinmc.fair(ROBOT, half_width=0.03, diameter_m=0.03)
    [root] = answer.roots
    assert root.lo < root.value < root.hi
    assert root.half_width <= 0.03
    assert root.reached
    assert root.slope > 0
    assert root.tosses > 4000
    assert root.at == {}
    assert root.diameter_m == 0.03
    assert math.isclose(root.thickness_m, root.value * 0.015)
    shift, lo, hi = root.numerical
    assert lo <= shift <= hi
    assert answer.tosses > root.tosses
    # the scan shows the whole curve
    assert answer.scan["value"][0] == pytest.approx(0.05)
    assert answer.scan["p"][0] < 1 / 3 < answer.scan["p"][-1]
    assert "H/R = 1." in repr(answer)
    assert "<table>" in answer._repr_html_()


def test_a_sweep_gives_an_answer_for_each_value():
    answer = coinmc.fair(
        ROBOT, half_width=0.05, overrides={"surface.restitution": [0.3, 0.7]}, numerical_tosses=0
    )
    assert [root.at for root in answer.roots] == [{"restitution": 0.3}, {"restitution": 0.7}]
    assert all(root.numerical is None for root in answer.roots)


def test_a_config_and_its_dict_are_the_same_question():
    config = coinmc.Config({"coin": {"ratio": 1.0}, **ROBOT, "stop": {"tosses": 10}})
    for asked in (config, {"coin": {"ratio": 2.0}, **ROBOT}):
        answer = coinmc.fair(asked, half_width=0.05, numerical_tosses=0)
        assert answer.roots[0].value == pytest.approx(1.6719, abs=0.1)


def test_an_everyday_scene_says_what_it_assumes():
    answer = coinmc.fair(
        scene="felt", half_width=0.05, assumption_tosses=64, overrides={"surface.friction": 0.3}
    )
    keys = {assumption["parameter"] for assumption in answer.assumptions}
    assert "surface.restitution" in keys
    # what is given is not assumed
    assert "surface.friction" not in keys
    assert all(assumption["source"] for assumption in answer.assumptions)
    assert set(coinmc.scenes()) >= {"table", "wood", "felt", "glass"}


def test_no_answer_is_an_answer():
    answer = coinmc.fair(
        {"coin": {"ratio": 0.5}, **ROBOT}, parameter="surface.restitution", target=0.9
    )
    assert answer.roots == []
    assert "none: P from" in repr(answer)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"target": 0.0}, "above 0 and below 1"),
        ({"half_width": -1.0}, "half width"),
        ({"face": "edge"}, "heads, tails or side"),
        ({"between": [2.0, 1.0]}, "the range must lead"),
        ({"max_tosses": 1}, "at least 4096"),
        ({"diameter_m": 0.0}, "diameter of the coin"),
        ({"diameter_m": 0.02, "volume_m3": 1e-6}, "not both"),
        ({"scene": "wood"}, "not both"),
    ],
)
def test_questions_without_sense_are_refused(wrong, message):
    with pytest.raises(ValueError, match=message):
        coinmc.fair(ROBOT, **wrong)


def test_a_wrong_key_is_a_problem_of_the_config():
    with pytest.raises(coinmc.ConfigError, match="did you mean `ratio`"):
        coinmc.fair({"coin": {"ratio": 1.0}, **ROBOT}, parameter="coin.ratoi")
    with pytest.raises(ValueError, match="did you mean `felt`"):
        coinmc.fair(scene="fellt")
