"""Files in the manner of many programs, read whole; and what the scene's start settles in a file."""

from __future__ import annotations

import csv
from collections.abc import Callable, Mapping
from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from builders.trajectories import QUATERNION, VECTORS, columns_at, rows_of

import taylor_verify
from taylor_verify.judge.conventions.meanings import rotations
from taylor_verify.judge.velocities import velocity_forms
from taylor_verify.records.faults import Refused
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.columns.programs import entries, spellings_of
from taylor_verify.solvers.files.columns.readings import Name
from taylor_verify.solvers.files.file import TrajectoryFile, from_columns, read
from taylor_verify.solvers.files.formats.column import Column
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


# What the start settles

SCENE = load("euler/with-attitude")
SOUND = columns_at(SCENE, SCENE.clock.instants[:7])
W = [f"w{k}" for k in (1, 2, 3)]


def npz(folder: Path, columns: Any, quaternion: Any) -> Path:
    arrays = {"t": columns["t"], "omega": rows_of(columns, W), "quaternion": quaternion}
    np.savez(folder / "run.npz", **arrays)
    return folder / "run.npz"


@pytest.mark.parametrize(("order", "last"), [([0, 1, 2, 3], False), ([1, 2, 3, 0], True)])
@pytest.mark.parametrize("start", [(1, 2, -1, 3), (1, 1, 1, 1)], ids=["one fits", "both fit"])
def test_the_scalar_of_an_array_is_settled_by_the_start(
    start: Any, order: list[int], last: bool, tmp_path: Path
) -> None:
    """A quaternion (n, 4) is read in the one order that has the scene's attitude, and moves as it does."""
    initial = replace(SCENE.initial, attitude=tuple(map(Fraction, start)))
    instants = tuple(Fraction(k, 20) for k in range(7))
    scene = replace(SCENE, initial=initial, clock=replace(SCENE.clock, instants=instants))
    sound = columns_at(scene, instants)
    rows = rows_of(sound, QUATERNION)
    file = read(npz(tmp_path, sound, rows[:, order]), scene=scene)
    assert np.array_equal(file.groups["quaternion"].doubles(), rows)
    assert any(f"the scalar is {'last' if last else 'first'}" in note for note in file.notes)


TWINS: dict[str, Callable[[Any], Any]] = {
    "conjugate": lambda rows: rows * [1, -1, -1, -1],
    "two exchanged": lambda rows: rows[:, [0, 2, 1, 3]],
    "one row late": lambda rows: np.roll(rows, 1, axis=0),
}


@pytest.mark.parametrize("twin", TWINS)
def test_a_scalar_that_the_start_does_not_settle_is_asked_for(twin: str, tmp_path: Path) -> None:
    """Four numbers of which neither order begins as the scene does are refused with what to type."""
    file = npz(tmp_path, SOUND, TWINS[twin](rows_of(SOUND, QUATERNION)))
    with pytest.raises(Refused, match=r"--columns q0=quaternion\[0\],.* for the first, q0="):
        read(file, scene=SCENE)


def clocked(name: str, times: Any, scene: Scene = SCENE) -> TrajectoryFile:
    columns = [Column(name, list(times)), *(Column(w, SOUND[w]) for w in W)]
    return from_columns(columns, "log", scene=scene)


@pytest.mark.parametrize("name", ["header.stamp", "timestamp", "gps_time [s]", "TOW", "stamp (s)"])
@pytest.mark.parametrize("zero", [20, 100, 345600.5, -50], ids=str)
def test_a_clock_with_another_zero_counts_from_the_first_row(name: str, zero: float) -> None:
    """Stamps that lie outside the scene's times have a zero of their own, which a note says."""
    file = clocked(name, [zero + t for t in SOUND["t"]])
    assert [float(t) for t in file.times] == SOUND["t"]
    assert any("t counts from" in note for note in file.notes)


@pytest.mark.parametrize(
    ("name", "zero"), [("stamp", 0.5), ("stamp", 12), ("t", 100), ("time", 100), ("TimeUS", 0.5)]
)
def test_a_lag_is_no_clock(name: str, zero: float) -> None:
    """Rows that are late within the scene's times, or by our own name, stay late."""
    parts = 10**6 if name == "TimeUS" else 1
    times = [int((zero + t) * parts) if parts > 1 else zero + t for t in SOUND["t"]]
    scene = replace(SCENE, clock=replace(SCENE.clock, instants=SCENE.clock.instants[:7]))
    file = clocked(name, times, scene if name == "TimeUS" else SCENE)
    signs = [s for s in file.notes if "t counts from" in s]
    assert not signs
    assert float(file.times[0]) == zero


def test_a_clock_since_boot_counts_from_the_first_row() -> None:
    """Microseconds of ArduPilot since its start lie after the scene's end, and no lag is so long."""
    file = clocked("TimeUS", [int((87.25 + t) * 10**6) for t in SOUND["t"]])
    assert [float(t) for t in file.times] == SOUND["t"]


@pytest.mark.parametrize("spoiled", [False, True])
def test_rates_in_space_axes_are_judged_without_an_attitude(spoiled: bool) -> None:
    """The exact attitude turns them; no cause is looked for in rows that are not in body axes."""
    R = rotations(rows_of(SOUND, QUATERNION))
    rates = np.einsum("nij,nj->ni", R, rows_of(SOUND, W)) * [1, -1 if spoiled else 1, 1]
    names = [f"omega_world_{axis}" for axis in "xyz"]
    log = {"t": SOUND["t"], **dict(zip(names, rates.T, strict=True))}
    judged = taylor_verify.check(SCENE.name, log, partial=True)
    assert judged.passed is not spoiled
    assert not judged.causes
    assert not judged.missing_load


def test_the_request_of_a_bare_matrix_has_whole_groups() -> None:
    """Seven columns may be times, rates and three angles; no quaternion is cut off."""
    columns = [Column(str(k), [0.0, 1.0]) for k in range(1, 8)]
    with pytest.raises(Refused, match=r"t=1,w1=2,w2=3,w3=4,zyx_deg=5:7 for yaw pitch roll"):
        from_columns(columns, "matrix", scene=SCENE)
