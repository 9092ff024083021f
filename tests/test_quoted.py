"""Published numbers that pages quote are made again with what they are quoted from, and nothing else is."""

from __future__ import annotations

from pathlib import Path

import pytest

from taylor_verify.publish import quoted, report
from taylor_verify.publish.quoted import BEGIN, END

REPORTS = Path(__file__).resolve().parents[1] / "reports"
PAGE = f"before\n\n{BEGIN}\n\nstale\n\n{END}\n\nafter\n"


def test_a_quoted_block_is_made_again(tmp_path: Path) -> None:
    """Between its marks the block is that of the verdicts; what stands around it stays."""
    (tmp_path / "README.md").write_text(PAGE)
    verdicts = report.load(REPORTS)
    (text,) = quoted.requoted(tmp_path / "reports", verdicts).values()
    assert text == PAGE.replace(f"{BEGIN}\n\nstale\n\n{END}", quoted.accuracy(verdicts))
    assert "stale" not in text


def test_a_page_without_marks_is_left_alone(tmp_path: Path) -> None:
    """Somebody's own README beside a report is not touched."""
    (tmp_path / "README.md").write_text("mine")
    assert quoted.requoted(tmp_path / "reports", report.load(REPORTS)) == {}


def test_another_folder_is_not_quoted(tmp_path: Path) -> None:
    """A run written beside the published folder changes no page."""
    (tmp_path / "README.md").write_text(PAGE)
    assert quoted.requoted(tmp_path / "local", report.load(REPORTS)) == {}


def test_a_scene_that_was_not_run_has_no_number() -> None:
    """A cell without a verdict says so, and is not left out."""
    verdicts = [v for v in report.load(REPORTS) if v.scene != "euler/generic"]
    line = next(n for n in quoted.accuracy(verdicts).splitlines() if "euler/generic" in n)
    assert line.count("no number") == 5


def test_a_block_without_its_end_is_refused(tmp_path: Path) -> None:
    """A page that lost the second mark would lose all that follows."""
    (tmp_path / "README.md").write_text(PAGE.replace(END, ""))
    with pytest.raises(ValueError, match="expected <!-- end of accuracy -->"):
        quoted.requoted(tmp_path / "reports", report.load(REPORTS))
