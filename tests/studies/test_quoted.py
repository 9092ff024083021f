"""Published numbers that pages quote are made again with what they are quoted from, and nothing else is."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from builders.verdicts import passed

from taylor_verify_reports.studies.accuracy import quoted
from taylor_verify_reports.studies.accuracy.quoted import BEGIN, END

RUNGS = ("f32", "f64", "f80", "f128", "mp237")
VERDICTS = [
    replace(passed(scene, "f64", quantity), rung=rung)
    for scene, quantity in (("euler/generic", "omega"), ("kirchhoff/whole-motion", "centre"))
    for rung in RUNGS
]
PAGE = f"before\n\n{BEGIN}\n\nstale\n\n{END}\n\nafter\n"


def test_a_quoted_block_is_made_again(tmp_path: Path) -> None:
    """The block between its marks is made again from the verdicts; other text stays."""
    (tmp_path / "README.md").write_text(PAGE)
    (text,) = quoted.requoted(tmp_path / "reports", VERDICTS).values()
    assert text == PAGE.replace(f"{BEGIN}\n\nstale\n\n{END}", quoted.accuracy(VERDICTS))
    assert text.count("3 u (0.5)") == len(VERDICTS)
    assert "stale" not in text


def test_a_page_without_marks_is_left_alone(tmp_path: Path) -> None:
    """Somebody's own README beside a report is not touched."""
    (tmp_path / "README.md").write_text("mine")
    assert quoted.requoted(tmp_path / "reports", VERDICTS) == {}


def test_another_folder_is_not_quoted(tmp_path: Path) -> None:
    """A run written beside the published folder changes no page."""
    (tmp_path / "README.md").write_text(PAGE)
    assert quoted.requoted(tmp_path / "local", VERDICTS) == {}


def test_a_block_without_its_end_is_refused(tmp_path: Path) -> None:
    """A page that lost the second mark would lose all that follows."""
    (tmp_path / "README.md").write_text(PAGE.replace(END, ""))
    with pytest.raises(ValueError, match="expected <!-- end of accuracy -->"):
        quoted.requoted(tmp_path / "reports", VERDICTS)
