"""An ellipsoid is enclosed itself: its coefficients enter as balls about Lamb's integrals."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest
from builders.ellipsoids import quadrature
from builders.scenes import one_instant, vector
from builders.turns import by_turns
from flint import arb, ctx
from mpmath import mp, mpf

from taylor_verify.exact.balls import ball
from taylor_verify.exact.enclosure import lamb
from taylor_verify.exact.enclosure.system import Balls, posed, posed_exactly
from taylor_verify.exact.route import solution
from taylor_verify.exact.solution import _distance
from taylor_verify.exact.taylor import TaylorSolution
from taylor_verify.scenes.bodies import Ellipsoid, ImmersedBody
from taylor_verify.scenes.manufactured import Manufactured, Wave
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.scene import Scene

SHAPES = {
    "triaxial": vector(3, 2, 1),
    "prolate": vector(1, 1, 2),
    "oblate": vector(2, "0.5", 2),
    "sphere": vector("1.5", "1.5", "1.5"),
    "nearly equal axes": vector(1, "1.000000000000000000000000000001", 2),
    "disc": vector(1, "1.5", "1e-6"),
    "disc of revolution": vector(1, 1, "1e-6"),
}
# A disc of so little mass turns a million times as fast.
LATER = {name: Fraction(1, 10**6 if "disc" in name else 1) for name in SHAPES}
START = Impulse(vector("0.1", "0.2", 1), vector("0.3", 0, 1), centre=vector(1, 2, 3))


def shaped(name: str, fluid: int = 1) -> Scene:
    body = Ellipsoid(SHAPES[name], Fraction(1), Fraction(fluid)).body()
    return one_instant(body, START, "attitude", "centre")


def rounded(asked: Scene, bits: int) -> Scene:
    """The scene of the rational body nearest to the ellipsoid."""
    assert isinstance(asked.body, ImmersedBody)
    assert asked.body.ellipsoid is not None
    formed = replace(asked.body.ellipsoid.body(bits), ellipsoid=None)
    return replace(asked, body=replace(formed, force=asked.body.force, couple=asked.body.couple))


@pytest.mark.parametrize("name", SHAPES)
def test_the_balls_contain_lambs_coefficients(name: str) -> None:
    """By a certified quadrature of Lamb's own integrands: along each axis the added mass."""
    asked = shaped(name)
    axes = SHAPES[name]
    with ctx.workprec(100):
        balls = Balls.of(posed(asked))
        volume = 4 * arb.pi() * ball(axes[0] * axes[1] * axes[2]) / 3
        for i in range(3):
            alpha = quadrature(axes, (i,))
            true = 1 / (volume + volume * alpha / (2 - alpha))
            assert true.rel_accuracy_bits() > 30
            assert balls.velocity[i, i].overlaps(true)
            assert balls.velocity[i, i].rel_accuracy_bits() > 90


@pytest.mark.parametrize("bits", by_turns([100, 60, 700]))
@pytest.mark.parametrize("name", SHAPES)
def test_every_equation_contains_that_of_a_sharper_body(name: str, bits: int) -> None:
    """Each entry holds the one of the body formed to far more bits; what is zero is zero exactly."""
    sharper = rounded(shaped(name), 2 * bits + 800)
    with ctx.workprec(bits):
        balls = Balls.of(posed(shaped(name)))
    with ctx.workprec(2 * bits + 800):
        exact = Balls.of(posed_exactly(sharper))
    for one, other in (
        (balls.hessian, exact.hessian),
        (balls.spin, exact.spin),
        (balls.velocity, exact.velocity),
    ):
        for got, true in zip(one.entries(), other.entries(), strict=True):
            assert got.overlaps(true)
            assert got.is_zero() == true.is_zero()
            # Differences of nearly equal coefficients as well.
            assert got.is_zero() or got.rel_accuracy_bits() >= bits - 8


def test_in_a_vacuum_no_mass_is_added() -> None:
    """Then p is one number, and x x U is zero exactly."""
    vacuum = shaped("triaxial", fluid=0)
    assert isinstance(vacuum.body, ImmersedBody)
    assert vacuum.body.ellipsoid is not None
    # One coefficient p and three r.
    assert len(lamb.units(vacuum.body, vacuum.body.ellipsoid)) == 4
    motion = TaylorSolution(vacuum).motion([Fraction(2)], 20)
    free = TaylorSolution(rounded(vacuum, 400)).motion([Fraction(2)], 20)
    for name in motion.quantities:
        assert _distance(motion[name][0], free[name][0]) <= mpf(10) ** -19


@pytest.mark.parametrize("name", by_turns(SHAPES))
def test_the_motion_is_that_of_the_ellipsoid_at_any_digits(name: str) -> None:
    """At 150 digits the body that a scene is read with is another one; the enclosure is not of it."""
    asked, later = shaped(name), [LATER[name]]
    motion = TaylorSolution(asked).motion(later, 150)
    finer = TaylorSolution(rounded(asked, 800)).motion(later, 160)
    with mp.workdps(200):
        for quantity in motion.quantities:
            apart = _distance(motion[quantity][0], finer[quantity][0])
            assert apart <= 2 * motion.radius_of(quantity)[0]
    as_read = TaylorSolution(rounded(asked, 400)).motion(later, 150)
    with mp.workdps(200):
        apart = _distance(motion["centre"][0], as_read["centre"][0])
        # That body is another one: proven, as its balls lie apart.
        assert apart > motion.radius[0] + as_read.radius[0]


@pytest.mark.parametrize("name", ["prolate", "oblate", "sphere", "disc of revolution"])
def test_the_closed_form_of_the_rounded_body_is_beside_the_enclosure(name: str) -> None:
    """The closed forms are of the body of rationals: at 30 digits the 120 that it has are the same."""
    asked, later = shaped(name), [3 * LATER[name]]
    motion, closed = (
        TaylorSolution(asked).motion(later, 30),
        solution(asked, "arb").motion(later, 30),
    )
    with mp.workdps(60):
        for quantity in motion.quantities:
            apart = _distance(motion[quantity][0], closed[quantity][0])
            assert apart <= (motion.radius[0] + closed.radius[0]) * 2


def test_loads_that_make_a_motion_are_those_of_the_ellipsoid() -> None:
    """Under the loads of a manufactured motion the enclosure of the ellipsoid follows that motion."""
    wave = Wave(Fraction(2), vector("0.1", 0, "0.3", 0, "0.2", "0.1"), vector(0, "0.2", 0, 1, 0, 0))
    manufactured = Manufactured(vector(1, 0, "0.5", 0, 1, "0.25"), (wave,))
    body = replace(shaped("triaxial").body, manufactured=manufactured)
    start = Impulse(manufactured.start[:3], manufactured.start[3:])
    asked = one_instant(body, start)
    motion = TaylorSolution(asked).motion([Fraction(2)], 140)
    chosen = solution(asked, "arb").motion([Fraction(2)], 150)
    with mp.workdps(180):
        for quantity in motion.quantities:
            apart = _distance(motion[quantity][0], chosen[quantity][0])
            assert apart <= 2 * motion.radius[0]


def test_coefficients_rounded_to_nothing_are_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """The width of the balls counts: with their midpoints alone the motion leaves its balls."""

    def contains_the_motion() -> bool:
        with ctx.workprec(40):
            balls = Balls.of(posed(shaped("triaxial")))
        exact = Balls.of(posed_exactly(rounded(shaped("triaxial"), 400)))
        pairs = zip(balls.spin.entries(), exact.spin.entries(), strict=True)
        return all(got.overlaps(true) for got, true in pairs)

    with ctx.workprec(400):
        assert contains_the_motion()
    honest = lamb.factors
    monkeypatch.setattr(lamb, "factors", lambda shape: [f.mid() for f in honest(shape)])
    monkeypatch.setattr(lamb, "cancelled_bits", lambda shape: 0)
    with ctx.workprec(400):
        assert not contains_the_motion()
