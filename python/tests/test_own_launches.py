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
