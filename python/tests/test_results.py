"""Results are a table to anyone, runs go on where they stopped, and directories are opened."""

import json
import pickle
import warnings
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import numpy as np
import pandas as pd
import polars as pl
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

import coinmc


@pytest.fixture
def sweep(scene):
    """Three points."""
    return {**scene, "coin": {"ratio": [0.8, 1.2, 1.6]}}


def test_arrow_and_parquet_hold_the_same_table(sweep, tmp_path):
    result = coinmc.run(sweep, tmp_path / "run")
    table = pa.table(result)
    written = pq.read_table(tmp_path / "run" / "results.parquet")
    assert table.schema.equals(written.schema, check_metadata=True)
    assert table.equals(written)
    for ours, theirs in zip(table.schema, written.schema, strict=True):
        assert ours.metadata == theirs.metadata, ours.name
        assert result.units[ours.name] == ours.metadata.get(b"unit", b"").decode()
        assert result.descriptions[ours.name] == ours.metadata[b"description"].decode()
    for key, value in result.metadata.items():
        assert table.schema.metadata[f"coinmc.{key}".encode()].decode() == value


def test_arrow_shares_memory(sweep):
    result = coinmc.estimate(sweep)
    addresses = [
        [
            chunk.buffers()[1].address
            for column in pa.table(result).columns
            for chunk in column.chunks
        ]
        for _ in range(2)
    ]
    assert addresses[0] == addresses[1]


def test_other_libraries_read_it(sweep):
    result = coinmc.estimate(sweep)
    frame = pl.DataFrame(result)
    assert frame["p_side"].to_list() == result["p_side"].tolist()
    assert frame["engine"].to_list() == result["engine"].tolist()
    assert isinstance(pa.table(result).to_pandas(), pd.DataFrame)
    from_columns = pd.DataFrame(result.columns)
    assert from_columns["tosses"].tolist() == [3000] * 3
    assert pa.table(result, schema=pa.table(result).schema).num_rows == 3


def test_columns_are_arrays(sweep):
    result = coinmc.estimate(sweep)
    kinds = {name: column.dtype.kind for name, column in result.columns.items()}
    assert (kinds["tosses"], kinds["p_side"], kinds["engine"], kinds["reached_target"]) == tuple(
        "ufUb"
    )
    assert {len(column) for column in result.columns.values()} == {3} == {len(result)}
    rule = {"coin": {"ratio": 1}, "engine": {"analytic": {"rule": "arc"}}}
    exact = coinmc.estimate(rule)
    assert np.isnan(exact["rel_error_side"][0])
    assert exact["p_side"][0] == coinmc.analytic.arc(1.0)
    assert exact.tosses == 0


def test_representation(sweep):
    result = coinmc.estimate(sweep)
    assert "3 points" in repr(result)
    assert repr(result).count("\n") == 4
    assert result._repr_html_().count("<tr>") == 4
    many = {"coin": {"ratio": {"from": 0.1, "to": 2, "steps": 50}}}
    many["engine"] = {"analytic": {"rule": "zone"}}
    assert "38 more points" in repr(coinmc.estimate(many))


def test_a_run_equals_the_estimate_and_its_directory_opens(sweep, tmp_path):
    estimate = coinmc.estimate(sweep)
    result = coinmc.run(sweep, tmp_path / "run")
    opened = coinmc.open(tmp_path / "run")
    assert pa.table(estimate).equals(pa.table(result))
    assert pa.table(opened).equals(pa.table(result))
    assert (result.status, opened.status, opened.path) == ("complete",) * 2 + (tmp_path / "run",)
    assert opened.config == result.config
    assert pa.table(pickle.loads(pickle.dumps(opened))).equals(pa.table(opened))


def test_results_go_to_other_processes(sweep, tmp_path, monkeypatch):
    """In memory with every number, in a directory by its absolute path."""
    rule = {"coin": {"ratio": [1, 2]}, "engine": {"analytic": {"rule": "arc"}}}
    integrated = {**sweep, "surface": {"landing": "adhesive"}}
    targets = {**sweep, "stop": {"half_width": 0.02, "max_tosses": 5000}}
    for config in (sweep, rule, integrated, targets):
        result = coinmc.estimate(config)
        again = pickle.loads(pickle.dumps(result))
        assert pa.table(again).equals(pa.table(result), check_metadata=True)
        assert (again.status, again.tosses, again.path) == (result.status, result.tosses, None)
        assert again.config == result.config
    monkeypatch.chdir(tmp_path)
    there = pickle.dumps(coinmc.run(sweep, "run"))
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    assert pickle.loads(there).tosses == 9000
    with ProcessPoolExecutor(1, get_context("spawn")) as pool:
        assert pool.submit(coinmc.estimate, sweep).result().tosses == 9000


def test_a_part_is_a_part(sweep, command, tmp_path):
    config = tmp_path / "toss.toml"
    config.write_text(coinmc.Config(sweep).resolved)
    command("run", config, "--out", tmp_path / "part", "--shard", "1/2", "--quiet")
    assert coinmc.open(tmp_path / "part").status == "part"


def test_a_result_is_a_mapping_of_columns(sweep):
    result = coinmc.estimate(sweep)
    assert list(result) == list(result.keys()) == list(result.columns)
    assert "p_side" in result
    assert "p_edge" not in result
    assert dict(result).keys() == dict(result.items()).keys()
    assert result.get("p_edge", 0) == 0
    assert len(result) == 3
    assert pd.DataFrame(dict(result)).equals(result.to_pandas())
    assert result.to_polars().equals(pl.DataFrame(result))


def test_a_sweep_has_the_dimensions_of_its_axes(sweep):
    two = {**sweep, "surface": {"restitution": [0.3, 0.5], "friction": 0.3}}
    result = coinmc.estimate(two)
    data = result.to_xarray()
    assert data.sizes == {"ratio": 3, "restitution": 2}
    assert data["p_side"].dims == ("ratio", "restitution")
    there = (result["ratio"] == 1.2) & (result["restitution"] == 0.3)
    assert float(data["p_side"].sel(ratio=1.2, restitution=0.3)) == result["p_side"][there][0]
    assert data["radius_m"].attrs["units"] == "m"
    assert data.attrs["plan_hash"] == result.config.hash
    alone = coinmc.estimate({**sweep, "coin": {"ratio": 1}}).to_xarray()
    assert alone.sizes == {"point": 1}


def test_undecided_tosses_are_shown_and_warned_of(sweep):
    """No friction: what slides does so for ever, and a limit of impacts ends the rest."""
    cut = {**sweep, "engine": {"flat": {"max_impacts": 2}}}
    with pytest.warns(RuntimeWarning, match=r"at 3 points undecided .* have no face"):
        result = coinmc.estimate(cut)
    assert result.undecided.sum() > 0
    assert "undecided" in repr(result)
    assert "undecided" in result._repr_html_()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert "undecided" not in repr(coinmc.estimate(sweep))


def test_the_command_line_resumes_a_run_and_vice_versa(scene, command, tmp_path):
    config = tmp_path / "toss.toml"
    config.write_text(coinmc.Config(scene).resolved)
    command("run", config, "--out", tmp_path / "run", "--quiet")
    before = (tmp_path / "run" / "results.parquet").read_bytes()
    result = coinmc.run(config, tmp_path / "run")
    assert result.tosses == 3000
    assert (tmp_path / "run" / "results.parquet").read_bytes() == before


def test_an_interrupted_run_resumes(sweep, tmp_path):
    whole = {**sweep, "stop": {"tosses": 200_000}}

    def interrupting(done, planned):
        if 0 < done < planned:
            raise KeyboardInterrupt

    try:
        coinmc.run(whole, tmp_path / "run", progress=interrupting)
        pytest.skip("it was over before it could be interrupted")
    except KeyboardInterrupt:
        pass
    part = coinmc.open(tmp_path / "run")
    assert part.status == "interrupted"
    assert 0 < part.tosses < 600_000
    result = coinmc.run(whole, tmp_path / "run")
    assert result.status == "complete"
    assert pa.table(result).equals(pa.table(coinmc.estimate(whole)))


def test_a_run_without_a_directory_names_one_like_the_command_line(
    scene, command, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "toss.toml").write_text(coinmc.Config(scene).resolved)
    result = coinmc.run("toss.toml")
    command("run", "toss.toml", "--quiet", cwd=tmp_path)
    assert [path.name for path in (tmp_path / "runs").iterdir()] == [result.path.name]


def test_a_point_short_of_its_target_is_reported(scene):
    stop = {"half_width": 0.001, "max_tosses": 2000}
    assert coinmc.estimate({**scene, "stop": stop}).status == "short"


def test_directories_of_other_runs_are_rejected(scene, command, tmp_path):
    with pytest.raises(coinmc.RunError, match="is not a run directory"):
        coinmc.open(tmp_path)
    coinmc.run(scene, tmp_path / "run")
    other = {**scene, "seed": 8}
    with pytest.raises(coinmc.RunError) as caught:
        coinmc.run(other, tmp_path / "run")
    (tmp_path / "other.toml").write_text(coinmc.Config(other).resolved)
    printed = command("run", tmp_path / "other.toml", "--out", tmp_path / "run", check=False)
    assert " ".join(str(caught.value).split()) in " ".join(printed.stderr.split())


def test_a_damaged_tally_is_reported_and_not_used(scene, tmp_path):
    coinmc.run(scene, tmp_path / "run")
    tally = tmp_path / "run" / "tallies.txt"
    tally.write_text(tally.read_text().replace("heads ", "heads 1"))
    with pytest.warns(RuntimeWarning, match="is rejected"):
        opened = coinmc.open(tmp_path / "run")
    assert opened.status == "interrupted"
    with pytest.warns(RuntimeWarning, match="is rejected"):
        again = coinmc.run(scene, tmp_path / "run")
    assert again.tosses == 3000


def test_the_fair_ratio_equals_that_of_the_command_line(command, examples, tmp_path):
    path = examples / "flat-fair.toml"
    arguments = ("--set", "stop.tosses=2000", "--format", "json", "--quiet")
    printed = command("run", path, "--out", tmp_path / "run", *arguments).stdout
    theirs = json.loads(printed)["fair_ratios"]
    ours = coinmc.open(tmp_path / "run").fair()
    assert len(ours) == len(theirs) > 0
    for fair, line in zip(ours, theirs, strict=True):
        assert (fair.value, fair.lo, fair.hi) == (line["ratio"], line["lo"], line["hi"])
        assert (fair.at, fair.rising) == (line["at"], line["rising"])


@pytest.mark.parametrize(
    ("engine", "preset", "interval"),
    [("volumetric", "hand", "student-t"), ("volumetric", "clean", "exact")],
)
def test_points_without_bounces_are_integrated_as_on_the_command_line(
    command, tmp_path, engine, preset, interval
):
    config = {
        "seed": 5,
        "coin": {"ratio": [0.7, 1.4]},
        "surface": {"landing": "adhesive"},
        "launch": {"preset": preset},
        "engine": {engine: {}},
        "stop": {"tosses": 20_000},
    }
    assert "none: points are integrated" in str(coinmc.check(config))
    path = tmp_path / "toss.toml"
    path.write_text(coinmc.Config(config).resolved)
    printed = command("run", path, "--out", tmp_path / "run", "--format", "json", "--quiet").stdout
    rows = json.loads(printed)["rows"]
    result = coinmc.estimate(config)
    assert result.tosses == 0
    assert set(result["interval"]) == {interval}
    for name in ("p_side", "p_side_lo", "p_side_hi", "p_heads", "evaluations", "sampling"):
        assert [row[name] for row in rows] == list(result[name])
    forced = coinmc.estimate(config, overrides={"sampling.method": "random"})
    assert forced.tosses == 40_000
    assert set(forced["sampling"]) == {"random"}
    # 4 standard errors of 20 000 tosses
    assert np.abs(forced["p_side"] - result["p_side"]).max() < 4 * np.sqrt(0.25 / 20_000)


def test_fair_for_other_faces_and_parameters(scene):
    config = {
        **scene,
        "surface": {"restitution": {"from": 0.0, "to": 0.9, "steps": 10}, "friction": 0.3},
    }
    result = coinmc.estimate(config, tosses=40_000)
    target = float(result["p_heads"][[3, 6]].mean())
    for along in ("restitution", "surface.restitution"):
        for crossing in result.fair(target, face="heads", along=along):
            assert 0.0 <= crossing.value <= 0.9
    assert result.fair(target, face="heads", along="restitution")
    with pytest.raises(ValueError, match="is not swept in this result; swept: restitution"):
        result.fair()
    with pytest.raises(ValueError, match="between 0 and 1"):
        result.fair(1.5, along="restitution")
    with pytest.raises(ValueError, match="heads, tails and side"):
        result.fair(face="edge", along="restitution")
