"""Copies of the working tree, in which lines are broken."""

import filecmp
import shutil
import subprocess


def copy_tree(root, to):
    """Brings the copy up to date; what is the same keeps its time, so little is compiled."""
    listing = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    names = subprocess.run(listing, cwd=root, check=True, capture_output=True, text=True).stdout
    names = {name for name in names.split("\0") if name and (root / name).is_file()}
    for name in names:
        here, there = root / name, to / name
        if not there.is_file() or not filecmp.cmp(here, there, shallow=False):
            there.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(here, there)
            shutil.copymode(here, there)
    kept = to / "target"
    for path in to.rglob("*"):
        if kept in path.parents or not path.is_file():
            continue
        if str(path.relative_to(to)) not in names:
            path.unlink()
