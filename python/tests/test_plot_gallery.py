"""The gallery and the notebook: every script runs, and the page shows what ran."""

import importlib.util
import re
import runpy
import shutil
import sys
from pathlib import Path

import matplotlib as mpl
import pytest
from PIL import Image

mpl.use("Agg")
ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs/guide/gallery.md"
SCRIPTS = sorted((ROOT / "docs/guide/gallery").glob("*.py"))
PICTURES = sorted(
    path for path in (ROOT / "docs/guide/gallery").iterdir() if path.suffix in (".png", ".gif")
)
# One picture and what of its script the page shows. Not ```python: those run once more elsewhere.
SHOWN = re.compile(r"!\[[^\]]+\]\((gallery/[^)]+)\)\n\n```py\n(.*?)```", re.DOTALL)


@pytest.fixture(autouse=True)
def workplace(tmp_path, monkeypatch):
    """A folder with the examples beside it, as the repository's root has them."""
    from matplotlib import pyplot

    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    monkeypatch.chdir(tmp_path)
    with mpl.rc_context():
        mpl.rcdefaults()
        yield
    pyplot.close("all")


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.stem)
def test_a_script_draws_its_picture(script, tmp_path, monkeypatch):
    shown = next(path for path in PICTURES if path.stem == script.stem)
    made = tmp_path / shown.name
    monkeypatch.setattr(sys, "argv", [str(script), str(made)])
    runpy.run_path(str(script), run_name="__main__")
    # of the same shape as the one that the page shows; not of the same pixels, which belong to a
    # release of matplotlib and, in one of them, to a clock
    with Image.open(made) as new, Image.open(shown) as old:
        assert new.size == old.size
        colours = new.convert("RGB").getcolors(1 << 24)
        assert len(colours) > 50, "next to nothing is drawn"


def test_the_page_shows_every_picture_with_the_lines_that_draw_it():
    shown = dict(SHOWN.findall(PAGE.read_text(encoding="utf-8")))
    assert set(shown) == {f"gallery/{path.name}" for path in PICTURES}
    assert {Path(name).stem for name in shown} == {path.stem for path in SCRIPTS}
    for name, lines in shown.items():
        script = (ROOT / "docs/guide/gallery" / f"{Path(name).stem}.py").read_text(encoding="utf-8")
        assert lines in script, name


def test_the_pictures_are_small():
    assert sum(path.stat().st_size for path in PICTURES) < 1_500_000


def cells():
    """The code of each cell of the notebook."""
    text = (ROOT / "docs/guide/notebooks/fair_coin.py").read_text(encoding="utf-8")
    parts = re.split(r"^# %%(.*)$", text, flags=re.MULTILINE)
    heads, bodies = parts[1::2], parts[2::2]
    return [body for head, body in zip(heads, bodies, strict=True) if "markdown" not in head]


def test_the_notebook_runs_cell_by_cell(capsys):
    names = {"__name__": "__main__"}
    found = cells()
    assert len(found) == 10
    for number, cell in enumerate(found, 1):
        assert cell.lstrip().startswith(f"# {number}. ")
        exec(compile(cell, f"cell {number}", "exec"), names)
    assert "fair at H/R = 1.6" in capsys.readouterr().out


@pytest.mark.skipif(
    not all(importlib.util.find_spec(name) for name in ("jupytext", "nbclient", "ipykernel")),
    reason="jupytext, nbclient and ipykernel are not installed",
)
def test_the_notebook_is_valid():
    import jupytext
    import nbclient

    notebook = jupytext.read(ROOT / "docs/guide/notebooks/fair_coin.py")
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert len(code) == 10
    # what is tested is installed already
    code[0].source = re.sub(r"^%pip.*$", "", code[0].source, flags=re.MULTILINE)
    nbclient.NotebookClient(notebook, timeout=120).execute()
    drawn = [
        output for cell in code for output in cell.outputs if "image/png" in output.get("data", {})
    ]
    assert len(drawn) >= 5
