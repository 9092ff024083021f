"""Likely causes of answers that begin otherwise than the scene, and have another fault as well."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from builders.caused_rows import RIGID, TENSOR, TIMES, Array, Q, columns, rows, titles
from builders.trajectories import Columns
from builders.turns import by_turns

SCENE = RIGID.format(load="")
START = [0.9, -0.4, 1.0]


def from_start(law: Callable[[Array], Array], start: list[float]) -> Columns:
    """Rows of a body that begins with another omega."""
    return columns(TIMES, rows(lambda t, w, q: law(w), start, Q, TIMES, ()), ("w1", "w2", "w3"))


def free(w: Array) -> Array:
    return np.linalg.solve(TENSOR, np.cross(TENSOR @ w, w))


FAULTS: dict[str, Callable[[Array], Array]] = {
    "damping = 0.05": lambda w: free(w) - 0.05 * w,
    "factor of the gyroscopic term = 0.9": lambda w: 0.9 * free(w),
    "no gyroscopic term": lambda w: 0 * w,
}


@pytest.mark.parametrize("name", by_turns([*FAULTS], 3))
def test_a_fault_is_named_beside_another_start(name: str, tmp_path: Path) -> None:
    """The first row shows the start, and the rows after it the fault of the equations."""
    first, *others = titles(tmp_path, SCENE, from_start(FAULTS[name], START))
    assert first == "another start"
    assert any(each.startswith(f"with that: {name}") for each in others)


def test_another_start_alone_is_all_that_is_said(tmp_path: Path) -> None:
    """A right motion from another start has no second fault."""
    (only,) = titles(tmp_path, SCENE, from_start(free, START))
    assert only.startswith("another start: from the file's own first row the motion is exact")


def test_an_unknown_law_from_another_start_is_not_named(tmp_path: Path) -> None:
    """Another start explains nothing alone, and no fault of the catalogue stands beside it."""
    made = from_start(lambda w: free(w) + 0.05 * np.sin(3 * w[::-1]), START)
    assert titles(tmp_path, SCENE, made) == []


def test_a_fault_from_the_right_start_has_no_other_one(tmp_path: Path) -> None:
    """A file that begins as the scene does has a fault of the equations alone."""
    names = titles(tmp_path, SCENE, from_start(FAULTS["damping = 0.05"], [0.8, -0.5, 1.1]))
    assert not any("start" in each for each in names)
