"""The way of a right file through `check`: few functions, each once, and no search."""

from __future__ import annotations

import sys
from pathlib import Path
from types import FrameType
from typing import Any

import pytest
from builders.trajectories import exact_columns, scalar_last, write_csv

import taylor_verify
from taylor_verify.judge.errors.measured import Block, Comparison, Measured
from taylor_verify.judge.errors.state import Errors
from taylor_verify.judge.files.file_rows import FileRows
from taylor_verify.judge.gated import Gate
from taylor_verify.judge.judged_rows import Run
from taylor_verify.judge.judgement import Judgement
from taylor_verify.records.record import Record
from taylor_verify.records.verdict import Verdict
from taylor_verify.solvers.files.file import Recorded, TrajectoryFile
from taylor_verify.solvers.files.formats.column import Column
from taylor_verify.solvers.trajectory import Trajectory

SCENE = "euler/with-attitude"
PACKAGE = str(Path(taylor_verify.__file__).parent)
# What becomes of a file, in order: its columns, its rows, an answer, errors, gates, verdicts.
STAGES = (
    *(Column, TrajectoryFile, FileRows, Recorded, Trajectory, Run),
    *(Comparison, Block, Measured, Errors, Gate, Verdict, Record, Judgement),
)
MOST = 30
SEARCHING = {
    str(Path("judge", "conventions", "convention_search.py")),
    str(Path("judge", "causes", "cause_search.py")),
}


class Searched(Exception):
    """The way has come to a search."""


class Way:
    """The functions of the package that receive a file, or what became of it, and return the next stage.

    Functions that return numbers, texts or truth values about a stage are not on the way.
    """

    def __init__(self, file: str) -> None:
        self.file = file
        self.receive: dict[str, None] = {}
        self.hand_on: set[str] = set()
        self.rooms: set[str] = set()

    def is_stage(self, value: Any) -> bool:
        """Return True for a stage, and for a sequence or mapping of stages."""
        if isinstance(value, dict):
            value = list(value.values())
        if isinstance(value, list | tuple) and value and not isinstance(value, STAGES):
            return self.is_stage(value[0])
        return isinstance(value, STAGES) or (
            isinstance(value, str | Path) and str(value) == self.file
        )

    def __call__(self, frame: FrameType, event: str, returned: Any) -> None:
        code = frame.f_code
        if not code.co_filename.startswith(PACKAGE) or code.co_name.startswith("<"):
            return
        room = code.co_filename.removeprefix(PACKAGE).strip("/\\")
        name = f"{room}: {code.co_qualname}"
        self.rooms.add(room)
        given = code.co_varnames[: code.co_argcount + code.co_kwonlyargcount]
        if event == "call" and any(self.is_stage(frame.f_locals.get(each)) for each in given):
            self.receive.setdefault(name)
        elif event == "return" and self.is_stage(returned):
            self.hand_on.add(name)

    @property
    def functions(self) -> list[str]:
        return [name for name in self.receive if name in self.hand_on]


def way_of(file: str) -> Way:
    """The way of a file through `check`; the modules are imported before."""
    assert taylor_verify.check(SCENE, file).passed
    way = Way(file)
    sys.setprofile(way)
    try:
        taylor_verify.check(SCENE, file)
    finally:
        sys.setprofile(None)
    return way


def test_a_right_file_passes_few_functions_and_no_search(tmp_path: Path) -> None:
    """At most 30 functions stand between a right file and its verdicts, and none searches anything."""
    way = way_of(write_csv(tmp_path / "mine.csv", exact_columns(SCENE)))
    print("\n".join(way.functions))
    first, last = "check.py: check", "judge/files/stored.py: with_file_kinds"
    assert (way.functions[0], way.functions[-1]) == (first, last)
    assert len(way.functions) <= MOST
    assert not way.rooms & SEARCHING
    assert not any("causes" in name or "conventions" in name for name in way.receive)


def test_a_file_that_does_not_fit_is_searched(tmp_path: Path) -> None:
    """Another convention makes a row fail, so that causes and conventions are searched for."""
    way = Way(write_csv(tmp_path / "mine.csv", scalar_last(exact_columns(SCENE))))

    def until_searching(frame: FrameType, event: str, returned: Any) -> None:
        way(frame, event, returned)
        if way.rooms & SEARCHING:
            raise Searched

    sys.setprofile(until_searching)
    try:
        with pytest.raises(Searched):
            taylor_verify.check(SCENE, way.file)
    finally:
        sys.setprofile(None)
