"""The kind of motion of Clebsch's body, and its turning points, decided in exact numbers."""

from __future__ import annotations

from math import ceil, log2
from typing import Final

from flint import arb, ctx, fmpq, fmpq_poly
from mpmath import mpf

from taylor_verify.exact.balls import midpoint
from taylor_verify.exact.kirchhoff.axes import clebsch_about
from taylor_verify.exact.kirchhoff.quartic import Nutation, derivative, repeated_root, value
from taylor_verify.exact.kirchhoff.solid import solid
from taylor_verify.exact.real_roots import real_roots
from taylor_verify.exact.solution import NoClosedForm, Unsettled
from taylor_verify.numbers.irrational import ball
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.scene import Scene

_DOUBLINGS: Final = 12
# Rationals near irrational constants have four times the digits asked for, and some more.
_BITS_PER_DIGIT: Final = 14
_MORE_BITS: Final = 256
ELLIPTIC: Final = ("four-roots", "two-roots", "cubic")
"""The kinds in which x3 swings between two simple roots of f."""
# The kind of motion by the sign of the curvature of f where its root is repeated.
_BY_CURVATURE: Final = {1: "hyperbolic", 0: "algebraic", -1: "trigonometric"}


def nutation_of(scene: Scene) -> tuple[Nutation, Impulse]:
    """The motion of a scene with Clebsch's energy and no loads, and its start.

    Raises NoClosedForm, with the reason, for every other scene.
    """
    body, start = solid(scene)
    if not body.is_free:
        raise NoClosedForm("a force or a couple acts on the body")
    six_and_axes = clebsch_about(body)
    if six_and_axes is None:
        raise NoClosedForm("the energy is not of Clebsch's form about any axis")
    return Nutation.of(six_and_axes[0], start, six_and_axes[1]), start


def regime(nutation: Nutation) -> str:
    """Return the word for the motion, decided in exact numbers.

    - rest: no impulse at all;
    - euler-top: x = 0, and y turns about axis 3 at a constant rate;
    - steady: x3 is constant;
    - trigonometric: f is a quadratic, or x3 swings on one side of an isolated double root;
    - hyperbolic: x3 comes from a double root of f and returns to it (homoclinic);
    - algebraic: the same, but the root is triple, and x3 a rational function of time;
    - heteroclinic: x3 goes from one pole to the other, and f is a square;
    - cubic, four-roots, two-roots: f has simple roots alone, and of a quartic four or two are real.
    """
    f = nutation.f
    if nutation.F2 == 0:
        return "rest" if nutation.m1 == 0 and nutation.y3 == 0 else "euler-top"
    if nutation.speed == 0 and value(derivative(f), nutation.z) == 0:
        return "steady"
    if len(f) < 4:
        return "trigonometric"
    g2, g3 = nutation.invariants
    discriminant = g2**3 - 27 * g3**2
    if not discriminant:
        root = repeated_root(f)
        if root is None:
            # Two repeated roots can only be the poles: f is a square, and f(+-F) <= 0.
            return "heteroclinic"
        curvature = value(derivative(derivative(f)), root)
        return _BY_CURVATURE[(curvature > 0) - (curvature < 0)]
    if len(f) == 4:
        return "cubic"
    # Of four different roots two are real, those between which x3 swings.
    return "four-roots" if discriminant > 0 else "two-roots"


def turning_points(nutation: Nutation, digits: int) -> tuple[mpf, mpf]:
    """The roots of f between which x3 swings, to ``digits`` significant digits of their difference.

    Of irrational constants rationals near them are taken: so these roots prove nothing, and two precisions
    must agree. Raises Unsettled if they do not come apart.
    """
    near = nutation.near(_BITS_PER_DIGIT * digits + _MORE_BITS)
    wanted = ceil(digits * log2(10))
    for bits in (2 * wanted << n for n in range(_DOUBLINGS)):
        with ctx.workprec(bits):
            low, high = _beside(near)
            if (high - low).rel_accuracy_bits() >= wanted:
                return midpoint(low), midpoint(high)
    raise Unsettled("the roots of the quartic of x3 do not come apart")


def _beside(nutation: Nutation) -> tuple[arb, arb]:
    """The roots on both sides of the start; a start at a turning point is one of them."""
    f, z = nutation.f, ball(nutation.z)
    roots = real_roots(fmpq_poly([fmpq(*c.as_integer_ratio()) for c in reversed(f)]))
    lower = sum(root.mid() <= z.mid() for root in roots) - 1
    if nutation.speed == 0:
        lower = min(range(len(roots)), key=lambda k: abs(roots[k] - z).mid())
        lower -= value(derivative(f), nutation.z) < 0
    lower = max(0, min(lower, len(roots) - 2))
    return roots[lower], roots[lower + 1]
