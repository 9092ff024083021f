"""The edges of what the judge measures and says, part by part."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from builders.verdicts import row
from scipy.spatial.transform import Rotation

from taylor_verify.judge.causes import tensor
from taylor_verify.judge.causes.equations import Equations
from taylor_verify.judge.conventions.search import conventions
from taylor_verify.judge.conventions.worlds import worlds
from taylor_verify.judge.errors.shift import Shift
from taylor_verify.judge.files.coverage import Extent, span_notes
from taylor_verify.judge.floor.carrying import Carrying, carrying
from taylor_verify.judge.judgement import Judgement
from taylor_verify.judge.series import files
from taylor_verify.records.reason import Kind
from taylor_verify.scenes.motion import Clock
from taylor_verify.scenes.precision import rung
from taylor_verify.scenes.reading.reader import load


def test_the_table_of_a_judgement_has_its_text_above() -> None:
    """A notebook shows the text of a judgement without its brackets, whole."""
    judged = Judgement((row(),), None)
    assert f">{repr(judged)[1:-1]}<" in judged._repr_html_()


@pytest.mark.parametrize(("kind", "remains"), [(Kind.NONE, None), (Kind.CONSTANT, 0.25)])
def test_what_remains_is_told_of_a_shift_alone(kind: Kind, remains: float | None) -> None:
    """Where no shift explains an error, nothing remains of it."""
    shift = Shift(1.0, 0.5, kind, 0.25, 0.0, (0.0, 1.0), (1.0, 1.0), (1.0, 1.0))
    assert shift.numbers()["remains"] == remains


def test_the_growth_of_an_error_is_known_until_the_end() -> None:
    """The last of the times is that of the scene; a growth in proportion has a pace at any size."""
    scene = load("euler/generic")
    growth = carrying(scene)
    assert growth is not None
    assert growth.times[-1] == float(scene.clock.instants[-1])
    assert Carrying((0.0, 0.25, 0.5, 1.0), (1.0, 10.0, 20.0, 40.0)).pace == 40


def test_a_file_is_late_against_the_start_of_its_scene() -> None:
    """A first row at 7 is late by 2 where the scene starts at 5."""
    plain = load("euler/generic")
    scene = replace(plain, clock=Clock(Fraction(5), tuple(map(Fraction, (5, 6, 7)))))
    words = [world.words for world in worlds(scene, tuple(map(Fraction, (7, 8, 9))))]
    assert "t is late by 2" in words


def test_a_file_that_ends_at_its_start_says_so() -> None:
    """The only row is the first one: the rest was not judged."""
    zero, end = Fraction(0), Fraction(10)
    scene = replace(load("euler/generic"), clock=Clock(zero, (zero, end)))
    extent = Extent((zero,), start=zero, sign=1, begin=zero, end=end, slack=zero)
    (note,) = span_notes(scene, (zero,), extent)
    assert note.startswith("the last row is at t = 0, and the scene ends at t = 10")


def test_a_file_without_numbers_has_no_conventions() -> None:
    """Where no row is finite, nothing is searched."""
    file: Any = SimpleNamespace(finite=np.zeros(3, dtype=bool))
    assert conventions(file, load("euler/generic"), rung("f64")).findings == ()


def test_the_turn_of_axes_is_an_angle() -> None:
    """A body that is turned by a thousandth of a radian is told to be."""
    right = Equations.of(load("euler/full-tensor").body)
    R = Rotation.from_rotvec([0, 0, 1e-3]).as_matrix()
    assert tensor._difference(right, R @ right.tensor @ R.T).endswith("turned by 0.001 rad")


@pytest.mark.parametrize(("order", "count"), [(3.9, 0), (1.0, 1)])
def test_a_lower_order_is_lower_by_a_half(order: float, count: int) -> None:
    """Orders that nearly agree are those of one method."""
    orders: Any = [
        SimpleNamespace(quantity=name, order=value)
        for name, value in (("omega", 4.0), ("attitude", order))
    ]
    notes = list(files._notes([], [], [], [], orders))
    assert sum("a method of its own" in note for note in notes) == count
