"""Counts against models: Rust tests the numbers, these tests what Python makes of them."""

import json

import numpy as np
import pytest

import coinmc

RULE = {"coin": {"ratio": [0.5, 1.5, 3.0]}, "engine": {"analytic": {"rule": "cross-section"}}}


def test_results_in_memory_and_in_directories(tmp_path, examples):
    overrides = {"stop.tosses": 2000, "coin.ratio": [0.8, 1.2]}
    run = coinmc.run(examples / "first.toml", tmp_path / "run", overrides=overrides)
    other = coinmc.estimate(examples / "first.toml", overrides={**overrides, "seed": 7})
    counts = {"heads": 480, "tails": 440, "side": 80}
    answer = coinmc.compare(counts, tmp_path / "run", other)
    assert len(answer.parameters) == 4
    assert answer.columns["share"].sum() == pytest.approx(1.0)
    assert (np.diff(answer.columns["evidence"]) <= 0).all()
    # of tosses that are decided there is one p-value
    assert (answer.columns["p_value"] == answer.columns["p_value_at_best"]).all()
    # the same run twice would halve its share
    with pytest.raises(ValueError, match="given before"):
        coinmc.compare(counts, tmp_path / "run", run)
    with pytest.raises(ValueError, match="given before"):
        coinmc.compare(counts, other, other)
    assert answer.seen["side"].lo < 0.08 < answer.seen["side"].hi
    assert "480 heads" in repr(answer)
    assert "p_value" in answer._repr_html_()
    json.dumps(answer.document)


def test_the_command_line_says_the_same(tmp_path, command):
    coinmc.run(RULE, tmp_path / "rule")
    answer = coinmc.compare((41, 38, 21), tmp_path / "rule")
    printed = command("compare", tmp_path / "rule", "--counts", "41,38,21", "--format", "json")
    assert json.loads(printed.stdout) == answer.document
    assert [p["ratio"] for p in answer.parameters] == [0.5, 1.5, 3.0]


def test_bad_counts_are_told():
    rule = coinmc.estimate(RULE)
    with pytest.raises(ValueError, match="at least one toss"):
        coinmc.compare([0, 0, 0], rule)
    with pytest.raises(ValueError, match="three counts"):
        coinmc.compare([1, 2], rule)
    with pytest.raises(ValueError, match="tails"):
        coinmc.compare([1, -2, 3], rule)
    with pytest.raises(ValueError, match="edge"):
        coinmc.compare({"edge": 3}, rule)
    with pytest.raises(ValueError, match="1000000"):
        coinmc.compare([10**9, 0, 0], rule)
    with pytest.raises(ValueError, match="at least one model"):
        coinmc.compare([1, 2, 3])
