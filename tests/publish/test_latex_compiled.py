"""What the pages are in LaTeX pdflatex compiles as it is, and nothing runs off a page."""

from __future__ import annotations

from pathlib import Path

from builders.pages import compiled
from builders.verdicts import MIXED, RECORD

from taylor_verify.publish.markdown import code, prose, table
from taylor_verify.publish.paper import Page, latex
from taylor_verify.studies import paper as files
from taylor_verify.studies.report import publish, write

# Signs that look like others are what it is about.
HOSTILE = "a_b^c 50% #1 {x} \\y ~z & \"q\" 'r' <b> |v| $w$ – × ≤ ½ ω ′ → ‖ é"  # noqa: RUF001


def test_pdflatex_takes_a_page_of_everything(tmp_path: Path) -> None:
    """Failures, long reasons, hostile signs, a wide table: it compiles, and nothing runs off the page."""
    columns = ["scene", *(f"c{i}:" for i in range(20)), "because"]
    rows = [[code("kirchhoff/a_b"), *("1.23e-45, 6.78e-9 @ 1011.01",) * 20, prose(HOSTILE * 9)]] * 3
    text = "\n\n".join(
        [
            f"# {prose(HOSTILE)}",
            prose(HOSTILE),
            code(HOSTILE.replace("\\", "")),
            "**fail** $`\\frac{a}{b} \\text{ and } \\sqrt{c}`$",
            table(columns, rows),
            table(["one"], [[prose("word " * 60)]]),
            "```\nplain $ % & # _ { } \\\n```",
            "- a\n- b\n\n1. c",
        ]
    )
    (tmp_path / "all.tex").write_text(latex(Page("tables/all.md", text)), "utf-8")
    assert "Overfull" not in compiled(tmp_path, "all.tex", tmp_path)


def test_pdflatex_takes_a_report_with_failures(tmp_path: Path) -> None:
    """The paper of a run with every kind of verdict compiles, all its pages in it."""
    write(tmp_path, MIXED, [RECORD])
    publish(tmp_path)
    files.write(tmp_path)
    assert "Overfull" not in compiled(tmp_path / "tables", "paper.tex", tmp_path)
