"""The implicit midpoint rule, of second order.

    H' = H + h ((w + r) x K w + M),  w = (H + H')/2;   R' = R (1 - [c]x)^-1 (1 + [c]x),  c = h K w / 2

It is a Gauss method, and conserves what is quadratic: T and |H + r|^2 of a free body, r the momentum of
wheels. The second line is
the same rule for R' = R [omega]x; with it R H, the momentum in space, is conserved too.

M. A. Austin, P. S. Krishnaprasad and L.-S. Wang, Almost Poisson integration of rigid body systems,
J. Comput. Phys. 107 (1993) 105-117; E. Hairer, C. Lubich and G. Wanner, Geometric Numerical
Integration, 2nd ed. (2006), IV.2.1 for the quadratic invariants.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from taylor_verify.solvers.geometric.fixed_step import Body, FixedStep, Step, Stepped
from taylor_verify.solvers.geometric.newton import midpoint_columns, root
from taylor_verify.solvers.geometric.vectors import (
    Matrix,
    Quaternion,
    Vector,
    ahead,
    apply,
    cayley,
    cross,
    scaled,
)


@final
@dataclass(frozen=True)
class ImplicitMidpoint(FixedStep):
    """The implicit midpoint rule for any tensor; with a constant moment T and |H|^2 are not conserved."""

    name: str = "geometric:implicit-midpoint"
    takes = ("moment", "rotor")

    def stepping(self, body: Body, H: Vector, h: float) -> Step:
        del H
        K, M, r = body.K, body.M, body.r

        def step(H: Vector) -> Stepped:
            def system(w: Vector) -> tuple[Vector, Matrix]:
                omega = apply(K, w)
                whole = ahead(w, 1.0, r)
                rate = ahead(cross(whole, omega), 1.0, M)
                columns = midpoint_columns(K, h / 2, whole, omega)
                return ahead(ahead(w, -1.0, H), -h / 2, rate), columns

            guess = ahead(ahead(H, h / 2, cross(ahead(H, 1.0, r), apply(K, H))), h / 2, M)
            w, count = root(system, guess)
            omega = apply(K, w)
            rate = ahead(cross(ahead(w, 1.0, r), omega), 1.0, M)
            # As an increment, and not as 2w - H: so it is rounded once, at its own small size.
            return Stepped(ahead(H, h, rate), scaled(h / 2, omega), count + 2)

        return step

    def turn(self, trace: Vector) -> Quaternion:
        return cayley(trace)
