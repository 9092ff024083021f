"""Checks of rendered pages: their cells, links and LaTeX; and the tables of the pages of docs."""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Mapping
from html.parser import HTMLParser
from pathlib import Path

import pytest

from builders.worked import DOCS
from taylor_verify.publish.paper import HTML, LATEX, MAKERS, Page


def page_in(folder: Path, path: str) -> Page:
    return Page(path, (folder / path).read_text(encoding="utf-8"))


class Cells(HTMLParser):
    """The tables of a page: every cell's text; code and bold are not told apart from words."""

    VOID = frozenset({"meta", "img", "br", "hr", "mspace"})

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tables: list[list[list[str]]] = []
        self.open: list[str] = []
        self.links: list[str] = []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.links += [value or "" for name, value in attrs if name in ("href", "src")]
        if tag in self.VOID:
            return
        self.open.append(tag)
        match tag:
            case "table":
                self.tables.append([])
            case "tr":
                self.tables[-1].append([])
            case "td" | "th":
                self.tables[-1][-1].append("")

    def handle_endtag(self, tag: str) -> None:
        if tag not in self.VOID:
            assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if {"td", "th"} & set(self.open):
            self.tables[-1][-1][-1] += data


def markdown_tables(text: str) -> list[list[list[str]]]:
    """The tables of a page, its lines cut at their bars: no parser of Markdown has a part in it."""
    found: list[list[list[str]]] = []
    before = ""
    for line in text.splitlines():
        if line.startswith("|"):
            if not before.startswith("|"):
                found.append([])
            if not re.fullmatch(r"[|:\- ]+", line) or "---" not in line:
                cells = re.split(r"(?<!\\)\|", line)[1:-1]
                found[-1].append([plain(cell) for cell in cells])
        before = line
    return found


def plain(cell: str) -> str:
    """The cell without its Markdown: what a reader sees."""
    seen = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", cell.strip())
    parts = re.split(r"((?<!\\)`[^`]*`)", seen)
    words = [
        part.strip("`").replace(r"\|", "|")
        if part.startswith("`")
        else re.sub(r"\\(.)", "\\1", re.sub(r"(?<!\\)\*+", "", part))
        for part in parts
    ]
    return "".join(words)


def html_has_the_cells(page: Page, rendered: Mapping[str, str]) -> None:
    text = rendered[f"tables/{page.stem}.html"]
    parsed = Cells(text)
    assert parsed.open == []
    assert text.splitlines()[0] == MAKERS[HTML]
    assert parsed.tables == markdown_tables(page.text)


def latex_has_the_rows(page: Page, rendered: Mapping[str, str]) -> None:
    text = rendered[f"tables/{page.stem}.tex"]
    assert text.splitlines()[0] == MAKERS[LATEX]
    assert "[U+" not in text.replace("{[}", "[")
    assert text.count("\\begin{") == text.count("\\end{")
    tables = markdown_tables(page.text)
    assert len(re.findall(r" \\\\$", text, re.M)) == sum(map(len, tables))
    number = re.compile(r"\d[\d.]*(?:e[+-]?\d+)?")
    printed = re.findall(r"\\endlastfoot\n(.*?)\\end\{longtable\}", text, re.S)
    for rows, latex_rows in zip(tables, printed, strict=True):
        cells = " ".join(cell for row in rows[1:] for cell in row)
        plain_rows = latex_rows.replace(r"\allowbreak{}", "").replace(r"}\texttt{", "")
        assert number.findall(plain_rows) == number.findall(cells)


def links_lead_somewhere(folder: Path, rendered: Mapping[str, str]) -> None:
    for name, text in rendered.items():
        for link in Cells(text).links if name.endswith(".html") else ():
            address, _, anchor = link.partition("#")
            if "://" in address:
                continue
            place = (folder / "tables" / address).resolve() if address else None
            target = place.relative_to(folder.resolve()).as_posix() if place else name
            assert target in rendered or (folder / target).exists(), (name, link)
            if anchor and target in rendered:
                assert f'id="{anchor}"' in rendered[target], (name, link)


def compiled(folder: Path, name: str, out: Path) -> str:
    """The output of pdflatex's second run, when the contents of a paper are known."""
    program = shutil.which("pdflatex")
    if program is None:
        pytest.skip("there is no pdflatex on this machine")
    # Those that come with Debian's texlive-latex-extra and lmodern, and not with LaTeX itself.
    packages = ["docmute.sty", "lmodern.sty"]
    if subprocess.run(["kpsewhich", *packages], capture_output=True, check=False).returncode:
        pytest.skip(f"expected {' and '.join(packages)}, which the LaTeX of this machine lacks")
    options = ["-interaction=nonstopmode", "-halt-on-error", f"-output-directory={out}"]
    for _ in range(2):
        ran = subprocess.run(
            [program, *options, name], cwd=folder, capture_output=True, check=False
        )
        said = ran.stdout.decode("utf-8", errors="replace")
        assert ran.returncode == 0, said[-2000:]
    assert (out / name).with_suffix(".pdf").stat().st_size
    return said


def table_rows(page: str) -> list[list[str]]:
    """The cells of every line of a table of a page of docs, heads and rules included."""
    text = (DOCS / page).read_text(encoding="utf-8")
    lines = [line for line in text.splitlines() if line.startswith("| ")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]


def results() -> list[list[str]]:
    """The rows of docs/results.md that quote a published verdict."""
    return [row for row in table_rows("results.md") if row[0].startswith("`")]
