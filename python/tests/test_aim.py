"""Which launch forces a face: Rust tests the answers, these tests what Python makes of them."""

import json

import pytest

import coinmc

FLAT = {
    "coin": {"ratio": 1.0},
    "surface": {"landing": "adhesive", "restitution": 0.0, "friction": 0.3},
    "launch": {
        "height_m": 0.5,
        "orientation": {"tilt_deg": {"normal": {"mean": 70.0, "sd": 5.0}}},
        "spin": {"about": {"axis": [0, 1, 0], "rate_rad_s": 0.0}},
    },
    "engine": {"flat": {}},
}
TILT = "launch.orientation.tilt_deg.normal.mean"


def test_an_answer_names_the_launches_and_a_clumsier_hand():
    answer = coinmc.aim(
        FLAT, over={TILT: (0, 180, 7)}, face="heads", tosses=64, final_tosses=1000, clumsiness=[10]
    )
    assert answer.best.values == {TILT: 0.0}
    assert answer.best.p == 1.0
    assert answer.best.tosses == 1000
    assert answer.worst.p == 0.0
    assert answer.baseline.values == {TILT: 70.0}
    assert answer.baseline.hi < 0.2
    [hand] = answer.clumsy
    assert (hand.spread, hand.values) == (10.0, {TILT: 0.0})
    assert hand.hi < 0.9
    # seven launches in order, of which tossed ones have an interval
    assert list(answer.map[TILT]) == [0, 30, 60, 90, 120, 150, 180]
    assert (answer.map["lo"] <= answer.map["p"]).all()
    assert (answer.map["tosses"] == 64).all()
    assert "most likely, 10 times the spread" in repr(answer)
    assert answer.picture().startswith("<svg")
    assert answer.picture() in answer._repr_html_()
    assert "picture" not in answer.document
    json.dumps(answer.document)


def test_two_numbers_span_a_map():
    answer = coinmc.aim(
        scene="felt",
        over={
            "launch.height_m": (0.05, 1),
            "launch.spin.precessing.psi_deg.normal.mean": (20, 90, 2),
        },
        tosses=8,
        final_tosses=16,
        clumsiness=[],
    )
    assert len(answer.map["p"]) == 22
    assert len(set(answer.map["launch.height_m"])) == 11
    assert answer.clumsy == []


def test_bad_questions_are_told():
    with pytest.raises(ValueError, match="first, last"):
        coinmc.aim(FLAT, over={TILT: (1,)})
    with pytest.raises(ValueError, match="heads, tails or side"):
        coinmc.aim(FLAT, over={TILT: (0, 1)}, face="edge")
    with pytest.raises(ValueError, match=r"launch\.nowhere"):
        coinmc.aim(FLAT, over={"launch.nowhere": (0, 1)})
    with pytest.raises(ValueError, match="not both"):
        coinmc.aim(FLAT, "felt", over={TILT: (0, 1)})
