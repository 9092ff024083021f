"""The paper: computed findings and all tables, set as one PDF and LaTeX that lose nothing of it."""

from __future__ import annotations

import re
import shutil
import string
from dataclasses import replace
from pathlib import Path

import pytest
from builders import reports

from taylor_verify.cli import main
from taylor_verify.words.markdown import prose, table
from taylor_verify_reports.studies import bulk
from taylor_verify_reports.studies.paper import pack
from taylor_verify_reports.studies.paper import paper_findings as findings
from taylor_verify_reports.studies.paper.sources import Sources, read
from taylor_verify_reports.typesetting.paper import formulas, images, latex, latex_table, pdf

TEXT = (Path(pack.__file__).parent / "text.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def sources() -> Sources:
    published = read(reports.for_paper())
    numbers = published.trades.numbers
    # So that a rival leaves the digits that the paper asks for.
    points = tuple(replace(p, error=1e-3 * p.error if p.error else None) for p in numbers.points)
    trades = replace(published.trades, numbers=replace(numbers, points=points))
    return replace(published, trades=trades)


@pytest.fixture(scope="module")
def made() -> pack.Pack:
    return pack.pack(reports.for_paper())


# The findings.


def test_no_number_of_the_abstract_is_typed() -> None:
    """The abstract has marks where numbers stand, and the paper begins with it."""
    abstract = TEXT[: TEXT.index("\n---\n", 4)]
    assert not re.search(r"\d", abstract)
    assert set(re.findall(r"§\{(\w+)\}", abstract)) == set(findings.FINDINGS)


def test_the_findings_are_those_of_the_rows(sources: Sources) -> None:
    """Counted anew from the documents, some of the numbers are those of the sentences."""
    passed = sum(verdict.verdict == "pass" for verdict in sources.verdicts)
    assert f"{passed} of {len(sources.verdicts)} comparisons" in findings.accuracy(sources)
    largest = max(v.ratio for v in sources.verdicts if v.ratio is not None)
    assert f"{largest:.3g} times what perfect rounding" in findings.accuracy(sources)
    assert f"Of {len(sources.controls.defects)} solvers" in findings.controls(sources)
    assert re.search(r"SciPy's DOP853, .* times as long", findings.trade(sources))


# The tables and the whole.


def test_every_table_is_named_and_shown(made: pack.Pack) -> None:
    """The text speaks of each table and each picture, which has a caption with its data and machine."""
    assert [one.name for one in made.tables] == re.findall(r"§\{tabular:(\w+)\}", TEXT)
    assert [f"table:{one.name}" for one in made.tables] == sorted(
        set(re.findall(r"§\{(table:\w+)\}", TEXT)),
        key=[f"table:{one.name}" for one in made.tables].index,
    )
    assert len(re.findall(r"§\{picture:\w+\}", TEXT)) == len(made.pictures)
    for one in made.tables:
        assert one.rows
        assert one.markdown in made.text
        assert re.search(r"Data: `data/[\w-]+\.json`.* Machine: .+\.$", one.caption.markdown)
    assert "§" not in made.text


@pytest.mark.slow
def test_the_pack_is_whole_and_the_same_every_time(tmp_path: Path) -> None:
    """PDF, LaTeX, tables and pictures are written and no longer missing; a second run changes nothing."""
    place = tmp_path / "report"
    shutil.copytree(reports.for_paper(), place)
    assert f"{pack.FOLDER}/{pack.PDF}" in bulk.missing(place, {}).renderings
    assert main(["publish", "--paper", "--from", str(place)]) == 0
    files = {file.name: file.read_bytes() for file in (place / pack.FOLDER).iterdir()}
    made = pack.pack(place)
    alone = {f"{one.name}{ending}" for one in made.tables for ending in (".tex", ".csv")}
    drawn = {f"{one.stem}.pdf" for one in made.pictures}
    assert set(files) == {pack.PDF, pack.LATEX, *alone, *drawn}
    assert bulk.missing(place, {}).renderings == ()
    assert all(name in files[pack.LATEX].decode() for name in drawn)
    assert len(images(made.text, made.citation, place / pack.FOLDER)) <= 12
    assert main(["publish", "--paper", "--from", str(place)]) == 0
    assert {file.name: file.read_bytes() for file in (place / pack.FOLDER).iterdir()} == files


def test_a_report_without_a_study_has_no_paper(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """One message names all missing studies, the exit status is 2, and nothing is written."""
    reports.write_runs(tmp_path, [("euler/rest", "f64")])
    before = sorted(tmp_path.rglob("*"))
    assert main(["publish", "--paper", "--from", str(tmp_path)]) == 2
    errors = capsys.readouterr().err
    assert "expected what `publish controls engines hard tradeoff` writes" in errors
    assert [file for file in sorted(tmp_path.rglob("*")) if file not in before] == []
    assert bulk.missing(tmp_path, {}).renderings == ()


# Setting

# Signs that look like others are what it is about.
HOSTILE = "a_b^c 50% #1 {x} \\y ~z & \"q\" 'r' <b> |v| $w$ @p * ` é – ²"  # noqa: RUF001
TABLE = table(["sign", "number:"], [[prose(HOSTILE), "**2.5e-14**"], ["b", "1e3 →"]])
HEAD = "---\nsubtitle: a subtitle\nabstract: |\n  An abstract.\n---\n\n"
MARKDOWN = f"{HEAD}# First\n\nWords.\n\n{TABLE}\n\n: A caption.\n"


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
    text = latex(MARKDOWN, citation)
    assert r"\title{A \& B: a subtitle}" in text
    assert r"\author{The group \and Ada Byron}" in text
    assert r"\date{Version 1.2}" in text
    assert "\\begin{abstract}\nAn abstract.\n\\end{abstract}" in text
    assert text.count(r"\begin{") == text.count(r"\end{")


def test_a_pdf_is_the_same_every_time(citation: Path, tmp_path: Path) -> None:
    """No time is in it, and no font of this machine."""
    made = pdf(MARKDOWN, citation, tmp_path)
    assert made.startswith(b"%PDF")
    assert made == pdf(MARKDOWN, citation, tmp_path)
    fonts = set(re.findall(rb"/FontName /[A-Z]+\+([A-Za-z]+)", made))
    assert fonts <= {b"NewCM", b"NewCMMath", b"DejaVuSansMono"}
