"""Configs from files, dicts and texts mean the same; messages are the command line's."""

import pickle
import tomllib

import numpy as np
import pytest

import coinmc


def test_every_example_means_the_same_as_file_text_and_dict(examples):
    for path in sorted(examples.glob("*.toml")):
        config = coinmc.Config(path)
        text = path.read_text()
        assert coinmc.Config.from_toml(text).hash == config.hash, path
        assert coinmc.Config(tomllib.loads(text)).hash == config.hash, path
        assert coinmc.Config.from_toml(config.resolved).hash == config.hash, path
        assert coinmc.Config(config).hash == config.hash
        assert pickle.loads(pickle.dumps(config)) == config


def test_the_plan_equals_that_of_the_command_line(examples, command):
    import json

    for path in sorted(examples.glob("f*.toml")):
        theirs = json.loads(command("check", path, "--format", "json").stdout)
        ours = coinmc.check(path)
        assert theirs["plan_hash"] == ours.hash
        assert theirs["axes"] == ours.axes
        assert theirs["points"] == len(ours)
        assert theirs["tosses_at_most"] == ours.tosses_planned
        assert theirs["notes"] == ours.notes
        assert theirs["resolved_config"] == ours.resolved
        assert theirs["groups"] == [group._asdict() for group in ours.groups]
        assert ours.hash[:8] in str(ours)


def test_overrides_act_as_on_the_command_line(examples):
    path = examples / "first.toml"
    dotted = {"coin.ratio": 1.25, "surface": {"restitution": 0.4, "friction": np.float32(0.5)}}
    config = coinmc.Config(path, dotted)
    assert config.parameters()["ratio"] == 1.25
    assert config.parameters()["restitution"] == 0.4
    assert config.parameters()["friction"] == 0.5
    twice = coinmc.Config(coinmc.Config(path, {"coin.ratio": 3}), {"seed": 5})
    assert (twice.parameters()["ratio"], twice.seed) == (3.0, 5)
    sweep = coinmc.Config(path, {"coin.ratio": np.linspace(1, 2, 5)})
    assert [sweep.parameters(i)["ratio"] for i in range(5)] == [1.0, 1.25, 1.5, 1.75, 2.0]


def test_messages_equal_those_of_the_command_line(command, tmp_path):
    bad = tmp_path / "bad.toml"
    bad.write_text('[coin]\nratoi = 1\n[surface]\nrestitution = 1.5\nfriction = "much"\n')
    printed = command("check", bad, check=False).stderr
    with pytest.raises(coinmc.ConfigError) as caught:
        coinmc.check(bad)
    assert str(caught.value) in printed
    assert "^^^^^" in str(caught.value)
    problem = caught.value.problems[0]
    assert (problem.line, problem.column) == (2, 1)
    assert problem.help == "did you mean `ratio`?"
    assert isinstance(caught.value, ValueError)
    assert isinstance(caught.value, coinmc.Error)
    copied = pickle.loads(pickle.dumps(caught.value))
    assert (str(copied), copied.problems) == (str(caught.value), caught.value.problems)


def test_a_string_is_always_a_path():
    with pytest.raises(coinmc.ConfigError, match="there is no such file"):
        coinmc.check("coin.ratio = 1\nengine.analytic.rule = 'arc'")


@pytest.mark.parametrize(
    ("config", "raised", "message"),
    [
        (None, TypeError, "a config must be a path, a dict or a coinmc.Config"),
        (7, TypeError, "not int"),
        (b"first.toml", TypeError, "not bytes"),
        ({1: {}}, TypeError, "config keys must be strings"),
        ({"coin": {"ratio": None}}, TypeError, "not NoneType"),
        ({"coin": {"ratio": 1j}}, TypeError, "not complex"),
        ({"coin": {"ratio": 10**400}}, coinmc.ConfigError, "64 bits"),
        ({"coin": {"ratio": float("nan")}}, coinmc.ConfigError, "nan"),
        ({'a"b\n\x00': 1}, coinmc.ConfigError, "unknown key"),
        ({}, coinmc.ConfigError, "`engine` is missing"),
    ],
)
def test_invalid_configs_are_rejected(config, raised, message):
    with pytest.raises(raised, match=message):
        coinmc.check(config)


def test_a_dict_that_contains_itself_is_rejected():
    config = {"coin": {"ratio": 1}}
    config["coin"]["coin"] = config["coin"]
    with pytest.raises(coinmc.ConfigError, match="nest"):
        coinmc.check(config)


def test_overrides_cannot_inject_toml():
    rule = {"coin": {"ratio": 1}, "engine": {"analytic": {"rule": "arc"}}}
    for overrides in ({"seed=1\n[coin]": 2}, {"": 1}, {"a.": 1}, {"seed": "x\ny"}):
        with pytest.raises(coinmc.ConfigError):
            coinmc.check(rule, overrides)
    with pytest.raises(TypeError, match="overrides must be a dict"):
        coinmc.check(rule, ["seed=1"])
    quoted = coinmc.check(rule, {"engine": {"analytic": {"rule": "zone"}}})
    assert "zone" in quoted.groups[0].computed


def test_targets_of_a_stop_are_told(scene):
    targets = {"relative_error": 0.1, "events": 50, "max_tosses": 2_000_000}
    config = coinmc.check({**scene, "stop": targets})
    assert config.stop == coinmc.Stop(2_000_000, None, 0.1, 50)
    limits = {"total_tosses": 10_000, "max_core_seconds": 5.0, "total_core_seconds": 9.0}
    limited = coinmc.check({**scene, "stop": {**targets, **limits}})
    assert limited.stop == coinmc.Stop(2_000_000, None, 0.1, 50, 10_000, 5.0, 9.0)
    assert limited.tosses_planned == 10_000
    assert "±10 % of its probability and every face was seen 50 times" in str(config)
    result = coinmc.estimate(config)
    assert (result["p_side_hi"] - result["p_side"] <= 0.1 * result["p_side"]).all()
    assert (result["side"] >= 50).all()
    with pytest.raises(coinmc.ConfigError, match="only one of `tosses`, `events`"):
        coinmc.check({**scene, "stop": {"tosses": 5, "events": 1}})


@pytest.mark.parametrize("seed", [0, 2**63 - 1, 2**63, 2**64 - 1])
def test_any_seed_of_64_bits(scene, seed, tmp_path):
    config = coinmc.Config({**scene, "seed": seed})
    assert config.seed == seed
    assert coinmc.Config.from_toml(config.resolved) == config
    result = coinmc.run(config, tmp_path / "run", overrides={"stop.tosses": 100})
    assert coinmc.open(tmp_path / "run").config.seed == seed
    assert result.tosses == 100
    with pytest.raises(coinmc.ConfigError, match="64 bits"):
        coinmc.Config({**scene, "seed": 2**64})
