"""A paper in Markdown becomes one PDF and one LaTeX file that lose nothing of it."""

from __future__ import annotations

import re
import string
from pathlib import Path

import pytest

from taylor_verify.words.markdown import prose, table
from taylor_verify_reports.typesetting.paper import formulas, latex, latex_table, pdf

# Signs that look like others are what it is about.
HOSTILE = "a_b^c 50% #1 {x} \\y ~z & \"q\" 'r' <b> |v| $w$ @p * ` é – ²"  # noqa: RUF001
TABLE = table(["sign", "number:"], [[prose(HOSTILE), "**2.5e-14**"], ["b", "1e3 →"]])
HEAD = "---\nsubtitle: a subtitle\nabstract: |\n  An abstract.\n---\n\n"
TEXT = f"{HEAD}# First\n\nWords.\n\n{TABLE}\n\n: A caption.\n"


@pytest.fixture
def citation(tmp_path: Path) -> Path:
    file = tmp_path / "CITATION.cff"
    file.write_text(
        'title: "A & B"\nversion: 1.2\nabstract: another\nauthors:\n  - name: "The group"\n'
        "  - given-names: Ada\n    family-names: Byron\n",
        encoding="utf-8",
    )
    return file


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("2.50e-14", r"$2.50\times 10^{-14}$"),
        ("-3e+03", r"$-3\times 10^{3}$"),
        ("1e-06", "$10^{-6}$"),
        ("1.00e3", r"$1.00\times 10^{3}$"),
        ("10 → ∞", r"10 $\to$ $\infty$"),
        ("`1e-3` tol1e-3 1e-3x 0.12", "`1e-3` tol1e-3 1e-3x 0.12"),
    ],
)
def test_powers_of_ten_are_formulas(text: str, expected: str) -> None:
    """Numbers of tables are set as they are printed in journals; names and code stay as they are."""
    assert formulas(text) == expected


def test_a_table_is_a_tabular_that_any_journal_takes() -> None:
    """The tabular has all cells, numbers to the right, and escaped special signs."""
    text = latex_table(f"{TABLE}\n\n: A caption.")
    assert r"\begin{tabular}{lr}" in text
    assert r"\caption{A caption.}" in text
    rows = re.findall(r"^(.*) & (.*) \\\\$", text, re.M)
    assert [number for _, number in rows] == [
        "number",
        r"\textbf{\(2.5\times 10^{-14}\)}",
        r"\(10^{3}\) \(\to\)",
    ]
    macros = re.compile(r"\\(?:[A-Za-z]+ ?|[#$%&_{}~^])(?:\{\})?")
    assert not set(macros.sub("", rows[1][0])) & set("#$%&_{}\\~")
    for sign in set(string.ascii_letters) & set(HOSTILE):
        assert sign in rows[1][0]


def test_title_and_authors_are_those_of_the_citation(citation: Path) -> None:
    """A group and a person are authors; the abstract is the paper's own."""
    text = latex(TEXT, citation)
    assert r"\title{A \& B: a subtitle}" in text
    assert r"\author{The group \and Ada Byron}" in text
    assert r"\date{Version 1.2}" in text
    assert "\\begin{abstract}\nAn abstract.\n\\end{abstract}" in text
    assert text.count(r"\begin{") == text.count(r"\end{")


def test_a_pdf_is_the_same_every_time(citation: Path, tmp_path: Path) -> None:
    """No time is in it, and no font of this machine."""
    made = pdf(TEXT, citation, tmp_path)
    assert made.startswith(b"%PDF")
    assert made == pdf(TEXT, citation, tmp_path)
    fonts = set(re.findall(rb"/FontName /[A-Z]+\+([A-Za-z]+)", made))
    assert fonts <= {b"NewCM", b"NewCMMath", b"DejaVuSansMono"}
