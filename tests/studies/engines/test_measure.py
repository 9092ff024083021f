"""The measurement: nothing is run twice, and nothing stops it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from shutil import rmtree
from typing import Any

import numpy as np
import pytest
from builders.studies.engines import ENTRIES, SPINNER, answers

from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.engines.launcher import NotMade
from taylor_verify_reports.studies.engines import measure as measuring
from taylor_verify_reports.studies.engines.answer import Answer, Answers, answered
from taylor_verify_reports.studies.engines.document import Standing
from taylor_verify_reports.studies.engines.entry import Asked, EntryList
from taylor_verify_reports.studies.engines.measure import measure
from taylor_verify_reports.studies.engines.replay import judged


@cache
def known() -> dict[str, Answer]:
    """The runs of the small list by their keys."""
    return {answer.row.key: answer for answer in answers()}


@pytest.fixture
def ran(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The keys of the runs that are made, in this process."""
    made: list[str] = []

    def run_all(
        work: Callable[[list[Asked]], list[Answer]], asked: list[list[Asked]], **options: Any
    ) -> list[list[Answer]]:
        results = []
        for some in asked:
            made.extend(one.key for one in some)
            results.append([known().get(one.key) or work([one])[0] for one in some])
            options["ended"](some, results[-1])
        return results

    monkeypatch.setattr(measuring, "run_all", run_all)
    return made


def test_what_is_stored_is_not_run_again(ran: list[str], tmp_path: Path) -> None:
    """Nothing is run if every answer is known, and the answers are in the order of the list."""
    measured = measure(ENTRIES, known(), Answers(tmp_path), lambda words: None)
    assert ran == []
    assert [answer.row.key for answer in measured] == [run.key for run in ENTRIES.runs()]


def test_a_measurement_goes_on_after_a_kill(ran: list[str], tmp_path: Path) -> None:
    """Finished runs are in the store and are not repeated; those of damaged files are."""
    store = Answers(tmp_path / "unfinished")
    for answer in answers()[:4]:
        store.add(answer)
    (damaged, *_) = sorted(store.folder.glob("*.json"))
    damaged.write_text("{", encoding="utf-8")
    measured = measure(ENTRIES, {}, store, lambda words: None)
    assert len(ran) == len(ENTRIES.runs()) - 3
    assert len(store.every()) == len(measured) == len(ENTRIES.runs())
    rmtree(store.folder)
    assert store.every() == {}


@pytest.mark.parametrize(
    "change",
    [
        {"made_of": "another adapter"},
        {"standing": Standing.FAILED},
        {"standing": Standing.UNAVAILABLE},
    ],
    ids=str,
)
def test_another_adapter_is_another_run(
    ran: list[str], tmp_path: Path, change: dict[str, Any]
) -> None:
    """Runs of another adapter, failed runs and runs without an environment are run again."""
    key, answer = next(iter(known().items()))
    changed = {**known(), key: replace(answer, row=replace(answer.row, **change))}
    measure(ENTRIES, changed, Answers(tmp_path), lambda words: None)
    assert ran == [key]


def test_an_engine_that_cannot_be_installed_is_no_failure(
    ran: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its rows are unavailable with the reason, its environment is tried once, and the others are run."""
    prepared: list[str] = []

    def prepare(name: str, tell: object) -> None:
        prepared.append(name)
        raise NotMade("no such package")

    monkeypatch.setattr(measuring, "prepare", prepare)
    lost = replace(SPINNER, name="lost", solver="outside:mujoco", versions=("1.0",))
    entries = EntryList(ENTRIES.scene, (*ENTRIES.entry, lost))
    measured = measure(entries, known(), Answers(tmp_path), lambda words: None)
    rows = [answer.row for answer in measured if answer.row.engine == "lost"]
    assert [row.standing for row in rows] == [Standing.UNAVAILABLE] * len(SPINNER.values)
    assert {row.detail for row in rows} == {"no such package"}
    assert prepared == ["outside:mujoco?version=1.0"]
    assert ran == []


def test_a_run_that_ends_early_is_a_row() -> None:
    """The row has failed, with the exit status; it has no trajectory and no error."""
    bad = replace(SPINNER, solver="process:false", values=())
    (answer,) = answered([next(bad.runs(ENTRIES.scene))])
    assert answer.row.standing is Standing.FAILED
    assert "exit status" in answer.row.detail
    assert (answer.states, answer.row.errors) == (None, {})


# What is stored.


def test_an_answer_reads_back_to_the_last_bit() -> None:
    """The states keep their type of float."""
    for answer in answers():
        assert answer.states is not None
        for states in (answer.states, answer.states.astype(np.float32)):
            read = Answer.from_text(replace(answer, states=states).to_text())
            assert read.row == answer.row
            assert read.states is not None
            assert read.states.dtype == states.dtype
            assert np.array_equal(read.states, states)


def test_a_cause_is_looked_for_at_the_coarsest_value() -> None:
    """A fault of the equations is named at the first value of a setting, and not searched for at others."""
    (coarse, *fine) = [run for run in ENTRIES.runs() if run.entry is SPINNER]
    still = np.tile([0.3, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0], (len(load(coarse.scene).clock.elapsed), 1))
    assert [judged(run, still, 1).causes == () for run in (coarse, fine[0])] == [False, True]
