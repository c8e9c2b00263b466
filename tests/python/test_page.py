"""The page to play with: its WebAssembly module counts what the program counts."""

import csv
import json
import shutil
import subprocess
from pathlib import Path

import pytest

FLAT = """
seed = 5
coin.ratio = 1.2
surface = { restitution = 0.5, friction = 0.3 }
launch.preset = "robot"
engine.flat = {}
stop.tosses = 20_000
"""
SPACE = """
coin.ratio = 0.85
surface = { restitution = 0.5, friction = 0.3, rolling_friction_m = 1e-4 }
launch.preset = "clean"
engine.volumetric = {}
stop.tosses = 1_500
"""
HAND = """
coin = { ratio = 0.6, radius_m = 0.0116 }
surface.material = "wood"
launch.preset = "hand"
engine.volumetric.law = "stronge"
stop.tosses = 200
"""


@pytest.fixture(scope="module")
def page(root, binary) -> Path:
    """The folder that `scripts/web-page` made."""
    if shutil.which("node") is None:
        pytest.skip("node is not installed")
    folder = binary.parents[1] / "web-page"
    if not (folder / "coinmc.wasm").exists():
        pytest.skip("the page is not built: scripts/web-page builds it")
    built = asked(folder, root, [{"ask": "about"}])[0]["build"]
    version = subprocess.run([binary, "--version"], check=True, capture_output=True, text=True)
    if built not in version.stdout:
        pytest.skip(
            f"the page was built of other sources ({built}): scripts/web-page builds it anew"
        )
    return folder


def asked(folder: Path, root: Path, questions: list) -> list:
    command = ["node", root / "tests/page/ask.mjs", folder]
    text = json.dumps(questions)
    done = subprocess.run(command, input=text, check=True, stdout=subprocess.PIPE, text=True)
    return json.loads(done.stdout)


@pytest.mark.parametrize("config", [FLAT, SPACE, HAND], ids=["flat", "space", "hand"])
def test_the_page_counts_what_the_program_counts(page, root, coinmc, tmp_path, config):
    (tmp_path / "toss.toml").write_text(config)
    coinmc("run", "toss.toml", "--out", "run", "--quiet", cwd=tmp_path)
    with (tmp_path / "run/results.csv").open(newline="") as file:
        (row,) = csv.DictReader(file)
    tosses = int(row["tosses"])
    questions = [{"count": config, "tosses": tosses, "workers": workers} for workers in (1, 3)]
    for told in asked(page, root, questions):
        assert told["last"]["done"]
        assert told["last"]["tosses"] == tosses
        tally = told["last"]["tally"]
        # every count that the results have: faces, reasons, events
        shared = tally.keys() & row.keys()
        assert {"heads", "tails", "side", "failed", "jams"} <= shared
        assert {name: tally[name] for name in shared} == {name: int(row[name]) for name in shared}
        # what is shown first is the tosses from the first on, without a gap
        early = told["early"]
        first = {"ask": "toss", "config": config, "from": 0, "to": early["tosses"]}
        assert asked(page, root, [first])[0]["tally"] == early["tally"]
    estimate = {"ask": "estimate", "config": config, "tally": tally}
    (told,) = asked(page, root, [estimate])
    for face, numbers in told["faces"].items():
        for end, column in (("p", f"p_{face}"), ("lo", f"p_{face}_lo"), ("hi", f"p_{face}_hi")):
            assert float(row[column]) == numbers[end]


def test_every_choice_of_the_form_is_a_config(page, root):
    (configs,) = asked(page, root, [{"choices": True}])
    assert len(configs) > 100
    checks = asked(page, root, [{"ask": "check", "config": config} for config in configs])
    assert [check["problems"] for check in checks if "problems" in check] == []


def test_the_page_asks_nothing_of_the_network(root):
    """All that it loads lies beside it."""
    for path in (root / "page/site").iterdir():
        text = path.read_text().replace("http://www.w3.org/2000/svg", "")
        assert "https://" not in text, path.name
        assert "http://" not in text, path.name
