"""Damaged records: no page is made of verdicts that no run has written, and edited ones say so."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from builders.verdicts import MIXED, RECORD

from taylor_verify.batch.earlier_file import read_report
from taylor_verify.cli import main
from taylor_verify.records import store
from taylor_verify.scenes.reading.reader import load
from taylor_verify_reports.studies.site import pages
from taylor_verify_reports.studies.source import Report

Captured = pytest.CaptureFixture[str]
Rows = list[dict[str, Any]]


@pytest.fixture
def report(tmp_path: Path) -> Path:
    store.write(tmp_path, MIXED, [RECORD])
    return tmp_path


def edit(report: Path, change: Callable[[Rows], object]) -> None:
    file = report / "data" / store.VERDICTS
    stored = json.loads(file.read_text())
    change(stored["verdicts"])
    file.write_text(store.laid_out(stored))


def published(report: Path, capsys: Captured, *options: str) -> tuple[int, str]:
    status = main(["publish", "--from", str(report), *options])
    return status, capsys.readouterr().err


def each(**fields: Any) -> Callable[[Rows], object]:
    return lambda rows: [row.update(fields) for row in rows]


def larger(rows: Rows) -> None:
    for row in rows:
        row["max"] = 1e9 * row["max"] if row.get("max") else None


# What is done to the rows, and the place of the fault that they themselves show, where they show one.
DAMAGES: dict[str, tuple[Callable[[Rows], object], str]] = {
    "negative": (
        each(max=-1),
        "expected a number that is not negative, got -1.0 @ verdicts[0].max",
    ),
    "above the bound": (larger, "of a row that passed, got"),
    "no number": (each(max=None), "expected a number of a row that passed, got null @ verdicts["),
    "twice": (lambda rows: rows.extend(rows[:]), "expected every row once, got more of"),
    "no key": (
        lambda rows: rows[1].pop("outcome"),
        "expected a key outcome, got none @ verdicts[1]",
    ),
    "a word": (each(max="x"), "expected a number or null, got 'x' @ verdicts[0].max"),
    "many digits": (each(max=10**4000), "got "),
    "one row less": (lambda rows: rows.pop(), ""),
    "no rows": (lambda rows: rows.clear(), "expected rows of a run, got none @ verdicts"),
    "another solver": (each(solver="mine"), "expected a run with its time in timings.json, got"),
    "another scene": (
        each(scene="euler/none"),
        "expected the digest of the scene's text, got none",
    ),
    "no precision": (each(rung="f63"), "expected a precision (f32 f64 f80 f128 mpN), got 'f63'"),
    "a mean above all": (each(mean=1e9), "expected no more than the largest error"),
}


@pytest.mark.parametrize("damage", DAMAGES)
def test_damaged_verdicts_are_refused(damage: str, report: Path, capsys: Captured) -> None:
    """The sum refuses all damage, in one line; what no run can have written is refused even as edited."""
    change, fault = DAMAGES[damage]
    edit(report, change)
    status, message = published(report, capsys)
    assert (status, message.count("\n")) == (2, 1)
    assert "expected the verdicts that a run has written" in message
    status, message = published(report, capsys, "--edited")
    assert status == (2 if fault else 0)
    assert fault in message
    assert "Error" not in message
    assert "sys." not in message


def test_a_scene_renamed_in_all_files_is_refused(report: Path, capsys: Captured) -> None:
    """The digest of a shipped scene names it, whatever the sums say; a file may be a copy of it."""
    rows = [verdict for verdict in MIXED if verdict.scene == "euler/generic"]
    for name, status in (("euler/soyuz", 2), ("copy.toml", 0)):
        provenance = {**rows[0].provenance, "scene": load("euler/apollo").digest}
        renamed = [replace(row, scene=name, provenance=provenance) for row in rows]
        store.write(report, renamed, [])
        done, message = published(report, capsys)
        assert done == status
        assert ("expected the scene euler/apollo" in message) is bool(status)


@pytest.mark.parametrize("is_deleted", [False, True])
def test_verdicts_without_their_sum_are_edited(
    is_deleted: bool, report: Path, capsys: Captured
) -> None:
    """A sum that was deleted says as little as a wrong one."""
    file = report / "data" / store.SUM
    file.unlink() if is_deleted else file.write_text("")
    status, message = published(report, capsys)
    assert (status, message.count("\n")) == (2, 1)
    assert "expected the verdicts that a run has written" in message
    assert read_report(report).edited is (None if is_deleted else True)
    assert published(report, capsys, "--edited")[0] == 0


def test_every_page_of_edited_verdicts_says_so(report: Path, capsys: Captured) -> None:
    """Below its title, and only as long as the verdicts are others than a run has written."""
    edit(report, lambda rows: rows.pop())
    assert published(report, capsys, "--edited")[0] == 0
    pages = [report / "README.md", *(report / "tables").glob("*.md")]
    assert all("**These numbers were edited**" in page.read_text() for page in pages)
    store.write(report, MIXED, [RECORD])
    assert published(report, capsys, "--edited")[0] == 0
    assert not any("edited**" in page.read_text() for page in pages)


def test_no_bit_of_the_verdicts_can_be_flipped(report: Path, capsys: Captured) -> None:
    """Every bit counts: the sum is that of the bytes."""
    file = report / "data" / store.VERDICTS
    content = file.read_bytes()
    for bit in range(0, 8 * len(content), len(content) // 5):
        flipped = bytearray(content)
        flipped[bit // 8] ^= 1 << bit % 8
        file.write_bytes(flipped)
        assert published(report, capsys)[0] == 2


@pytest.mark.parametrize("name", [store.VERDICTS, store.TIMINGS, store.SUM])
def test_a_fifo_among_the_records_is_never_opened(
    name: str, report: Path, capsys: Captured
) -> None:
    """It would be read for ever; a device likewise."""
    file = report / "data" / name
    file.unlink()
    os.mkfifo(file)
    status, message = published(report, capsys)
    assert status == 2
    assert "expected a stored document, got a FIFO" in message


def test_the_site_lists_the_scenes_of_any_solver(tmp_path: Path) -> None:
    """Runs of another solver than ours, all failed or not, are the runs of their scene."""
    store.write(tmp_path, [replace(verdict, solver="mine") for verdict in MIXED], [])
    text = pages._scenes(Report(tmp_path))
    assert all(f"`{verdict.scene}`" in text for verdict in MIXED)
