"""The discrete Moser-Veselov algorithm, of second order, and preprocessed, of fourth.

m, m'   momentum before and after      F  turn of the frame in the step, R' = R F, m' = F^T m
I       inertia tensor, K = I^-1       D  = tr(I)/2 - I
e1 e2 e3  tr K, (tr^2 K - tr K^2)/2, det K

Discrete Lagrangian tr(R D R'^T) leads to h [m]x = F D - D F^T. Let F be the turn of the unit
quaternion s (1, c), s^-2 = 1 + |c|^2, and v = 2 I c/h. Then 1 + |c|^2 = 1 + h^2 |K v|^2/4 =: sigma and

    sigma m = v - (h/2) v x K v,        sigma m' = v + (h/2) v x K v,

so no inverse of K is needed, nor principal axes. T, |m|^2 and R m are conserved: it is an integrable
map, the midpoint rule with the step h sigma.

By backward analysis m' = (1 + h^2 t) m x K m + O(h^4), with a factor that is constant on the orbit:
t = e1 T/3 - e2 |m|^2/12. A frame that keeps R m turns with (1 + h^2 t) K m + h^2 l m; the component
along m of the exponential of a step gives l = e3 |m|^2/6 - e2 T/6. The algorithm with

    K~ = (1 - h^2 t) K - h^2 l

in place of K is thus of order four, the attitude too, and conserves T as before.

J. Moser and A. P. Veselov, Discrete versions of some classical integrable systems and factorization of
matrix polynomials, Comm. Math. Phys. 139 (1991) 217-243. E. Hairer and G. Vilmart,
Preprocessed discrete Moser-Veselov algorithm for the full dynamics of a rigid body, J. Phys. A 39 (2006)
13225-13235: their s_3 is -t and their d_3 is -l, derived here anew for a tensor in any axes.
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
    dot,
    scaled,
)


@final
@dataclass(frozen=True)
class MoserVeselov(FixedStep):
    """The Moser-Veselov algorithm for any tensor; the preprocessed tensor has a rounding error."""

    name: str = "geometric:moser-veselov"
    preprocessed: bool = False

    def stepping(self, body: Body, H: Vector, h: float) -> Step:
        K = _modified(body.K, H, h) if self.preprocessed else body.K

        def step(m: Vector) -> Stepped:
            def system(v: Vector) -> tuple[Vector, Matrix]:
                omega = apply(K, v)
                sigma = 1 + h * h / 4 * dot(omega, omega)
                value = ahead(ahead(v, -h / 2, cross(v, omega)), -sigma, m)
                return value, _with_sigma(midpoint_columns(K, h / 2, v, omega), K, h, m, omega)

            v, count = root(system, ahead(m, h / 2, cross(m, apply(K, m))))
            omega = apply(K, v)
            sigma = 1 + h * h / 4 * dot(omega, omega)
            after = ahead(m, h / sigma, cross(v, omega))
            return Stepped(after, scaled(h / 2, omega), count + 2)

        return step

    def turn(self, trace: Vector) -> Quaternion:
        return cayley(trace)


def _with_sigma(columns: Matrix, K: Matrix, h: float, m: Vector, omega: Vector) -> Matrix:
    """Return the columns less m times the gradient of sigma, h^2 K omega/2."""
    g1, g2, g3 = scaled(-h * h / 2, apply(K, omega))
    c1, c2, c3 = columns
    return (ahead(c1, g1, m), ahead(c2, g2, m), ahead(c3, g3, m))


def _modified(K: Matrix, m: Vector, h: float) -> Matrix:
    """Return K~, the tensor with which the second-order algorithm is of fourth order."""
    (k11, k12, k13), (_, k22, k23), (_, _, k33) = K
    e1 = k11 + k22 + k33
    e2 = k11 * k22 + k22 * k33 + k33 * k11 - k12 * k12 - k23 * k23 - k13 * k13
    e3 = dot(K[0], cross(K[1], K[2]))
    energy, squared = dot(m, apply(K, m)) / 2, dot(m, m)
    t = e1 * energy / 3 - e2 * squared / 12
    along = e3 * squared / 6 - e2 * energy / 6
    s, d = h * h * t, h * h * along
    (x1, y1, z1), (x2, y2, z2), (x3, y3, z3) = (ahead(row, -s, row) for row in K)
    return ((x1 - d, y1, z1), (x2, y2 - d, z2), (x3, y3, z3 - d))
