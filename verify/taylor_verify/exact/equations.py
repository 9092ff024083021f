"""The equations of motion of both texts as polynomials with exact coefficients.

They are written here from the texts and share nothing with models. A polynomial is homogeneous of degree
two: the coefficient of each product of two variables, which are counted from 0, the smaller first.
"""

from __future__ import annotations

from fractions import Fraction

from taylor_verify.exact import clocks
from taylor_verify.exact.clocks import Polynomial
from taylor_verify.scenes import tensors
from taylor_verify.scenes.bodies import Body, ImmersedBody, RigidBody
from taylor_verify.scenes.tensors import Matrix, Vector

Triple = tuple[int, int, int]


def euler_drift(body: RigidBody) -> Vector:
    """K M, the part of omega' that does not depend on omega."""
    return tensors.apply(body.inverse_inertia, body.moment)


def euler_rates(body: RigidBody) -> list[Polynomial]:
    """K((I omega) x omega), in products of omega."""
    omega: Triple = (0, 1, 2)
    inertia, inverse = body.inertia, body.inverse_inertia
    torque: list[Polynomial] = []
    for j, k in ((1, 2), (2, 0), (0, 1)):
        forward = {(i, k): inertia[j][i] for i in omega}
        backward = {(i, j): -inertia[k][i] for i in omega}
        torque.append(_sum(forward, backward))
    return [_sum(*(_times(c, p) for c, p in zip(row, torque, strict=True))) for row in inverse]


def momentum_rates(body: RigidBody) -> list[Polynomial]:
    """H x omega with omega = K H, in products of H."""
    return _cross_form(0, body.inverse_inertia)


def impulse_rates(body: ImmersedBody) -> list[Polynomial]:
    """x x Omega, and y x Omega + x x U, in products of x and y alone.

    With U and Omega put in, what cancels in exact coefficients is gone: where x x U vanishes for a
    whole body, y stays a zero that no rounding disturbs.
    """
    velocity, omega = body.energy_matrix[:3], body.energy_matrix[3:]
    turned = zip(_cross_form(3, omega), _cross_form(0, velocity), strict=True)
    return _cross_form(0, omega) + [_sum(p, q) for p, q in turned]


def driven(free: list[Polynomial], body: Body, clock: int) -> list[Polynomial]:
    """The rates with the loads of a manufactured motion, if there is one, and then those of its clock."""
    motion = body.manufactured
    if motion is None:
        return free
    loads = clocks.loads(free, motion, clock)
    return [_sum(p, q) for p, q in zip(free, loads, strict=True)] + clocks.rates(motion, clock)


def _cross_form(first: int, rows: Matrix) -> list[Polynomial]:
    """The vector of the states ``first``, ... times a linear form of all states, given by its rows."""
    entries = [[(i, c) for i, c in enumerate(row) if c] for row in rows]
    forward = [{(first + j, i): c for i, c in entries[k]} for j, k in ((1, 2), (2, 0), (0, 1))]
    backward = [{(first + k, i): -c for i, c in entries[j]} for j, k in ((1, 2), (2, 0), (0, 1))]
    return [_sum(p, q) for p, q in zip(forward, backward, strict=True)]


def _times(factor: Fraction, polynomial: Polynomial) -> Polynomial:
    return {pair: factor * coefficient for pair, coefficient in polynomial.items()}


def _sum(*polynomials: Polynomial) -> Polynomial:
    """The sum; a b and b a are one product, and what cancels is gone."""
    total: dict[tuple[int, int], Fraction] = {}
    for polynomial in polynomials:
        for (a, b), coefficient in polynomial.items():
            pair = (min(a, b), max(a, b))
            total[pair] = total[pair] + coefficient if pair in total else coefficient
    return {pair: coefficient for pair, coefficient in total.items() if coefficient}
