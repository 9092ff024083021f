"""The Taylor route returns balls that contain the motion, however small what drives it."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest
from builders.boxes import CASES, TRUTHS, WIDE, corners, enclosed, is_contained, with_few_orders
from builders.numbers import largest
from builders.scenes import MOMENT, QUATERNION, TENSOR, one_instant, sample_scene, vector
from builders.turns import by_turns
from flint import arb, arb_mat, ctx
from mpmath import mp, mpf

from taylor_verify.exact.balls import balls
from taylor_verify.exact.enclosure import box, step, tube, walk
from taylor_verify.exact.enclosure.course import Course
from taylor_verify.exact.enclosure.loaded import posed
from taylor_verify.exact.enclosure.node_bounds import Bounds
from taylor_verify.exact.enclosure.series import Series
from taylor_verify.exact.enclosure.step import Stepper
from taylor_verify.exact.enclosure.system import System, column
from taylor_verify.exact.solution import Unsettled
from taylor_verify.exact.taylor import TaylorSolution, arcs
from taylor_verify.numbers import tensors
from taylor_verify.numbers.rotation import conjugate, product, rotation_matrix, rotation_rows
from taylor_verify.numbers.tensors import diagonal
from taylor_verify.scenes.bodies import Clebsch, RigidBody
from taylor_verify.scenes.motion import Impulse, Spin
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

TRIAXIAL = RigidBody(diagonal(vector(1, 2, 3)))


# Contained: every motion that begins in a box of starts ends in the balls of that box.


TURN = rotation_matrix(QUATERNION)


@pytest.mark.slow
@pytest.mark.parametrize("size", [WIDE, Fraction(1, 10**12)], ids=["1e-6", "1e-12"])
@pytest.mark.parametrize("name", CASES)
def test_motions_from_a_box_of_starts_stay_in_its_balls(name: str, size: Fraction) -> None:
    """State, attitude and centre, forwards and backwards in time, free and loaded."""
    assert is_contained(name, size=size)


@pytest.mark.parametrize("name", by_turns(CASES, 4))
def test_the_balls_of_a_box_are_not_much_wider_than_its_motions(name: str) -> None:
    """The corners are apart by more than a thirtieth of the width that is given for them."""
    asked, end = CASES[name]
    row = enclosed(asked, Fraction(end), WIDE, 80)
    ends = [TRUTHS[name, tuple(signs), WIDE][0] for signs in corners(asked)]
    for place, width in enumerate(row.state):
        values = [float(z[place].mid()) for z in ends]
        assert max(values) - min(values) >= float(width.rad()) / 30


@pytest.mark.parametrize(
    ("broken", "name"),
    by_turns(
        [
            ("truncation", "euler"),
            ("truncation", "kirchhoff"),
            ("radius", "euler"),
            ("radius", "loaded"),
        ],
        2,
    ),
)
def test_a_bound_left_out_is_seen(broken: str, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each bound counts: without one of them a motion leaves its balls, with it none does."""
    size = WIDE
    if broken == "truncation":
        size = Fraction(0)
        _ = [TRUTHS[name, tuple(signs), size] for signs in corners(CASES[name][0])]
        with_few_orders(monkeypatch)
    assert is_contained(name, size=size)
    zero = column([arb(0)] * posed(CASES[name][0]).size)
    carried = box.carried
    match broken:
        case "truncation":
            monkeypatch.setattr(Bounds, "defect", lambda _: zero)
        case "radius":
            monkeypatch.setattr(
                walk, "carried", lambda *a: replace(carried(*a), radius=carried(*a).radius / 64)
            )
    assert not is_contained(name, size=size)


def test_a_step_whose_bounds_do_not_close_is_halved(monkeypatch: pytest.MonkeyPatch) -> None:
    """The motion is enclosed as sharply by steps of half the length, at the same precision."""
    asked, end = CASES["kirchhoff"]
    usual = enclosed(asked, Fraction(end), Fraction(0), 120)
    closes, lengths = step.tube, list[Fraction]()

    def tube_but_twice(bounds: Bounds, apart: arb_mat) -> tube.Tube:
        lengths.append(bounds.series.step)
        if len(lengths) in (1, 3):
            raise tube.StepTooLong
        return closes(bounds, apart)

    monkeypatch.setattr(step, "tube", tube_but_twice)
    halved = enclosed(asked, Fraction(end), Fraction(0), 120)
    first, half, third, half_of_third, *_ = lengths
    assert (half, half_of_third) == (first / 2, third / 2)
    rows = ([*row.state, *row.turn] for row in (usual, halved))
    for one, other in zip(*rows, strict=True):
        assert one.overlaps(other)
        assert float(other.rad()) <= 4 * float(one.rad()) <= 1e-30


# The precision, and its end.


def test_a_vector_that_vanishes_has_an_absolute_radius() -> None:
    """A moment stops the body: at that instant omega is zero to 200 bits more than were asked for."""
    stopping = RigidBody(diagonal(vector(2, 2, 2)), vector(-2, 0, 0))
    motion = TaylorSolution(one_instant(stopping, Spin(vector(3, 0, 0)))).motion([Fraction(3)], 20)
    assert mp.norm(list(motion["omega"][0])) <= motion.radii["omega"][0]
    assert motion.radii["omega"][0] <= mpf(10) ** -80


@pytest.mark.parametrize("unit", ["1e-200", "1e200"])
def test_the_unit_of_time_may_be_beyond_floats(unit: str) -> None:
    """A motion 10^200 times as slow, or as fast, is the same motion: no length passes through a float."""
    factor = Fraction(unit) ** 2
    usual = one_instant(TRIAXIAL, Spin(vector("0.3", 1, "0.2")))
    other = one_instant(TRIAXIAL, Spin(tensors.scaled(factor, vector("0.3", 1, "0.2"))))
    one = TaylorSolution(usual).motion([Fraction(7)], 20)["omega"][0]
    two = TaylorSolution(other).motion([7 / factor], 20)["omega"][0]
    with mp.workdps(30):
        size = mp.convert(factor)
        assert mp.norm(list(two / size - one)) <= mpf(10) ** -19


def test_the_bits_that_a_motion_loses_are_said() -> None:
    """A motion that no ten thousand bits carry so far is refused: digits per unit of time, and why."""
    # The middle axis of a tensor that is turned by a rational rotation: no coordinate is zero.
    turned = tensors.product(tensors.product(TURN, TRIAXIAL.inertia), tensors.transpose(TURN))
    steady = one_instant(RigidBody(turned), Spin(tensors.apply(TURN, vector(0, 1, 0))))
    assert TaylorSolution(steady).motion([Fraction(20)], 12).radius[0] <= mpf(10) ** -12
    with pytest.raises(
        Unsettled, match=r"loses about 0\.\d+ digits per unit of time.*more than \d+ bits"
    ):
        TaylorSolution(steady).motion([Fraction(10**5)], 12)


def test_instants_within_a_step_cost_no_step(monkeypatch: pytest.MonkeyPatch) -> None:
    """A thousand samples are read off the steps that the last one takes."""
    steps = 0
    original = Stepper.step

    def counted(self: Stepper, *arguments: Any) -> Any:
        nonlocal steps
        steps += 1
        return original(self, *arguments)

    monkeypatch.setattr(Stepper, "step", counted)
    asked = TaylorSolution(CASES["euler"][0])
    counts = []
    for count in (1, 200):
        steps = 0
        asked.motion([Fraction(10 * (k + 1), count) for k in range(count)], 15)
        counts.append(steps)
    assert counts[0] == counts[1]


@pytest.mark.slow
def test_an_axis_for_each_error_keeps_what_a_frame_wraps_away(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A vehicle at t = 25 is known to a digit more than with no more axes than components."""
    scene = replace(load("kirchhoff/auv-turn"), track=frozenset())

    def radius() -> float:
        with ctx.workprec(106):
            ((_, row),) = TaylorSolution(scene).rows({0: Fraction(25)}, 106, 10_000)
        size = sum((z * z for z in row.state), arb(0)).sqrt()
        return max(float((arb(z.rad()) / size).abs_upper()) for z in row.state)

    usual = radius()
    monkeypatch.setattr(box, "_MOST_AXES", 1)
    monkeypatch.setattr(box, "_LONGEST", 0)
    assert usual < radius() / 10


# Frames and series

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


# Arcs


@pytest.mark.parametrize(
    "scene",
    [sample_scene(RigidBody(TENSOR, MOMENT), "attitude"), load("loads/heavy-top")],
    ids=["loads apart from the attitude", "a weight"],
)
def test_arcs_are_motions_of_their_own(scene: Scene) -> None:
    """Row k of arcs is the motion from the k-th state alone, after the k-th span, in its own attitude."""
    starts = [Spin(vector(1, 0, "0.5"), QUATERNION), Spin(vector("0.2", -1, 0))]
    spans = [Fraction(3, 2), Fraction(-1, 3)]
    together = arcs(scene, starts, spans, 30, [Fraction(0)] * 2)
    for k, (start, span) in enumerate(zip(starts, spans, strict=True)):
        alone = TaylorSolution(replace(scene, initial=start)).motion([span], 30)
        with mp.workdps(50):
            for name in together.quantities:
                assert largest(together[name][k] - alone[name][0]) <= mpf(10) ** -30


@pytest.mark.parametrize("size", [Fraction(1, 2**40), Fraction(2**20)], ids=["small", "large"])
def test_arcs_begin_at_any_size(size: Fraction) -> None:
    """An arc has its digits also where its state is far smaller or larger than the scene's own."""
    scene = sample_scene(RigidBody(TENSOR))
    start = Spin(vector(size, -size, size / 2))
    (arc,) = arcs(scene, [start], [1 / size], 30)["omega"]
    (alone,) = TaylorSolution(replace(scene, initial=start)).motion([1 / size], 30)["omega"]
    with mp.workdps(50):
        assert largest(arc - alone) <= mpf(10) ** -30 * largest(alone)


def test_a_couple_that_vanishes_for_the_body_leaves_y_exactly() -> None:
    """With p = p' and no coupling x x U = 0 whatever x is: y = 0 stays zero, and no rounding tells."""
    ninth = Fraction(1, 9)
    sphere = Clebsch(ninth, ninth, Fraction(0), Fraction(0), ninth, ninth).body()
    still = Impulse(vector(0, "25/16", "-4/7"), vector(0, 0, 0), QUATERNION, vector(1, 2, 3))
    moving = replace(sample_scene(sphere, "attitude", "centre"), initial=still)
    motion = TaylorSolution(moving).motion([Fraction(14000, 1107)], 30)
    assert not any(motion["angular_impulse"].flat)
