"""The pages in LaTeX and HTML say what their Markdown says, and no cell of a table is lost."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

import pytest
from builders import reports
from builders.pages import html_has_the_cells, latex_has_the_rows, links_lead_somewhere, page_in
from builders.verdicts import MIXED, RECORD
from hypothesis import given, settings
from hypothesis import strategies as st

from taylor_verify.cli import main
from taylor_verify.publish.paper import html, latex, latex_table, latex_text
from taylor_verify.publish.paper.latex_table import TURNED, UPRIGHT, Cell, Table
from taylor_verify.publish.paper.parsed import Page
from taylor_verify.studies import paper as files
from taylor_verify.studies.report import publish, write

# Of all pages these have nothing but measured times, or the measurement of every trap.
MADE = [path for path in files.PAGES if path not in ("tables/prices.md", "tables/traps.md")]
# What a sign is written as, read backwards; the longest first.
WRITTEN = {macro: sign for sign, macro in latex_text._SPECIAL.items()}


def page_of(text: str, path: str = "tables/mine.md") -> Page:
    return Page(path, f"# Mine\n\n{text}\n")


def body(text: str) -> str:
    """The LaTeX of a text, below its title."""
    return latex.blocks(page_of(text)).removeprefix("\\section{Mine}\n\n")


# Signs.


def read_back(written: str) -> str:
    """Undo the escaping of ASCII as pdflatex does: every macro its sign, every other sign itself."""
    pattern = "|".join(re.escape(macro) for macro in sorted(WRITTEN, key=len, reverse=True))
    return re.sub(pattern, lambda found: WRITTEN[found[0]], written.replace("-{}-", "--"))


@given(st.text(st.characters(min_codepoint=0x20, max_codepoint=0x7E)))
def test_every_ascii_sign_survives(text: str) -> None:
    """Words and code, escaped and read back, are the same; no special sign is left bare."""
    assert read_back(latex_text.prose(text)) == text
    written = latex_text.code(text)
    assert read_back(written.removeprefix(r"\texttt{").removesuffix("}")) == text
    bare = re.sub(r"\\(text[a-z]+\{\}|[#$%&_{}])", "", latex_text.prose(text))
    assert not set(bare) & set("#$%&_{}\\~^")


def test_a_sign_without_a_macro_is_seen_to_be_missing() -> None:
    """It is no error and does not vanish: its code point stands in its place."""
    assert latex_text.prose("a\N{SNOWMAN}b") == "a[U+2603]b"
    assert latex_text.prose("½ ω ≤ é") == r"\(\frac12\) \(\omega\) \(\leq\) é"


@pytest.mark.parametrize(
    ("statement", "expected"),
    [
        (r"a_1 = b", "$a_1 = b$"),
        (r"\text{for } M = 0 \text{ it holds}", "for $M = 0$  it holds"),
        (r"y_3 = \text{constant}", "$y_3 =$ constant"),
        (r"\sqrt{\text{x}}", r"$\sqrt{\text{x}}$"),
        (r"\text{a {b} c}d", "a {b} c$d$"),
        (r"\frac12 \{ x \}", r"$\displaystyle \frac12 \{ x \}$"),
    ],
)
def test_words_of_a_formula_can_break(statement: str, expected: str) -> None:
    """Words of a formula outside every brace become words; the rest stays mathematics."""
    assert latex_text.formula(statement) == expected


def test_a_formula_whose_words_do_not_end_is_refused() -> None:
    """The refusal names the formula."""
    with pytest.raises(ValueError, match=r"closing brace, got none @ \\text\{for"):
        latex_text.formula(r"\text{for M")


# Blocks.


def test_the_kinds_of_a_page_have_their_kinds_in_latex() -> None:
    """Headings, lists, emphasis, code, links, mathematics and code blocks."""
    text = body(
        "## A `b_c`\n\n- *one* and **two**\n- [three](https://x.org/a_b#c), [four](gates.md)\n\n"
        "1. first\n\n```python\nx = a_b  # 5 %\n```\n\n> said\n\n$`x^2`$ | 1 < 2"
    )
    for part in (
        r"\subsection{A \texttt{b\_\allowbreak{}c}}",
        r"\item \emph{one} and \textbf{two}",
        r"\href{https://x.org/a\_b\#c}{three}, four",
        "\\begin{enumerate}\n\\item first",
        "\\begin{verbatim}\nx = a_b  # 5 %\n\\end{verbatim}",
        "\\begin{quote}\nsaid",
        r"$x^2$ \textbar{} 1 \textless{} 2",
    ):
        assert part in text


def test_a_failure_stands_out_in_every_rendering() -> None:
    """A cell whose verdict is fail is bold in LaTeX and in HTML."""
    page = page_of("| scene | verdict |\n| --- | --- |\n| `a/b` | **fail** |")
    assert r"\texttt{a/b} & \textbf{fail} \\" in latex.document(page).replace(r"\allowbreak{}", "")
    assert "<td><strong>fail</strong></td>" in html.html(page, [])


@pytest.mark.parametrize("text", ["<b>bold</b>", "a <img src=x> b", "<div>\nx\n</div>"])
def test_html_in_a_page_is_refused(text: str) -> None:
    """It would be lost in LaTeX; a comment, which nobody sees anyway, is not."""
    with pytest.raises(ValueError, match=r"expected no HTML, got .* @ tables/mine\.md"):
        latex.document(page_of(text))
    assert "secret" not in latex.document(page_of("<!-- secret -->"))


def test_a_picture_is_the_pdf_beside_the_svg() -> None:
    """LaTeX takes the PDF, and HTML the SVG with what it shows in words."""
    page = page_of("![a *b*](../figures/c.svg)")
    assert r"\shown{../figures/c.pdf}" in latex.document(page)
    assert '<img src="../figures/c.svg" alt="a b"' in html.html(page, [])


# Tables.


WORDS = st.text("abcdefgh ", max_size=60)
CELLS = st.builds(lambda words, spans: Cell(f"{words}{spans}", words, spans), WORDS, WORDS)


@st.composite
def tables(draw: st.DrawFn) -> Table:
    """A table whose first column names a row by its number; its cells are words of any length."""
    columns, rows = draw(st.integers(2, 9)), draw(st.integers(0, 4))
    to_right = (False, *(draw(st.booleans()) for _ in range(columns - 1)))
    heads = tuple(Cell(f"h{i}", f"h{i}") for i in range(columns))
    lines = [
        (Cell(f"row{r}", f"row{r}"), *(draw(CELLS) for _ in range(columns - 1)))
        for r in range(rows)
    ]
    return Table(heads, to_right, tuple(lines))


@given(tables())
@settings(max_examples=60)
def test_no_cell_is_lost(table: Table) -> None:
    """However a table is laid out, each cell that says something stands in a row with its name."""
    found = {
        (row[0].latex, head.latex): cell.latex
        for layout in latex_table.laid_out(table)
        for row in layout.table.rows
        for head, cell in zip(layout.table.heads, row, strict=True)
    }
    for row in table.rows:
        for head, cell in zip(table.heads, row, strict=True):
            if cell.latex not in ("", "--"):
                assert found[row[0].latex, head.latex] == cell.latex


@given(tables())
@settings(max_examples=60)
def test_a_layout_is_as_wide_as_its_page_at_most(table: Table) -> None:
    """The columns as they come and those of a given width fit together, or there is one beside its name."""
    for layout in latex_table.laid_out(table):
        natural = layout.table.natural(layout.size)
        widths = [n if w is None else w for n, w in zip(natural, layout.widths, strict=True)]
        room = TURNED if layout.turned else UPRIGHT
        fits = latex_table._total(widths) <= room + len(widths)
        keys = layout.table.to_right.index(True) if True in layout.table.to_right else 1
        assert fits or len(widths) == keys + 1


def test_a_table_that_is_cut_keeps_the_rows_that_have_something() -> None:
    """Columns that are nearly empty come last, with the rows that are in them and no others."""
    wide = "x" * 60
    heads = tuple(Cell(name, name) for name in ("scene", "full", "sparse", "also full", "word"))
    rows = tuple(
        (
            *(Cell(f"s{r}", f"s{r}"), Cell(wide, wide)),
            Cell(wide, wide) if r == 3 else Cell("--", "-"),
            *(Cell(wide, wide), Cell("pass", "pass")),
        )
        for r in range(5)
    )
    first, second = latex_table.laid_out(Table(heads, (False, True, True, True, True), rows))
    assert [head.latex for head in first.table.heads] == ["scene", "full", "also full", "word"]
    assert len(first.table.rows) == 5
    assert [head.latex for head in second.table.heads] == ["scene", "sparse"]
    assert [row[0].latex for row in second.table.rows] == ["s3"]


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
    """No row of a table is lost, a cut one may have more of them; no sign is without its macro."""
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
    (tables / "old.tex").write_text(f"{latex.MAKER}\n", encoding="utf-8")
    (tables / "old.html").write_text(f"{html.MAKER}\n", encoding="utf-8")
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
