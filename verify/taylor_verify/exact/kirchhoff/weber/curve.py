"""Weber's case of Clebsch's second: its bodies, and the curve of genus two, all in rationals.

Legend: T = sum (p_i x_i^2 + r_i y_i^2)/2, to which multiples of F^2 = x.x and of x.y may be added, and
x.y = 0. Where r_i = r, or p_i - p_j = theta r_k (r_j - r_i), the direction n = x/F of the impulse is led
by Neumann's motion of a point on the sphere, n'' = -a n + (...) n, x' = rho x x y along its own time:

    r_i = r:         a_i = r F^2 p_i,        rho = r,  and the motion is that one;
    Clebsch's:       a_i = -theta F^2 r_i,   rho = 1,  and the motion commutes with that one.

With elliptic coordinates u1 < u2 on the sphere and the integrals F_i of K. Uhlenbeck

    A(z) = prod (z - a_i),    U(z) = A sum n_i^2/(z - a_i) = (z - u1)(z - u2),
    F_i = n_i^2 + sum over j of (rho y_k)^2/(a_i - a_j),    B(z) = A sum F_i/(z - a_i),
    w^2 = -4 A(z) B(z),    u1' = w1/(u1 - u2),  u2' = w2/(u2 - u1) in Neumann's time,

the integrals v_m of z^m dz/w, summed over the two points (u, w), are linear in time: their rates are
the ``flow``. The five roots of A B, in ascending order, are e1 ... e5; u1 swings between e2 and e3,
u2 between e4 and e5. Only differences of the a_i count: they are taken from their middle one, in the
unit sigma^2.

Sources: H. Weber, Math. Ann. 14 (1878) 173; J. Moser, in The Chern Symposium (1980) 147.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any, Final

from taylor_verify.exact.kirchhoff.integrable import CYCLIC, diagonal_family
from taylor_verify.exact.kirchhoff.solid import solid
from taylor_verify.exact.solution import NoClosedForm
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import floor_log2, power_of_two
from taylor_verify.numbers.tensors import Vector
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.scene import Scene

REGIME: Final = "weber"
_ORTHOGONAL: Final = (
    "of the bodies with r_1 = r_2 = r_3, and of Clebsch's second case, only the motions with FG = 0 "
    "are solved (Weber's)"
)
_DEGENERATE: Final = (
    "two branch points of Weber's curve coincide: the theta functions of genus two degenerate"
)

Quadratic = tuple[Fraction, Fraction, Fraction]


@dataclass(frozen=True)
class Curve:
    """A motion of Weber's: the curve and the start on it.

    ``a`` are the a_i in the order of the body's axes and in the unit sigma^2, from the middle one;
    ``flow`` are the rates of the two integrals in that unit, ``start`` are x and y.
    """

    a: Vector
    sigma: Fraction
    rho: Fraction
    flow: tuple[Fraction, Fraction]
    start: Impulse

    @cached_property
    def F2(self) -> Fraction:
        return tensors.dot(self.start.linear, self.start.linear)

    @cached_property
    def x_rate(self) -> Vector:
        """x' along Neumann's time, at the start."""
        return tensors.scaled(self.rho, tensors.cross(self.start.linear, self.start.angular))

    @cached_property
    def sign_data(self) -> tuple[tuple[Fraction, Fraction], ...]:
        """Pairs of sigma^2 x_i and x_i' at the start, which decide the sign of c_i.

        With n_i and n_i' of the right sign, but for a common one, both products are positive, so that
        their sum has its digits as long as one of the two is not small. Both are zero on a degenerate
        curve alone.
        """
        pairs = zip(self.start.linear, self.x_rate, strict=True)
        return tuple((self.sigma**2 * x, rate) for x, rate in pairs)

    @cached_property
    def uhlenbeck(self) -> Vector:
        """F_1, F_2, F_3, of which the sum is 1."""
        x, y, a = self.start.linear, self.start.angular, self.a
        turned = [(self.rho * entry / self.sigma) ** 2 for entry in y]
        return tuple(
            x[i] ** 2 / self.F2 + turned[k] / (a[i] - a[j]) + turned[j] / (a[i] - a[k])
            for i, j, k in CYCLIC
        )

    @cached_property
    def B(self) -> Quadratic:
        """B, whose first coefficient is 1."""
        return self._over(self.uhlenbeck)

    @cached_property
    def U(self) -> Quadratic:
        return self._over(tuple(entry**2 / self.F2 for entry in self.start.linear))

    @cached_property
    def U_rate(self) -> Quadratic:
        """dU/dt in Neumann's time, of degree 1; at u1 and u2 it is -sigma w, in the unit sigma^2."""
        pairs = zip(self.start.linear, self.x_rate, strict=True)
        return self._over(tuple(2 * x * rate / self.F2 for x, rate in pairs))

    @cached_property
    def places(self) -> tuple[int, ...]:
        """The places of a_1, a_2 and a_3 among the e, counted from 0."""
        _, linear, constant = self.B
        places = []
        for z in self.a:
            is_between = z * z + linear * z + constant < 0
            roots = 1 if is_between else 2 * (2 * z > -linear)
            places.append(roots + sum(other < z for other in self.a))
        return tuple(places)

    @property
    def is_degenerate(self) -> bool:
        """Return True if two of the e coincide: some F_i is zero, or B has a double root."""
        _, linear, constant = self.B
        return not all(self.uhlenbeck) or linear**2 == 4 * constant

    def _over(self, weights: Vector) -> Quadratic:
        """A(z) sum weights_i/(z - a_i), the highest power first."""
        a = self.a
        return (
            sum(weights, Fraction(0)),
            -sum((weights[i] * (a[j] + a[k]) for i, j, k in CYCLIC), Fraction(0)),
            sum((weights[i] * a[j] * a[k] for i, j, k in CYCLIC), Fraction(0)),
        )


def curve(scene: Scene) -> Curve | None:
    """The curve of a motion of Weber's, or None for a body or a motion that is not of the family.

    Raises NoClosedForm, with the reason, for what is of the family and has no theta functions of genus two,
    such as a motion in a plane of the body.
    """
    body, start = solid(scene)
    if not body.is_free or body.axis_of_symmetry is not None or not any(start.linear):
        return None
    family = diagonal_family(body)
    if family is None or family[0] not in ("neumann", "clebsch2"):
        return None
    if tensors.dot(start.linear, start.angular) != 0:
        raise NoClosedForm(_ORTHOGONAL)
    genus_two = _curve(body, start, *family)
    if genus_two is None or genus_two.is_degenerate:
        raise NoClosedForm(_DEGENERATE)
    return genus_two


def _curve(
    body: ImmersedBody, start: Impulse, family: str, coefficients: tuple[Any, ...]
) -> Curve | None:
    """The curve, or None where the a_i are equal."""
    F2 = tensors.dot(start.linear, start.linear)
    if family == "neumann":
        rho = coefficients[0]
        a = tensors.scaled(rho * F2, tuple(body.linear[i][i] for i in range(3)))
        flow = (Fraction(0), Fraction(1))
    else:
        r, theta = coefficients
        if theta == 0:
            return None
        a, rho = tensors.scaled(-theta * F2, r), Fraction(1)
        # The rate of v_1 is 0 for z from zero, and this for z from the middle a.
        flow = (1 / (theta * F2), sorted(r)[1])
    middle = sorted(a)[1]
    # The nearest power of 4 to the spread: it keeps every integral near 1, and rounds nothing.
    sigma = power_of_two(floor_log2(max(a) - min(a)) // 2)
    scaled = tuple((entry - middle) / sigma**2 for entry in a)
    return Curve(scaled, sigma, rho, (sigma**3 * flow[0], sigma * flow[1]), start)
