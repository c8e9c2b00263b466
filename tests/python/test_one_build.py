"""The program, the Python wheel and the tests share all that they compile.

Cargo compiles a package anew for every set of features that is asked of it. If one build asks for
another set than the other, all that depends on the package is compiled twice: minutes for nothing.
The package workspace-hack makes them agree.
"""

import os
import subprocess
from collections import defaultdict

import pytest


def features(root, *which: str) -> dict[str, set[str]]:
    """Features of every package that a build compiles, by name and version.

    There may be several sets of them: procedural macros have packages of their own.
    """
    cargo = os.environ.get("CARGO", "cargo")
    words = [cargo, "tree", "--prefix", "none", "--format", "{p} | {f}", *which]
    told = subprocess.run(words, cwd=root, check=True, capture_output=True, text=True).stdout
    sets = defaultdict(set)
    for line in told.splitlines():
        if " | " in line:
            name, asked = line.removesuffix(" (*)").split(" | ", 1)
            sets[name].add(asked)
    return sets


# As `scripts/wheel` builds it.
WHEEL = ("--edges", "normal,build", "--package", "coinmc-python", "--features", "shared-build")


@pytest.mark.parametrize(
    ("other", "agree"),
    [
        (WHEEL, set.__eq__),
        # procedural macros of the tests alone may ask for more, beside it
        (("--edges", "normal,build,dev", "--workspace"), set.__le__),
    ],
    ids=["wheel", "tests"],
)
def test_builds_ask_for_the_features_of_the_program(root, other, agree):
    # the default members: what `cargo build` at the root builds
    program = features(root, "--edges", "normal,build")
    theirs = features(root, *other)
    shared = program.keys() & theirs.keys()
    assert len(shared) > 100
    different = {
        name: (program[name], theirs[name])
        for name in sorted(shared)
        if not agree(program[name], theirs[name])
    }
    # to be mended in workspace-hack/Cargo.toml
    assert not different


def test_no_published_package_depends_on_the_workspace_hack(root):
    for manifest in root.glob("crates/*/Cargo.toml"):
        assert "workspace-hack" not in manifest.read_text(), manifest
