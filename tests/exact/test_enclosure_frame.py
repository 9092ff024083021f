"""The turn and the way of a step are those of the equations, and each of their bounds is needed."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest
from builders.boxes import CASES, enclosed, is_contained, with_few_orders
from builders.scenes import GENERAL, one_instant, vector
from flint import arb, ctx

from taylor_verify.exact.balls import balls
from taylor_verify.exact.enclosure import placing
from taylor_verify.exact.enclosure.coefficients import frame_series, value
from taylor_verify.exact.enclosure.course import Course
from taylor_verify.exact.enclosure.placing import norm
from taylor_verify.exact.enclosure.posing import posed
from taylor_verify.exact.enclosure.series import Series
from taylor_verify.exact.enclosure.step import Stepper
from taylor_verify.exact.enclosure.system import Forms, System
from taylor_verify.exact.rotation import conjugate, product, rotation_matrix, rotation_rows
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import diagonal
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Impulse, Spin
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

MOVING = Impulse(vector("0.1", "0.2", 1), vector("0.3", 0, 1))
GENERAL_SCENE = one_instant(GENERAL, MOVING, "attitude", "centre")
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


@pytest.mark.parametrize("s", ["0.25", "1"])
def test_the_series_of_the_frame_obey_its_equations(s: str) -> None:
    """q' = h q Omega/2 and d' = h (U + d x Omega), by a difference of the sums at 300 bits."""
    with ctx.workprec(300):
        body, h, at, step = Forms.of(posed(GENERAL_SCENE)), arb(1) / 16, arb(s), arb(2) ** -60
        state = series(posed(GENERAL_SCENE), Fraction(1, 16), 80)
        frame = frame_series(body, state, h, with_centre=True)
        z = placing.column(value(state, at))
        here, ahead, behind = (value(frame, point) for point in (at, at + step, at - step))
        rates = [(b - a) / (2 * step) for a, b in zip(behind, ahead, strict=True)]
        spin, speed = (form.entries() for form in (body.spin * z, body.velocity * z))
        turned = [h / 2 * w for w in product(here[:4], [arb(0), *spin])]
        d = here[4:]
        way = [
            h * (speed[i] + d[j] * spin[k] - d[k] * spin[j])
            for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
        ]
        # A central difference errs by the square of its step.
        missed = norm([a - b for a, b in zip(rates, turned + way, strict=True)])
        assert missed <= arb(2) ** -110


def test_a_series_loses_no_bit_of_its_sum() -> None:
    """Coefficients that keep fewer bits the smaller they are leave the sum as sharp as it was."""
    scene = load("kirchhoff/general-body")
    with ctx.workprec(140):
        run = Course.of(posed(scene), balls(posed(scene).start), None, 140, 10_000)
        (row,) = (row for _, row in run.rows([Fraction(1, 8)]))
        assert norm([arb(z.rad()) for z in row.state]) <= norm(row.state) * arb(2) ** -130
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


# Each bound is needed.


def nothing(*_: object) -> arb:
    return arb(0)


@pytest.mark.parametrize("name", ["euler", "kirchhoff"])
def test_the_deviation_of_the_spin_is_needed(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of a box of starts, a turn by the middle's spin alone leaves the attitudes of its corners out."""
    assert is_contained(name)
    monkeypatch.setattr(placing, "_accumulated", nothing)
    assert not is_contained(name)


def test_the_products_left_out_of_a_turn_are_needed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of a body that turns evenly, eight orders to a step miss the attitude by what they leave out."""
    sphere = RigidBody(diagonal(vector(1, 1, 1)))
    turning = one_instant(sphere, Spin(vector("0.3", 1, "0.2"), Q), "attitude")
    time, none = Fraction(3), Fraction(0)
    truth = enclosed(turning, time, none, 160)
    with_few_orders(monkeypatch)

    def is_there() -> bool:
        rough = enclosed(turning, time, none, 80)
        return all(a.overlaps(b) for a, b in zip(rough.turn, truth.turn, strict=True))

    assert is_there()
    monkeypatch.setattr(placing, "_left_out", nothing)
    assert not is_there()


def test_the_error_of_the_turn_is_needed_for_the_centre(monkeypatch: pytest.MonkeyPatch) -> None:
    """A way in body axes is turned by an attitude that has an error of its own."""
    assert is_contained("kirchhoff")
    turning = placing._turning
    monkeypatch.setattr(placing, "_turning", nothing)
    assert not is_contained("kirchhoff")
    monkeypatch.setattr(placing, "_turning", turning)
    assert is_contained("kirchhoff")


def test_a_body_without_spin_moves_straight() -> None:
    """The attitude of a body at rest is that of its start, exactly known."""
    resting = one_instant(CASES["euler"][0].body, Spin(vector(0, 0, 0)), "attitude")
    motion = TaylorSolution(resting).motion([Fraction(50)], 30)
    assert motion.radii["attitude"][0] == 0
