"""Coins in sound recordings."""

import json
import subprocess
import sys

import pytest

import coinmc
from coinmc._toml import document

#: A coin that is let go almost level, and one that is spun upright.
DROPPED = {
    "coin": {"ratio": 0.16, "radius_m": 0.0116},
    "surface": {"restitution": 0.55, "friction": 0.3},
    "launch": {
        "height_m": 0.15,
        "orientation": {"tilt_deg": {"normal": {"mean": 0.0, "sd": 10.0}}},
        "spin": {"isotropic_sd_rad_s": 1.0},
    },
    "engine": {"volumetric": {}},
    "prior": {"material": "wood"},
}


def coinmc_program(*arguments):
    command = [sys.executable, "-m", "coinmc", *arguments]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("recordings")


@pytest.fixture(scope="module")
def config(folder):
    path = folder / "dropped.toml"
    path.write_text(document({**DROPPED, "stop": {"tosses": 1}}))
    return path


@pytest.fixture(scope="module")
def drop(folder, config):
    path = folder / "drop.wav"
    coinmc_program(
        "listen", "--synthetic", path, "--config", config, "--noise-db", "20", "--toss", "1"
    )
    return path


def test_a_drop_is_heard_as_the_program_hears_it(drop, config):
    heard = coinmc.listen(drop, config, surfaces=2000, seed=3)
    said = coinmc_program(
        *("listen", drop, "--config", config, "--surfaces", "2000", "--seed", "3"),
        *("--format", "json", "--quiet"),
    )
    assert heard.document == json.loads(said)
    assert heard.recordings[0]["taken_for"] == "drop"
    low, high = heard.parameters["restitution"]["interval"]
    assert low < 0.55 < high
    assert high - low < 0.2  # the prior's is .3
    assert heard.rolling_friction_m is None
    assert "bounces" in repr(heard)
    assert drop.name in heard._repr_html_()
    assert heard.config.startswith("[prior]")


def test_a_dict_is_a_config_too(drop, config):
    of_file = coinmc.listen(drop, config, surfaces=500)
    of_dict = coinmc.listen([drop], DROPPED, surfaces=500)
    assert of_dict.parameters == of_file.parameters


def test_without_a_config_times_are_told(drop):
    heard = coinmc.listen(drop)
    assert heard.parameters == {}
    assert heard.recordings[0]["bounces_s"][0] == 0.0
    assert "[[bounces]]" in heard.config


def test_whatever_is_wrong_is_said_of_every_file(folder, drop, config):
    text = folder / "text.wav"
    text.write_text("no sound")
    with pytest.raises(ValueError, match=r"text\.wav.*\n.*none\.wav"):
        coinmc.listen([text, drop, folder / "none.wav"])
    with pytest.raises(ValueError, match="no recordings"):
        coinmc.listen([])
    with pytest.raises(ValueError, match='"drop", "spin"'):
        coinmc.listen(drop, of="bell")
    with pytest.raises(coinmc.ConfigError, match="restitution"):
        coinmc.listen(drop, config, overrides={"surface.restitution": 2})
    with pytest.raises(ValueError, match="give one"):
        coinmc.listen(drop, overrides={"surface.restitution": 0.5})
