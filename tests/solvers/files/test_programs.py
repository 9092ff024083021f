"""Files in the manner of many programs: read whole, with the right attitude, without a request."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from builders.trajectories import QUATERNION, VECTORS, columns_at, rows_of

from taylor_verify.judge.conventions.meanings import rotations
from taylor_verify.judge.velocities import velocity_forms
from taylor_verify.records.faults import Refused
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.files.columns.programs import entries, spellings_of
from taylor_verify.solvers.files.columns.readings import Name
from taylor_verify.solvers.files.file import TrajectoryFile, from_columns, read
from taylor_verify.solvers.files.formats.reading import read_table

FOLDER = Path(__file__).parent / "programs"
INDEX = list(csv.DictReader((FOLDER / "index.csv").read_text(encoding="utf-8").splitlines()))
# Ten digits are written, of angles of up to 360 degrees and of quaternions; a matrix doubles their error.
PRINTED = 4e-9


@cache
def exact(scene: str) -> Mapping[str, Any]:
    """The rows of each group at the first samples of a scene."""
    given = load(scene)
    columns = columns_at(given, given.clock.instants[:3])
    groups = {
        name: rows_of(columns, names) for name, names in VECTORS.items() if names[0] in columns
    }
    if isinstance(given.body, ImmersedBody):
        forms = velocity_forms(given.body)["linear_velocity"]
        parts = [groups[name] @ np.array(form, dtype=float).T for name, form in forms.items()]
        groups["linear_velocity"] = np.sum(parts, axis=0)
    return {**groups, "attitude": rotations(rows_of(columns, QUATERNION)), "t": columns["t"]}


def matrices(file: TrajectoryFile) -> Any:
    if "attitude" in file.groups:
        return file.groups["attitude"].doubles().reshape(-1, 3, 3)
    return rotations(file.groups["quaternion"].doubles())


def differs(entry: Mapping[str, str], file: TrajectoryFile) -> bool:
    """True if anything that is read is not that of the exact motion."""
    right = exact(entry["scene"])
    if not np.allclose([float(t) for t in file.times], right["t"], rtol=0, atol=PRINTED):
        return True
    for name in entry["reads"].split():
        rows = matrices(file) if name == "attitude" else file.groups[name].doubles()
        size = max(1, np.max(np.abs(right[name])))
        if not np.max(np.abs(rows - right[name])) <= PRINTED * size:
            return True
    return False


@pytest.mark.parametrize("entry", INDEX, ids=lambda entry: entry["file"])
def test_a_file_of_a_program_is_read_whole(entry: Mapping[str, str]) -> None:
    """Times, velocities, attitude and place are those of the exact motion, and a habit is said."""
    file = read(FOLDER / f"{entry['file']}.csv", scene=load(entry["scene"]))
    assert set(entry["reads"].split()) <= {*file.groups, "attitude"}
    assert not differs(entry, file)
    is_told = any(f"the habit of {entry['program']}" in note for note in file.notes)
    is_known = entry["program"] in {each["program"] for each in entries()}
    assert is_told or not is_known or entry["file"] in PLAIN


# Files of which the names say all: no habit is needed.
PLAIN = {"mss-names-degrees", "simulink-euler", "plotjuggler", "ros2-odometry", "bagpy-imu"}


# The spoilings of a column: a sign, an order, a unit.
SPOILED = (
    lambda numbers, _: -numbers,
    lambda numbers, following: following,
    lambda numbers, _: numbers * np.pi / 180,
)


@pytest.mark.parametrize("entry", INDEX, ids=lambda entry: entry["file"])
def test_a_broken_twin_is_not_read_as_the_sound_file(entry: Mapping[str, str]) -> None:
    """A column with another sign, place or unit changes what is read, is refused, or is named as left."""
    table = read_table(FOLDER / f"{entry['file']}.csv")
    numbers = [np.array(column.values, dtype=float) for column in table.columns]
    scene = load(entry["scene"])
    for k, (column, own) in enumerate(zip(table.columns, numbers, strict=True)):
        spoiled = SPOILED[k % len(SPOILED)](own, numbers[(k + 1) % len(numbers)])
        if np.allclose(spoiled, own, atol=1e-3):
            continue
        twin = [c._replace(values=spoiled) if c is column else c for c in table.columns]
        try:
            file = from_columns(twin, "twin", scene=scene)
        except Refused:
            continue
        left = " ".join(note for note in file.notes if "not taken" in note or "ignored" in note)
        assert differs(entry, file) or f"`{column.name}`" in left or " more" in left, column.name


def test_every_entry_of_the_table_has_a_source_and_a_file_that_shows_it() -> None:
    """An entry whose names stand in no file of its program is unmet."""
    shown = {
        (reading.spelling.whose, reading.spelling.keys, reading.component)
        for entry in INDEX
        for column in read_table(FOLDER / f"{entry['file']}.csv").columns
        for reading in Name(column).readings
    }
    for entry in entries():
        assert entry["source"]
        assert any(
            all((s.whose, s.keys, k) in shown for k in range(len(s.keys)))
            for s in spellings_of(entry)
        ), entry["names"]
