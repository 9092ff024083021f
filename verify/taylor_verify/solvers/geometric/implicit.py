"""Two implicit methods: the midpoint rule, and the discrete Moser-Veselov algorithm.

m, m'   momentum before and after      K  inverse inertia, omega = K v at the middle momentum v
h       step                           r  momentum of wheels          M  moment
c       h omega/2: the frame turns by R' = R (1 - [c]x)^-1 (1 + [c]x), an angle 2 atan |c| about c

The midpoint rule, of second order, is  m' = m + h ((v + r) x K v + M)  with  v = (m + m')/2. It is a Gauss
method, and conserves what is quadratic: T and |m + r|^2 of a free body. With the turn above R (m + r), the
momentum in space, is conserved too.

The discrete Lagrangian tr(R D R'^T), D = tr(I)/2 - I, leads to h [m]x = F D - D F^T with R' = R F and
m' = F^T m. Let F be the turn of c, and v = 2 I c/h. Then 1 + |c|^2 = 1 + h^2 |K v|^2/4 =: sigma and

    sigma m = v - (h/2) v x K v,        sigma m' = v + (h/2) v x K v,

so no inverse of K is needed, nor principal axes. T, |m|^2 and R m are conserved: it is an integrable
map, the midpoint rule with the step h sigma, and of second order.

Preprocessed it is of fourth. Let e1 e2 e3 be tr K, (tr^2 K - tr K^2)/2 and det K. By backward analysis
m' = (1 + h^2 t) m x K m + O(h^4), with a factor that is constant on the orbit: t = e1 T/3 - e2 |m|^2/12.
A frame that keeps R m turns with (1 + h^2 t) K m + h^2 l m; the component along m of the exponential of a
step gives l = e3 |m|^2/6 - e2 T/6. The algorithm with

    K~ = (1 - h^2 t) K - h^2 l

in place of K is thus of order four, the attitude too, and conserves T as before.

M. A. Austin, P. S. Krishnaprasad and L.-S. Wang, Almost Poisson integration of rigid body systems,
J. Comput. Phys. 107 (1993) 105-117. E. Hairer, C. Lubich and G. Wanner, Geometric Numerical Integration,
2nd ed. (2006), IV.2.1 for the quadratic invariants. J. Moser and A. P. Veselov, Discrete versions of some
classical integrable systems and factorization of matrix polynomials, Comm. Math. Phys. 139 (1991) 217-243.
E. Hairer and G. Vilmart, Preprocessed discrete Moser-Veselov algorithm for the full dynamics of a rigid
body, J. Phys. A 39 (2006) 13225-13235: their s_3 is -t and their d_3 is -l, derived here anew for a tensor
in any axes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, final

from taylor_verify.numbers.rotation import scalar_product as dot
from taylor_verify.numbers.tensors import cross
from taylor_verify.solvers.geometric.fixed_step import Body, FixedStep, Step, Stepped, Unsolved
from taylor_verify.solvers.geometric.vectors import (
    Matrix,
    Quaternion,
    Vector,
    ahead,
    apply,
    cayley,
    scaled,
    solved,
)

# Newton's iteration squares its error. A correction below the root of the roundoff is the last one.
_ROUNDOFF: Final = 2.0**-53
# From a first guess that is right to a half, six squarings lead beyond float64: where so many
# more do not, the step is too long for the equation.
_MOST: Final = 25
_UNITS: Final[Matrix] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))

System = Callable[[Vector], tuple[Vector, Matrix]]


class _Implicit(FixedStep):
    """A method whose frame turns by the Cayley map; its trace is c."""

    def turn(self, trace: Vector) -> Quaternion:
        return cayley(trace)


@final
@dataclass(frozen=True)
class ImplicitMidpoint(_Implicit):
    """The implicit midpoint rule for any tensor; with a constant moment T and |H|^2 are not conserved."""

    name: str = "geometric:implicit-midpoint"
    takes = ("moment", "rotor")

    def stepping(self, body: Body, H: Vector, h: float) -> Step:
        del H
        K, M, r = body.K, body.M, body.r

        def step(m: Vector) -> Stepped:
            def system(v: Vector) -> tuple[Vector, Matrix]:
                omega = apply(K, v)
                whole = ahead(v, 1.0, r)
                rate = ahead(cross(whole, omega), 1.0, M)
                columns = _columns(K, h / 2, whole, omega)
                return ahead(ahead(v, -1.0, m), -h / 2, rate), columns

            guess = ahead(ahead(m, h / 2, cross(ahead(m, 1.0, r), apply(K, m))), h / 2, M)
            v, count = root(system, guess)
            omega = apply(K, v)
            rate = ahead(cross(ahead(v, 1.0, r), omega), 1.0, M)
            # As an increment, and not as 2v - m: so it is rounded once, at its own small size.
            return Stepped(ahead(m, h, rate), scaled(h / 2, omega), count + 2)

        return step


@final
@dataclass(frozen=True)
class MoserVeselov(_Implicit):
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
                # Less m times the gradient of sigma, h^2 K omega/2.
                gradient = scaled(-h * h / 2, apply(K, omega))
                (a, b, c), (g1, g2, g3) = _columns(K, h / 2, v, omega), gradient
                return value, (ahead(a, g1, m), ahead(b, g2, m), ahead(c, g3, m))

            v, count = root(system, ahead(m, h / 2, cross(m, apply(K, m))))
            omega = apply(K, v)
            sigma = 1 + h * h / 4 * dot(omega, omega)
            after = ahead(m, h / sigma, cross(v, omega))
            return Stepped(after, scaled(h / 2, omega), count + 2)

        return step


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


def _columns(K: Matrix, c: float, w: Vector, omega: Vector) -> Matrix:
    """Return the columns of d(v - c w x K v)/dv = 1 - c ([w]x K - [omega]x), w = v + r, omega = K v."""

    def column(unit: Vector) -> Vector:
        turned, bent = cross(unit, omega), cross(w, apply(K, unit))
        return ahead(ahead(unit, -c, turned), -c, bent)

    return (column(_UNITS[0]), column(_UNITS[1]), column(_UNITS[2]))


def root(system: System, guess: Vector) -> tuple[Vector, int]:
    """Return the zero of a map with the columns of its derivative, and the number of evaluations.

    Raises Unsolved where Newton's iteration does not settle.
    """
    v = guess
    for count in range(1, _MOST + 1):
        value, columns = system(v)
        change = solved(columns, value)
        v = ahead(v, -1.0, change)
        if dot(change, change) <= _ROUNDOFF * dot(v, v):
            return v, count
    raise Unsolved(
        f"Newton's iteration for the implicit step did not settle in {_MOST}: take shorter steps"
    )
