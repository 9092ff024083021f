"""The gallery: every notebook runs from top to bottom, and what it says is what it computes."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from pathlib import Path

import nbformat
import pytest
from builders.notebooks import NOTEBOOKS, Output, cells, execute
from builders.worked import ROOT

from taylor_verify_reports.studies.site.notebooks import notebook

# One for each use that a newcomer asks for.
NAMES = ("dzhanibekov", "engine", "falling-solid", "precision", "proof", "simulator")

# An ellipsoid in a fluid, whose border between two kinds of motion is sought by halving, and two that
# take seconds each.
LONG = ("falling-solid", "simulator", "precision")


@pytest.fixture(autouse=True)
def _as_in_a_kernel(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[None]:
    """An empty folder, and the place of the clone that the pages are built from."""
    monkeypatch.setenv("TAYLOR_VERIFY_CLONE", str(ROOT))
    before = Path.cwd()
    os.chdir(tmp_path)
    yield
    os.chdir(before)


def test_each_use_has_a_notebook() -> None:
    """Simulator, flip, solid in a fluid, precision, engine, proof."""
    assert tuple(page.stem for page in NOTEBOOKS) == NAMES


@pytest.mark.parametrize(
    "page",
    [
        pytest.param(page, id=page.stem, marks=[pytest.mark.slow] if page.stem in LONG else [])
        for page in NOTEBOOKS
    ],
)
def test_a_notebook_runs(page: Path) -> None:
    """Every cell runs, its assertions among them, and one to three pictures are shown."""
    outputs = execute(page.read_text(encoding="utf-8"), page.name)
    assert 1 <= sum("<img" in output.shown or "<iframe" in output.shown for output in outputs) <= 3


@pytest.mark.parametrize("page", NOTEBOOKS, ids=lambda page: page.stem)
def test_a_notebook_is_a_short_story(page: Path) -> None:
    """It opens with its conclusion, holds its facts in hidden cells, and ends with what to do next."""
    text = page.read_text(encoding="utf-8")
    opening = text.split("\n# ", 1)[1].split("\n\n")[1]
    assert opening[0].isupper()
    assert opening.count(". ") + opening.endswith(".") >= 2
    hidden = [cell.code for cell in cells(text) if not cell.is_shown]
    assert sum(code.count("assert ") for code in hidden) >= 3
    *_, last = re.split(r"^## ", text, flags=re.MULTILINE)
    assert last.startswith("What to do next\n")
    assert last.count("\n- ") >= 3
    assert "](../" in last


@pytest.mark.parametrize("page", NOTEBOOKS, ids=lambda page: page.stem)
def test_a_notebook_stores_no_output(page: Path) -> None:
    """Nothing of a page is what a cell has put out once: every fence is a cell."""
    text = page.read_text(encoding="utf-8")
    assert text.count("```") == 2 * len(cells(text))
    assert "format_name: myst" in text.partition("\n# ")[0]


def test_a_false_statement_is_an_error() -> None:
    """An assertion that does not hold ends the notebook, and names the line of the page."""
    first, second = "x = 1", ":tags: [remove-cell]\n\nassert x == 2"
    page = f"# A title\n\n```{{code-cell}}\n{first}\n```\n\n```{{code-cell}}\n{second}\n```\n"
    with pytest.raises(AssertionError) as raised:
        execute(page, "page.md")
    assert raised.traceback[-1].lineno + 1 == page[: page.index("assert")].count("\n") + 1


def test_cells_are_read_with_their_places() -> None:
    """Names go from cell to cell, a last expression is shown, and a hidden cell is told apart."""
    page = "```{code-cell}\nx = 2\nprint(x)\n```\n\n```{code-cell}\n:tags: [remove-cell]\n\nx + 1\n```\n"
    assert [cell.is_shown for cell in cells(page)] == [True, False]
    assert execute(page, "page.md") == [Output("2\n", ""), Output("", "3")]


@pytest.mark.parametrize("page", NOTEBOOKS, ids=lambda page: page.stem)
def test_a_notebook_can_be_downloaded(page: Path) -> None:
    """The file for Jupyter has the cells of the page, no output, and no link that needs the site."""
    text = page.read_text(encoding="utf-8")
    made = nbformat.reads(notebook(text), as_version=4)
    nbformat.validate(made)
    codes = [cell for cell in made.cells if cell.cell_type == "code"]
    assert [cell.source.strip() for cell in codes] == [cell.code.strip() for cell in cells(text)]
    assert not any(cell.outputs for cell in codes)
    words = "".join(cell.source for cell in made.cells if cell.cell_type == "markdown")
    assert not re.search(r"\]\((?!https?:)", words)
    assert notebook(text) == notebook(text)
