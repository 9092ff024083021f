"""Findings about engines: each script is a short report, and the page of the board lists it."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from taylor_verify_reports.studies.engines.findings import FOLDER, PARTS, findings, read, scripts

REPORTS = Path(__file__).resolve().parents[3] / "reports"
SCRIPTS = scripts(REPORTS)


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.stem)
def test_a_script_is_a_report(script: Path) -> None:
    """A script has title, versions, expectation, finding and evidence, and at most 60 lines in all."""
    report = read(script)
    assert report.title
    assert set(report.parts) - {"To run"} == set(PARTS)
    assert re.search(r"\d+\.\d+", report.parts["Versions"])
    lines = script.read_text(encoding="utf-8").splitlines()
    assert len(lines) <= 60


def test_the_readme_has_a_row_for_every_script() -> None:
    """The table of the README has exactly the scripts with their titles, in alphabetical order."""
    text = (REPORTS / FOLDER / "README.md").read_text(encoding="utf-8")
    rows = [line for line in text.splitlines() if line.startswith("| [")]
    assert rows == [f"| [{one.name}]({one.name}) | {read(one).title} |" for one in SCRIPTS]


def test_the_page_lists_every_script() -> None:
    """The page of the board has a line for each script, with its finding and versions."""
    page = "\n".join(findings(REPORTS))
    assert all(f"../{FOLDER}/{script.name})" in page for script in SCRIPTS)
    assert len(SCRIPTS) >= 3


def test_a_script_without_a_part_is_named(tmp_path: Path) -> None:
    """The fault has the parts that lack, and the file."""
    file = tmp_path / "it.py"
    file.write_text('"""A title.\n\nVersions: 1.0.\n\nCame: 2.\n"""\n', encoding="utf-8")
    with pytest.raises(ValueError, match=r"paragraphs Expected, Evidence, got none @ it\.py"):
        read(file)
