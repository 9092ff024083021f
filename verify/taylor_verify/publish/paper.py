"""A published page as LaTeX that pdflatex compiles as it is, and as one file of HTML; pandoc makes both.

The pages are the one source: no number is written down in two places. ``paper.lua`` beside this file has
what pandoc lacks, tables that fit a printed page above all.
"""

from __future__ import annotations

import posixpath
from collections.abc import Collection, Iterable
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Final

FOLDER: Final = "tables"
LATEX: Final = ".tex"
HTML: Final = ".html"
_MADE_BY: Final = "made by taylor-verify publish --paper; do not edit"
MAKERS: Final = {LATEX: f"% {_MADE_BY}", HTML: f"<!-- {_MADE_BY} -->"}
"""First line of every rendering, by its suffix."""

_FILTER: Final = Path(__file__).with_suffix(".lua")
_TEMPLATE: Final = Path(__file__).with_suffix(".latex")
_OPTIONS: Final = (
    "--standalone",
    "--fail-if-warnings",
    "--syntax-highlighting=none",
    "--wrap=none",
)


@dataclass(frozen=True)
class Page:
    """A page by its path below the report's folder, with its Markdown."""

    path: str
    text: str

    @property
    def stem(self) -> str:
        """Name of its renderings: those of the ledger stand among the tables, too."""
        return PurePosixPath(self.path).stem


def latex(page: Page) -> str:
    """Return the LaTeX of one page. Raises ValueError for HTML in it, which would be lost."""
    # Without `smart` an apostrophe is written as it stands.
    return _render(page, LATEX, "latex-smart", [f"--template={_TEMPLATE}"])


def html(page: Page, pages: Collection[str]) -> str:
    """Return the HTML of one page; links to ``pages`` lead to their renderings.

    Raises ValueError for HTML in the page, and for a formula that is none.
    """
    seen = " ".join(posixpath.relpath(path, FOLDER) for path in pages)
    folder = "" if posixpath.dirname(page.path) == FOLDER else "../"
    settings = ["--metadata=lang:en", f"--metadata=pages:{seen}", f"--metadata=folder:{folder}"]
    return _render(page, HTML, "html5", ["--mathml", "--variable=maxwidth:80rem", *settings])


def paper(title: str, stems: Iterable[str]) -> str:
    """Return one document that reads in the files of all pages."""
    inputs = "\n".join(rf"\clearpage\input{{{stem}}}" for stem in stems)
    options = [*_OPTIONS, f"--template={_TEMPLATE}", f"--metadata=title:{title}"]
    text = _convert(f"```{{=latex}}\n{inputs}\n```", "markdown", "latex", options)
    return f"{MAKERS[LATEX]}\n{text}"


def _render(page: Page, suffix: str, writer: str, options: list[str]) -> str:
    options = [*_OPTIONS, f"--lua-filter={_FILTER}", *options]
    try:
        return f"{MAKERS[suffix]}\n{_convert(page.text, 'gfm', writer, options)}"
    except RuntimeError as error:
        # A filter that stops adds where in it that was.
        reason = str(error).partition("\nstack traceback")[0]
        raise ValueError(f"{reason} @ {page.path}") from error


def _convert(text: str, reader: str, writer: str, options: list[str]) -> str:
    import pypandoc

    return str(pypandoc.convert_text(text, writer, reader, options))
