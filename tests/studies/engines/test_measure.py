"""The entry list of the boards, whose rows can all be run, and their measurement, which repeats nothing."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path
from shutil import rmtree
from typing import Any

import numpy as np
import pytest
from builders.studies.engines import ENTRIES, SPINNER, answers

from taylor_verify.scenes.library import ENGINES, names
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.engines.launcher import NotMade
from taylor_verify.solvers.registry import solver_named
from taylor_verify_reports.studies.engines import measure as measuring
from taylor_verify_reports.studies.engines.answer import Answer, Answers, answered
from taylor_verify_reports.studies.engines.document import Standing
from taylor_verify_reports.studies.engines.entry import (
    BOARDS,
    Asked,
    BoardScene,
    Entry,
    EntryList,
    entry_list,
    read_list,
)
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


# The entry list

SCENES = (
    BoardScene("engines/oblique", sweep=True, shipped=True),
    BoardScene("engines/ten-minutes", least=0.01),
)
ROW = Entry(
    "it",
    "It",
    "outside:it",
    ("0.02", "0.005"),
    versions=("1.0", "2.0"),
    settings={"integrator": ("euler", "rk4"), "flags": ("2",)},
    shipped={"defaults": "shipped"},
)


def test_the_newest_version_is_run_on_every_scene() -> None:
    """Older versions are run on scenes with `sweep`, and no step is below the least one of its scene."""
    runs = [run for run in ROW.runs(SCENES) if not run.shipped]
    assert {(run.version, run.scene, run.value) for run in runs} == {
        *(("2.0", "engines/oblique", value) for value in ("0.02", "0.005")),
        *(("1.0", "engines/oblique", value) for value in ("0.02", "0.005")),
        ("2.0", "engines/ten-minutes", "0.02"),
    }


def test_a_run_has_the_whole_name_of_its_solver() -> None:
    """The name has version, words and step, and a number among the words keeps its key in tables."""
    first = next(ROW.runs(SCENES))
    assert first.solver == "outside:it?version=2.0&integrator=euler&flags=2&step=0.02"
    assert first.variant == "euler, flags=2"
    assert str(first) == f"engines/oblique by {first.solver} on f64"


def test_as_shipped_is_run_where_the_scene_asks_for_it() -> None:
    """The settings as shipped are added to those of the row, in the newest version at one step."""
    runs = [run for run in ROW.runs(SCENES) if run.shipped]
    assert {(run.version, run.scene) for run in runs} == {("2.0", "engines/oblique")}
    assert len(runs) == 2
    assert all(run.solver.endswith("defaults=shipped&step=0.005") for run in runs)


@pytest.mark.parametrize("board", BOARDS)
def test_every_run_of_the_list_is_a_solver(board: str) -> None:
    """Each solver, setting and word is known, and each run is asked for once."""
    runs = entry_list(board).runs()
    assert len({run.key for run in runs}) == len(runs) > 10
    for solver in {run.solver for run in runs}:
        solver_named(solver)


def test_the_scenes_of_the_list_are_those_of_the_folder() -> None:
    """Each scene has 21 samples, all at whole numbers of every step that is run on it."""
    entries = entry_list()
    assert sorted(scene.name for scene in entries.scene) == sorted(names(ENGINES))
    stepped = {(r.scene, r.value) for r in entries.runs() if r.entry.knob == "step" and r.value}
    elapsed = {scene: load(scene).clock.elapsed for scene, _ in stepped}
    assert {len(times) for times in elapsed.values()} == {21}
    for scene, step in stepped:
        assert all((t / Fraction(step)).denominator == 1 for t in elapsed[scene])


def test_a_fault_of_the_list_is_named(tmp_path: Path) -> None:
    """The error names the place and the file."""
    file = tmp_path / "list.toml"
    file.write_text('[[scene]]\nname = "a"\n[[entry]]\nname = 3\n', encoding="utf-8")
    with pytest.raises(ValueError, match=r"expected a text, got 3 @ entry\[0\]\.name @ list\.toml"):
        read_list(file)
