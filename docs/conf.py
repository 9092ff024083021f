"""How Sphinx makes these pages: `make docs`, with every warning an error.

The docstrings of the package are plain text in which only ``literals`` are marked. They are turned into
what Sphinx reads here, so that |x|, R_ij and an indented formula stay what they are.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator
from importlib.metadata import version as version_of
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent

project = "taylor-verify"
author = "The taylor-verify authors"
copyright = author
version = release = version_of(project)

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
exclude_patterns = ["_build"]
myst_enable_extensions = ["deflist", "dollarmath"]
# The scenes and the glossary are linked to by heading, as on the pages of a repository.
myst_heading_anchors = 3
# A transcript is text: a lexer that stumbles over it says nothing about the page.
highlight_language = "text"
# Docstrings with headings are numpydoc's; the colon of a plain one begins no section.
napoleon_google_docstring = False
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_class_signature = "mixed"
python_use_unqualified_type_names = True
maximum_signature_line_length = 88

html_theme = "alabaster"
html_static_path = ["_static"]
html_css_files = ["pages.css"]
html_title = project
html_show_sourcelink = False
html_show_copyright = False
html_theme_options = {
    "description": "How wrong is your rigid-body or ideal-fluid simulation?",
    "page_width": "1100px",
    "sidebar_width": "230px",
    "fixed_sidebar": True,
    "show_powered_by": False,
}
html_sidebars = {"**": ["about.html", "navigation.html", "searchbox.html"]}

LINK = re.compile(r"(?<=\]\()(?!\w+:|#)([^)#\s]+)(#[^)\s]*)?(?=\))")
LITERAL = re.compile(r"(``.+?``)")
MARKUP = re.compile(r"([\\*|`]|_(?!\w))")


def plain(lines: Iterable[str]) -> Iterator[str]:
    """A docstring as reStructuredText: its marks escaped, but for literals; what is indented verbatim."""
    before, is_verbatim = "", False
    for line in lines:
        is_indented = line.startswith(" ")
        if is_indented and not is_verbatim and not before:
            yield from ("::", "")
        if line or not is_verbatim:
            is_verbatim = is_indented and (is_verbatim or not before)
        if is_verbatim or not line:
            yield line
        else:
            parts = LITERAL.split(re.sub(r"(?<!`)`([^`]+)`(?!`)", r"``\1``", line))
            yield "".join(p if p.startswith("``") else MARKUP.sub(r"\\\1", p) for p in parts)
        before = line


def told(_app: Any, _what: str, _name: str, _thing: Any, _options: Any, lines: list[str]) -> None:
    lines[:] = plain(lines)


def linked(text: str, written_in: Path, shown_in: Path) -> str:
    """The links of a text that stands in one folder and is shown in another.

    What lies beyond these pages comes along as a file: it has links of its own, which start there. A
    picture is shown where it is named.
    """

    def moved(link: re.Match[str]) -> str:
        target = (written_in / link[1]).resolve()
        path = os.path.relpath(target, shown_in)
        is_here = target.is_relative_to(HERE) or target.suffix == ".svg"
        return f"{path}{link[2] or ''}" if is_here else f"path:{path}"

    return LINK.sub(moved, text)


def linked_from_page(_app: Any, page: str, content: list[str]) -> None:
    folder = (HERE / page).parent
    content[0] = linked(content[0], folder, folder)


def linked_from_included(_app: Any, path: Path, _page: str, content: list[str]) -> None:
    content[0] = linked(content[0], (HERE / path).resolve().parent, HERE)


def setup(app: Any) -> None:
    app.connect("autodoc-process-docstring", told)
    app.connect("source-read", linked_from_page)
    app.connect("include-read", linked_from_included)
