"""Kirchhoff's equations of a solid moving through an ideal fluid (Hydromechanics 48-49).

x  linear impulse, body axes           U      = dT/dx, velocity of the body's origin
y  impulsive couple about the origin   Omega  = dT/dy, angular velocity
X, L  force and couple, body axes      T      = x.A x/2 + x.B y + y.C y/2

p, p', q, q', r, r' are Clebsch's coefficients, 49 (1), with body axis 3 the axis of symmetry.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

from taylor_verify.models.algebra import (
    ABSENT,
    Terms,
    add,
    apply,
    cross,
    dot,
    minus,
    times,
    transpose,
)
from taylor_verify.models.form import Named, frame_rates, labelled

CLEBSCH_NAMES: Final = ("p", "p'", "q", "q'", "r", "r'")


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
    x: Terms, y: Terms, coefficients: Terms, X: Terms, L: Terms
) -> tuple[list[Any], list[Any]]:
    """Return both rates for Clebsch's T, where six products of the state serve for eighteen.

    x3' is 49 (3). y3' is the couple's third component alone, by 49 (2), whatever the force: without
    it y3 is a constant and the caller passes a parameter. Coefficients stand by themselves, never as
    differences such as q' - q, which the arithmetic of a rung would have to round. Where q' is the
    very object that q is, the body is the same in all directions as far as q goes, and the terms of
    that difference are left out; likewise p' and p, r' and r.
    """
    p, p_prime, q, q_prime, r, r_prime = coefficients
    x1, x2, x3 = x
    y1, y2, y3 = y
    x1x3, x2x3, x3y1, x3y2 = x1 * x3, x2 * x3, x3 * y1, x3 * y2
    x1y3, x2y3, y1y3, y2y3 = times(x1, y3), times(x2, y3), times(y1, y3), times(y2, y3)

    def sum_of(positive: Sequence[Terms], negative: Sequence[Terms]) -> Any:
        kept, taken = _uncancelled(positive, negative)
        total = dot(*zip(*kept, strict=True)) if kept else ABSENT
        for coefficient, term in taken:
            total = minus(total, times(coefficient, term))
        return total

    x_rate = [
        sum_of([(q_prime, x2x3), (r_prime, x2y3)], [(q, x2x3), (r, x3y2)]),
        sum_of([(q, x1x3), (r, x3y1)], [(q_prime, x1x3), (r_prime, x1y3)]),
        times(r, x1 * y2 - x2 * y1),
    ]
    y_rate = [
        sum_of(
            [(q_prime, x3y2), (r_prime, y2y3), (p_prime, x2x3), (q_prime, x2y3)],
            [(q, x2y3), (r, y2y3), (p, x2x3), (q, x3y2)],
        ),
        sum_of(
            [(q, x1y3), (r, y1y3), (p, x1x3), (q, x3y1)],
            [(q_prime, x3y1), (r_prime, y1y3), (p_prime, x1x3), (q_prime, x1y3)],
        ),
        0,
    ]
    return add(x_rate, X), add(y_rate, L)


def _uncancelled(
    positive: Sequence[Terms], negative: Sequence[Terms]
) -> tuple[list[Terms], list[Terms]]:
    """The products without those that occur with both signs: the same coefficient, the same term."""
    # Identity, not equality: two numbers may be equal by chance, and in one body only.
    added, taken = ([(id(c), id(term)) for c, term in terms] for terms in (positive, negative))
    return (
        [term for key, term in zip(added, positive, strict=True) if key not in taken],
        [term for key, term in zip(taken, negative, strict=True) if key not in added],
    )


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
    has no name of its own.
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
        found = clebsch_rates(x, y, six, X, L)
        x_rate, y_rate = ([rate[order.index(i)] for i in range(3)] for rate in found)
        A, B, C = ([[ABSENT] * 3 for _ in range(3)] for _ in range(3))
        for block, across, along in zip((A, B, C), six[::2], six[1::2], strict=True):
            for i in range(3):
                block[i][i] = along if i == self.axis - 1 else across
        U, Omega = velocities(n.vector("x"), n.vector("y"), A, B, C)
        return labelled("x", x_rate) | labelled("y", y_rate) | frame_rates(n, Omega, U)


# About axis 3 and with six coefficients; y3 is a state only where a couple turns it.
clebsch_equations: Final = ClebschAbout()
