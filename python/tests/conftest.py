"""Where things are. All tests are of the installed wheel, never of the source tree."""

import json
import os
import subprocess
from pathlib import Path

import pytest

import coinmc

ROOT = Path(__file__).resolve().parents[2]


def pytest_sessionstart(session):
    """Refuse to test anything but an installed wheel."""
    installed = Path(coinmc.__file__).resolve()
    if installed.is_relative_to(ROOT / "python"):
        pytest.exit(f"{installed} is the source tree: install the wheel (scripts/wheel)", 2)


@pytest.fixture(scope="session")
def root() -> Path:
    """The repository."""
    return ROOT


@pytest.fixture(scope="session")
def examples() -> Path:
    """Configs that everyone knows."""
    return ROOT / "examples"


@pytest.fixture(scope="session")
def package() -> Path:
    """The installed package."""
    return Path(coinmc.__file__).parent


@pytest.fixture(scope="session")
def program() -> Path:
    """The command-line program: what COINMC_BIN names, else a release build."""
    if "COINMC_BIN" in os.environ:
        return Path(os.environ["COINMC_BIN"]).resolve()
    cargo = os.environ.get("CARGO", "cargo")
    build = [cargo, "build", "--quiet", "--release", "--package", "coinmc-cli"]
    subprocess.run(build, cwd=ROOT, check=True)
    query = [cargo, "metadata", "--format-version", "1", "--no-deps"]
    told = subprocess.run(query, cwd=ROOT, check=True, capture_output=True, text=True).stdout
    return Path(json.loads(told)["target_directory"]) / "release" / "coinmc"


@pytest.fixture(scope="session")
def command(program):
    """Runs the program: command("run", …) returns the finished process."""

    def run(*arguments, cwd=ROOT, check=True):
        words = [program, *map(str, arguments)]
        return subprocess.run(words, cwd=cwd, check=check, capture_output=True, text=True)

    return run


@pytest.fixture(scope="session")
def scene() -> dict:
    """A thick coin that bounces in the plane."""
    return {
        "seed": 7,
        "coin": {"ratio": 1.2},
        "surface": {"restitution": 0.5, "friction": 0.3},
        "launch": {"preset": "robot"},
        "engine": {"flat": {}},
        "stop": {"tosses": 3000},
    }
