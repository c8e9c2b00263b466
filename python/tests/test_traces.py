"""Traces show what the engine did."""

import csv

import numpy as np
import pytest

import coinmc


@pytest.mark.parametrize("example", ["first", "hand"])
def test_a_trace_equals_that_of_the_command_line(example, examples, command, tmp_path):
    path = examples / f"{example}.toml"
    trace = coinmc.trace(path, 3, rate_hz=100)
    command("trace", path, "--toss", 3, "--rate", 100, "--out", tmp_path / "toss.csv", "--quiet")
    with (tmp_path / "toss.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    for records, kinds in ((trace.samples, ("sample", "launched", "ended")), (trace.events, None)):
        theirs = [
            row for row in rows if (row["kind"] in kinds if kinds else row["kind"] != "sample")
        ]
        assert len(theirs) == len(records)
        columns = {
            "time_s": records["time_s"],
            "x_m": records["position_m"][:, 0],
            "z_m": records["position_m"][:, 2],
            "vz_m_s": records["velocity_m_s"][:, 2],
            "ux": records["axis"][:, 0],
            "qw": records["quaternion"][:, 0],
            "qz": records["quaternion"][:, 3],
            "wy_rad_s": records["spin_rad_s"][:, 1],
            "energy_j_kg": records["energy_j_kg"],
        }
        for name, column in columns.items():
            assert [float(row[name]) for row in theirs] == column.tolist(), name
        assert [row["mode"] for row in theirs] == records["mode"].tolist()
        if kinds is None:
            assert [row["kind"] for row in theirs] == records["kind"].tolist()
    assert {row["outcome"] for row in rows} == {trace.outcome}


def test_energy_never_increases_and_axes_have_unit_length(examples):
    # on a plane: over rough ground the engine balances the energy from node to node
    trace = coinmc.trace(examples / "clean.toml", 5, rate_hz=1000)
    energy = trace.samples["energy_j_kg"]
    assert (np.diff(energy) <= 1e-9 * energy[0]).all()
    norms = np.linalg.norm(trace.samples["axis"], axis=1)
    np.testing.assert_allclose(norms, 1.0, atol=1e-9)
    w, x, y, z = trace.samples["quaternion"].T
    up = np.stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)], axis=1)
    np.testing.assert_allclose(up, trace.samples["axis"], atol=1e-7)


def test_samples_are_at_whole_multiples_between_the_ends(scene):
    trace = coinmc.trace(scene, 1, rate_hz=50)
    times = trace.samples["time_s"]
    assert times[0] == 0.0
    np.testing.assert_array_equal(times[1:-1], np.arange(1, len(times) - 1) / 50)
    assert times[-1] == trace.duration_s == trace.events["time_s"][-1]
    assert trace.complete
    assert trace.scene["radius_m"] == coinmc.Config(scene).scene().radius_m
    assert len(coinmc.trace(scene, 1, rate_hz=0)) == 2
    assert coinmc.trace(scene, 1, rate_hz=None).rate_hz > 50


def test_a_given_launch_is_traced(scene):
    launch = coinmc.launches(scene, 1, first=17)
    own, drawn = coinmc.trace(scene, launch=launch), coinmc.trace(scene, 17)
    np.testing.assert_array_equal(own.samples, drawn.samples)
    assert (own.toss, drawn.toss) == (None, 17)


def test_tosses_that_cannot_be_traced_are_reported(scene, command, tmp_path):
    with pytest.raises(coinmc.TraceError, match="3000") as caught:
        coinmc.trace(scene, 3000)
    (tmp_path / "toss.toml").write_text(coinmc.Config(scene).resolved)
    printed = command("trace", tmp_path / "toss.toml", "--toss", 3000, check=False).stderr
    assert " ".join(str(caught.value).split()) in " ".join(printed.split())
    with pytest.raises(coinmc.TraceError, match="rate"):
        coinmc.trace(scene, rate_hz=-1.0)
    with pytest.raises(coinmc.TraceError, match="rate"):
        coinmc.trace(scene, rate_hz=float("nan"))
    with pytest.raises(ValueError, match="exactly one launch"):
        coinmc.trace(scene, launch=coinmc.launches(scene, 2))


def test_a_trace_is_saved_as_on_the_command_line(examples, command, tmp_path):
    """Every format but the recording, whose bytes hold no more, byte for byte."""
    path = examples / "first.toml"
    trace = coinmc.trace(path, 3, rate_hz=100)
    for ending in ("mcap", "csv", "parquet", "jsonl", "svg"):
        ours, theirs = (tmp_path / f"{who}.{ending}" for who in ("ours", "theirs"))
        trace.save(ours)
        command("trace", path, "--toss", 3, "--rate", 100, "--out", theirs, "--quiet")
        assert ours.read_bytes() == theirs.read_bytes(), ending
    ours, theirs = (tmp_path / f"{who}-in-json.mcap" for who in ("ours", "theirs"))
    trace.save(ours, encoding="json")
    more = ("--encoding", "json", "--out", theirs, "--quiet")
    command("trace", path, "--toss", 3, "--rate", 100, *more)
    assert ours.read_bytes() == theirs.read_bytes() != (tmp_path / "ours.mcap").read_bytes()
    with pytest.raises(ValueError, match="encoding is `protobuf` or `json`"):
        trace.save(tmp_path / "other.mcap", encoding="xml")
    assert not (tmp_path / "other.mcap").exists()
    with pytest.raises(FileExistsError, match="exists already"):
        trace.save(tmp_path / "ours.csv")
    with pytest.raises(ValueError, match=r"use \.mcap"):
        trace.save(tmp_path / "ours.png")
    with pytest.raises(OSError, match="nowhere"):
        trace.save(tmp_path / "nowhere" / "ours.csv")


def test_a_launch_of_ones_own_is_saved_as_it_was_recorded(scene, tmp_path):
    launches = coinmc.launches(scene, 3)
    launches["position_m"][2, :2] += (1.5, -0.25)
    trace = coinmc.trace(scene, launch=launches[2:], rate_hz=50)
    trace.save(tmp_path / "own.csv")
    with (tmp_path / "own.csv").open(newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["kind"] in ("sample", "launched")]
    times = trace.samples["time_s"][:-1]
    assert [float(row["time_s"]) for row in rows] == times.tolist()
    drawn = coinmc.trace(scene, 2, rate_hz=50)
    for axis, name in enumerate(("x_m", "y_m")):
        at = trace.samples["position_m"][:-1, axis]
        assert [float(row[name]) for row in rows] == at.tolist()
        shift = at - drawn.samples["position_m"][:-1, axis]
        assert shift == pytest.approx((1.5, -0.25)[axis], abs=1e-12)
    assert [float(row["z_m"]) for row in rows] == drawn.samples["position_m"][:-1, 2].tolist()
