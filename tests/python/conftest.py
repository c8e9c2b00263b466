"""Where things are, and how to run the program."""

import json
import os
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def root() -> Path:
    """The repository."""
    return ROOT


def cargo(*arguments: str) -> str:
    """What a cargo command prints."""
    command = [os.environ.get("CARGO", "cargo"), *arguments]
    return subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout


@pytest.fixture(scope="session")
def binary() -> Path:
    """The program: what COINMC_BIN names, else a release build."""
    if "COINMC_BIN" in os.environ:
        return Path(os.environ["COINMC_BIN"]).resolve()
    cargo("build", "--quiet", "--release")
    metadata = json.loads(cargo("metadata", "--format-version", "1", "--no-deps"))
    return Path(metadata["target_directory"]) / "release" / "coinmc"


@pytest.fixture(scope="session")
def coinmc(binary):
    """Runs the program: coinmc("run", …) returns the finished process."""

    def run(*arguments, cwd=ROOT, check=True):
        command = [binary, *map(str, arguments)]
        return subprocess.run(command, cwd=cwd, check=check, capture_output=True, text=True)

    return run


@pytest.fixture(scope="session")
def random_words() -> dict:
    """What tests/examples/random-words.rs prints."""
    # of the workspace, with whose features the tests of Rust have built it
    build = ("build", "--quiet", "--workspace", "--release", "--message-format", "json")
    said = cargo(*build, "--example", "random-words").splitlines()
    built = [json.loads(line).get("executable") for line in said]
    program = next(path for path in reversed(built) if path)
    return json.loads(subprocess.run(program, check=True, stdout=subprocess.PIPE).stdout)
