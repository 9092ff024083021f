"""Small reports that are made in the session by the real code, for tests of pages and pictures.

A report is made once in a process, when a test first asks for it.
"""

from __future__ import annotations

import atexit
import shutil
from collections.abc import Iterable, Mapping
from functools import cache
from itertools import chain, product
from pathlib import Path
from tempfile import mkdtemp
from types import SimpleNamespace
from typing import Any, Final

import pytest

from builders.studies.claims import STUDY
from builders.studies.engines import board_with, made_up
from builders.studies.hard import study as hard_study
from builders.studies.tradeoff import NUMBERS_MADE, TIMES_MADE
from builders.verdicts import row
from taylor_verify.batch.job import Job
from taylor_verify.judge.judgement import Judgement
from taylor_verify.numbers.precision import rung
from taylor_verify.plotting.picture import save
from taylor_verify.records import store
from taylor_verify.run import run
from taylor_verify.scenes.library import names
from taylor_verify.scenes.reading.reader import load
from taylor_verify_reports.controls.defects import DEFECTS
from taylor_verify_reports.studies import figures, registry
from taylor_verify_reports.studies import published_report as report
from taylor_verify_reports.studies.claims_page import CLAIMS
from taylor_verify_reports.studies.controls import broken_runs as sight
from taylor_verify_reports.studies.controls import controls_page as controls
from taylor_verify_reports.studies.controls.sight import CONTROLS, ControlsStudy
from taylor_verify_reports.studies.engines.document import write as write_board
from taylor_verify_reports.studies.engines.entry import entry_list
from taylor_verify_reports.studies.growth.experiment import followed
from taylor_verify_reports.studies.growth.growth_page import GROWTH
from taylor_verify_reports.studies.growth.question import Question
from taylor_verify_reports.studies.hard.hard_scenes import HARD
from taylor_verify_reports.studies.portraits.portrait import portrait
from taylor_verify_reports.studies.portraits.stored_portraits import PORTRAITS
from taylor_verify_reports.studies.reference import reference_page as reference_files
from taylor_verify_reports.studies.reference.exact_table import reference
from taylor_verify_reports.studies.tradeoff.trades import write as write_tradeoff

RUNGS: Final = ("f32", "f64", "f80", "f128", "mp237")
# Three bodies in vacuum, of which one is loaded, and two in a fluid with their paths.
SCENES: Final = (
    *("euler/with-attitude", "euler/separatrix", "euler/constant-moment"),
    *("kirchhoff/whole-motion", "kirchhoff/falling-away"),
)
# One that a shift of time explains, one that the energy does not see, and a term that is missing.
_BROKEN: Final = ("half-a-millisecond-early", "munk-moment-sign", "no-gyroscopic-term")


def folder() -> Path:
    """Return a new folder, which is removed when the process ends."""
    place = Path(mkdtemp(prefix="taylor-verify-made-"))
    atexit.register(shutil.rmtree, place, ignore_errors=True)
    return place


@cache
def result_of(scene: str, rung: str) -> Judgement:
    """Return a run of a scene by the Taylor driver."""
    return run(load(scene), "taylor", rung)


@cache
def portrait_of(scene: str) -> dict[str, Any]:
    """Return the portrait of a scene."""
    return portrait(load(scene))


@cache
def portrait_without_run(scene: str) -> dict[str, Any]:
    """Return a portrait whose run is left out: the rest does not depend on it, and it takes longest."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(
            "taylor_verify_reports.studies.portraits.portrait.explanation",
            lambda scene, rung: {"cost": {"seconds": 1.0}},
        )
        return portrait(load(scene))


def write_runs(place: Path, runs: Iterable[tuple[str, str]]) -> None:
    """Run scenes on rungs by the Taylor driver, and write verdicts and records."""
    results = [result_of(scene, rung) for scene, rung in runs]
    verdicts = [verdict for result in results for verdict in result.verdicts]
    records = [result.record for result in results if result.record is not None]
    store.write(place, verdicts, records)
    report.publish(place)


def write_remade(place: Path, monkeypatch: pytest.MonkeyPatch, errors: Mapping[str, float]) -> None:
    """Write rows of two scenes, and have each run make just these rows again."""
    made = [
        row(**errors, scene=scene, quantity=quantity)
        for scene in ("euler/generic", "euler/full-tensor")
        for quantity in ("omega", "T", "H2")
    ]
    store.write(place, made, [])
    report.publish(place)

    def judged(jobs: list[Job], *_: Any) -> list[Any]:
        scenes = {job.name for job in jobs}
        rows = tuple(verdict for verdict in made if verdict.scene in scenes)
        return [SimpleNamespace(verdicts=rows, record=None, causes=(), notes=())]

    monkeypatch.setattr("taylor_verify.batch.judging.judge_all", judged)


def write_portraits(place: Path, scenes: Iterable[str]) -> None:
    """Write portraits and exact trajectories."""
    asked = list(scenes)
    PORTRAITS.write(place, map(portrait_of, asked))
    reference_files.write(place, [reference(load(scene)) for scene in asked])


@cache
def _controls() -> ControlsStudy:
    return sight.study(sight.sights(defect for defect in DEFECTS if defect.name in _BROKEN))


def write_controls(place: Path) -> None:
    """Write what each gate sees of some solvers that are broken on purpose."""
    CONTROLS.write(place, _controls())
    controls.STUDY.publish(place)


@cache
def every_portrait() -> Path:
    """Return a report with the portrait of every scene of the standard set."""
    place = folder()
    PORTRAITS.write(place, map(portrait_of, names()))
    return place


# A sixth of the standard set, and what tests ask for by name.
SOME_REFERENCES: Final = tuple(
    name
    for n, name in enumerate(names())
    if n % 6 == 0
    or name
    in (
        *("euler/generic", "euler/nesc-brick", "euler/rest", "euler/tennis-racket"),
        *("kirchhoff/steady-precession", "kirchhoff/steady-spin"),
    )
)


@cache
def some_references() -> Path:
    """Return a report with the exact trajectories of some scenes of the standard set."""
    place = folder()
    reference_files.write(place, [reference(load(scene)) for scene in SOME_REFERENCES])
    return place


@cache
def every_reference() -> Path:
    """Return a report with the exact trajectory of every scene of the standard set."""
    place = folder()
    reference_files.write(place, [reference(load(scene)) for scene in names()])
    return place


def _write_measured(place: Path) -> None:
    """Write the studies that the paper tells of, beside the verdicts."""
    write_controls(place)
    write_tradeoff(place, NUMBERS_MADE, TIMES_MADE)
    HARD.write(place, hard_study())
    errors = {"omega": 1e-5, "attitude": 1e-4, "T": 1e-9}
    board = [made_up(one, errors) for one in entry_list().entry if one.name in ("cannon", "havok")]
    write_board(place, board_with(*chain.from_iterable(board)))


@cache
def for_paper() -> Path:
    """Return a report of two scenes with all that the paper tells of."""
    place = folder()
    write_runs(place, product(("euler/generic", "kirchhoff/general-body"), ("f32", "f64")))
    _write_measured(place)
    return place


def write_growth(place: Path) -> None:
    """Write the growth of errors of a small ensemble."""
    ensemble = Question(load("euler/about-max-axis"), rung("f64"), 10**3.5, 4, why="a test")
    GROWTH.write(place, followed([ensemble], lambda *piece: None))


@cache
def small() -> Path:
    """Return a report of five scenes on two rungs, with a page of every kind and its picture."""
    place = folder()
    write_runs(place, product(SCENES, ("f64", "mp237")))
    write_portraits(place, SCENES)
    _write_measured(place)
    write_growth(place)
    CLAIMS.write(place, STUDY)
    save(registry.pictures(place), place / figures.FOLDER, ["svg"])
    report.publish(place)
    return place
