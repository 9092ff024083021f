"""Clebsch's body in balls: against the other closed form, Taylor and the equations of motion.

The twins at the end are faults put in on purpose; the comparison they name must notice each.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cache
from itertools import chain
from typing import Any

import numpy as np
import pytest
from builders.clebsch import (
    FALLING,
    GENERIC,
    PLAIN,
    STOUT,
    UPRIGHT,
    State,
    at_the_border,
    body,
    falling,
)
from builders.scenes import one_instant, vector
from builders.turns import by_turns
from flint import acb, arb, ctx
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf

from taylor_verify.exact import lattice as lattice_module
from taylor_verify.exact.balls import Undecidable, ball
from taylor_verify.exact.kirchhoff import course as course_module
from taylor_verify.exact.kirchhoff.closed import closed_form, enclosed
from taylor_verify.exact.kirchhoff.course import Course, course
from taylor_verify.exact.kirchhoff.quartic import Nutation
from taylor_verify.exact.kirchhoff.weierstrass import NutatingBody, Orbit
from taylor_verify.exact.lattice import Periods
from taylor_verify.exact.solution import NoClosedForm, Unsettled
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.scenes.bodies import Clebsch, ImmersedBody
from taylor_verify.scenes.library import names
from taylor_verify.scenes.motion import Impulse, Motion
from taylor_verify.scenes.precision import exact_value
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene

DIGITS = 30
WHOLE = frozenset({"attitude", "centre"})
TILTED = (Fraction(1), Fraction(2), Fraction(-1), Fraction(3))  # not of unit length
AWAY = (Fraction(1, 3), Fraction(-2), Fraction(5))


def scene(solid: Clebsch, start: State, track: frozenset[str] = WHOLE) -> Scene:
    impulse = Impulse(tuple(start[:3]), tuple(start[3:]), TILTED, AWAY)
    return one_instant(solid.body(), impulse, *track)


# Bodies and starts: one per regime and per difficulty.

SHARP = body(1, 2, "1/10", "3/10", 1, "1/2")  # p' > p
BLUNT = body(2, 1, "1/10", "3/10", 1, "1/2")  # p' < p
EVEN = body(1, 1, "1/10", "3/10", 1, "1/2")  # p' = p
ALIKE = body(1, 1, "1/10", "1/10", 1, "1/2")  # p' = p, q' = q


CASES: dict[str, tuple[Clebsch, State, str]] = {
    "four real roots": (SHARP, GENERIC, "four-roots"),
    "four real roots, the two largest": (
        body(3, 1, "-1/10", "7/20", 2, 1),
        vector(1, 1, "3/4", "1/4", "-1/4", "-1/8"),
        "four-roots",
    ),
    "two real roots": (BLUNT, GENERIC, "two-roots"),
    "cubic": (EVEN, GENERIC, "cubic"),
    "cubic, third root below": (EVEN, (*GENERIC[:5], Fraction(-1)), "cubic"),
    "no screw coupling": (PLAIN, GENERIC, "four-roots"),
    "start at a turning point": (SHARP, vector(1, 1, 2, "1/3", "1/3", 2), "four-roots"),
    "start at the upper turning point": (BLUNT, vector(1, 1, 2, "1/3", "1/3", 3), "two-roots"),
    "through the pole": (SHARP, vector("3/5", 0, "4/5", "1/3", "1/7", 1), "four-roots"),
    "through the lower pole": (BLUNT, vector("3/5", 0, "4/5", 3, "1/7", -1), "two-roots"),
    # A third is no ball of radius zero: that the pole is a root is then told by rationals alone.
    "through the pole, F = 1/3": (
        SHARP,
        vector("1/5", 0, "4/15", "1/3", "1/7", 1),
        "four-roots",
    ),
    "through the lower pole, F = 1/3": (
        BLUNT,
        vector("1/5", 0, "4/15", -3, "1/7", 1),
        "two-roots",
    ),
    "at a turning point and to the pole, F = 1/3": (
        SHARP,
        vector("1/5", 0, "4/15", "1/3", 0, 1),
        "four-roots",
    ),
    "from the axis": (EVEN, UPRIGHT, "cubic"),
    "from the axis, two roots": (BLUNT, vector(0, 0, -2, "1/3", "1/7", 2), "two-roots"),
    "planar, over both poles": (
        BLUNT,
        vector("3/5", "1/5", "4/5", "1/5", "-3/5", 0),
        "four-roots",
    ),
    "from rest beside the axis": (SHARP, vector("1/100", 0, 1, 0, 0, 0), "four-roots"),
    "quadratic": (ALIKE, GENERIC, "trigonometric"),
    "quadratic, screw": (EVEN, (*GENERIC[:5], Fraction(0)), "trigonometric"),
    "quadratic, from the axis": (ALIKE, UPRIGHT, "trigonometric"),
    "falling from the pole": (falling(PLAIN, FALLING), FALLING, "hyperbolic"),
    "falling from the pole, screw": (falling(EVEN, FALLING), FALLING, "hyperbolic"),
    "border": (at_the_border(STOUT, FALLING), FALLING, "algebraic"),
    "heteroclinic": (PLAIN, vector("3/5", 0, "4/5", 0, "3/5", 0), "heteroclinic"),
    "heteroclinic downwards, F irrational": (
        body(1, 2, "1/5", "-1/3", 1, "1/2"),
        vector("1/2", 1, 1, 1, "-1/2", 0),
        "heteroclinic",
    ),
    "steady": (
        body(1, "92/81", "1/10", "3/10", 1, "1/2"),  # p' solves f'(4/5) = 0
        vector("3/5", 0, "4/5", "1/3", 0, 1),
        "steady",
    ),
    "along the axis": (SHARP, vector(0, 0, 1, 0, 0, 1), "steady"),
    "top": (EVEN, vector(0, 0, 0, "1/5", "-1/4", "2/3"), "euler-top"),
    "rest": (EVEN, vector(0, 0, 0, 0, 0, 0), "rest"),
}
by_case = pytest.mark.parametrize(("solid", "start", "kind"), list(CASES.values()), ids=list(CASES))
of_each_kind = pytest.mark.parametrize(
    ("solid", "start", "kind"),
    by_turns(CASES.values(), 4, lambda solid, start, kind: kind),
    ids=list(CASES),
)


# The comparison


def overlap(a: Motion, b: Motion) -> bool:
    """Whether every vector and matrix of both differs by no more than the two radii together."""
    with mp.workdps(400):
        return all(
            _distance(a[name][k], b[name][k]) <= _room(a, k, name) + _room(b, k, name)
            for name in a.quantities
            for k in range(len(a.radius))
        )


def _distance(a: np.ndarray[Any, Any], b: np.ndarray[Any, Any]) -> mpf:
    return mp.norm(list((a - b).flat))


def _room(motion: Motion, k: int, name: str) -> mpf:
    """The radius times the largest norm that the truth can have."""
    radius = motion.radius[k]
    return radius * (mp.norm(list(motion[name][k].flat)) / (1 - radius) or 1)


def is_narrow(motion: Motion, digits: int) -> bool:
    return all(radius <= mpf(10) ** -digits for radius in motion.radius)


def agrees_with_taylor(problem: Scene, times: Sequence[Fraction]) -> bool:
    """Impulses, attitude and centre."""
    try:
        motion = enclosed(problem).motion(times, DIGITS)
    except Unsettled:
        return False
    return is_narrow(motion, DIGITS) and overlap(motion, truth(problem, tuple(times)))


@cache
def truth(problem: Scene, times: tuple[Fraction, ...]) -> Motion:
    return TaylorSolution(problem).motion(times, DIGITS)


def agrees_with_jacobi(problem: Scene, times: Sequence[Fraction]) -> bool:
    """Impulses alone, by Jacobi's functions."""
    problem = replace(problem, track=frozenset())
    motion = enclosed(problem).motion(times, DIGITS)
    return is_narrow(motion, DIGITS) and overlap(motion, closed_form(problem).motion(times, DIGITS))


BOTH_WAYS = vector("3/2", 4, "-7/3", 0, "1/1000000007")


@pytest.mark.parametrize(("solid", "start", "kind"), by_turns(CASES.values()))
def test_agrees_with_taylor(solid: Clebsch, start: State, kind: str) -> None:
    """Impulses, attitude and centre are those of the Taylor route, both ways in time."""
    problem = scene(solid, start)
    assert enclosed(problem).regime == kind
    assert agrees_with_taylor(problem, BOTH_WAYS)


@of_each_kind
def test_agrees_with_jacobi_for_long(solid: Clebsch, start: State, kind: str) -> None:
    """Jacobi's functions lead to the same impulses, also after a time of 1e12."""
    times = vector("13/3", -120, Fraction(10) ** 12)
    if kind in ("hyperbolic", "heteroclinic"):
        times = times[:2]  # Then nothing but the double root is left.
    assert agrees_with_jacobi(scene(solid, start), times)


@by_case
def test_begins_as_told(solid: Clebsch, start: State, kind: str) -> None:
    """At time zero everything is exact; a centre at the origin and a y of zero included."""
    for centre in (AWAY, vector(0, 0, 0)):
        problem = scene(solid, start)
        problem = replace(
            problem,
            initial=Impulse(tuple(start[:3]), tuple(start[3:]), TILTED, tuple(centre)),
        )
        motion = enclosed(problem).motion([Fraction(0)], DIGITS)
        assert is_narrow(motion, DIGITS)
        with mp.workdps(DIGITS + 20):
            stated = [mp.convert(c) for c in (*start, *centre)]
            vectors = [motion[n][0] for n in ("linear_impulse", "angular_impulse", "centre")]
            for a, b in zip(chain(*vectors), stated, strict=True):
                assert abs(a - b) <= motion.radius[0] * 10


@by_case
@pytest.mark.parametrize("bits", [60, 100, 170])
def test_a_ball_at_any_precision_holds_the_truth(
    solid: Clebsch, start: State, kind: str, bits: int
) -> None:
    """Component by component, however coarse: what is found with 80 digits lies in every ball."""
    problem, times = scene(solid, start), vector("3/2", -40, 1000)
    if kind in ("hyperbolic", "heteroclinic"):
        times = times[:2]
    fine = enclosed(problem).motion(times, 80)
    with ctx.workprec(bits):
        try:
            coarse = enclosed(problem).enclose(times, bits)
        except Undecidable:
            pytest.skip("a branch is open at this precision")
    for name, rows in coarse.items():
        coarse_balls = np.array(rows, dtype=object).flat
        for narrow, wide in zip(fine[name].flat, coarse_balls, strict=True):
            # The finer number is known to 80 digits of its vector, which is below 10000.
            blur = Fraction(1, 10**76)
            exactly = exact_value(narrow)
            with ctx.workprec(400):
                assert wide.overlaps(arb(ball(exactly), ball(blur)))


# The equations of motion

# Central differences at h: the error is h^2/6 of a third derivative. No rate here is above 10 per
# unit of time and no vector above 100, so it is below 1e-30 * 1e5 / 6; rounding leaves 1e-70/h.
STEP = Fraction(1, 10**15)
LEFT = mpf("1e-25")


@by_case
def test_obeys_the_equations_of_motion(solid: Clebsch, start: State, kind: str) -> None:
    """x' = x x Omega, y' = y x Omega + x x U, R' = R [Omega]x and centre' = R U."""
    middles = vector("-39/7", "13/3", 0)
    times = [middle + k * STEP for middle in middles for k in (-1, 0, 1)]
    motion = enclosed(scene(solid, start)).motion(times, 70)
    with mp.workdps(80):
        for k in range(1, len(times), 3):
            before, now, after = (
                {n: motion[n][k + d] for n in motion.quantities} for d in (-1, 0, 1)
            )
            for name, expected in rates(solid, now).items():
                slope = (after[name] - before[name]) / (2 * mp.convert(STEP))
                assert _distance(slope, expected) <= LEFT


def rates(solid: Clebsch, now: dict[str, Any]) -> dict[str, Any]:
    """The right-hand sides of Kirchhoff's equations, Hydromechanics 49."""
    immersed: ImmersedBody = solid.body()
    A, B, C = (
        np.array([[mp.convert(c) for c in row] for row in matrix], dtype=object)
        for matrix in (immersed.linear, immersed.coupling, immersed.angular)
    )
    x, y, R = now["linear_impulse"], now["angular_impulse"], now["attitude"]
    U, Omega = A @ x + B @ y, B.T @ x + C @ y
    return {
        "linear_impulse": _cross(x, Omega),
        "angular_impulse": _cross(y, Omega) + _cross(x, U),
        "attitude": np.array([_cross(row, Omega) for row in R], dtype=object),
        "centre": R @ U,
    }


def _cross(a: Any, b: Any) -> Any:
    return np.array([a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)], dtype=object)


# Difficult bodies

TINY = Fraction(1, 10**30)


def beside(solid: Clebsch, change: Fraction) -> Clebsch:
    return replace(solid, p_prime=solid.p_prime + change)


ADVERSARIAL: dict[str, tuple[Clebsch, State]] = {
    # 1 - k^2 is about 1e-30 and 1e-60 beside a homoclinic and a heteroclinic motion.
    "beside falling": (beside(falling(PLAIN, FALLING), TINY), FALLING),
    "beyond falling": (beside(falling(EVEN, FALLING), -(TINY**2)), FALLING),
    "beside the border": (beside(at_the_border(STOUT, FALLING), TINY), FALLING),
    "beside heteroclinic": (PLAIN, vector("3/5", 0, "4/5", 0, "3/5", TINY)),
    "beside heteroclinic, faster": (PLAIN, vector("3/5", 0, "4/5", 0, Fraction(3, 5) + TINY, 0)),
    "beside steady": (SHARP, vector(TINY, 0, 1, 0, TINY / 3, 3)),
    "p' nearly p": (body(1, 1 + TINY, "1/10", "3/10", 1, "1/2"), GENERIC),
    "p' nearly p, below": (body(1, 1 - TINY, "1/10", "3/10", 1, "1/2"), GENERIC),
    "q' nearly q": (body(1, 2, "1/10", Fraction(1, 10) + TINY, 1, "1/2"), GENERIC),
    "both nearly": (body(1, 1 + TINY, "1/10", Fraction(1, 10) - TINY, 1, "1/2"), GENERIC),
    "q' nearly q, p' = p": (body(1, 1, "1/10", Fraction(1, 10) + TINY, 1, "1/2"), GENERIC),
    "nearly through the pole": (BLUNT, vector("3/5", 0, "4/5", "1/3", "1/7", 1 - TINY)),
    "nearly through the lower pole": (BLUNT, vector("3/5", 0, "4/5", 3, "1/7", -1 + TINY)),
    "nearly from the axis": (EVEN, vector(TINY, 0, 1, "1/3", "1/7", 1)),
    "slender and heavy": (
        body("1e-6", "1e6", 0, 0, "1e-3", "1e3"),
        vector("1e-3", 0, "1e-6", 1, 1, "1e-3"),
    ),
    "weak impulse": (SHARP, vector("1e-12", "2e-12", "-1e-12", "1/3", "1/7", 1)),
    "no G": (SHARP, vector(1, 0, 0, 0, "1/3", "1/4")),
    "no y3": (BLUNT, vector(1, "1/2", "1/3", 1, "1/3", 0)),
    "no x3": (BLUNT, vector(1, "1/2", 0, "1/5", "1/3", "1/4")),
    "only y": (BLUNT, vector(1, 0, 0, 0, 1, 0)),
}
by_difficulty = pytest.mark.parametrize(
    ("solid", "start"), list(ADVERSARIAL.values()), ids=list(ADVERSARIAL)
)
some_difficult = pytest.mark.parametrize(
    ("solid", "start"), by_turns(ADVERSARIAL.values()), ids=list(ADVERSARIAL)
)


@some_difficult
def test_difficult_bodies_agree_with_taylor(solid: Clebsch, start: State) -> None:
    """Beside every degenerate motion, and with the least and the largest of coefficients."""
    assert agrees_with_taylor(scene(solid, start), vector("3/2", -3))


@some_difficult
def test_difficult_bodies_agree_with_jacobi_for_long(solid: Clebsch, start: State) -> None:
    """And so they do after 1e6 units of time, beside a separatrix and elsewhere."""
    assert agrees_with_jacobi(scene(solid, start), vector("17/3", Fraction(-(10**6))))


@by_difficulty
def test_difficult_bodies_settle_to_few_digits_and_to_many(solid: Clebsch, start: State) -> None:
    """Three digits are not refused because the way there takes hundreds, and hold what 150 find."""
    problem, times = scene(solid, start), vector(2, Fraction(-(10**12)), Fraction(1, 10**100))
    few, many = (enclosed(problem).motion(times, digits) for digits in (3, 150))
    assert is_narrow(few, 3)
    assert is_narrow(many, 150)
    assert overlap(few, many)


@pytest.mark.parametrize("power", [6, 12])
def test_a_strong_impulse_only_runs_faster(power: int) -> None:
    """x and y multiplied by c, and time divided by it, leave the path as it is, to c = 1e12."""
    c = Fraction(10) ** power
    slow = enclosed(scene(SHARP, GENERIC)).motion(vector("3/2"), DIGITS)
    strong = [c * component for component in GENERIC]
    fast = enclosed(scene(SHARP, strong)).motion([Fraction(3, 2) / c], DIGITS)
    scaled = dict(fast.quantities)
    with mp.workdps(200):  # The division's own error is nothing beside the radii.
        for n in ("linear_impulse", "angular_impulse"):
            scaled[n] = fast[n] / mp.convert(c)
    assert overlap(Motion(scaled, fast.radius), slow)


numbers = st.fractions(-2, 2, max_denominator=40)
coefficients = st.builds(
    lambda f, e: f * Fraction(10) ** e,
    st.fractions(Fraction(1, 9), 9, max_denominator=9),
    st.integers(-3, 3),
)


@st.composite
def motions(draw: st.DrawFn) -> tuple[Clebsch, State]:
    """Bodies whose coefficients may coincide, and starts on the axis, at a pole or with zeros."""
    p, r = draw(coefficients), draw(coefficients)
    p_prime = draw(st.one_of(coefficients, st.just(p)))
    r_prime = draw(st.one_of(coefficients, st.just(r)))
    # |q|^2 < p r and likewise along the axis, for any |q| below the least of the four.
    most = min(p, p_prime, r, r_prime)
    share = st.fractions(Fraction(-9, 10), Fraction(9, 10), max_denominator=20)
    q = draw(st.one_of(st.just(Fraction(0)), share)) * most
    q_prime = draw(st.one_of(st.just(q), share.map(lambda s: s * most)))
    start = [draw(numbers) for _ in range(6)]
    place = draw(st.sampled_from(["anywhere", "axis", "pole", "zeros"]))
    if place == "axis":
        start[:2] = [Fraction(0), Fraction(0)]
    elif place == "pole":  # F = 5 c, FG = F y3
        c = start[0]
        start[:3] = [3 * c, Fraction(0), 4 * c]
        start[3] = start[5] / 3
    elif place == "zeros":
        for k in draw(st.sets(st.integers(0, 5), max_size=5)):
            start[k] = Fraction(0)
    return Clebsch(p, p_prime, q, q_prime, r, r_prime), start


def agree_at_any_time(motion: tuple[Clebsch, State], time: Fraction, power: int) -> None:
    """The closed form is Jacobi's, at a time and at one up to 1e12 times as long."""
    solid, start = motion
    # Far out on a motion that never returns nothing is left to compare but its limit.
    kind = enclosed(scene(solid, start, frozenset())).regime
    assume(kind not in ("hyperbolic", "heteroclinic") or power == 0)
    assert agrees_with_jacobi(scene(solid, start), [time, time * 10**power])


any_time = given(motions(), st.fractions(-3, 3, max_denominator=30), st.integers(0, 12))


@settings(max_examples=8)
@any_time
def test_any_motion_agrees_with_jacobi(
    motion: tuple[Clebsch, State], time: Fraction, power: int
) -> None:
    """Any body, any start, any time up to 1e12."""
    agree_at_any_time(motion, time, power)


@pytest.mark.slow
@settings(max_examples=100)
@any_time
def test_many_motions_agree_with_jacobi(
    motion: tuple[Clebsch, State], time: Fraction, power: int
) -> None:
    """So they do for many more bodies."""
    agree_at_any_time(motion, time, power)


@settings(max_examples=25)
@given(motions(), st.fractions(-1, 1, max_denominator=30))
def test_any_motion_agrees_with_taylor(motion: tuple[Clebsch, State], share: Fraction) -> None:
    """With attitude and centre, within a few units of the body's own time."""
    solid, start = motion
    largest = max(solid.p, solid.p_prime, solid.r, solid.r_prime)
    pace = largest * (sum(abs(c) for c in start) + Fraction(1, 1000))
    assert agrees_with_taylor(scene(solid, start), [3 * share / pace])


# Long times and shipped scenes


def closed_scenes() -> list[str]:
    shipped = [name for name in names() if name.startswith("kirchhoff/")]
    return [name for name in shipped if _is_closed(load(name))]


def _is_closed(problem: Scene) -> bool:
    try:
        enclosed(problem)
    except NoClosedForm:
        return False
    return True


@pytest.mark.parametrize("name", closed_scenes())
def test_a_billion_periods_are_no_obstacle(name: str) -> None:
    """After 1e9 periods 40 digits are proven, and x3 and |y| are where they were at the start."""
    problem = load(name)
    time = 10**9 * period(problem)
    if enclosed(problem).regime == "heteroclinic":
        time = Fraction(100)  # y falls off exponentially: 1e9 units would need as many digits.
    motion = enclosed(problem).motion([time], 40)
    assert is_narrow(motion, 40)
    start = problem.initial
    assert isinstance(start, Impulse)
    with mp.workdps(100):
        x, y = motion["linear_impulse"][0], motion["angular_impulse"][0]
        told_x, told_y = ([mp.convert(c) for c in v] for v in (start.linear, start.angular))
        # 40 digits of each vector; squares have twice its relative error.
        bound = 4 * mpf(10) ** -40
        assert abs(mp.norm(list(x)) - mp.norm(told_x)) <= bound * mp.norm(told_x)
        if isinstance(enclosed(problem), NutatingBody) and recurs(problem):
            assert abs(x[2] - told_x[2]) <= bound * mp.norm(told_x)
            assert abs(mp.norm(list(y)) - mp.norm(told_y)) <= bound * mp.norm(told_y)


def period(problem: Scene) -> Fraction:
    """That of x3 to 80 digits; 1 where it has none."""
    if not recurs(problem):
        return Fraction(1)
    with ctx.workprec(300):
        real_period = _course(problem).lattice.period
        assert real_period is not None
        mantissa, exponent = real_period.mid().man_exp()
    return Fraction(int(mantissa)) * Fraction(2) ** int(exponent)


def recurs(problem: Scene) -> bool:
    if not isinstance(enclosed(problem), NutatingBody):
        return False
    with ctx.workprec(100):
        return _course(problem).lattice.period is not None


def _course(problem: Scene) -> Course:
    assert isinstance(problem.body, ImmersedBody)
    assert problem.body.clebsch is not None
    assert isinstance(problem.initial, Impulse)
    nutation = Nutation.of(problem.body.clebsch, problem.initial)
    return course(nutation, enclosed(problem).regime == "heteroclinic")


def test_other_bodies_have_no_closed_form_here() -> None:
    """Loads, and an energy that is not of Clebsch's form, are declined with the reason."""
    loaded = replace(scene(SHARP, GENERIC), body=SHARP.body(force=vector(0, 0, 1)))
    with pytest.raises(NoClosedForm, match="force or a couple"):
        enclosed(loaded)
    with pytest.raises(NoClosedForm, match="not of Clebsch's form"):
        enclosed(load("kirchhoff/general-body"))


# Broken twins: the comparison that a twin names must notice it.

Twin = Callable[[pytest.MonkeyPatch], None]


def wrong_sign_in_weierstrass(monkeypatch: pytest.MonkeyPatch) -> None:
    """+ v p' instead of - v p': z(-u) instead of z(u)."""
    right = Course._at

    def at(self: Course, p: arb, slope: arb) -> tuple[arb, arb]:
        z, speed = right(self, p, -slope)
        return z, -speed

    monkeypatch.setattr(course_module.Course, "_at", at)


def wrong_argument(monkeypatch: pytest.MonkeyPatch) -> None:
    """-u instead of u."""
    right = Periods.argument
    monkeypatch.setattr(Periods, "argument", lambda self, X, Y: -right(self, X, Y))


def lost_windings(monkeypatch: pytest.MonkeyPatch) -> None:
    """The principal argument instead of the continuous one."""

    def principal(quotient: acb, rough: arb) -> arb:
        return quotient.arg()

    monkeypatch.setattr(lattice_module, "nearest_turn", principal)


def no_advance(monkeypatch: pytest.MonkeyPatch) -> None:
    """The centre keeps its height along the impulse."""

    def no_advances(self: Orbit, times: Sequence[arb], *rest: Any) -> list[arb]:
        return [arb(0)] * len(times)

    monkeypatch.setattr(Orbit, "_advances", no_advances)


def transposed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Space to body instead of body to space."""
    right = Orbit.rows

    def rows(self: Orbit, times: Sequence[arb]) -> dict[str, list[Any]]:
        quantities = right(self, times)
        frames = [[list(column) for column in zip(*R, strict=True)] for R in quantities["attitude"]]
        return {**quantities, "attitude": frames}

    monkeypatch.setattr(Orbit, "rows", rows)


TURNING = scene(BLUNT, GENERIC)  # a0 < 0 and q' != q: the argument of sigma enters


@pytest.mark.parametrize(
    "twin", [wrong_sign_in_weierstrass, wrong_argument, lost_windings, no_advance, transposed]
)
def test_a_broken_twin_is_noticed(twin: Twin, monkeypatch: pytest.MonkeyPatch) -> None:
    """Taylor's motion agrees with the closed form, and not with any of its twins."""
    times = vector(3, 20)
    assert agrees_with_taylor(TURNING, times)
    twin(monkeypatch)
    assert not agrees_with_taylor(TURNING, times)


def test_windings_are_lost_only_after_a_turn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Within half a turn the principal argument is the continuous one: only a long time tells."""
    lost_windings(monkeypatch)
    assert agrees_with_taylor(TURNING, vector("1/10"))
    assert not agrees_with_taylor(TURNING, vector(3, 20))
