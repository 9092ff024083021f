"""The kind of motion of Clebsch's body, and its turning points, decided in exact numbers."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from math import ceil, log2
from typing import Any, Final

from flint import arb, ctx

from taylor_verify.exact.balls import midpoint
from taylor_verify.exact.kirchhoff.axis_of_revolution import clebsch_about
from taylor_verify.exact.kirchhoff.quartic import Nutation, derivative, repeated_root, value
from taylor_verify.exact.kirchhoff.solid import solid
from taylor_verify.exact.real_roots import polynomial, real_roots
from taylor_verify.exact.solution import NoClosedForm, Unsettled
from taylor_verify.numbers.irrational import ball
from taylor_verify.numbers.precision import exact_value
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


@dataclass(frozen=True)
class TurningPoints:
    """z1 <= z <= z2, and the other roots of f, as rationals near enough to the true ones.

    Every difference of two of the numbers here, and F^2 - z1^2 and F^2 - z2^2, has the relative
    error asked for. Going up from z1 and round through infinity, the real roots are z1, z2, z4, z3,
    where None is infinity; a complex pair is given as ``pair`` = (middle, n^2) instead, for
    middle +- i n. ``at_top`` says that z2 = F, and ``at_bottom`` that z1 = -F, exactly.
    """

    z1: Fraction
    z2: Fraction
    z3: Fraction | None
    z4: Fraction | None
    pair: tuple[Fraction, Fraction] | None
    at_top: bool
    at_bottom: bool


def turning_points(nutation: Nutation, digits: int) -> TurningPoints:
    """The turning points to ``digits`` significant digits of every difference.

    The smallest difference is not known beforehand: the precision rises until it has its digits. Of
    irrational constants rationals near them are taken: so these roots prove nothing, and two precisions
    must agree. Raises Unsettled if they do not come apart.
    """
    poles = nutation.touches_pole(1), nutation.touches_pole(-1)
    near = nutation.near(_BITS_PER_DIGIT * digits + _MORE_BITS)
    wanted = ceil(digits * log2(10))
    for bits in (2 * wanted << n for n in range(_DOUBLINGS)):
        with ctx.workprec(bits):
            points = _arranged(near, nutation.z, poles)
            if min(map(arb.rel_accuracy_bits, _differences(near, points))) >= wanted:
                z1, z2, z3, z4 = map(_rational, (points.z1, points.z2, points.z3, points.z4))
                pair = points.pair and (_rational(points.pair[0]), _rational(points.pair[1]))
                return TurningPoints(z1, z2, z3, z4, pair, points.at_top, points.at_bottom)
    raise Unsettled("the roots of the quartic of x3 do not come apart")


def _arranged(nutation: Nutation, start: Fraction, poles: tuple[bool, bool]) -> TurningPoints:
    """The roots in the order of the formulas, in balls; a start at a turning point is exactly that."""
    f, z = nutation.f, ball(nutation.z)
    roots: list[Any] = real_roots(polynomial(*reversed(f)))
    lower = sum(root.mid() <= z.mid() for root in roots) - 1
    if nutation.speed == 0:
        lower = min(range(len(roots)), key=lambda k: abs(roots[k] - z).mid())
        roots[lower] = start
        lower -= value(derivative(f), nutation.z) < 0
    lower = max(0, min(lower, len(roots) - 2))
    z1, z2 = roots[lower], roots[lower + 1]
    at_top = poles[0] and _is_pole(nutation, roots, lower + 1, side=1)
    at_bottom = poles[1] and _is_pole(nutation, roots, lower, side=-1)
    if len(f) == 5 and len(roots) == 2:
        pair: Any = _complex_pair(nutation, ball(z1), ball(z2))
        return TurningPoints(z1, z2, None, None, pair, at_top, at_bottom)
    circle = [*roots, *[None] * (4 - len(roots))]
    z4, z3 = circle[(lower + 2) % 4], circle[(lower + 3) % 4]
    return TurningPoints(z1, z2, z3, z4, None, at_top, at_bottom)


def _is_pole(nutation: Nutation, roots: list[Any], index: int, side: int) -> bool:
    """Return True if this root is the pole side * F, one of the roots: it is the nearest one."""
    F2 = ball(nutation.F2)
    squares = [ball(root) * abs(ball(root)) * side for root in roots]
    distances = [abs(F2 - square).mid() for square in squares]
    return bool(distances[index] == min(distances))


def _complex_pair(nutation: Nutation, z1: arb, z2: arb) -> tuple[arb, arb]:
    """(middle, n^2) from the coefficients and the two real roots."""
    lead, cubic, square = nutation.f[:3]
    middle = -(ball(cubic / lead) + z1 + z2) / 2
    return middle, ball(square / lead) - z1 * z2 - middle * (2 * (z1 + z2) + middle)


def _differences(nutation: Nutation, points: TurningPoints) -> list[arb]:
    """The numbers that enter a closed form and whose digits count."""
    z1, z2, z, F2 = (ball(entry) for entry in (points.z1, points.z2, nutation.z, nutation.F2))
    numbers = [z2 - z1]
    numbers += [z - z1, z2 - z] * (nutation.speed != 0)
    numbers += [F2 - z1 * z1] * (not points.at_bottom)
    numbers += [F2 - z2 * z2] * (not points.at_top)
    others = [ball(root) for root in (points.z3, points.z4) if root is not None]
    numbers += [a - b for a in others for b in (z1, z2)]
    numbers += [a - b for a, b in pairwise(others)]
    if points.pair is not None:
        middle, n2 = map(ball, points.pair)
        numbers += [n2, *((z - middle) * (z - middle) + n2 for z in (z1, z2))]
    return numbers


def _rational(root: Any) -> Any:
    """The midpoint of a ball; what is no ball as it is."""
    return exact_value(midpoint(root)) if isinstance(root, arb) else root
