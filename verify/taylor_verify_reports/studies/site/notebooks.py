"""Notebooks of the gallery as files for Jupyter, each beside its page, which links to it."""

from __future__ import annotations

import json
import posixpath
import re
from pathlib import Path
from typing import TYPE_CHECKING, Final

from docutils import nodes

if TYPE_CHECKING:
    from sphinx.application import Sphinx

SUFFIX: Final = ".ipynb"

_OPENING: Final = "---\njupytext:\n"
# Links to other pages of the site, which do not work in a downloaded notebook.
_LINK_WITHIN: Final = re.compile(r"\[([^\]]+)\]\((?!https?:)[^)]*\)")


def is_notebook(text: str) -> bool:
    """Return True for Markdown that is a notebook."""
    return text.startswith(_OPENING)


def notebook(text: str) -> str:
    """Return a notebook in Markdown as the JSON that Jupyter opens; no output is stored in it."""
    from myst_nb.core.read import read_myst_markdown_notebook

    parsed = read_myst_markdown_notebook(text)
    for i, cell in enumerate(parsed.cells):
        # With the reader's random names, two builds of one page would differ.
        cell["id"] = f"cell-{i}"
        if cell.cell_type == "markdown":
            cell.source = _LINK_WITHIN.sub(r"\1", cell.source)
    return json.dumps(parsed, ensure_ascii=False, indent=1)


def add_link(app: Sphinx, doctree: nodes.document) -> None:
    """Add to a page the link to its notebook, after the conclusion with which the page begins."""
    page = app.env.docname
    section = next(doctree.findall(nodes.section), None)
    if section is None or not is_notebook(_source(app, page)):
        return
    name = f"{posixpath.basename(page)}{SUFFIX}"
    link = nodes.reference("", "Download this page as a notebook", refuri=name, internal=True)
    section.insert(2, nodes.paragraph("", "", link, nodes.Text(" for Jupyter.")))


def write_notebooks(app: Sphinx, exception: Exception | None) -> None:
    """Write a notebook beside each page that is made from one; nothing after a failed build."""
    if exception is not None:
        return
    for page in sorted(app.env.found_docs):
        if is_notebook(text := _source(app, page)):
            Path(app.outdir, f"{page}{SUFFIX}").write_text(notebook(text), encoding="utf-8")


def _source(app: Sphinx, page: str) -> str:
    return Path(app.env.doc2path(page)).read_text(encoding="utf-8")
