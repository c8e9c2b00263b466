"""Numerical settings, and parts: what the command line says, and the same numbers."""

import json
import re

import numpy as np
import polars
import pytest

import coinmc

#: With so coarse a setting a bias is seen.
COARSE = {"engine.flat.zeno": 1.0, "coin.ratio": [0.5, 1.2]}


def test_shifts_are_those_of_the_command_line(examples, command):
    path = examples / "first.toml"
    found = coinmc.converge(path, tosses=4096, overrides=COARSE)
    sets = ("--set", "engine.flat.zeno=1", "--set", "coin.ratio=[0.5, 1.2]")
    words = ("--tosses", 4096, "--format", "json", "--quiet")
    told = command("converge", path, *sets, *words).stdout
    assert found.document == json.loads(told)
    assert len(found) == 2
    assert found["ratio"].tolist() == [0.5, 1.2]
    assert {"key": "engine.flat.zeno", "usual": 1.0, "tight": 0.1} in found.settings
    assert (found["shift_side_lo"] <= found["shift_side"]).all()
    assert (found["shift_side"] <= found["shift_side_hi"]).all()
    assert found["changed"].min() > 0
    total = sum(found[f"shift_{face}"] for face in ("heads", "tails", "side"))
    assert np.abs(total).max() < 1e-12
    assert polars.DataFrame(found).columns == list(found)
    assert repr(found).startswith("<coinmc.Convergence 2 points")


def test_a_dict_needs_no_stop_and_too_few_tosses_are_refused(scene):
    config = {name: table for name, table in scene.items() if name != "stop"}
    assert not coinmc.converge(config, tosses=1024).is_biased
    with pytest.raises(ValueError, match="at least"):
        coinmc.converge(config, tosses=10)


@pytest.fixture
def parts(examples, command, tmp_path):
    """Three parts of a run."""
    made = []
    for index in (1, 2, 3):
        made.append(tmp_path / f"part-{index}")
        sets = ("--set", "stop.tosses=60_000", "--set", "coin.ratio=1.0")
        shard = ("--shard", f"{index}/3", "--out", made[-1], "--quiet")
        command("run", examples / "first.toml", *sets, *shard)
    return made


def test_parts_merge_into_the_bytes_of_one_run(examples, parts, tmp_path):
    with pytest.raises(coinmc.RunError, match=r"Run this part \(again\): 3/3"):
        coinmc.merge(parts[:2], tmp_path / "whole")
    with pytest.warns(RuntimeWarning, match=r"merged without \d chunks?: part 3/3"):
        some = coinmc.merge(parts[:2], tmp_path / "whole", partial=True)
    assert some.status == "interrupted"
    assert 0 < some.tosses < 60_000
    merged = coinmc.merge(parts, tmp_path / "whole")
    assert merged.status == "complete"
    assert merged.tosses == 60_000
    overrides = {"stop.tosses": 60_000, "coin.ratio": 1.0}
    one = coinmc.run(examples / "first.toml", tmp_path / "one", overrides=overrides)
    both = [(result.path / "results.csv").read_bytes() for result in (merged, one)]
    assert both[0] == both[1]
    with pytest.raises(TypeError, match="a list of directories"):
        coinmc.merge(parts[0], tmp_path / "other")


def test_a_bar_shows_what_a_point_has_shown(scene, capsys):
    pytest.importorskip("tqdm")
    coinmc.estimate(scene, tosses=400_000, progress=True)
    shown = capsys.readouterr().err
    assert re.search(r"P\(side\) 0\.\d{4,5} \[0\.\d{4,5}, 0\.\d{4,5}\]", shown), shown
