"""Enclosures of drawn motions against sharper ones of another order, and against the closed forms.

Bodies, loads, starts and spans are drawn to be difficult: seeds down to 1e-300 in a start, a moment, a
coefficient and a gap between moments or semi-axes; near unstable axes; along the axes and not.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from fractions import Fraction
from unittest import mock

import numpy as np
import pytest
from builders.boxes import with_few_orders
from builders.scenes import one_instant
from flint import arb, ctx
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf

from taylor_verify.exact.enclosure.bounds import Bounds
from taylor_verify.exact.enclosure.step import Stepper
from taylor_verify.exact.enclosure.stopping import Coarse
from taylor_verify.exact.enclosure.system import column
from taylor_verify.exact.enclosure.walk import Row
from taylor_verify.exact.rotation import rotation_matrix
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import NoClosedForm, Unsettled, _distance
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import ZERO_VECTOR, Matrix, Vector, diagonal
from taylor_verify.scenes.bodies import Clebsch, Ellipsoid, ImmersedBody, RigidBody
from taylor_verify.scenes.motion import Impulse, Motion, Spin
from taylor_verify.scenes.scene import Scene

BITS = 60
DIGITS = 12

Draw = st.DrawFn

numbers = st.integers(-8, 8).map(lambda n: Fraction(n, 4))
positive = st.integers(1, 8).map(lambda n: Fraction(n, 2))
vectors = st.tuples(numbers, numbers, numbers)
along = st.sampled_from([(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0)]).map(
    lambda axis: tuple(map(Fraction, axis))
)
quaternions = st.tuples(*[st.integers(-3, 3).map(Fraction)] * 4).filter(any)


def seeds_to(deepest: int) -> st.SearchStrategy[Fraction]:
    """Powers of ten of either sign, from one down to 10^-deepest."""
    return st.builds(
        lambda exponent, sign: Fraction(sign, 10**exponent),
        st.sampled_from([k for k in (0, 1, 9, 30, 60, 300) if k <= deepest]),
        st.sampled_from([-1, 1]),
    )


seeds = seeds_to(300)
spans = st.lists(
    st.integers(-8, 8).filter(bool).map(lambda n: Fraction(n, 4)), min_size=1, max_size=2
)


def scaled(factor: Fraction, vector: Vector) -> Vector:
    return tensors.scaled(factor, vector)


def plus(one: Vector, other: Vector) -> Vector:
    return tuple(a + b for a, b in zip(one, other, strict=True))


@st.composite
def loads(draw: Draw) -> Vector:
    """None, one of any size, or a seed of one."""
    if draw(st.booleans()):
        return ZERO_VECTOR
    return scaled(draw(seeds), draw(st.one_of(vectors, along)))


@st.composite
def starts(draw: Draw, deepest: int = 300) -> Vector:
    """A vector of its own, or an axis with a seed beside it."""
    if draw(st.booleans()):
        return draw(vectors)
    beside = draw(st.one_of(vectors, along))
    return plus(draw(along), scaled(draw(seeds_to(deepest)), beside))


@st.composite
def turns(draw: Draw) -> Matrix:
    """The body's own axes, or others in which no number is zero."""
    return rotation_matrix(
        draw(st.one_of(st.just((Fraction(1),) + (Fraction(0),) * 3), quaternions))
    )


@st.composite
def rigid(draw: Draw, is_free: bool = False, deepest: int = 300) -> Scene:
    """A full tensor, two of its moments perhaps all but equal, under a moment or free."""
    gap = abs(draw(seeds_to(deepest)))
    moments = draw(st.permutations([Fraction(2), Fraction(2) + gap, draw(positive)]))
    turn = draw(turns())
    inertia = tensors.product(
        tensors.product(turn, diagonal(tuple(moments))), tensors.transpose(turn)
    )
    moment = ZERO_VECTOR if is_free else tensors.apply(turn, draw(loads()))
    spin = Spin(tensors.apply(turn, draw(starts(deepest))), draw(quaternions))
    return one_instant(RigidBody(inertia, moment), spin, "attitude")


@st.composite
def impulses(draw: Draw, turn: Matrix, deepest: int = 300) -> Impulse:
    x, y = (tensors.apply(turn, draw(starts(deepest))) for _ in range(2))
    return Impulse(
        x, scaled(draw(st.sampled_from([Fraction(0), Fraction(1)])), y), draw(quaternions)
    )


@st.composite
def solids(draw: Draw) -> Scene:
    """All 21 coefficients: a sum of squares, its coupling perhaps a seed; with loads or free."""
    lower = [[draw(st.integers(-2, 2)) * (i > j) for j in range(6)] for i in range(6)]
    for i in range(6):
        lower[i][i] = draw(st.integers(2, 4))
    energy = [
        [Fraction(sum(a * b for a, b in zip(p, q, strict=True)), 8) for q in lower] for p in lower
    ]
    part = abs(draw(seeds))
    body = ImmersedBody(
        linear=tuple(tuple(row[:3]) for row in energy[:3]),
        # Less coupling leaves T positive.
        coupling=tuple(tuple(part * entry for entry in row[3:]) for row in energy[:3]),
        angular=tuple(tuple(row[3:]) for row in energy[3:]),
        force=draw(loads()),
        couple=draw(loads()),
    )
    unturned = diagonal((Fraction(1),) * 3)
    return one_instant(body, draw(impulses(unturned)), "attitude", "centre")


@st.composite
def revolved(draw: Draw, deepest: int = 300) -> Scene:
    """Clebsch's body, free; p and p' perhaps all but equal."""
    p, r, r_prime = draw(positive), draw(positive), draw(positive)
    p_prime = p + draw(st.one_of(positive, seeds_to(deepest).map(abs)))
    q = draw(st.integers(-3, 3)) * Fraction(1, 8)
    body = Clebsch(p, p_prime, q, -q, r, r_prime).body()
    unturned = diagonal((Fraction(1),) * 3)
    return one_instant(body, draw(impulses(unturned, deepest)), "attitude", "centre")


@st.composite
def ellipsoids(draw: Draw) -> Scene:
    """Three semi-axes, two perhaps equal or all but equal; in a vacuum or a fluid; with loads or free."""
    a, b = draw(positive), draw(positive)
    axes = draw(st.permutations([a, a + draw(st.one_of(st.just(Fraction(0)), seeds.map(abs))), b]))
    shape = Ellipsoid(tuple(axes), Fraction(1), draw(st.sampled_from([Fraction(0), Fraction(1)])))
    body = replace(shape.body(), force=draw(loads()), couple=draw(loads()))
    # Its mass is some units, and its moments of inertia.
    return one_instant(body, draw(impulses(diagonal((Fraction(4),) * 3))), "attitude", "centre")


# So many of each kind are drawn by `make test`, and sixty times as many with the slow tests.
COUNTS = {"rigid": 8, "solid": 2, "revolved": 3, "ellipsoid": 5}
MANY = 60
KINDS = {"rigid": rigid(), "solid": solids(), "revolved": revolved(), "ellipsoid": ellipsoids()}


def balls_at(asked: Scene, times: Mapping[int, Fraction], bits: int) -> dict[int, Row]:
    """The rows at these bits, or at more if those do not reach the end."""
    for _ in range(8):
        try:
            with ctx.workprec(bits):
                return dict(TaylorSolution(asked).rows(times, bits, 100_000))
        except Coarse as reason:
            bits = reason.bits
    raise AssertionError(f"no enclosure with {bits} bits")


def entries(row: Row) -> list[arb]:
    return [*row.state, *row.turn, *(row.centre or [])]


def leaving(asked: Scene, elapsed: Sequence[Fraction]) -> list[tuple[int, int]]:
    """Times and entries at which the balls hold no number of those of a sharper run of another order."""
    times = dict(enumerate(elapsed))
    rows = balls_at(asked, times, BITS)
    honest = Stepper.order.fget
    assert honest is not None
    higher = property(lambda self: honest(self) * 5 // 4 + 3)
    with mock.patch.object(Stepper, "order", higher):
        sharper = balls_at(asked, times, 2 * BITS + 20)
    return [(place, k) for place in times for k in missed(rows[place], sharper[place])]


def missed(row: Row, sharper: Row) -> list[int]:
    """The entries whose balls do not meet those of the sharper row."""
    with ctx.workprec(4 * BITS):
        pairs = enumerate(zip(entries(row), entries(sharper), strict=True))
        return [k for k, (one, other) in pairs if not one.overlaps(other)]


@pytest.mark.parametrize("times", [1, pytest.param(MANY, marks=pytest.mark.slow)])
@pytest.mark.parametrize("kind", KINDS)
def test_an_enclosure_holds_a_sharper_one_of_another_order(kind: str, times: int) -> None:
    """Entry by entry: state, attitude and centre, at twice the precision, on both sides of the start."""

    @settings(max_examples=times * COUNTS[kind])
    @given(KINDS[kind], spans)
    def hold(asked: Scene, elapsed: list[Fraction]) -> None:
        assert not leaving(asked, elapsed)

    hold()


def apart(one: Motion, other: Motion) -> bool:
    """Return True if at some time some vector or matrix is farther off than both radii allow."""
    for name in one.quantities:
        sums = one.radius_of(name) + other.radius_of(name)
        for k, room in enumerate(sums):
            # A radius is absolute where the vector may be zero.
            size = mp.norm(list(np.ravel(other[name][k])))
            allowed = room * (1 + room) if size > room else room / size if size else room
            if not _distance(one[name][k], other[name][k]) <= allowed:
                return True
    return False


# Where numbers differ by 1e-300 the closed forms take minutes.
CLOSED = {"rigid": rigid(is_free=True, deepest=60), "revolved": revolved(deepest=30)}


@pytest.mark.parametrize("times", [1, pytest.param(MANY, marks=pytest.mark.slow)])
@pytest.mark.parametrize("kind", CLOSED)
def test_closed_forms_by_both_routes_overlap_the_enclosure(kind: str, times: int) -> None:
    """Within the sum of the radii, and at least one closed form answers for every body."""

    @settings(max_examples=times * COUNTS[kind])
    @given(CLOSED[kind], spans)
    def overlap(asked: Scene, elapsed: list[Fraction]) -> None:
        enclosed = TaylorSolution(asked).motion(elapsed, DIGITS)
        assert max(enclosed.radius) <= mpf(10) ** -DIGITS
        answered = 0
        for route in ("arb", "mpmath"):
            # Seeds of 1e-300 are beyond what the second formulas are made for, and they say so.
            with suppress(NoClosedForm, Unsettled), mp.workdps(60):
                known = solution(asked, route).motion(elapsed, DIGITS + 3)
                assert not apart(enclosed, known)
                answered += 1
        assert answered

    overlap()


@pytest.mark.parametrize("kind", ["rigid", "ellipsoid"])
def test_the_referee_notices_a_bound_that_is_left_out(kind: str) -> None:
    """Without the tail of the polynomial, and with steps that are long for it, drawn motions leave."""
    left: list[bool] = []

    @settings(max_examples=6)
    @given(KINDS[kind])
    def referee(asked: Scene) -> None:
        times = {0: Fraction(1)}
        (sharper,) = balls_at(asked, times, 2 * BITS).values()
        # Eight terms make an enclosure as well, if a wide one.
        with pytest.MonkeyPatch.context() as patch:
            with_few_orders(patch)
            (wide,) = balls_at(asked, times, BITS).values()
            assert not missed(wide, sharper)
            nothing = column([arb(0)] * len(sharper.state))
            with mock.patch.object(Bounds, "defect", return_value=nothing):
                (broken,) = balls_at(asked, times, BITS).values()
        left.append(bool(missed(broken, sharper)))

    referee()
    assert any(left)
