"""The scene's start settles what a file leaves open: the place of a scalar, the zero of a clock."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from builders.trajectories import QUATERNION, columns_at, rows_of

import taylor_verify
from taylor_verify.judge.conventions.meanings import rotations
from taylor_verify.records.faults import Refused
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.files.file import TrajectoryFile, from_columns, read
from taylor_verify.solvers.files.formats.column import Column

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
