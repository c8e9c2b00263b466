"""The guide's Python is well typed, as its readers' checkers see it."""

import importlib.util
import re
import subprocess
import sys

import pytest

BLOCKS = re.compile(r"^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)


@pytest.mark.skipif(importlib.util.find_spec("mypy") is None, reason="mypy is not installed")
def test_mypy_accepts_the_guide(root, tmp_path):
    guide = (root / "docs/guide/python.md").read_text(encoding="utf-8")
    (tmp_path / "guide.py").write_text("\n".join(BLOCKS.findall(guide)), encoding="utf-8")
    # what other packages say of their types is not ours
    command = (sys.executable, "-m", "mypy", "--ignore-missing-imports", "guide.py")
    done = subprocess.run(command, cwd=tmp_path, check=False, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout
