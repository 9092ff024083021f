"""Columns of states of the scene's own, in files and objects: by their names, or by those asked for."""

from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from builders.acted import acted

from taylor_verify.records.faults import Refused
from taylor_verify.solvers.files.file import read
from taylor_verify.solvers.files.objects import trajectory

NAMES = ("t", "w1", "w2", "w3", "q0", "q1", "q2", "q3", "m1", "m2", "h")
NUMBERS = np.arange(1.0, 23.0).reshape(2, 11)


def csv(folder: Path, names: tuple[str, ...] = NAMES) -> Path:
    path = folder / "answer.csv"
    rows = [",".join(map(repr, row.tolist())) for row in NUMBERS[:, : len(names)]]
    path.write_text("\n".join([",".join(names), *rows]), encoding="utf-8")
    return path


def as_json(folder: Path) -> Path:
    path = folder / "answer.json"
    columns = dict(zip(NAMES, NUMBERS.T.tolist(), strict=True))
    path.write_text(json.dumps(columns), encoding="utf-8")
    return path


def as_npz(folder: Path) -> Path:
    path = folder / "answer.npz"
    np.savez(path, **dict(zip(NAMES, NUMBERS.T, strict=True)))
    return path


@pytest.mark.parametrize("written", [csv, as_json, as_npz])
def test_every_format_has_them_by_one_list(written: Any, tmp_path: Path) -> None:
    """The reader of a format names columns; which are the scene's own is asked in one place."""
    groups = read(written(tmp_path), (), acted()).groups
    np.testing.assert_array_equal(groups["m"].doubles(), NUMBERS[:, 8:10])
    # A column h is a step of an integrator in another scene.
    np.testing.assert_array_equal(groups["h"].doubles(), NUMBERS[:, 10:])
    assert {"omega", "quaternion"} <= groups.keys()


@pytest.mark.parametrize("theirs", [("u", "v"), ("9", "10")])
def test_they_may_have_other_names(theirs: tuple[str, str], tmp_path: Path) -> None:
    """Columns are given by a name or by a number; one that is not there is a fault."""
    file = csv(tmp_path, (*NAMES[:8], "u", "v", "h"))
    wanted = tuple(zip(("m1", "m2"), theirs, strict=True))
    np.testing.assert_array_equal(
        read(file, wanted, acted()).groups["m"].doubles(), NUMBERS[:, 8:10]
    )
    with pytest.raises(Refused, match="expected a column of the file for m1, got `missing`"):
        read(file, (("m1", "missing"), ("m2", "v")), acted())


@pytest.mark.parametrize("place", [0, 9])
def test_a_column_that_is_asked_for_comes_before_one_of_our_name(
    place: int, tmp_path: Path
) -> None:
    """Wherever the other one stands, it is ignored, as among the columns of a body."""
    names = [*NAMES[:8], "u", "m2"]
    names.insert(place, "m1")
    groups = read(csv(tmp_path, tuple(names)), (("m1", "u"),), acted()).groups
    expected = NUMBERS[:, [names.index("u"), names.index("m2")]]
    np.testing.assert_array_equal(groups["m"].doubles(), expected)


def test_a_name_that_is_asked_for_twice_is_a_fault(tmp_path: Path) -> None:
    file = csv(tmp_path, (*NAMES[:8], "u", "v", "h"))
    with pytest.raises(Refused, match="expected every name once, got m1 again"):
        read(file, (("m1", "u"), ("m1", "v"), ("m2", "v")), acted())


def test_a_part_of_a_vector_is_a_fault(tmp_path: Path) -> None:
    with pytest.raises(Refused, match="expected the columns m1 m2, got no m2"):
        read(csv(tmp_path, NAMES[:9]), (), acted())


def test_objects_have_them_as_arrays_and_in_the_order_of_a_state() -> None:
    parts = {"t": NUMBERS[:, 0], "omega": NUMBERS[:, 1:4], "m": NUMBERS[:, 8:10]}
    np.testing.assert_array_equal(trajectory(parts, acted()).groups["m"].doubles(), parts["m"])
    # The scene has h before m.
    result = SimpleNamespace(t=NUMBERS[:, 0], y=NUMBERS[:, 1:].T)
    groups = trajectory(result, acted()).groups
    np.testing.assert_array_equal(groups["h"].doubles(), NUMBERS[:, 8:9])
    np.testing.assert_array_equal(groups["m"].doubles(), NUMBERS[:, 9:])
