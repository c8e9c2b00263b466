"""Tosses from Python are the tosses of a run, to the last bit."""

import csv
import subprocess
import sys
import threading

import numpy as np
import pytest

import coinmc

# name of an example, and tosses that take about a second
SCENES = {"first": 20_000, "hand": 300, "table1": 200, "rapier": 4}
FACES = ("heads", "tails", "side")


@pytest.fixture(params=SCENES)
def example(request, examples):
    """An example with few tosses and few points."""
    config = coinmc.Config(examples / f"{request.param}.toml")
    overrides = {"stop": {"tosses": SCENES[request.param]}}
    if len(config) > 3:
        overrides["coin.ratio"] = [0.8, 1.2]
    return examples / f"{request.param}.toml", overrides


def test_an_estimate_has_exactly_the_counts_of_the_command_line(example, command, tmp_path):
    path, overrides = example
    result = coinmc.estimate(path, overrides=overrides)
    sets = [f"stop.tosses={overrides['stop']['tosses']}"]
    if "coin.ratio" in overrides:
        sets.append("coin.ratio=[0.8,1.2]")
    arguments = [word for text in sets for word in ("--set", text)]
    command("run", path, "--out", tmp_path / "run", "--quiet", *arguments)
    with (tmp_path / "run" / "results.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == list(result.columns)
    for name, column in result.columns.items():
        for cell, row in zip(column.tolist(), rows, strict=True):
            there = row[name]
            if isinstance(cell, bool):
                assert str(cell).lower() == there, name
            elif isinstance(cell, float):
                assert there == "" if np.isnan(cell) else float(there) == cell, name
            else:
                assert str(cell) == there, name


def test_tosses_add_up_to_the_estimate(example):
    path, overrides = example
    result = coinmc.estimate(path, overrides=overrides)
    for point in range(len(result)):
        tosses = coinmc.toss(path, point=point, overrides=overrides)
        for face in FACES:
            assert tosses.counts[face] == result[face][point]
            estimated = tosses.estimate()[face]
            for end, value in zip(("", "_lo", "_hi"), estimated, strict=False):
                assert value == pytest.approx(result[f"p_{face}{end}"][point], abs=1e-12)
        impacts = tosses.impacts.sum() / len(tosses)
        assert impacts == pytest.approx(result["impacts_per_toss"][point], rel=1e-12)


def test_tosses_do_not_depend_on_threads_or_on_the_first_toss(example):
    path, overrides = example
    n = overrides["stop"]["tosses"]
    whole = coinmc.toss(path, overrides=overrides)
    single = coinmc.toss(path, threads=1, overrides=overrides)
    later = coinmc.toss(path, n - n // 3, first=n // 3, overrides=overrides)
    for name in ("face", "ended", "impacts", "time_s", "final"):
        np.testing.assert_array_equal(getattr(whole, name), getattr(single, name))
        np.testing.assert_array_equal(getattr(whole, name)[n // 3 :], getattr(later, name))
    faces = coinmc.toss(path, overrides=overrides, faces_only=True)
    np.testing.assert_array_equal(faces, whole.face)


def test_drawn_launches_can_be_tossed_again(example):
    path, overrides = example
    tosses = coinmc.toss(path, overrides=overrides)
    launches = coinmc.launches(path, len(tosses), overrides=overrides)
    np.testing.assert_array_equal(launches, tosses.launches)
    again = coinmc.toss(path, launches=launches, overrides=overrides)
    assert again.launches is launches
    for name in ("face", "ended", "impacts", "time_s", "final"):
        np.testing.assert_array_equal(getattr(tosses, name), getattr(again, name))


def test_a_trace_ends_in_the_state_of_its_toss(example):
    path, overrides = example
    tosses = coinmc.toss(path, 4, overrides=overrides)
    for number in range(len(tosses)):
        trace = coinmc.trace(path, number, overrides=overrides, rate_hz=0)
        last = trace.events[-1]
        assert trace.face == tosses.face[number]
        assert trace.impacts == tosses.impacts[number]
        assert last["time_s"] == tosses.time_s[number]
        for name in coinmc.STATE.names:
            np.testing.assert_array_equal(last[name], tosses.final[name][number])


def test_the_horizontal_position_only_shifts_the_motion(scene):
    launches = coinmc.launches(scene, 100)
    plain = coinmc.toss(scene, launches=launches)
    moved = launches.copy()
    moved["position_m"][:, :2] += (3.0, -2.0)
    moved["axis"] *= 2.0  # and an axis is a direction
    tosses = coinmc.toss(scene, launches=moved)
    np.testing.assert_array_equal(tosses.face, plain.face)
    shift = tosses.final["position_m"] - plain.final["position_m"]
    np.testing.assert_allclose(shift, np.tile([3.0, -2.0, 0.0], (100, 1)), atol=1e-12)
    trace = coinmc.trace(scene, launch=moved[:1])
    assert trace.samples["position_m"][0].tolist()[:2] == [3.0, -2.0]


def test_other_layouts_of_launches_are_accepted(scene):
    launches = coinmc.launches(scene, 50)
    expected = coinmc.toss(scene, launches=launches, faces_only=True)
    names = list(reversed(coinmc.LAUNCH.names))
    swapped = np.empty(50, [(name, ">f8", 3) for name in names])
    for name in names:
        swapped[name] = launches[name]
    strided = np.repeat(launches, 2)[::2]
    frozen = launches.copy()
    frozen.flags.writeable = False
    for given in (swapped, strided, frozen, launches.view(np.recarray)):
        np.testing.assert_array_equal(coinmc.toss(scene, launches=given, faces_only=True), expected)
    assert len(coinmc.toss(scene, launches=launches[0])) == 1


def test_bad_launches_are_named(scene):
    launches = coinmc.launches(scene, 40_000)
    launches["axis"][39_000] = 0.0
    launches["axis"][30_001] = np.nan
    with pytest.raises(ValueError, match="launch 30001: its axis has no direction"):
        coinmc.toss(scene, launches=launches)
    launches = coinmc.launches(scene, 10)
    launches["velocity_m_s"][3, 1] = 0.1
    with pytest.raises(ValueError, match="launch 3: the flat engine needs"):
        coinmc.toss(scene, launches=launches)
    with pytest.raises(TypeError, match="structured array with the fields position_m"):
        coinmc.toss(scene, launches=np.zeros((3, 12)))
    with pytest.raises(ValueError, match="omit n"):
        coinmc.toss(scene, 3, launches=coinmc.launches(scene, 4))


def test_launches_with_nan_fail_and_are_counted(scene):
    launches = coinmc.launches(scene, 3)
    launches["velocity_m_s"][0, 2] = np.nan
    launches["position_m"][1, 2] = np.inf
    tosses = coinmc.toss(scene, launches=launches)
    assert tosses.ended[:2].tolist() == [coinmc.Ended.FAILED] * 2
    assert tosses.face[:2].tolist() == [coinmc.Face.UNDECIDED] * 2
    assert tosses.face[2] != coinmc.Face.UNDECIDED


def test_a_coin_that_leaves_the_table_is_an_end_of_its_own(examples):
    overrides = {"surface.table_radius_m": 0.1, "stop.tosses": 2000}
    tosses = coinmc.toss(examples / "hand.toml", overrides=overrides)
    left = tosses.face == coinmc.Face.LEFT
    assert 200 < left.sum() == tosses.counts["left"] < 2000
    assert np.array_equal(left, tosses.ended == coinmc.Ended.LEFT)
    # seen within a hundredth of the coin's radius in contact, and above the edge in flight
    where = np.hypot(*tosses.final["position_m"][:, :2].T)
    assert where[left].min() > 0.1 - 1e-12
    assert where[left].max() < 0.1 + 0.02 * 0.0117
    assert where[~left].max() < 0.1 + 1e-12
    result = coinmc.estimate(examples / "hand.toml", overrides=overrides)
    assert result["p_left"][0] == left.mean()


def test_a_closed_form_makes_no_toss(examples):
    with pytest.raises(ValueError, match="closed form, which makes no tosses"):
        coinmc.toss(examples / "closed-forms.toml", 10)
    with pytest.raises(ValueError, match="closed form, which makes no tosses"):
        coinmc.launches(examples / "closed-forms.toml", 10)
    with pytest.raises(ValueError, match="closed form, which makes no tosses"):
        coinmc.trace(examples / "closed-forms.toml")


def test_arguments_out_of_range_are_rejected(scene):
    with pytest.raises(IndexError, match="there is no point 5: this config has 1"):
        coinmc.toss(scene, 10, point=5)
    for arguments in ({"n": -1}, {"n": 2**63}, {"n": 1, "first": 10**15}, {"threads": 0}):
        with pytest.raises(ValueError, match=r"must be from 0 to|numbered below|threads"):
            coinmc.toss(scene, **arguments)
    for arguments in ({"n": "7"}, {"n": 1.5}, {"first": None}, {"threads": "two"}):
        with pytest.raises(TypeError, match="whole number"):
            coinmc.toss(scene, **arguments)
    assert len(coinmc.toss(scene, 1e2)) == 100
    assert len(coinmc.toss(scene, 0)) == 0
    stops = {"stop": {"half_width": 0.01, "max_tosses": 1000}}
    with pytest.raises(ValueError, match="give the number of tosses"):
        coinmc.toss(scene, overrides=stops)


def test_other_threads_keep_running(scene):
    """The interpreter's lock is free: a Python thread counts while tosses are made."""
    counted, stop = [0], threading.Event()

    def count():
        while not stop.is_set():
            counted[0] += 1

    counter = threading.Thread(target=count)
    counter.start()
    before = counted[0]
    coinmc.toss(scene, 300_000, faces_only=True, threads=1)
    counted_meanwhile = counted[0] - before
    stop.set()
    counter.join()
    # a held lock would let it count a few thousand times at the switch interval
    assert counted_meanwhile > 100_000


def test_progress_is_reported(scene):
    told = []
    coinmc.toss(scene, 400_000, progress=lambda done, planned: told.append((done, planned)))
    assert told
    assert all(planned in (0, 400_000) for _, planned in told)
    assert [done for done, _ in told] == sorted(done for done, _ in told)
    told.clear()
    coinmc.estimate(scene, tosses=400_000, progress=lambda *now: told.append(now))
    assert told[-1] == (400_000, 400_000)


def test_an_exception_in_progress_stops_the_work(scene):
    def raising(done, planned):
        raise LookupError(f"{done} of {planned}")

    for work in (
        lambda: coinmc.toss(scene, 100_000_000, faces_only=True, progress=raising),
        lambda: coinmc.estimate(scene, tosses=100_000_000, progress=raising),
        lambda: coinmc.sensitivity(scene, ["coin.ratio"], tosses=100_000_000, progress=raising),
    ):
        with pytest.raises(LookupError, match="of"):
            work()


def test_a_bar_is_shown_if_tqdm_is_installed(scene, capsys, monkeypatch):
    coinmc.toss(scene, 300_000, faces_only=True, progress=True)
    assert "toss" in capsys.readouterr().err
    coinmc.toss(scene, 300_000, faces_only=True, progress=False)
    assert not capsys.readouterr().err
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    with pytest.raises(ImportError, match="pip install"):
        coinmc.toss(scene, 10, progress=True)
    coinmc.toss(scene, 10)


@pytest.mark.parametrize("close", ["sys.stderr.close()", "sys.stderr = None", "os.close(2)"])
def test_a_closed_standard_error_stops_nothing(close):
    program = f"""
import os, sys
{close}
import coinmc
scene = {{"coin": {{"ratio": 1}}, "surface": {{"restitution": 0.5, "friction": 0.3}},
         "launch": {{"preset": "robot"}}, "engine": {{"flat": {{}}}}}}
print(coinmc.estimate(scene, tosses=1000, progress=True).tosses)
print(coinmc.toss(scene, 10).counts["undecided"])
"""
    done = subprocess.run(
        [sys.executable, "-c", program], check=True, capture_output=True, text=True
    )
    assert done.stdout.split() == ["1000", "0"]
