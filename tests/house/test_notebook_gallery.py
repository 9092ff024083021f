"""The gallery: notebooks that the build of the docs executes, and that can be taken to Jupyter."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import nbformat
import pytest
from builders.worked import DOCS

from taylor_verify_reports.studies.site.notebooks import notebook

NOTEBOOKS = sorted((DOCS / "gallery").glob("*.md"))


@pytest.mark.slow
@pytest.mark.parametrize(("assertion", "ends"), [("x == 1", 0), ("x == 2", 1)])
def test_a_false_statement_ends_the_build(assertion: str, ends: int, tmp_path: Path) -> None:
    """An assertion in a hidden cell that does not hold is an error of `make docs`."""
    cells = ("x = 1", f":tags: [remove-cell]\n\nassert {assertion}")
    page = "\n".join(f"```{{code-cell}}\n{cell}\n```\n" for cell in cells)
    head = (DOCS / "gallery" / "proof.md").read_text(encoding="utf-8").partition("\n# ")[0]
    (tmp_path / "index.md").write_text(f"{head}\n# A title\n\n{page}", encoding="utf-8")
    settings = "from taylor_verify_reports.studies.site.conf import *\n"
    (tmp_path / "conf.py").write_text(settings, encoding="utf-8")
    command = [sys.executable, "-m", "sphinx", "-W", "-q", str(tmp_path), str(tmp_path / "made")]
    done = subprocess.run(command, capture_output=True, text=True)
    assert (done.returncode, "AssertionError" in done.stderr) == (ends, bool(ends)), done.stderr


@pytest.mark.parametrize("page", NOTEBOOKS, ids=lambda page: page.stem)
def test_a_notebook_can_be_downloaded(page: Path) -> None:
    """The file for Jupyter has every fence of the page as a cell, no output, and no link to the site.

    What the page states is asserted in at least three places.
    """
    text = page.read_text(encoding="utf-8")
    made = nbformat.reads(notebook(text), as_version=4)
    nbformat.validate(made)
    codes = [cell for cell in made.cells if cell.cell_type == "code"]
    assert text.count("```") == 2 * len(codes)
    assert not any(cell.outputs for cell in codes)
    assert sum(cell.source.count("assert ") for cell in codes) >= 3
    words = "".join(cell.source for cell in made.cells if cell.cell_type == "markdown")
    assert not re.search(r"\]\((?!https?:)", words)
