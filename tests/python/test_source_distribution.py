"""The source distribution: what `pip install coinmc-VERSION.tar.gz` gets, built and tried.

It shares compiled crates with the release build, as cargo finds the same files at the same places
of a workspace. A file that is missing in the archive is missed: its crate is then compiled anew.
"""

import json
import os
import subprocess
import sys
import tarfile
from pathlib import Path

import pytest

#: A small part of the wheel's tests: of those that need nothing but the package.
TRIED = ("test_analytic.py", "test_own_launches.py")


def run(*words, **more) -> str:
    done = subprocess.run([*map(str, words)], check=False, capture_output=True, text=True, **more)
    assert done.returncode == 0, f"{words}\n{done.stdout}\n{done.stderr}"
    return done.stdout


@pytest.fixture(scope="module")
def archive(root, tmp_path_factory) -> Path:
    """The source distribution of the working tree."""
    folder = tmp_path_factory.mktemp("sdist")
    maturin = Path(sys.executable).with_name("maturin")
    run(maturin, "sdist", "--manifest-path", root / "python/Cargo.toml", "--out", folder)
    [archive] = folder.iterdir()
    return archive


def test_the_archive_has_what_it_is_made_of(root, archive):
    with tarfile.open(archive) as tar:
        members = {member.name: member for member in tar.getmembers()}
    assert not any(member.issym() or member.islnk() for member in members.values())
    names = {name.split("/", 1)[1] for name in members}
    tracked = run("git", "ls-files", "python/coinmc", cwd=root).split()
    packaged = {name.removeprefix("python/") for name in tracked}
    assert packaged <= names, packaged - names
    assert {"LICENSE-MIT", "LICENSE-APACHE", "README.md", "Cargo.lock", "PKG-INFO"} <= names
    assert not any(name.startswith("tests/") for name in names)


def test_it_installs_in_an_empty_environment_and_works(root, archive, tmp_path):
    """With the features that all builds share, so that cargo compiles nothing but the wheel."""
    environment = tmp_path / "venv"
    run(sys.executable, "-m", "venv", "--without-pip", environment)
    python = environment / "bin/python"
    pip = (sys.executable, "-m", "pip", "--python", python, "install", "--quiet")
    told = run("cargo", "metadata", "--format-version", "1", "--no-deps", cwd=root)
    target = {
        "CARGO_TARGET_DIR": json.loads(told)["target_directory"],
        # The archive has no git. Its build must not stay the one that programs compiled here name:
        # Cargo looks for the commit again once this is not set any more.
        "COINMC_COMMIT": "archive",
    }
    shared = ("--config-settings", "build-args=--features shared-build")
    run(*pip, *shared, archive, "pytest", env={**os.environ, **target})
    tried = [root / "python/tests" / name for name in TRIED]
    quiet = ("-q", "-p", "no:cacheprovider", "-k", "not pandas")
    told = run(python, "-B", "-m", "pytest", *quiet, *tried, cwd=tmp_path)
    assert " passed" in told
    # data files, the command, and what the package says of itself
    data = environment.glob("lib/*/site-packages/coinmc/plot/data/*.csv")
    assert {path.name for path in data} == {"fair-ratios.csv", "unity-table1.csv"}
    command = environment / "bin/coinmc"
    told = run(command, "analytic", "--fair")
    assert told.startswith("rule ")
    done = subprocess.run([command, "rum"], check=False, capture_output=True, text=True)
    assert done.returncode == 2
    assert "unrecognized subcommand" in done.stderr
    about = run(python, "-c", "import importlib.metadata as m; print(m.metadata('coinmc'))")
    for name in ("Homepage", "Repository", "Documentation", "Changelog", "Issues"):
        assert f"Project-URL: {name}, https://" in about
