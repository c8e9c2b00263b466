"""Launches of one's own: as arrays, as dicts, without a launch in the config."""

import numpy as np
import pytest

import coinmc


@pytest.fixture
def bare(scene):
    """A config that says nothing of launches and of their number."""
    return {key: value for key, value in scene.items() if key not in ("launch", "stop")}


def test_a_dict_of_arrays_is_an_array_of_launches(scene, bare, tmp_path):
    drawn = coinmc.launches(scene, 300)
    given = {name: drawn[name] for name in coinmc.LAUNCH.names}
    expected = coinmc.toss(scene, 300).face
    assert coinmc.toss(bare, launches=given).face.tolist() == expected.tolist()
    assert coinmc.toss(bare, launches=drawn, faces_only=True).tolist() == expected.tolist()
    (tmp_path / "bare.toml").write_text(
        "\n".join(line for line in coinmc.Config(scene).resolved.split("[stop]")[0].splitlines())
    )
    assert coinmc.toss(tmp_path / "bare.toml", 300).face.tolist() == expected.tolist()


def test_one_vector_stands_for_all(bare):
    upright = {
        "position_m": [0.0, 0.0, 0.3],
        "velocity_m_s": [0.0, 0.0, 0.0],
        "axis": [0.0, 0.0, 1.0],
        "spin_rad_s": np.stack([np.zeros(9), np.linspace(0, 40, 9), np.zeros(9)], axis=1),
    }
    tosses = coinmc.toss(bare, launches=upright)
    assert len(tosses) == 9
    assert (tosses.launches["position_m"][:, 2] == 0.3).all()
    assert tosses.launches["spin_rad_s"][8, 1] == 40.0
    trace = coinmc.trace(bare, launch={**upright, "spin_rad_s": [0.0, 5.0, 0.0]})
    assert trace.samples["position_m"][0, 2] == 0.3


def test_what_is_missing_or_does_not_fit_is_named(bare):
    whole = {name: [[0.0, 0.0, 1.0]] * 2 for name in coinmc.LAUNCH.names}
    with pytest.raises(TypeError, match="this lacks position_m, velocity_m_s, spin_rad_s"):
        coinmc.toss(bare, launches={"axis": [0, 0, 1]})
    with pytest.raises(ValueError, match="equally long, not 2 of position_m, 3 of velocity_m_s"):
        coinmc.toss(bare, launches={**whole, "velocity_m_s": np.zeros((3, 3))})
    with pytest.raises(TypeError, match=r"axis must be an array .* shape \(n, 3\)"):
        coinmc.toss(bare, launches={**whole, "axis": [0.0, 1.0]})
    # without launches they are still asked for
    with pytest.raises(coinmc.ConfigError, match="launch"):
        coinmc.toss(bare, 10)


def test_the_environment_says_how_many_threads(scene, monkeypatch):
    expected = coinmc.toss(scene, 200).face
    monkeypatch.setenv("COINMC_THREADS", "1")
    assert coinmc.toss(scene, 200).face.tolist() == expected.tolist()
    drawn = [coinmc.launches(scene, 5, threads=threads) for threads in (None, 1, 2)]
    assert len({launches.tobytes() for launches in drawn}) == 1
    for wrong in ("0", "many", "-1", "2000"):
        monkeypatch.setenv("COINMC_THREADS", wrong)
        with pytest.raises(ValueError, match="COINMC_THREADS must be from 1 to 1024"):
            coinmc.estimate(scene)
    assert coinmc.toss(scene, 200, threads=2).face.tolist() == expected.tolist()


def test_times_and_final_states_are_those_of_traces(scene):
    """They are computed on first use, and belong to the same tosses."""
    tosses = coinmc.toss(scene, 40, first=5)
    for k in (0, 17, 39):
        trace = coinmc.trace(scene, 5 + k)
        assert tosses.time_s[k] == trace.duration_s
        assert (tosses.final["position_m"][k] == trace.events["position_m"][-1]).all()
        assert tosses.impacts[k] == trace.impacts


@pytest.mark.parametrize("engine", ["flat", "volumetric", "rapier"])
def test_launches_that_are_not_finite_fail_and_stay_where_they_are(bare, engine):
    scene = {**bare, "engine": {engine: {}}}
    drawn = coinmc.launches({**scene, "launch": {"preset": "robot"}}, 1)
    for name in ("position_m", "velocity_m_s", "spin_rad_s"):
        for component in range(3):
            for value in (np.nan, np.inf, -np.inf):
                launches = drawn.copy()
                launches[name][:, component] = value
                tosses = coinmc.toss(scene, launches=launches)
                assert tosses.ended.tolist() == [coinmc.Ended.FAILED]
                assert coinmc.toss(scene, launches=launches, faces_only=True) == [
                    coinmc.Face.UNDECIDED
                ]
                trace = coinmc.trace(scene, launch=launches[0])
                assert trace.outcome == "failed"
                for field in ("position_m", "velocity_m_s", "spin_rad_s"):
                    np.testing.assert_array_equal(tosses.final[field], launches[field])
                    np.testing.assert_array_equal(trace.samples[field][-1], launches[field][0])


@pytest.mark.parametrize("table", [{"table_radius_m": 0.2}, {"table_tilt_deg": 5}])
def test_coins_are_launched_above_the_middle_of_a_table_that_has_one(bare, table):
    endless = {**bare, "engine": {"volumetric": {}}}
    scene = {**endless, "surface": {**bare["surface"], **table}}
    launches = coinmc.launches({**scene, "launch": {"preset": "robot"}}, 4)
    assert len(coinmc.toss(scene, launches=launches)) == 4
    for component in (0, 1):
        aside = launches.copy()
        aside["position_m"][2:, component] = 0.1
        with pytest.raises(ValueError, match="launch 2: x and y must be 0"):
            coinmc.toss(scene, launches=aside)
        with pytest.raises(ValueError, match="launch: x and y must be 0"):
            coinmc.trace(scene, launch=aside[2])
        tosses = coinmc.toss(endless, launches=aside)
        middle = coinmc.toss(endless, launches=launches).final["position_m"]
        assert (tosses.final["position_m"] == middle + aside["position_m"] * [1, 1, 0]).all()


def test_final_states_are_in_the_laboratory_on_a_tilted_table(bare):
    surface = {**bare["surface"], "table_tilt_deg": 5, "table_downhill_deg": 30}
    scene = {**bare, "surface": surface, "engine": {"volumetric": {}}}
    tosses = coinmc.toss({**scene, "launch": {"preset": "robot"}}, 60)
    tilt, ahead = np.radians([5, 30])
    downhill = np.array([np.cos(ahead), np.sin(ahead), 0])
    up = np.sin(tilt) * downhill + [0, 0, np.cos(tilt)]
    heads = tosses.face == coinmc.Face.HEADS
    assert heads.sum() > 9
    # these coins lie almost flat on the table, 5 degrees off the vertical
    lie = np.degrees(np.arccos(tosses.final["axis"][heads] @ up))
    lean = np.degrees(np.arccos(tosses.final["axis"][heads][:, 2]))
    assert np.median(lie) < 1 < 4 < np.median(lean)
    # lengths and heights over the table are those of the trace, which is in axes of the table
    for k in (0, 17):
        end = coinmc.trace({**scene, "launch": {"preset": "robot"}}, k).events[-1]
        final = tosses.final[k]
        for name in coinmc.STATE.names:
            assert final[name] @ up == pytest.approx(end[name][2], abs=1e-12)
            assert np.linalg.norm(final[name]) == pytest.approx(np.linalg.norm(end[name]))
        across = [-np.sin(ahead), np.cos(ahead), 0]
        assert final["axis"] @ across == pytest.approx(end["axis"] @ across, abs=1e-12)


def test_an_axis_of_any_length_will_do(bare):
    launch = {
        "position_m": [0.0, 0.0, 0.3],
        "velocity_m_s": [0.0, 0.0, 0.0],
        "axis": [0.6, 0.0, 0.8],
        "spin_rad_s": [0.0, 40.0, 0.0],
    }
    axis = np.array(launch["axis"])
    final = coinmc.toss(bare, launches=launch).final
    for length in (5e-323, 1e-300, 1e-160, 2.0, 1e160, 1e300, 1.7e308):
        long = {**launch, "axis": axis * length}
        if length > 1e-310:
            np.testing.assert_allclose(
                coinmc.toss(bare, launches=long).final["position_m"], final["position_m"], atol=1e-9
            )
        leaning = {**launch, "axis": np.array([0.0, 0.6, 0.8]) * length}
        with pytest.raises(ValueError, match="flat engine needs"):
            coinmc.toss(bare, launches=leaning)
    for none in ([0, 0, 0], [0, np.nan, 1], [np.inf, 0, 0]):
        with pytest.raises(ValueError, match="its axis has no direction"):
            coinmc.toss(bare, launches={**launch, "axis": none})
