"""The program, the Python wheel and the tests share all that they compile.

Cargo compiles a package anew for every set of features that is asked of it. If one build asks for
another set than the other, all that depends on the package is compiled twice: minutes for nothing.
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


@pytest.mark.parametrize(
    ("other", "agree"),
    [
        (("--edges", "normal,build", "--package", "coinmc-python"), set.__eq__),
        # procedural macros of the tests alone may ask for more, beside it
        (("--edges", "normal,build,dev", "--workspace"), set.__le__),
    ],
    ids=["wheel", "tests"],
)
def test_builds_ask_for_the_features_of_the_program(root, other, agree):
    program = features(root, "--edges", "normal,build", "--package", "coinmc-cli")
    theirs = features(root, *other)
    shared = program.keys() & theirs.keys()
    assert len(shared) > 100
    different = {
        name: (program[name], theirs[name])
        for name in sorted(shared)
        if not agree(program[name], theirs[name])
    }
    # mended in the two Cargo.toml, where they name packages that they do not use
    assert not different
