"""Tables of docs/ are those of their CSV files, which say where they come from."""

import importlib.machinery
import importlib.util
import re
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
DATA = ROOT / "data/validation"


@pytest.fixture(scope="module")
def script():
    """scripts/docs-tables as a module."""
    loader = importlib.machinery.SourceFileLoader("docs_tables", str(ROOT / "scripts/docs-tables"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("docs_tables", loader))
    loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def tables() -> dict:
    return tomllib.loads((ROOT / "docs/tables.toml").read_text(encoding="utf-8"))


def test_pages_show_what_the_files_say(script, capsys):
    assert script.main(["--check"]) == 0, capsys.readouterr().out


def test_a_wrong_digit_is_noticed(script, tables):
    page = (ROOT / "docs/validation/spatial.md").read_text(encoding="utf-8")
    assert script.written(page, tables) == page
    wrong = page.replace("0.3318 ±", "0.3319 ±", 1)
    assert wrong != page
    assert script.written(wrong, tables) == page


def test_a_wrong_default_of_a_key_is_noticed(script, tables):
    page = (ROOT / "docs/reference/config.md").read_text(encoding="utf-8")
    wrong = page.replace("| `0.01` |", "| `0.02` |", 1)
    assert wrong != page
    assert script.written(wrong, tables) == page


def test_every_table_of_measurements_is_generated():
    """Under docs/validation and in docs/performance.md no table is typed by hand."""
    pages = [*(ROOT / "docs/validation").glob("*.md"), ROOT / "docs/performance.md"]
    for page in pages:
        text = page.read_text(encoding="utf-8")
        text = re.sub(r"<!-- table .*?<!-- /table -->", "", text, flags=re.DOTALL)
        if page.name != "index.md":
            assert not re.search(r"^\|", text, re.MULTILINE), page.name


def test_every_file_is_used_and_its_origin_known(tables):
    files = {path.name for path in DATA.glob("*.csv")}
    used = {table["csv"] for table in tables.values()}
    assert files == {name for name in used if "/" not in name}
    assert all((DATA / name).is_file() for name in used)
    described = re.findall(
        r"^\| `([\w-]+\.csv)` \|", (DATA / "README.md").read_text(), re.MULTILINE
    )
    assert sorted(described) == sorted(files)


def test_every_study_that_is_named_exists():
    source = (ROOT / "studies/src/arguments.rs").read_text(encoding="utf-8")
    variants = re.findall(r"^    ([A-Z][A-Za-z]+)\(", source, re.MULTILINE)
    studies = {re.sub(r"(?<!^)(?=[A-Z])", "-", name).lower() for name in variants}
    pages = [*(ROOT / "docs").rglob("*.md"), DATA / "README.md"]
    for page in pages:
        text = page.read_text(encoding="utf-8")
        for command in re.findall(r"coinmc-studies ((?:--\w+ \S+ )*[\w-]+)", text):
            name = command.split()[-1]
            assert name in {*studies, "--", "NAME"}, f"{page.name}: {name}"
