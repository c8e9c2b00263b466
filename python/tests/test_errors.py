"""Errors say what to do."""

import copy
import pickle

import pytest

import coinmc


def test_errors_advise_what_helps(scene, tmp_path, monkeypatch):
    """Each error with a part of its advice."""
    monkeypatch.chdir(tmp_path)
    coinmc.run(scene, "done")
    launch = {"position_m": [0, 0, 1.0], "velocity_m_s": [0, 0, 0], "axis": [0, 0, 1.0]}
    still = {**launch, "spin_rad_s": [0, 0, 0]}
    loose = {**scene, "surface": {"restitution": 0.0, "friction": 0.3}}
    for advice, call in [
        # what is to be read is not to be filled
        (r"no such directory\. Name the directory of `coinmc run`", lambda: coinmc.open("no")),
        (r"it holds no manifest\.json\. Name the dir", lambda: coinmc.open(tmp_path)),
        (r"no such directory\. Name the directory", lambda: coinmc.merge(["no"], "whole")),
        (r"Choose a new or empty directory", lambda: coinmc.run(scene, tmp_path)),
        (r"the config of this run is done/config\.toml", lambda: coinmc.check("done")),
        (r"seed 7 -> 8", lambda: coinmc.run(scene, "done", overrides={"seed": 8})),
        (r"did you mean 'p_side'", lambda: coinmc.estimate(scene)["p_sied"]),
        (r"this lacks spin_rad_s", lambda: coinmc.toss(scene, launches=launch)),
        (r"this has speed", lambda: coinmc.toss(scene, launches={**still, "speed": 1})),
        (r"is 1 launch: omit n", lambda: coinmc.toss(scene, 5, launches=still)),
        (
            r"launch 0: it lies below the surface",
            lambda: coinmc.toss(scene, launches={**still, "position_m": [0, 0, -1]}),
        ),
        (r"from 1 to 1024, not -3", lambda: coinmc.estimate(scene, threads=-3)),
        (r"from 0 to 2\^63 - 1, not -5", lambda: coinmc.toss(scene, -5)),
        (
            r"surface\.restitution is 0, which no factor",
            lambda: coinmc.sensitivity(loose, ["surface.restitution"]),
        ),
    ]:
        with pytest.raises((coinmc.Error, ValueError, TypeError, KeyError), match=advice):
            call()


def test_arguments_are_named_where_a_table_is_missing(scene):
    bare = {name: scene[name] for name in ("coin", "surface", "engine")}
    for call, notes in [
        (lambda: coinmc.toss(bare), ["n, which", "launches, which"]),
        (lambda: coinmc.estimate(bare), ["tosses, which"]),
        (lambda: coinmc.check("coin.ratio = 1"), ["Config.from_toml(text)"]),
    ]:
        with pytest.raises(coinmc.ConfigError) as raised:
            call()
        told = "\n".join(raised.value.__notes__)
        assert all(note in told for note in notes), told


def test_copies_of_errors_have_problems_and_notes(scene):
    with pytest.raises(coinmc.ConfigError) as raised:
        coinmc.toss({name: scene[name] for name in ("coin", "surface", "engine")})
    error = raised.value
    for again in (pickle.loads(pickle.dumps(error)), copy.copy(error)):
        assert type(again) is coinmc.ConfigError
        assert (str(again), again.problems) == (str(error), error.problems)
        assert again.__notes__ == error.__notes__ != []
