"""The entry list: the runs of a row, and a shipped list whose rows can all be run."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import pytest

from taylor_verify.scenes.library import ENGINES, names
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.registry import solver_named
from taylor_verify_reports.studies.engines.entry import (
    BOARDS,
    BoardScene,
    Entry,
    entry_list,
    read_list,
)

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
