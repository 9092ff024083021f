"""Steady screws: a solid of any shape that turns about its impulse and advances along it, unchanged.

Legend: T = x.A x/2 + x.B y + y.C y/2, U = A x + B y, Omega = B^T x + C y, F = |x|. Where

    Omega = lambda x,  U = lambda y + mu x,

x' = x x Omega and y' = y x Omega + x x U vanish. With y = C^-1 (lambda - B^T) x from the first of
these the second says S(lambda) x = mu x with the symmetric matrix

    S(lambda) = A - (B - lambda) C^-1 (B - lambda)^T:

for every lambda three screws, along axes across each other; lambda = 0 makes them the three pure
translations of a solid. The body turns about the impulse at lambda F and keeps T stationary for
given F^2 and FG, with lambda and mu/2 the multipliers.

A small disturbance obeys the linearised equations, whose exponents s are 0 twice (F and FG may
change) and the roots of s^4 + c2 s^2 + c0 = 0, with J their matrix: c2 = -tr J^2/2 and
c0 = (2 c2^2 - tr J^4)/4. Everything is in balls, every statement a sign that they prove.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from fractions import Fraction
from typing import Any, Final

from flint import arb, arb_mat, ctx, fmpq, fmpq_mat

from taylor_verify.exact.balls import ball, balls
from taylor_verify.scenes import tensors
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.tensors import Matrix, Vector

_FIRST_BITS: Final = 128
# Beyond it a sign that is still open is taken for an equality.
_MOST_BITS: Final = 2048


class Stability(Enum):
    """What is proven of a screw; the value is the sentence."""

    STABLE = "stable: T - lambda x.y - mu x.x/2 is least there"
    TO_FIRST_ORDER = "stable to the first order: small disturbances swing"
    UNSTABLE = "unstable: a small disturbance grows exponentially"
    UNDECIDED = "on a border that the first order does not decide"


@dataclass(frozen=True)
class Screw:
    """One steady screw with a given F, in body axes.

    ``speed`` is the velocity of the body's origin along the impulse, ``c2`` and ``c0`` the
    coefficients of the exponents' equation.
    """

    turn: Fraction
    mu: arb
    x: tuple[arb, ...]
    y: tuple[arb, ...]
    speed: arb
    c2: arb
    c0: arb
    stability: Stability

    def axis(self) -> list[arb]:
        """The direction of x in body axes; its sense is of no account."""
        F = _dot(self.x, self.x).sqrt()
        return [entry / F for entry in self.x]

    def growth(self) -> arb:
        """The largest real part of an exponent of an unstable screw, 1/time."""
        discriminant = self.c2**2 - 4 * self.c0
        if discriminant < 0:
            return ((self.c0.sqrt() - self.c2 / 2) / 2).sqrt()
        return ((discriminant.nonnegative_part().sqrt() - self.c2) / 2).sqrt()

    def swings(self) -> tuple[arb, arb]:
        """The two rates of small disturbances, radians/time, of one whose exponents are imaginary."""
        discriminant = (self.c2**2 - 4 * self.c0).nonnegative_part()
        fast = ((self.c2 + discriminant.sqrt()) / 2).sqrt()
        return self.c0.sqrt() / fast, fast


def turn_of(body: ImmersedBody, start: Impulse) -> Fraction:
    """lambda of the start, Omega.x/F^2: its turning about the impulse, over F; F is not zero."""
    Omega = tensors.apply(body.energy_matrix, start.linear + start.angular)[3:]
    return tensors.dot(Omega, start.linear) / tensors.dot(start.linear, start.linear)


def is_steady(body: ImmersedBody, start: Impulse) -> bool:
    """Whether x and y stay as they are at the start, exactly."""
    x, y = start.linear, start.angular
    both = tensors.apply(body.energy_matrix, x + y)
    U, Omega = both[:3], both[3:]
    torque = tensors.plus(tensors.cross(y, Omega), tensors.cross(x, U))
    return not any(tensors.cross(x, Omega) + torque)


def stiffness(body: ImmersedBody, turn: Fraction) -> Matrix:
    """S(lambda)."""
    less = _less(body.coupling, turn)
    bent = tensors.product(
        tensors.product(less, tensors.inverse(body.angular)), tensors.transpose(less)
    )
    return tuple(
        tuple(a - b for a, b in zip(row, other, strict=True))
        for row, other in zip(body.linear, bent, strict=True)
    )


def screws(body: ImmersedBody, F2: Fraction, turn: Fraction) -> tuple[Screw, ...]:
    """The three steady screws of a free body with F^2 = F2 and lambda = turn, by rising mu.

    None at all where two mu are equal: every axis across the third one is a screw then.
    """
    S = stiffness(body, turn)
    polynomial = fmpq_mat([[_rational(entry) for entry in row] for row in S]).charpoly()
    if polynomial.gcd(polynomial.derivative()).degree() > 0:
        return ()
    bits = _FIRST_BITS
    while True:
        with ctx.workprec(bits):
            enclosed: list[Any] = polynomial.complex_roots()
            roots = sorted((root.real for root, _ in enclosed), key=_middle)
            found = [_screw(body, S, F2, turn, mu, n == 0) for n, mu in enumerate(roots)]
        if bits >= _MOST_BITS or Stability.UNDECIDED not in (s.stability for s in found):
            return tuple(found)
        bits *= 2


def _screw(
    body: ImmersedBody, S: Matrix, F2: Fraction, turn: Fraction, mu: arb, is_least: bool
) -> Screw:
    F = ball(F2).sqrt()
    n = _axis(S, mu)
    x = [F * entry for entry in n]
    to_y = tensors.product(
        tensors.inverse(body.angular), _scaled(_less(tensors.transpose(body.coupling), turn), -1)
    )
    y = _times(to_y, x)
    U = [ball(turn) * b + mu * a for a, b in zip(x, y, strict=True)]
    Omega = [ball(turn) * entry for entry in x]
    J = _linearised(body, x, y, U, Omega)
    square = J * J
    c2 = -_trace(square) / 2
    c0 = (2 * c2**2 - _trace(square * square)) / 4
    speed = sum((u * a for u, a in zip(U, n, strict=True)), arb(0))
    stability = Stability.STABLE if is_least else _stability(c2, c0)
    return Screw(turn, mu, tuple(x), tuple(y), speed, c2, c0, stability)


def _stability(c2: arb, c0: arb) -> Stability:
    """s^2 is real and negative, twice over, or else one s has a positive real part."""
    discriminant = c2**2 - 4 * c0
    if c2 > 0 and c0 > 0 and discriminant > 0:
        return Stability.TO_FIRST_ORDER
    if c2 < 0 or c0 < 0 or discriminant < 0:
        return Stability.UNSTABLE
    return Stability.UNDECIDED


def _axis(S: Matrix, mu: arb) -> list[arb]:
    """The unit vector n with S n = mu n for a simple mu: adj(S - mu) is a multiple of n n^T."""
    M = [[ball(e) - (mu if i == j else 0) for j, e in enumerate(row)] for i, row in enumerate(S)]
    adjugate = [_cross(M[(i + 1) % 3], M[(i + 2) % 3]) for i in range(3)]
    column = max(adjugate, key=lambda row: _middle(_dot(row, row)))
    size = _dot(column, column).sqrt()
    return [entry / size for entry in column]


def _linearised(
    body: ImmersedBody, x: Sequence[arb], y: Sequence[arb], U: Sequence[arb], Omega: Sequence[arb]
) -> arb_mat:
    """The matrix of (dx, dy) in the linearised equations 48 (3), (4)."""
    columns = []
    for n in range(6):
        move = [arb(int(n == m)) for m in range(6)]
        dx, dy = move[:3], move[3:]
        both = [balls(row)[n] for row in body.energy_matrix]
        dU, dOmega = both[:3], both[3:]
        first = _plus(_cross(dx, Omega), _cross(x, dOmega))
        second = _plus(_cross(dy, Omega), _cross(y, dOmega), _cross(dx, U), _cross(x, dU))
        columns.append(first + second)
    return arb_mat(columns).transpose()


# Small algebra, on rationals and on balls.


def _rational(entry: Fraction) -> fmpq:
    return fmpq(entry.numerator, entry.denominator)


def _less(matrix: Matrix, value: Fraction) -> Matrix:
    """The matrix less a multiple of the unit matrix."""
    return tuple(
        tuple(entry - value if i == j else entry for j, entry in enumerate(row))
        for i, row in enumerate(matrix)
    )


def _scaled(matrix: Matrix, factor: int) -> Matrix:
    return tuple(tensors.scaled(Fraction(factor), row) for row in matrix)


def _times(matrix: Sequence[Vector], vector: Sequence[arb]) -> list[arb]:
    return [_dot(balls(row), vector) for row in matrix]


def _dot(a: Sequence[Any], b: Sequence[Any]) -> arb:
    return sum((p * q for p, q in zip(a, b, strict=True)), arb(0))


def _cross(a: Sequence[Any], b: Sequence[Any]) -> list[arb]:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def _plus(*vectors: Sequence[arb]) -> list[arb]:
    return [sum(entries, arb(0)) for entries in zip(*vectors, strict=True)]


def _trace(matrix: arb_mat) -> arb:
    return sum((matrix[i, i] for i in range(6)), arb(0))


def _middle(value: arb) -> float:
    return float(value.mid())
