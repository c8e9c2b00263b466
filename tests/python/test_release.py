"""What `scripts/release` refuses, tried with `--dry-run` in a copy of the repository."""

import shutil
import subprocess

import pytest


def git(folder, *words: str) -> str:
    who = ("-c", "user.name=test", "-c", "user.email=test@localhost")
    command = ["git", *who, *words]
    return subprocess.run(command, cwd=folder, check=True, capture_output=True, text=True).stdout


@pytest.fixture(scope="module")
def repository(root, tmp_path_factory):
    """The working tree as it is, committed in a repository of its own."""
    folder = tmp_path_factory.mktemp("repository")
    if not shutil.which("git") or not (root / ".git").exists():
        pytest.skip("no git here")
    for name in git(root, "ls-files", "-z", "--cached", "--others", "--exclude-standard").split(
        "\0"
    ):
        # pictures and the like make no difference
        if name and not name.startswith(("docs/", "fuzz/", "tests/")) and (root / name).exists():
            there = folder / name
            there.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(root / name, there, follow_symlinks=True)
    # a member of the workspace
    shutil.copytree(root / "tests", folder / "tests", dirs_exist_ok=True)
    (folder / "scripts/release").chmod(0o755)
    git(folder, "init", "--quiet")
    commit(folder)
    return folder


@pytest.fixture
def copy(repository):
    """The same for each test."""
    first = git(repository, "rev-list", "--max-parents=0", "HEAD").strip()
    git(repository, "reset", "--quiet", "--hard", first)
    return repository


def commit(folder):
    git(folder, "add", "--all")
    git(folder, "commit", "--quiet", "--message", "all")


def dry_run(folder) -> subprocess.CompletedProcess[str]:
    command = ["scripts/release", "--dry-run"]
    return subprocess.run(command, cwd=folder, check=False, capture_output=True, text=True)


def change(path, old: str, new: str):
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))


def test_a_clean_commit_is_released(copy):
    done = dry_run(copy)
    assert done.returncode == 0, done.stderr
    made = done.stdout.split("would be made")[1].split()
    crates = [name for name in made if name.endswith(".crate")]
    # each after what it depends on
    order = ["coinmc-lanes-", "coinmc-core-", "coinmc-flat-", "coinmc-0.", "coinmc-cli-"]
    places = [next(i for i, name in enumerate(crates) if name.startswith(part)) for part in order]
    assert places == sorted(places)
    assert not any("hack" in name or "testkit" in name or "oracle" in name for name in crates)
    notes = (copy / "target/dist/NOTES.md").read_text()
    after = (copy / "CHANGELOG.md").read_text().split("## [0.1.0] - ")[1]
    section = after.split("\n", 1)[1].split("\n## [")[0]
    assert notes.strip() == section.strip()


def test_a_dirty_tree_is_refused(copy):
    change(copy / "README.md", "coinmc", "coinmc, changed,")
    done = dry_run(copy)
    assert done.returncode == 1
    assert "README.md" in done.stderr


def test_a_version_that_the_changelog_does_not_have_is_refused(copy):
    change(copy / "CHANGELOG.md", "## [0.1.0] - ", "## [0.0.9] - ")
    commit(copy)
    done = dry_run(copy)
    assert done.returncode == 1
    assert "CHANGELOG.md" in done.stderr


def test_addresses_must_agree(copy):
    change(copy / "python/pyproject.toml", 'Repository = "', 'Repository = "https://elsewhere.')
    commit(copy)
    done = dry_run(copy)
    assert done.returncode == 1
    assert "pyproject.toml" in done.stderr
