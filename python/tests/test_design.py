"""A coin to print: Rust tests the solid, these tests what Python makes of it."""

import json

import pytest

import coinmc

COIN = {"scene": "felt", "diameter_m": 0.03, "half_width": 0.1}


def test_a_design_has_its_files(tmp_path):
    coin = coinmc.design(**COIN, rim_m=0.001, marks=True)
    assert coin.ratio_lo < coin.ratio < coin.ratio_hi
    assert coin.thickness_m == pytest.approx(0.015 * coin.ratio)
    assert coin.diameter_m == pytest.approx(0.03)
    assert list(coin.tolerances["thickness_error_m"]) == [5e-5, 1e-4, 2e-4]
    assert (coin.tolerances["tosses_to_tell"] > 1000).all()
    assert coin.sheet().startswith("<svg")
    paths = coin.write(tmp_path / "coin")
    assert [path.name for path in paths] == ["coin.stl", "coin.3mf", "coin.scad", "coin.svg"]
    assert (tmp_path / "coin.stl").read_bytes() == coin.files[".stl"]
    assert len(coin.files[".stl"]) == 84 + 50 * coin.document["triangles"]
    with pytest.raises(FileExistsError, match="exists already"):
        coin.write(tmp_path / "coin")
    assert "mm thick" in repr(coin)
    assert "tosses to tell" in coin._repr_html_()
    json.dumps(coin.document)


def test_the_config_gives_the_diameter():
    config = {
        "coin": {"ratio": 1.0, "radius_m": 0.005},
        "surface": {"material": "wood"},
        "launch": {"preset": "hand"},
        "engine": {"volumetric": {}},
    }
    assert coinmc.design(config, half_width=0.2).diameter_m == pytest.approx(0.01)
    wide = coinmc.design(config, half_width=0.2, diameter_m=0.03)
    assert wide.diameter_m == pytest.approx(0.03)


def test_infill_makes_it_lighter():
    full = coinmc.design(**COIN)
    light = coinmc.design(**COIN, walls_m=0.0008, infill=0.2)
    assert light.mass_kg < 0.8 * full.mass_kg


def test_a_conical_edge_makes_heads_and_tails_differ():
    plane = {"surface.roughness_slope": 0}
    coin = coinmc.design(**COIN, draft_deg=10, overrides=plane)
    assert coin.draft_deg == 10
    assert coin.p_heads + 0.1 < coin.p_tails
    assert b"draft = 10;" in coin.files[".scad"]
    same = coinmc.design(**COIN, overrides={**plane, "coin.draft_deg": 10})
    assert same.files == coin.files
    plain = coinmc.design(**COIN)
    assert (plain.draft_deg, plain.document["faces"]) == (0, None)
    assert plain.p_heads == plain.p_tails == pytest.approx(1 / 3)
    with pytest.raises(ValueError, match="no marks"):
        coinmc.design(**COIN, draft_deg=10, marks=True)


def test_bad_questions_are_told():
    with pytest.raises(ValueError, match="not both"):
        coinmc.design(**COIN, rim_m=0.001, chamfer_m=0.001)
    with pytest.raises(ValueError, match="go together"):
        coinmc.design(**COIN, infill=0.2)
    with pytest.raises(ValueError, match="the edge must take"):
        coinmc.design(**COIN, rim_m=0.02)
    with pytest.raises(ValueError, match="target"):
        coinmc.design(**COIN, target=1.5)
