"""Quaternions turn as matrices do; series keep their bits, and what rests is known exactly."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest
from builders.boxes import CASES
from builders.scenes import one_instant, vector
from flint import arb, ctx

from taylor_verify.exact.balls import balls
from taylor_verify.exact.enclosure.course import Course
from taylor_verify.exact.enclosure.loaded import posed
from taylor_verify.exact.enclosure.series import Series
from taylor_verify.exact.enclosure.step import Stepper
from taylor_verify.exact.enclosure.system import System
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.numbers import tensors
from taylor_verify.numbers.rotation import conjugate, product, rotation_matrix, rotation_rows
from taylor_verify.scenes.motion import Spin
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

P, Q = vector(1, 2, -3, 4), vector("0.5", -1, 2, "0.25")


def test_a_quaternion_turns_as_its_matrix_does() -> None:
    """R(p) v is p v p*, and R(p q) = R(p) R(q); the rotation of p is R(p)/|p|^2."""
    for k in range(3):
        unit = [Fraction(int(i == k)) for i in range(-1, 3)]
        turned = product(product(P, unit), conjugate(P))
        assert turned == [0, *(row[k] for row in rotation_rows(P))]
    both = tensors.product(exactly(rotation_rows(P)), exactly(rotation_rows(Q)))
    assert exactly(rotation_rows(product(P, Q))) == both
    square = tensors.dot(P, P)
    assert exactly([[square * e for e in row] for row in rotation_matrix(P)]) == exactly(
        rotation_rows(P)
    )


def exactly(rows: list[list[Fraction]]) -> tensors.Matrix:
    return tuple(map(tuple, rows))


def series(system: System, step: Fraction, order: int) -> list[list[arb]]:
    """The coefficients of the state from its start, at the ambient precision."""
    return Series(
        system.pieces(Fraction(0), True).tape, balls(system.start), Fraction(0), step, order
    ).rows


def test_a_series_loses_no_bit_of_its_sum() -> None:
    """Coefficients that keep fewer bits the smaller they are leave the sum as sharp as it was."""
    scene = load("kirchhoff/general-body")
    with ctx.workprec(140):
        run = Course.of(posed(scene), balls(posed(scene).start), 140, 10_000)
        (row,) = (row for _, row in run.rows([Fraction(1, 8)]))
        widest, largest = max(z.rad() for z in row.state), max(abs(z).mid() for z in row.state)
        assert widest <= largest * arb(2) ** -130
        order = run.stepper.order
        rows = series(posed(scene), Fraction(1, 8), order)
    with ctx.workprec(400):
        sharp = series(posed(scene), Fraction(1, 8), order)
        for coarse, fine in zip(rows, sharp, strict=True):
            assert all(a.overlaps(b) for a, b in zip(coarse, fine, strict=True))


@pytest.mark.parametrize("name", ["kirchhoff/steady-screw", "kirchhoff/steady-spin"])
def test_a_state_that_never_changes_takes_one_step(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """However long the time and however fast a neighbour would leave: nothing is left out."""
    steps, original = [], Stepper.step

    def counted(self: Stepper, *arguments: Any) -> Any:
        steps.append(arguments)
        return original(self, *arguments)

    monkeypatch.setattr(Stepper, "step", counted)
    motion = TaylorSolution(bare(load(name))).motion([Fraction(10**6)], 30)
    assert len(steps) == 1
    assert motion.radius[0] == 0


def bare(scene: Scene) -> Scene:
    return replace(scene, track=frozenset())


def test_a_body_without_spin_moves_straight() -> None:
    """The attitude of a body at rest is that of its start, exactly known."""
    resting = one_instant(CASES["euler"][0].body, Spin(vector(0, 0, 0)), "attitude")
    motion = TaylorSolution(resting).motion([Fraction(50)], 30)
    assert motion.radii["attitude"][0] == 0
