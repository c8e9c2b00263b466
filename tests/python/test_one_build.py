"""The program and the Python wheel share all that they compile.

Cargo compiles a package anew for every set of features that is asked of it. If one build asks for
another set than the other, all that depends on the package is compiled twice: minutes for nothing.
"""

import os
import subprocess


def features(root, package: str) -> dict[str, str]:
    """Features of every package that a build compiles, by name and version."""
    cargo = os.environ.get("CARGO", "cargo")
    words = [cargo, "tree", "--edges", "normal,build", "--prefix", "none"]
    words += ["--package", package, "--format", "{p} | {f}"]
    told = subprocess.run(words, cwd=root, check=True, capture_output=True, text=True).stdout
    lines = {line.removesuffix(" (*)") for line in told.splitlines()}
    return dict(sorted(line.split(" | ", 1) for line in lines))


def test_program_and_wheel_ask_for_the_same_features(root):
    program, wheel = features(root, "coinmc-cli"), features(root, "coinmc-python")
    shared = program.keys() & wheel.keys()
    assert len(shared) > 100
    different = {
        name: (program[name], wheel[name]) for name in shared if program[name] != wheel[name]
    }
    # mended in the two Cargo.toml, where they name packages that they do not use
    assert not different
