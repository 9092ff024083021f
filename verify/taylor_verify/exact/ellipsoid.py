"""Mass, inertia and added masses of a homogeneous ellipsoid, in balls, by Lamb's formulas.

Legend: semi-axes a, b, c in any cyclic order, V = 4 pi a b c/3, M mass, I moments of inertia about the
axes, m added masses, j added moments of inertia, rho the density of the fluid; Lamb, Hydrodynamics,
arts. 114 and 115, with R_D by Arb:

    alpha = (2/3) a b c R_D(b^2, c^2, a^2) and so on,        m_a = rho V alpha/(2 - alpha),
    j_a = rho V (b^2 - c^2)^2 (gamma - beta) / (5 (2 (b^2 - c^2) + (b^2 + c^2)(beta - gamma))).

The cancellation in these formulas is left as it is: the balls show its cost, and the precision rises. The
coefficients that a scene is read with are computed by rearranged formulas. So this file is an independent
check of them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import ceil, log2
from typing import Final

from flint import acb, arb, ctx
from mpmath import mp, mpf

from taylor_verify.exact.balls import ball, balls, midpoint, upper
from taylor_verify.exact.solution import Unsettled
from taylor_verify.scenes.bodies import COEFFICIENT_BITS, Ellipsoid, ImmersedBody
from taylor_verify.scenes.reading.faults import shown
from taylor_verify.scenes.scene import Scene

_FIRST_GUARD_BITS: Final = 40
# Digits beyond those asked for: errors that an orbit magnifies by 10^30 stay below the last digit.
_MORE_DIGITS: Final = 30
_DIGITS_TOLD: Final = 12
# Doublings of the guard bits: from 40 bits to more than axes of the largest ratio that a scene can write
# (10^10000) and of the smallest difference need.
_DOUBLINGS: Final = 14


@dataclass(frozen=True)
class Inertias:
    """Mass M, inertia I, added mass and added inertia, along or about body axes 1, 2, 3."""

    mass: arb
    inertia: list[arb]
    added_mass: list[arb]
    added_inertia: list[arb]

    def coefficients(self) -> tuple[list[arb], list[arb]]:
        """1/(M + m_i) and 1/(I_i + j_i) at the ambient precision."""
        p = [1 / (self.mass + m) for m in self.added_mass]
        r = [1 / (I + j) for I, j in zip(self.inertia, self.added_inertia, strict=True)]
        return p, r


def formed_to(scene: Scene, digits: int) -> Scene:
    """The scene with the coefficients of its ellipsoid to 30 digits more than these, as rationals.

    A scene is read with 120 digits of them; one that asks for no more than 90, or whose body is given
    by coefficients, is left as it is.
    """
    body = scene.body
    bits = ceil((digits + _MORE_DIGITS) * log2(10))
    if not isinstance(body, ImmersedBody) or body.ellipsoid is None or bits <= COEFFICIENT_BITS:
        return scene
    formed = body.ellipsoid.body(bits)
    return replace(scene, body=replace(body, linear=formed.linear, angular=formed.angular))


def inertias(ellipsoid: Ellipsoid, bits: int) -> Inertias:
    """Return the inertias of the ellipsoid to ``bits`` relative bits; zeros are exact.

    Raises Unsettled if no reasonable precision suffices.
    """
    guard = _FIRST_GUARD_BITS
    for _ in range(_DOUBLINGS):
        with ctx.workprec(bits + guard):
            result = _at_ambient_precision(ellipsoid)
            numbers = [result.mass, *result.inertia, *result.added_mass, *result.added_inertia]
            if all(number.is_zero() or number.rel_accuracy_bits() >= bits for number in numbers):
                return result
        guard *= 2
    raise Unsettled(f"the inertia of the ellipsoid does not settle to {bits} bits")


def deviation(body: ImmersedBody, bits: int) -> mpf:
    """Return a bound of the relative error of a body's coefficients, compared with its ellipsoid.

    The bound is proven with ``bits`` bits, so it is never below about 2^-bits. Raises ValueError
    for a body that was not given as an ellipsoid.
    """
    if body.ellipsoid is None:
        raise ValueError("expected a body that was given as an ellipsoid, got coefficients alone")
    exact = inertias(body.ellipsoid, bits)
    with ctx.workprec(bits + _FIRST_GUARD_BITS):
        pairs = zip((body.linear, body.angular), exact.coefficients(), strict=True)
        off = (ball(form[i][i]) / true[i] - 1 for form, true in pairs for i in range(3))
        return max(upper(abs(error)) for error in off)


def sentences(body: ImmersedBody) -> list[str]:
    """Return sentences on the ellipsoid of a body; none for a body given by its coefficients."""
    shape = body.ellipsoid
    if shape is None:
        return []
    exact = inertias(shape, COEFFICIENT_BITS)
    off = deviation(body, COEFFICIENT_BITS + _FIRST_GUARD_BITS)
    a = ", ".join(map(shown, shape.semi_axes))
    is_neutral = shape.density == shape.fluid_density
    buoyancy = ", as heavy as what it displaces" if is_neutral else ""
    return [
        f"A homogeneous ellipsoid: semi-axes {a}, density {shown(shape.density)}, in a fluid of "
        f"density {shown(shape.fluid_density)}{buoyancy}.",
        f"By Lamb's integrals: mass {_text([exact.mass])}, added mass {_text(exact.added_mass)}; "
        f"inertia {_text(exact.inertia)}, added inertia {_text(exact.added_inertia)}.",
        f"1/(mass + added mass) and 1/(inertia + added inertia) are rounded to {COEFFICIENT_BITS} "
        "bits, and the body of these rationals is the one that is solved: each is off by less than "
        f"2^{mp.mag(off)} of itself, as balls about Lamb's formulas prove.",
        *_symmetry(body),
    ]


def _symmetry(body: ImmersedBody) -> list[str]:
    axis = body.axis_of_symmetry
    if axis is None:
        return ["Three different semi-axes: none of them is an axis of symmetry."]
    if body.ellipsoid is None or len(set(body.ellipsoid.semi_axes)) > 1:
        return [
            f"Two equal semi-axes: Clebsch's body with q = q' = 0, its axis the body axis {axis}."
        ]
    free = "; free, y is constant in body axes, and x turns about it at the rate r |y|"
    return [f"A sphere: T = p x.x/2 + r y.y/2{free if body.is_free else ''}."]


def _text(numbers: Sequence[arb]) -> str:
    return ", ".join(
        str(mp.nstr(midpoint(number), _DIGITS_TOLD)) if not number.is_zero() else "0"
        for number in numbers
    )


def _at_ambient_precision(ellipsoid: Ellipsoid) -> Inertias:
    a, b, c = balls(ellipsoid.semi_axes)
    volume = 4 * arb.pi() * a * b * c / 3
    mass, displaced = volume * ball(ellipsoid.density), volume * ball(ellipsoid.fluid_density)
    squares = [axis * axis for axis in ellipsoid.semi_axes]
    alphas = [_alpha(ellipsoid, i) for i in range(3)]
    inertia, added_mass, added_inertia = [], [], []
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        inertia.append(mass * ball(squares[j] + squares[k]) / 5)
        added_mass.append(displaced * alphas[i] / (2 - alphas[i]))
        if squares[j] == squares[k]:
            added_inertia.append(arb(0))
            continue
        gap, total = ball(squares[j] - squares[k]), ball(squares[j] + squares[k])
        difference = alphas[k] - alphas[j]
        resistance = gap * gap * difference / (5 * (2 * gap - total * difference))
        added_inertia.append(displaced * resistance)
    return Inertias(mass, inertia, added_mass, added_inertia)


def _alpha(ellipsoid: Ellipsoid, i: int) -> arb:
    """The integral of axis i: a^3 R_D(b^2, c^2, a^2) = R_D((b/a)^2, (c/a)^2, 1)."""
    axis = ellipsoid.semi_axes[i]
    y, z = (ellipsoid.semi_axes[(i + n) % 3] / axis for n in (1, 2))
    integral = acb.elliptic_rd(ball(y * y), ball(z * z), acb(1)).real
    return 2 * ball(y * z) * integral / 3
