"""Which unknown matters most: Rust tests the answers, these tests what Python makes of them."""

import json

import numpy as np
import pytest

import coinmc

FLAT = {
    "coin": {"ratio": 1.0},
    "surface": {"landing": "adhesive", "restitution": 0.0, "friction": 0.3},
    "launch": {"preset": "clean-flat"},
    "engine": {"flat": {}},
}
OVER = {"surface.friction": (0.1, 0.5), "coin.ratio": (0.5, 1.5)}


def test_a_ranking_is_a_table_with_a_picture():
    ranking = coinmc.rank(FLAT, over=OVER, samples=200, tosses=1024)
    assert len(ranking) == 2
    assert ranking["parameter"].tolist() == ["coin.ratio", "surface.friction"]
    assert ranking["value"].tolist() == [1.0, 0.3]
    assert (ranking["from"][0], ranking["to"][0]) == OVER["coin.ratio"]
    assert ranking["p_from"][0] < ranking["p_to"][0]
    assert ranking["p_from"][1] == ranking["p_to"][1]
    assert (ranking["total_lo"] <= ranking["total"]).all()
    assert 0.1 < ranking.mean < 0.5
    assert 0.0 < ranking.standard_deviation < 0.2
    # 200 samples of 4 places with 32 tosses, and both ends of two ranges and the scene itself
    assert ranking.tosses == 200 * 4 * 32 + 5 * 1024
    assert ranking.picture().startswith("<svg")
    assert ranking.picture() in ranking._repr_html_()
    assert "coin.ratio" in repr(ranking)
    assert "picture" not in ranking.document
    json.dumps(ranking.document)


def test_what_does_not_move_has_no_indices():
    over = {"surface.friction": (0.1, 0.5)}
    ranking = coinmc.rank(FLAT, over=over, samples=100, tosses=256)
    assert np.isnan(ranking["total"]).all()
    assert "nan" in repr(ranking)


def test_an_everyday_scene_says_its_own_ranges():
    overrides = {"surface.friction": 0.4, "coin.ratio": 1.2}
    ranking = coinmc.rank(scene="felt", samples=64, tosses=256, overrides=overrides)
    assert "surface.restitution" in ranking["parameter"]
    assert "surface.friction" not in ranking["parameter"]


def test_bad_questions_are_told():
    with pytest.raises(ValueError, match="say what is unknown"):
        coinmc.rank(FLAT)
    with pytest.raises(ValueError, match="least, most"):
        coinmc.rank(FLAT, over={"coin.ratio": (1,)})
    with pytest.raises(ValueError, match="the range must lead"):
        coinmc.rank(FLAT, over={"coin.ratio": (2, 1)})
    with pytest.raises(ValueError, match="choose from"):
        coinmc.rank(FLAT, over={"coin.ratoi": (1, 2)})
