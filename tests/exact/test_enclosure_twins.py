"""Each ingredient of an enclosure counts, and the derivative that it carries is that of differences."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import product
from typing import Any
from unittest import mock

import pytest
from builders.scenes import one_instant, vector
from builders.turns import by_turns
from flint import arb, arb_mat, ctx, fmpq, fmpq_mat

from taylor_verify.exact.balls import balls
from taylor_verify.exact.conditioning.by_differences import derivatives
from taylor_verify.exact.conditioning.momentum import block_units
from taylor_verify.exact.enclosure import box, flow, tape
from taylor_verify.exact.enclosure.box import Box, carried, identity
from taylor_verify.exact.enclosure.course import Course
from taylor_verify.exact.enclosure.loaded import posed
from taylor_verify.exact.enclosure.node_bounds import Bounds
from taylor_verify.exact.enclosure.step import Step, Stepper
from taylor_verify.exact.enclosure.system import Piece, System, column
from taylor_verify.exact.enclosure.tape import Graph, Tape
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.numbers.irrational import ball
from taylor_verify.numbers.precision import exact_value
from taylor_verify.numbers.tensors import Matrix, Vector, diagonal
from taylor_verify.scenes.bodies import RigidBody
from taylor_verify.scenes.motion import Spin
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

ZERO = Fraction(0)


def squared() -> System:
    """z' = z^2 from 1: z = z0/(1 - z0 t), whose derivative by z0 is 1/(1 - z0 t)^2."""
    graph = Graph()
    (z,) = graph.states(1)
    tape = Tape.of(graph, 1, [graph.product(z, z)])
    return System(lambda time, is_later: Piece(tape, None), (1,), (Fraction(1),))


SQUARE = squared()
STEP, WIDE, SMALL = Fraction(1, 10), Fraction(1, 2), Fraction(1, 10**6)
ORDER = 40
BITS = 80


def square(start: Fraction, time: Fraction) -> Fraction:
    return start / (1 - start * time)


def step_of(order: int = ORDER, apart: Fraction = WIDE) -> Step:
    """One step of z' = z^2, to order ``order``, from all within ``apart`` of 1."""
    with ctx.workprec(BITS), mock.patch.object(Stepper, "order", order):
        start = [arb(1, ball(apart))]
        return Stepper(SQUARE).step(Box.about(start), ZERO, STEP, STEP)


def polynomial(step: Fraction, s: Fraction, order: int) -> Fraction:
    """The Taylor polynomial from 1 at the share s of a step."""
    return sum(((s * step) ** k for k in range(order + 1)), ZERO)


def is_in_the_tube(order: int, apart: Fraction) -> bool:
    """Return True if the motions from 1 and from both ends of the box stay within the tube's bounds."""
    step = step_of(order, apart)
    for share, start in product((Fraction(1, 2), Fraction(1)), (-apart, ZERO, apart)):
        end = square(1 + start, share * step.length)
        error = abs(end - polynomial(step.length, share, order))
        bound = step.tube.width if start else step.tube.truncation
        if not ball(error) <= bound[0, 0]:
            return False
    return True


def test_the_tail_of_the_polynomial_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without the products of high orders the truncation is nothing, and the motion is elsewhere."""
    assert is_in_the_tube(4, ZERO)
    zero = column([arb(0)])
    monkeypatch.setattr(Bounds, "defect", lambda _: zero)
    assert not is_in_the_tube(4, ZERO)


def test_the_width_of_the_tube_counts_in_its_own_bound(monkeypatch: pytest.MonkeyPatch) -> None:
    """Rates of change on the polynomial alone are too small for motions beside it."""
    assert is_in_the_tube(ORDER, WIDE)
    honest = Bounds.rates_of_change
    monkeypatch.setattr(Bounds, "rates_of_change", lambda self, _: honest(self, [arb(0)]))
    assert not is_in_the_tube(ORDER, WIDE)


def is_in_the_box(start: Fraction) -> bool:
    """Return True if the balls of a wide box of starts hold the motion from one of its ends."""
    with ctx.workprec(BITS):
        wide = [arb(1, ball(WIDE))]
        run = Course.of(SQUARE, wide, BITS, 10_000)
        ((_, row),) = run.rows([STEP])
        return bool(row.state[0].contains(ball(square(start, STEP))))


def test_what_the_variational_polynomial_misses_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    """The derivative at the middle of a box is none for its ends: the motion from one end leaves."""
    ends = 1 - WIDE, 1 + WIDE
    assert all(map(is_in_the_box, ends))
    monkeypatch.setattr(flow, "flow_defect", lambda *_: column([arb(0)]))
    assert not all(map(is_in_the_box, ends))


def test_the_derivative_of_the_flow_holds_that_of_every_start(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """At both ends of the box and in its middle; without the defect only in the middle."""

    def holds() -> list[bool]:
        step = step_of()
        assert step.flow is not None
        with ctx.workprec(BITS):
            starts = (1 - WIDE, Fraction(1), 1 + WIDE)
            true = [ball(1 / (1 - z * step.length) ** 2) for z in starts]
            return [step.flow.at(arb(1))[0, 0].overlaps(value) for value in true]

    assert holds() == [True, True, True]
    monkeypatch.setattr(flow, "flow_defect", lambda *_: column([arb(0)]))
    assert holds()[::2] == [False, False]


# The frame about the shortest axes, when there are too many. Its inverse may be known badly: columns that
# are nearly parallel are as sound as any others.

PARALLEL = [
    [[1, 3, 7], [3, 9 + Fraction(k, 2**46), 21], [7, 21, 49 + Fraction(1, 2**44 + k)]]
    for k in range(1, 9)
]


def rational(value: arb) -> fmpq:
    mantissa, exponent = value.mid().man_exp()
    return fmpq(mantissa) * fmpq(2) ** int(exponent)


def is_about(columns: Sequence[Sequence[Fraction | int]], patch: pytest.MonkeyPatch) -> bool:
    """Return True if a frame of these columns holds every corner of four axes: in exact rationals."""
    with ctx.workprec(64):
        frame = [[ball(Fraction(entry)).mid() for entry in column] for column in columns]
        patch.setattr(box, "directions", lambda *_: frame)
        patch.setattr(box, "_LONGEST", 0)
        axes = arb_mat([[2, 1, 0, 1], [0, 3, 1, 1], [1, 0, 5, 1]])
        radius = column([arb(1), arb(1) / 8, arb(3) / 4, arb(1) / 2])
        about, bounds = box.fewer(axes, radius, [arb(1)] * 3)
    inverse = fmpq_mat(3, 3, [rational(entry) for entry in about.entries()]).inv()
    old = fmpq_mat(3, 4, [rational(entry) for entry in axes.entries()])
    for signs in product((-1, 1), repeat=4):
        corner = [s * rational(r) for s, r in zip(signs, radius.entries(), strict=True)]
        shares = (inverse * (old * fmpq_mat(4, 1, corner))).entries()
        pairs = zip(shares, bounds.entries(), strict=True)
        if any(abs(share) > rational(bound) for share, bound in pairs):
            return False
    return True


def test_the_width_of_the_inverse_counts_in_the_radius(monkeypatch: pytest.MonkeyPatch) -> None:
    """The inverse of nearly parallel columns has few digits: with its midpoint the box is too small."""
    assert all(is_about(columns, monkeypatch) for columns in PARALLEL)
    honest = box.inverted

    def midpoints(matrix: arb_mat) -> arb_mat:
        inverse = honest(matrix)
        return arb_mat(3, 3, [entry.mid() for entry in inverse.entries()])

    monkeypatch.setattr(box, "inverted", midpoints)
    assert not all(is_about(columns, monkeypatch) for columns in PARALLEL)


def test_columns_that_cannot_be_inverted_are_replaced(monkeypatch: pytest.MonkeyPatch) -> None:
    """The coordinate axes are always sound: the box is wider, and holds what it held."""
    assert is_about([[1, 2, 3], [2, 4, 6], [1, 0, 0]], monkeypatch)
    assert is_about([[1, 2, 3]], monkeypatch)


def is_left(replaced: Any, patch: pytest.MonkeyPatch) -> bool:
    """Return True if a motion from a corner of a box leaves it, where each step replaces all axes."""
    patch.setattr(box, "_MOST_AXES", 1)
    patch.setattr(box, "_LONGEST", 0)
    patch.setattr(box, "fewer", replaced)
    system, half = posed(replace(load("kirchhoff/general-body"), track=frozenset())), ball(SMALL)
    with ctx.workprec(BITS):
        starts = balls(system.start)
        corner = [z + half for z in starts]
        wide = [z + arb(0, half.upper()) for z in starts]
        row, end = (
            next(Course.of(system, start, BITS, 10_000).rows([Fraction(3)]))[1].state
            for start in (wide, corner)
        )
        return not all(a.overlaps(b) for a, b in zip(row, end, strict=True))


def test_the_radius_of_the_frame_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    """A motion leaves the box if the radius is halved."""
    honest = box.fewer

    def halved(axes: arb_mat, radius: arb_mat, units: list[arb]) -> box.Axes:
        about, bounds = honest(axes, radius, units)
        return about, bounds / 2

    assert not is_left(honest, monkeypatch)
    assert is_left(halved, monkeypatch)


# The data.


def is_at_its_speed(bits: int, start: Fraction, moment: Fraction) -> bool:
    """Return True if a body that is pushed about one axis has, at t = 4, the speed start + 4 moment."""
    pushed = RigidBody(diagonal(vector(1, 2, 3)), (moment, ZERO, ZERO))
    asked = TaylorSolution(one_instant(pushed, Spin((start, ZERO, ZERO))))
    with ctx.workprec(bits):
        ((_, row),) = asked.rows({0: Fraction(4)}, bits, 10_000)
    with ctx.workprec(2 * bits):
        return bool(row.state[0].overlaps(ball(start + 4 * moment)))


@pytest.mark.parametrize("bits", [40, 80, 200])
def test_the_rounding_of_the_data_counts(bits: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """A third is no binary number: with its nearest one in its place the motion is another one."""
    third = Fraction(1, 3)
    assert is_at_its_speed(bits, ZERO, third)
    monkeypatch.setattr(tape, "ball", lambda number: ball(number).mid())
    assert not is_at_its_speed(bits, ZERO, third)


@pytest.mark.parametrize("bits", [40, 80, 200])
def test_the_rounding_of_the_start_counts(bits: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """A start of a third is a box, however small."""
    third = Fraction(1, 3)
    assert is_at_its_speed(bits, third, ZERO)
    honest = Box.about
    monkeypatch.setattr(Box, "about", lambda numbers: honest([b.mid() for b in numbers]))
    assert not is_at_its_speed(bits, third, ZERO)


# The derivative

MANY_BITS = 140
# The start is a box of this half width, so that there is something to carry.
BOX = Fraction(1, 10**38)
# Differences of 10^-30 units err by less than this part of the largest derivative.
OF_DIFFERENCES = Fraction(1, 10**20)
# Norms are wanted to a digit or two.
OF_NORMS = arb("0.01")

# One scene of every kind, and a time of its own.
BY_DIFFERENCES = {
    "euler/generic": 10,
    "euler/tennis-racket": 12,
    "euler/axisymmetric": 10,
    "euler/full-tensor": 10,
    "euler/moment-oblique": 3,
    "kirchhoff/whole-motion": 5,
    "kirchhoff/weber": 1,
    "kirchhoff/chaplygin": 2,
    "kirchhoff/general-body": 1,
    "extremes/kirchhoff-nearly-clebsch": 3,
}


def enclosed(scene: Scene, times: Sequence[Fraction]) -> list[arb_mat]:
    """The derivatives at the times of the state by its start: products of those of the steps."""
    system, derivatives, pending = posed(scene), [], list(times[::-1])
    with ctx.workprec(MANY_BITS):
        start = [ball(value) + arb(0, ball(BOX).upper()) for value in system.start]
        run = Course.of(system, start, MANY_BITS, 10_000)
        box, now, length, total = Box.about(start), Fraction(0), times[-1], identity(system.size)
        while pending:
            step = run.stepper.step(box, now, length, times[-1] - now)
            assert step.flow is not None
            while pending and abs(pending[-1] - now) <= abs(step.length):
                derivatives.append(
                    step.flow.whole(ball((pending.pop() - now) / step.length)) * total
                )
            total = step.flow.whole(arb(1)) * total
            box = carried(box, step.state, step.tube, step.flow, system.spans)
            now, length = now + step.length, 2 * step.length
        return [in_momenta(scene, matrix) for matrix in derivatives]


def in_momenta(scene: Scene, matrix: arb_mat) -> arb_mat:
    """The derivative of H by H for a rigid body, and of the impulses without any clock."""
    size = 3 if scene.model == "euler" else 6
    block = arb_mat([[matrix[i, j] for j in range(size)] for i in range(size)])
    if not isinstance(scene.body, RigidBody):
        return block
    inertia, inverse = in_balls(scene.body.inertia), in_balls(scene.body.inverse_inertia)
    return inertia * block * inverse


def in_balls(matrix: Matrix) -> arb_mat:
    return arb_mat([[ball(entry) for entry in row] for row in matrix])


def in_units(units: Vector, matrix: arb_mat) -> arb_mat:
    """The derivatives between momenta that are counted in these powers of two."""
    n = len(units)
    factors = [[ball(units[j] / units[i]) for j in range(n)] for i in range(n)]
    return arb_mat([[matrix[i, j] * factors[i][j] for j in range(n)] for i in range(n)])


@pytest.mark.parametrize("name", by_turns(BY_DIFFERENCES))
def test_differences_of_the_motion_lie_in_the_enclosed_derivative(name: str) -> None:
    """Each derivative, a difference of exact motions, is in its ball, whose width no norm would notice."""
    scene = replace(load(name), track=frozenset())
    times = [Fraction(BY_DIFFERENCES[name], 3), Fraction(BY_DIFFERENCES[name])]
    differences = derivatives(scene, times, 30, 110)
    for by_steps, sharp in zip(enclosed(scene, times), differences.momentum, strict=True):
        with ctx.workprec(MANY_BITS):
            counted = in_units(block_units(scene), by_steps)
            size = max(abs(exact_value(entry)) for entry in sharp.flat)
            slack = ball(size * OF_DIFFERENCES).upper()
            for i, row in enumerate(sharp):
                for j, entry in enumerate(row):
                    assert counted[i, j].overlaps(ball(exact_value(entry)) + arb(0, slack))
                    assert counted[i, j].rad() <= ball(size) * OF_NORMS
