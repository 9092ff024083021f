"""Kirchhoff's equations of a solid moving through an ideal fluid (Hydromechanics 48-49).

x  linear impulse, body axes           U      = dT/dx, velocity of the body's origin
y  impulsive couple about the origin   Omega  = dT/dy, angular velocity
X, L  force and couple, body axes      T      = x.A x/2 + x.B y + y.C y/2

p, p', q, q', r, r' are Clebsch's coefficients, 49 (1), with body axis 3 the axis of symmetry.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce
from typing import Any, Final

from taylor_verify.models.algebra import (
    ABSENT,
    Terms,
    add,
    apply,
    cross,
    minus,
    plus,
    times,
    transpose,
)
from taylor_verify.models.form import Named, frame_rates, labelled

CLEBSCH_NAMES: Final = ("p", "p'", "q", "q'", "r", "r'")
# The names of p' - p, q' - q and r' - r where they are coefficients.
CLEBSCH_DIFFERENCES: Final = {"p": "D1", "q": "D2", "r": "D3"}


def velocities(
    x: Terms, y: Terms, A: Sequence[Terms], B: Sequence[Terms], C: Sequence[Terms]
) -> tuple[list[Any], list[Any]]:
    """Return U = A x + B y and Omega = B^T x + C y, body axes."""
    U = add(apply(A, x), apply(B, y))
    Omega = add(apply(transpose(B), x), apply(C, y))
    return U, Omega


def impulse_rates(
    x: Terms, y: Terms, U: Terms, Omega: Terms, X: Terms, L: Terms
) -> tuple[list[Any], list[Any]]:
    """Return x' = x x Omega + X and y' = y x Omega + x x U + L: 48 (3) and (4), all 21 coefficients."""
    x_rate = add(cross(x, Omega), X)
    y_rate = add(add(cross(y, Omega), cross(x, U)), L)
    return x_rate, y_rate


def clebsch_rates(
    x: Terms, y: Terms, coefficients: Terms, X: Terms, L: Terms, differences: Terms = ()
) -> tuple[list[Any], list[Any]]:
    """Return both rates for Clebsch's T, with six products of the state instead of eighteen.

    x3' is 49 (3). y3' is the couple's third component alone, by 49 (2), whatever the force: without
    it y3 is a constant and the caller passes a parameter. ``differences`` are p' - p, q' - q and r' - r,
    as far as the caller has them exactly. One that is None, or all of them where nothing is passed,
    is formed as it goes, term by term: the arithmetic of a rung would have to round it.
    """
    p, p_prime, q, q_prime, r, r_prime = coefficients
    dp, dq, dr = differences or (None, None, None)
    x1, x2, x3 = x
    y1, y2, y3 = y
    x1x3, x2x3, x3y1, x3y2 = x1 * x3, x2 * x3, x3 * y1, x3 * y2
    x1y3, x2y3, y1y3, y2y3 = times(x1, y3), times(x2, y3), times(y1, y3), times(y2, y3)

    def by_p(term: Any) -> Any:
        return _by_difference(dp, p_prime, p, term)

    def by_q(term: Any) -> Any:
        return _by_difference(dq, q_prime, q, term)

    def by_r(term: Any) -> Any:
        return _by_difference(dr, r_prime, r, term)

    x_rate = [
        minus(plus(by_q(x2x3), times(r_prime, x2y3)), times(r, x3y2)),
        minus(times(r, x3y1), plus(by_q(x1x3), times(r_prime, x1y3))),
        times(r, x1 * y2 - x2 * y1),
    ]
    y_rate = [
        reduce(plus, [by_q(x3y2), by_r(y2y3), by_p(x2x3), by_q(x2y3)]),
        minus(0, reduce(plus, [by_q(x3y1), by_r(y1y3), by_p(x1x3), by_q(x1y3)])),
        0,
    ]
    return add(x_rate, X), add(y_rate, L)


def _by_difference(difference: Any, primed: Any, plain: Any, term: Any) -> Any:
    """Return (primed - plain) term, with the exact difference if it is given."""
    if difference is None:
        return minus(times(primed, term), times(plain, term))
    return times(difference, term)


# The equations of a form.


def kirchhoff_equations(n: Named) -> dict[str, Any]:
    """Return 48 (3) and (4) with the general T, and attitude and centre where they are tracked."""
    x, y = n.vector("x"), n.vector("y")
    U, Omega = velocities(x, y, n.symmetric("A"), n.matrix("B"), n.symmetric("C"))
    x_rate, y_rate = impulse_rates(x, y, U, Omega, n.vector("X"), n.vector("L"))
    return labelled("x", x_rate) | labelled("y", y_rate) | frame_rates(n, Omega, U)


@dataclass(frozen=True)
class ClebschAbout:
    """Kirchhoff's equations for Clebsch's T about body axis 1, 2 or 3.

    ``equal`` lists those of p, q, r that are the same along the axis as across it: p' is p then, and
    has no name of its own. The difference of two others may be a parameter.
    """

    axis: int = 3
    equal: tuple[str, ...] = ()

    def __call__(self, n: Named) -> dict[str, Any]:
        six = [
            n[name.removesuffix("'") if name[0] in self.equal else name] for name in CLEBSCH_NAMES
        ]
        # A cyclic change of names turns the axes and mirrors nothing.
        order = [(self.axis + k) % 3 for k in range(3)]
        x, y, X, L = ([n.vector(letter)[i] for i in order] for letter in "xyXL")
        differences = [
            ABSENT if name in self.equal else n.get(difference)
            for name, difference in CLEBSCH_DIFFERENCES.items()
        ]
        rates = clebsch_rates(x, y, six, X, L, differences)
        x_rate, y_rate = ([rate[order.index(i)] for i in range(3)] for rate in rates)
        A, B, C = ([[ABSENT] * 3 for _ in range(3)] for _ in range(3))
        for block, across, along in zip((A, B, C), six[::2], six[1::2], strict=True):
            for i in range(3):
                block[i][i] = along if i == self.axis - 1 else across
        U, Omega = velocities(n.vector("x"), n.vector("y"), A, B, C)
        return labelled("x", x_rate) | labelled("y", y_rate) | frame_rates(n, Omega, U)


# About axis 3 and with six coefficients; y3 is a state only if a couple changes it.
clebsch_equations: Final = ClebschAbout()
