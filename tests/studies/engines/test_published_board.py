"""What is published of engines: boards with their rows, and findings by script."""

from __future__ import annotations

import argparse
import re
from functools import cache
from pathlib import Path

import pytest

from taylor_verify_reports.studies.engines.document import Board, EngineRow, find
from taylor_verify_reports.studies.engines.entry import BOARDS, entry_list
from taylor_verify_reports.studies.engines.findings import FOLDER, PARTS, findings, read, scripts
from taylor_verify_reports.verbs import board as verb

REPORTS = Path(__file__).resolve().parents[3] / "reports"


@cache
def board() -> Board:
    published = find(REPORTS)
    assert published is not None
    return published


def rows() -> list[EngineRow]:
    """The rows of runs that ended with a trajectory."""
    return [row for row in board().study.rows if row.is_judged]


def test_the_first_row_of_every_trajectory_is_the_start() -> None:
    """The first row is the start to the rounding of the arithmetic, so that conventions are right.

    Orekit takes no step: it evaluates the first row like any other, and a thousandth beside the separatrix
    the motion magnifies its roundings a thousandfold.
    """
    roundoff = {"f64": 2.0**-53, "f32": 2.0**-24}
    magnified = {("outside:orekit", "engines/flip"): 1000}
    wrong = [
        row.key
        for row in rows()
        if not (row.start or 0.0)
        <= 16 * roundoff[row.rung] * magnified.get((row.solver, row.scene), 1)
    ]
    assert wrong == []


def test_no_engine_is_lost() -> None:
    """A run without a trajectory has a reason."""
    assert [row.key for row in board().study.rows if not row.is_judged and not row.detail] == []


@pytest.mark.parametrize("name", BOARDS)
def test_the_verb_shows_every_published_board(name: str) -> None:
    """A board has its advice for each job, and each row its number and the command that makes it."""
    parser = argparse.ArgumentParser()
    verb.add(parser)
    asked = parser.parse_args(["--from", str(REPORTS), "--board", name])
    (document,) = verb.run(asked).document["boards"]
    jobs = entry_list(name).jobs
    assert [job for job in jobs if not any(f"or {job} take" in a for a in document["advice"])] == []
    assert [row["row"] for row in document["rows"]] == [*range(len(document["rows"]))]
    assert all(row["command"].startswith("taylor-verify run ") for row in document["rows"])


# Findings

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
