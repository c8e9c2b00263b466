"""How rare a face is: Rust tests the answers, these tests what Python makes of them."""

import json
import math

import pytest

import coinmc

FLAT = {
    "coin": {"ratio": 0.02},
    "surface": {"landing": "adhesive", "restitution": 0.0, "friction": 0.3},
    "launch": {"preset": "clean-flat"},
    "engine": {"flat": {}},
}


def test_an_answer_says_what_it_gained():
    answer = coinmc.rare(FLAT, relative_error=0.2)
    assert answer.reached
    assert 0.0 < answer.lo < answer.p < answer.hi
    assert answer.hi - answer.lo <= 0.4 * answer.p
    assert answer.gain > 1.5
    assert answer.gain_of_work > 0.5
    assert answer.strata["tosses"].sum() == answer.tosses <= answer.launches
    assert answer.strata["launches"].sum() == answer.launches
    assert (answer.strata["cos_from"][1:] == answer.strata["cos_to"][:-1]).all()
    assert "P(side)" in repr(answer)
    assert "cos_from" in answer._repr_html_()
    json.dumps(answer.document)


def test_a_limit_and_a_face_that_was_not_seen():
    tilt = {"normal": {"mean": 180, "sd": 1}}
    spin = {"about": {"axis": [0, 1, 0], "rate_rad_s": 0}}
    launch = {"height_m": 0.5, "orientation": {"tilt_deg": tilt}, "spin": spin}
    answer = coinmc.rare({**FLAT, "launch": launch}, face="heads", max_tosses=5000)
    assert not answer.reached
    assert (answer.p, answer.lo) == (0.0, 0.0)
    assert answer.hi > 0.0
    assert math.isnan(answer.gain)


def test_bad_questions_are_told():
    with pytest.raises(ValueError, match="relative error"):
        coinmc.rare(FLAT, relative_error=0.0)
    with pytest.raises(ValueError, match="heads, tails or side"):
        coinmc.rare(FLAT, face="edge")
    with pytest.raises(ValueError, match="at least 4096"):
        coinmc.rare(FLAT, max_tosses=10)
