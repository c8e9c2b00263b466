"""The package and its guide are well typed, as their readers' checkers see them."""

import importlib.util
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

BLOCKS = re.compile(r"^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def installed(checker):
    """Skip a test where its type checker is missing."""
    missing = importlib.util.find_spec(checker) is None
    return pytest.mark.skipif(missing, reason=f"{checker} is not installed (pip install {checker})")


def checked(path, *command):
    """Run a type checker in a folder.

    It finds this interpreter's packages by the first Python of PATH: what `pyright --verifytypes`
    is told by --pythonpath it does not heed.
    """
    folders = (str(Path(sys.executable).parent), os.environ["PATH"])
    environment = {**os.environ, "PATH": os.pathsep.join(folders)}
    command = (sys.executable, "-m", *command)
    return subprocess.run(
        command, cwd=path, env=environment, check=False, capture_output=True, text=True
    )


@pytest.fixture
def guide(root, tmp_path):
    text = (root / "docs/guide/python.md").read_text(encoding="utf-8")
    (tmp_path / "guide.py").write_text("\n".join(BLOCKS.findall(text)), encoding="utf-8")
    return tmp_path


@installed("mypy")
def test_mypy_accepts_the_guide(guide):
    # what other packages say of their types is not ours
    done = checked(guide, "mypy", "--ignore-missing-imports", "guide.py")
    assert done.returncode == 0, done.stdout


@installed("pyright")
def test_pyright_accepts_the_guide(guide):
    done = checked(guide, "pyright", "guide.py")
    assert done.returncode == 0, done.stdout


@installed("pyright")
def test_the_type_of_every_public_name_is_known(tmp_path):
    command = ("pyright", "--verifytypes", "coinmc", "--ignoreexternal", "--outputjson")
    done = checked(tmp_path, *command)
    found = json.loads(done.stdout)["typeCompleteness"]
    doubtful = [s["name"] for s in found["symbols"] if s["isExported"] and not s["isTypeKnown"]]
    assert found["completenessScore"] == 1, doubtful
