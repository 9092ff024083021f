"""What the pages are in LaTeX pdflatex compiles as it is, and nothing runs off a page."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest
from test_publish import MIXED, RECORD

from taylor_verify.publish.markdown import Column, code, prose, table
from taylor_verify.publish.paper import Page, latex
from taylor_verify.studies import paper as files
from taylor_verify.studies.report import publish, write


def compiled(folder: Path, name: str, out: Path) -> str:
    """What pdflatex says the second time, when the contents of a paper are known."""
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


# Signs that look like others are what it is about.
HOSTILE = "a_b^c 50% #1 {x} \\y ~z & \"q\" 'r' <b> |v| $w$ – × ≤ ½ ω ′ → ‖ é"  # noqa: RUF001


def test_pdflatex_takes_a_page_of_everything(tmp_path: Path) -> None:
    """Failures, long reasons, hostile signs, a wide table: it compiles, and nothing runs off the page."""
    columns = [Column("scene"), *(Column(f"c{i}", True) for i in range(20)), Column("because")]
    rows = [[code("kirchhoff/a_b"), *("1.23e-45, 6.78e-9 @ 1011.01",) * 20, prose(HOSTILE * 9)]] * 3
    text = "\n\n".join(
        [
            f"# {prose(HOSTILE)}",
            prose(HOSTILE),
            code(HOSTILE.replace("\\", "")),
            "**fail** $`\\frac{a}{b} \\text{ and } \\sqrt{c}`$",
            table(columns, rows),
            table([Column("one")], [[prose("word " * 60)]]),
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
