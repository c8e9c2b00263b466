"""Python shown in README and docs runs."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

PYTHON = re.compile(r"^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)
COMMAND = re.compile(
    r"^\$ (?:coinmc|cargo run --release --) (run .*|listen --synthetic .*)$", re.MULTILINE
)


def documents(root: Path) -> list[Path]:
    return sorted([*root.glob("*.md"), *(root / "docs").rglob("*.md")])


def test_python_blocks_run(root, binary, tmp_path):
    """Blocks of one document share a session; commands that toss or write sound come before."""
    path = f"{binary.parent}{os.pathsep}{os.environ['PATH']}"
    for document in documents(root):
        text = document.read_text()
        blocks = PYTHON.findall(text)
        if not blocks:
            continue
        folder = tmp_path / document.relative_to(root).with_suffix("")
        shutil.copytree(root / "examples", folder / "examples")
        environment = {**os.environ, "PATH": path}
        for arguments in COMMAND.findall(text):
            command = f"coinmc {arguments} > /dev/null"
            subprocess.run(["sh", "-c", command], cwd=folder, env=environment, check=True)
        done = subprocess.run(
            [sys.executable, "-c", "\n".join(blocks)],
            cwd=folder,
            env=environment,
            capture_output=True,
            text=True,
        )
        assert done.returncode == 0, f"{document.relative_to(root)}:\n{done.stderr}"
