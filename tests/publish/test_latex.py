"""The pages in LaTeX and HTML say what their Markdown says, and no cell of a table is lost."""

from __future__ import annotations

import re
import string
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import pytest
from builders import reports
from builders.pages import html_has_the_cells, latex_has_the_rows, links_lead_somewhere, page_in
from builders.verdicts import MIXED, RECORD

from taylor_verify.cli import main
from taylor_verify.publish.markdown import code, prose, table
from taylor_verify.publish.paper import HTML, LATEX, MAKERS, Page, html, latex
from taylor_verify.studies import paper as files
from taylor_verify.studies.report import publish, write

# Of all pages these have nothing but measured times, or the measurement of every trap.
MADE = [path for path in files.PAGES if path not in ("tables/prices.md", "tables/traps.md")]
# What LaTeX writes a special sign as, read backwards.
WRITTEN = {
    **{f"\\{sign}": sign for sign in "#$%&_{}"},
    **{r"\ ": " ", "{[}": "[", "{]}": "]", r"-\/": "-", r"\^": "^", r"\textbackslash": "\\"},
    **{r"\textasciitilde": "~", r"\textless": "<", r"\textgreater": ">", r"\textbar": "|"},
    **{r"\textasciigrave": "`", r"\textquotesingle": "'", "\N{RIGHT SINGLE QUOTATION MARK}": "'"},
}
MACRO = re.compile(f"({'|'.join(map(re.escape, WRITTEN))})(?:(?<=[a-z^]){{}}|(?<=[a-z]) )?")


def page_of(text: str, path: str = "tables/mine.md") -> Page:
    return Page(path, f"# Mine\n\n{text}\n")


def body(text: str) -> str:
    """The LaTeX of a text, below its title."""
    (inner,) = re.findall(
        r"\\label\{mine\}\n\n(.*)\n\n\\end\{document\}", latex(page_of(text)), re.S
    )
    return inner


# Signs.


def read_back(written: str) -> str:
    """Undo the escaping of ASCII as pdflatex does: every macro its sign, every other sign itself."""
    assert not set(MACRO.sub("", written)) & set("#$%&_{}\\~^")
    return MACRO.sub(lambda found: WRITTEN[found[1]], written)


@pytest.mark.parametrize("between", ["", "a", " "])
def test_every_ascii_sign_survives(between: str) -> None:
    """Words and code, escaped and read back, are the same; no special sign is left bare."""
    text = between.join(("--", *string.punctuation, "z"))
    assert read_back(body(prose(text))) == text
    # Markdown has no way to write these three in a span of code outside a table.
    text = " ".join(re.sub(r"[\\`|]", "", text).split())
    (spans,) = re.findall(r"\\texttt\{(.*)\}", body(code(text)))
    assert read_back(spans.replace(r"}\allowbreak{}\texttt{", "")) == text


def test_a_sign_without_a_macro_is_seen_to_be_missing() -> None:
    """It is no error and does not vanish: its code point stands in its place."""
    assert body("a\N{SNOWMAN}b") == "a{[}U+2603{]}b"
    assert body("½ ω ≤ é `ω`") == r"½ \(\omega\) \(\leq\) é \(\omega\)"


@pytest.mark.parametrize(
    ("statement", "expected"),
    [
        (r"a_1 = b", r"\(a_1 = b\)"),
        (r"\text{for } M = 0 \text{ it holds}", r"for \(M = 0\) it holds"),
        (r"y_3 = \text{constant}", r"\(y_3 =\) constant"),
        (r"\sqrt{\text{x}}", r"\(\sqrt{\text{x}}\)"),
        (r"\text{a {b} c}d", r"a \{b\} c\(d\)"),
        (r"\frac12 \{ x \}", r"\(\displaystyle \frac12 \{ x \}\)"),
    ],
)
def test_words_of_a_formula_can_break(statement: str, expected: str) -> None:
    """What a formula says in words outside every brace is words; the rest stays mathematics."""
    assert re.sub(" +", " ", body(f"$`{statement}`$")) == expected


def test_a_formula_that_is_none_is_refused() -> None:
    """Which one it is, and on which page, is said."""
    with pytest.raises(ValueError, match=r"(?s)frac12 \^ \^.* @ tables/mine\.md"):
        html(page_of(r"$`\frac12 ^ ^`$"), [])


# Blocks.


def test_the_kinds_of_a_page_have_their_kinds_in_latex() -> None:
    """Headings, lists, emphasis, code, links, mathematics and code blocks."""
    text = body(
        "## A `b_c`\n\n- *one* and **two**\n- [three](https://x.org/a_b#c), [four](gates.md)\n\n"
        "1. first\n\n```python\nx = a_b  # 5 %\n```\n\n> said\n\n$`x^2`$ | 1 < 2"
    )
    for part in (
        r"{A \texttt{b\_}\allowbreak{}\texttt{c}}",
        "\\item\n  \\emph{one} and \\textbf{two}",
        r"\href{https://x.org/a_b\#c}{three}, four",
        "\\begin{enumerate}",
        "\\item\n  first",
        "\\begin{verbatim}\nx = a_b  # 5 %\n\\end{verbatim}",
        "\\begin{quote}\nsaid",
        r"\(x^2\) \textbar{} 1 \textless{} 2",
    ):
        assert part in text


def test_a_failure_stands_out_in_every_rendering() -> None:
    """A cell whose verdict is fail is bold in LaTeX and in HTML."""
    page = page_of("| scene | verdict |\n| --- | --- |\n| `a/b` | **fail** |")
    assert r"\texttt{a/}\allowbreak{}\texttt{b} & \textbf{fail} \\" in latex(page)
    assert "<td><strong>fail</strong></td>" in html(page, [])


@pytest.mark.parametrize("text", ["<b>bold</b>", "a <img src=x> b", "<div>\nx\n</div>"])
def test_html_in_a_page_is_refused(text: str) -> None:
    """It would be lost in LaTeX; a comment, which nobody sees anyway, is not."""
    with pytest.raises(ValueError, match=r"(?s)expected no HTML, got .* @ tables/mine\.md"):
        latex(page_of(text))
    assert "secret" not in latex(page_of("<!-- secret -->"))


def test_a_picture_is_the_pdf_beside_the_svg() -> None:
    """LaTeX takes the PDF where there is one, and HTML the SVG with what it shows in words."""
    page = page_of("![a *b*](../figures/c.svg)")
    assert r"\IfFileExists{../figures/c.pdf}" in latex(page)
    assert '<img src="../figures/c.svg" alt="a b"' in html(page, [])


# Tables.


class Layout(NamedTuple):
    """A printed table: whether its page is turned, the size of its type, the widths as parts of a page."""

    turned: bool
    size: float
    widths: list[float]


def layouts(*tables: tuple[int, str]) -> list[Layout]:
    """The layouts of tables, each of so many columns with equal cells; numbers stand to the right."""
    pages = [
        table([f"c{i}" + ":" * cell[:1].isdigit() for i in range(columns)], [[cell] * columns] * 2)
        for columns, cell in tables
    ]
    _, *parts = re.split(r"(?=\\fontsize)", body("\n\nwords\n\n".join(["## First", *pages])))
    return [
        Layout(
            r"\end{landscape}" in part,
            float(re.findall(r"\\fontsize\{([\d.]+)\}", part)[0]),
            [float(width) for width in re.findall(r"\\real\{([\d.]+)\}", part)],
        )
        for part in parts
    ]


@pytest.mark.parametrize("cell", ["1.5", "1.23e-45, 6.78e-9 @ 11", "word " * 40, "a" * 30, ""])
def test_a_table_is_as_wide_as_its_page_at_most(cell: str) -> None:
    """However many columns there are and however long their cells, all stand beside each other."""
    counts = (2, 5, 9, 22, 40)
    for columns, layout in zip(counts, layouts(*((n, cell) for n in counts)), strict=True):
        assert len(layout.widths) == columns
        assert min(layout.widths) > 0
        assert sum(round(1e4 * width) for width in layout.widths) <= 1e4
        assert 0 < layout.size <= 8


def test_a_table_is_turned_only_where_it_must_be() -> None:
    """Narrow tables and long words stand upright in the larger type; many numbers are turned."""
    few, words, many, most = layouts(
        (5, "1.5"), (3, "word " * 90), (16, "1.2345e-67"), (40, "1.2345e-67")
    )
    assert few[:2] == words[:2] == (False, 8)
    assert many.turned
    assert most.turned
    assert most.size < 7


def test_a_heading_goes_with_its_turned_table() -> None:
    """It would stand alone on the page before."""
    wide = table([f"c{i}:" for i in range(16)], [["1.2345e-67"] * 16])
    text = body(f"## Wide\n\n{wide}")
    assert text.index(r"\begin{landscape}") < text.index("Wide") < text.index(r"\begin{longtable}")


# Whole pages.


@pytest.fixture(scope="module")
def rendered() -> dict[str, str]:
    return files.renderings(reports.small())


@pytest.mark.parametrize("path", MADE)
def test_html_has_the_cells_of_the_page(path: str, rendered: Mapping[str, str]) -> None:
    """Every table, row and cell of the Markdown stands in the HTML, whose elements all close."""
    html_has_the_cells(page_in(reports.small(), path), rendered)


@pytest.mark.parametrize("path", MADE)
def test_latex_has_the_rows_of_the_page(path: str, rendered: Mapping[str, str]) -> None:
    """No row or number of a table is lost; no sign is without its macro."""
    latex_has_the_rows(page_in(reports.small(), path), rendered)


def test_every_link_leads_somewhere(rendered: Mapping[str, str]) -> None:
    """Links and pictures of the HTML lead to renderings, or to files that are there."""
    links_lead_somewhere(reports.small(), rendered)


def test_the_paper_has_every_page_once(rendered: Mapping[str, str]) -> None:
    """paper.tex reads in the file of each page, in the order of the list, and nothing else."""
    stems = re.findall(r"\\input\{([^}]*)\}", rendered["tables/paper.tex"])
    assert stems == [Path(path).stem for path in MADE]
    assert {f"tables/{stem}.tex" for stem in stems} < set(rendered)


# Files.


def test_the_command_renders_what_is_there(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Renderings of pages that are gone go too; other people's files stay, and a second run is the same."""
    write(tmp_path, MIXED, [RECORD])
    publish(tmp_path)
    tables = tmp_path / "tables"
    (tables / "old.tex").write_text(f"{MAKERS[LATEX]}\n", encoding="utf-8")
    (tables / "old.html").write_text(f"{MAKERS[HTML]}\n", encoding="utf-8")
    (tables / "mine.tex").write_text("mine\n", encoding="utf-8")
    assert main(["publish", "--paper", "--from", str(tmp_path)]) == 0
    written = {Path(line).name for line in capsys.readouterr().out.split()}
    stems = ("README", "accuracy", "attainable", "conserved")
    assert written == {"paper.tex", *(f"{s}{end}" for s in stems for end in (".tex", ".html"))}
    there = {file.name for file in tables.iterdir() if file.suffix in (".tex", ".html")}
    assert there == {*written, "mine.tex"}
    before = {file: file.read_bytes() for file in tables.iterdir()}
    assert main(["publish", "--paper", "--from", str(tmp_path)]) == 0
    assert {file: file.read_bytes() for file in tables.iterdir()} == before


def test_a_folder_without_pages_has_no_renderings(tmp_path: Path) -> None:
    """There is no empty paper."""
    assert files.renderings(tmp_path) == {}
