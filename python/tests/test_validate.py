"""Verdicts: Rust tests how they are found, these tests what Python makes of them."""

import json

import pytest

import coinmc


def test_verdicts_come_with_their_grounds(tmp_path):
    only = ["stopping-rule", "budden", "kerrich"]
    found = coinmc.validate(only, out=tmp_path / "runs")
    assert found.verdicts == {
        "stopping-rule": "holds only where",
        "kerrich": "not rejected",
        "budden": "not validated",
    }
    assert found.conditions["budden"] == "its bodies are no cylinders"
    assert found.p_values == pytest.approx({"kerrich": 0.1835}, abs=1e-3)
    assert found.not_rejected == 1
    first = [row["name"] for row in found.rows if row["first"]]
    assert first == ["stopping-rule", "kerrich", "budden"]
    assert len(found.rows) == 3 + 3
    evidence = found.document["claims"][0]["evidence"]
    assert all(number["tosses"] == 4000 for number in evidence)
    assert (tmp_path / "runs/claims").is_dir()
    # the same again is read from there
    assert coinmc.validate(only, out=tmp_path / "runs").document == found.document
    assert "1 of 1 predicted" in repr(found)
    assert "stopping-rule" in found._repr_html_()
    json.dumps(found.rows)


def test_names_that_nothing_has_are_told():
    with pytest.raises(ValueError, match="did you mean `kerrich`"):
        coinmc.validate(["kerich"])
    with pytest.raises(ValueError, match="as a list"):
        coinmc.validate("kerrich")
