"""The kind of motion of Clebsch's body, and its turning points, decided in exact numbers."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import pairwise
from typing import Any, Final

from taylor_verify.exact.kirchhoff.axes import clebsch_about
from taylor_verify.exact.kirchhoff.quartic import (
    Nutation,
    RealRoots,
    derivative,
    repeated_root,
    value,
)
from taylor_verify.exact.kirchhoff.solid import solid
from taylor_verify.exact.solution import NoClosedForm, Unsettled
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.precision import floor_log2, power_of_two
from taylor_verify.scenes.scene import Scene

_NARROWINGS: Final = 40
# Rationals near irrational constants have four times the digits asked for, and some more.
_BITS_PER_DIGIT: Final = 14
_MORE_BITS: Final = 256
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

    The smallest difference is not known beforehand: the roots are narrowed until it is large enough
    beside what is left of their enclosures. Of irrational constants rationals near them are taken: so these
    roots prove nothing, and two precisions must agree. Raises Unsettled if they do not come apart.
    """
    poles = nutation.touches_pole(1), nutation.touches_pole(-1)
    start, nutation = nutation.z, nutation.near(_BITS_PER_DIGIT * digits + _MORE_BITS)
    roots = RealRoots(nutation.f)
    F_above = power_of_two(floor_log2(nutation.F2) // 2 + 1)
    width = F_above / 10**digits
    for _ in range(_NARROWINGS):
        points = _arranged(nutation, roots, width, poles)
        smallest = min(_allowances(nutation, points, width))
        if width * 10**digits <= smallest:
            # A start at a turning point is that point exactly, whatever the constants are.
            at_start: dict[str, Any] = {
                name: start for name in ("z1", "z2") if getattr(points, name) == nutation.z
            }
            return replace(points, **at_start)
        width = min(smallest / 10**digits, width) / 16 if smallest > 0 else width / 10**digits
    raise Unsettled("the roots of the quartic of x3 do not come apart")


def _arranged(
    nutation: Nutation, real: RealRoots, width: Fraction, poles: tuple[bool, bool]
) -> TurningPoints:
    """The roots in the order of the formulas, with those that are known exactly put in."""
    roots = real.enclosed(width)
    lower = real.number_up_to(nutation.z) - 1
    if nutation.speed == 0:  # a start at a turning point
        lower = min(range(len(roots)), key=lambda k: abs(roots[k] - nutation.z))
        roots[lower] = nutation.z
        if value(derivative(nutation.f), nutation.z) < 0:
            lower -= 1
    z1, z2 = roots[lower], roots[lower + 1]
    at_top = poles[0] and _is_pole(nutation, roots, lower + 1, side=1)
    at_bottom = poles[1] and _is_pole(nutation, roots, lower, side=-1)
    if len(nutation.f) == 5 and len(roots) == 2:
        pair = _complex_pair(nutation, z1, z2)
        return TurningPoints(z1, z2, None, None, pair, at_top, at_bottom)
    circle: list[Fraction | None] = [*roots]
    if len(roots) == 3:
        circle.append(None)
    z4, z3 = circle[(lower + 2) % 4], circle[(lower + 3) % 4]
    return TurningPoints(z1, z2, z3, z4, None, at_top, at_bottom)


def _is_pole(nutation: Nutation, roots: list[Fraction], index: int, side: int) -> bool:
    """Return True if this root is the pole side * F, one of the roots: it is the nearest one."""
    distances = [
        abs(nutation.F2 - root**2) if side * root > 0 else nutation.F2 + root**2 for root in roots
    ]
    return distances[index] == min(distances)


def _complex_pair(nutation: Nutation, z1: Fraction, z2: Fraction) -> tuple[Fraction, Fraction]:
    """(middle, n^2) from the coefficients and the two real roots."""
    lead, cubic, square = nutation.f[:3]
    middle = -(cubic / lead + z1 + z2) / 2
    return middle, square / lead - z1 * z2 - 2 * middle * (z1 + z2) - middle**2


def _allowances(nutation: Nutation, points: TurningPoints, width: Fraction) -> list[Fraction]:
    """Errors of a root that would be as large as each difference that enters."""
    z1, z2 = points.z1, points.z2
    F_above = power_of_two(floor_log2(nutation.F2) // 2 + 1)
    allowed = [z2 - z1]
    if nutation.speed != 0:
        allowed += [nutation.z - z1, z2 - nutation.z]
    allowed += [(nutation.F2 - z1**2) / (4 * F_above)] * (not points.at_bottom)
    allowed += [(nutation.F2 - z2**2) / (4 * F_above)] * (not points.at_top)
    others = [root for root in (points.z3, points.z4) if root is not None]
    allowed += [abs(a - b) / 2 for a in others for b in (z1, z2)]
    allowed += [abs(a - b) / 2 for a, b in pairwise(others)]
    if points.pair is not None:
        middle, n_squared = points.pair
        if n_squared <= 0:
            return [Fraction(0)]
        cubic = abs(nutation.f[1] / nutation.f[0])
        # d(n^2) <= influence * width, by differentiating the formulas of _complex_pair.
        influence = 5 * (abs(z1) + abs(z2)) + 2 * cubic + 2 * abs(middle) + 10 * width
        allowed += [n_squared / influence, power_of_two(floor_log2(n_squared) // 2)]
    return allowed
