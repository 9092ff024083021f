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
change) and the roots of s^4 + c2 s^2 + c0 = 0. Everything is in balls, every statement a sign that
they prove.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from fractions import Fraction
from typing import Final

from flint import arb, arb_mat, ctx

from taylor_verify.exact.balls import ball, ball_matrix
from taylor_verify.exact.kirchhoff.solid import velocities
from taylor_verify.exact.spectrum import Cubic
from taylor_verify.numbers import tensors
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Impulse
from taylor_verify.scenes.scene import Scene

_FIRST_BITS: Final = 128
# Beyond it a sign that is still open is taken for an equality.
_MOST_BITS: Final = 2048


class Stability(Enum):
    """Proven statements about a screw; the value is the sentence."""

    STABLE = "stable: T - lambda x.y - mu x.x/2 is least there"
    TO_FIRST_ORDER = "stable to the first order: small disturbances swing"
    UNSTABLE = "unstable: a small disturbance grows exponentially"
    UNDECIDED = "on a border that the first order does not decide"


@dataclass(frozen=True)
class Screw:
    """A steady screw with a given F, in body axes.

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
        F = _length(self.x)
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
    _, Omega = velocities(body, start)
    return tensors.dot(Omega, start.linear) / tensors.dot(start.linear, start.linear)


def is_steady(body: ImmersedBody, start: Impulse) -> bool:
    """Return True if x and y stay as they are at the start, exactly, under the constant loads."""
    x, y = start.linear, start.angular
    U, Omega = velocities(body, start)
    force = tensors.plus(tensors.cross(x, Omega), body.force)
    torque = tensors.plus(tensors.cross(y, Omega), tensors.cross(x, U))
    return not any(force + tensors.plus(torque, body.couple))


def screws_beside(scene: Scene) -> tuple[Screw, ...]:
    """The steady screws with the F of the scene that turn about it as fast as its start does.

    None for a body of revolution, under loads, without linear impulse, and where they are not
    three.
    """
    body, start = scene.body, scene.initial
    if not (isinstance(body, ImmersedBody) and isinstance(start, Impulse)):
        return ()
    if not body.is_free or body.axis_of_symmetry is not None or not any(start.linear):
        return ()
    return screws(body, tensors.dot(start.linear, start.linear), turn_of(body, start))


def screws(body: ImmersedBody, F2: Fraction, turn: Fraction) -> tuple[Screw, ...]:
    """The three steady screws of a free body with F^2 = F2 and lambda = turn, by rising mu.

    None at all where two mu are equal: every axis across the third one is a screw then.
    """
    D = tuple(map(tensors.minus, tensors.diagonal((turn,) * 3), body.coupling))
    to_y = tensors.product(tensors.inverse(body.angular), tensors.transpose(D))
    S = tuple(map(tensors.minus, body.linear, tensors.product(D, to_y)))
    cubic = Cubic.of(S)
    if not cubic.discriminant > 0:
        return ()
    bits = _FIRST_BITS
    while True:
        with ctx.workprec(bits):
            low, middle, high = reversed(cubic.spectrum().values)
            balls, energy, F = ball_matrix(S), ball_matrix(body.energy_matrix), ball(F2).sqrt()
            pairs = (low, middle, high), (middle, high, low), (high, low, middle)
            three = [
                _screw(energy, _axis(balls, *others) * F, ball_matrix(to_y), turn, mu, mu is low)
                for mu, *others in pairs
            ]
        if bits >= _MOST_BITS or Stability.UNDECIDED not in (s.stability for s in three):
            return tuple(three)
        bits *= 2


def _axis(S: arb_mat, other: arb, third: arb) -> arb_mat:
    """The unit eigenvector of S beside two others, whose mu are these: (S - mu_2)(S - mu_3) ~ n n^T."""
    columns = ((S - arb_mat(3, 3, other)) * (S - arb_mat(3, 3, third))).transpose().tolist()
    longest = max(columns, key=lambda column: max(_middle(abs(entry)) for entry in column))
    return arb_mat(3, 1, longest) / _length(longest)


def _screw(
    energy: arb_mat, x: arb_mat, to_y: arb_mat, turn: Fraction, mu: arb, is_least: bool
) -> Screw:
    y = to_y * x
    U, Omega = y * ball(turn) + x * mu, x * ball(turn)
    # Of (dx, dy) in the linearised equations 48 (3), (4): s^6 + c2 s^4 + c0 s^2.
    none = arb_mat(3, 3)
    given, turned, pushed = _blocks(none, _cross(x), _cross(x), _cross(y)), _cross(Omega), _cross(U)
    spectrum = (given * energy - _blocks(turned, none, pushed, turned)).charpoly()
    c2, c0 = spectrum[4], spectrum[2]
    speed = (U.transpose() * x)[0, 0] / _length(x.entries())
    stability = Stability.STABLE if is_least else _stability(c2, c0)
    return Screw(turn, mu, tuple(x.entries()), tuple(y.entries()), speed, c2, c0, stability)


def _stability(c2: arb, c0: arb) -> Stability:
    """s^2 is real and negative, twice over, or else one s has a positive real part."""
    discriminant = c2**2 - 4 * c0
    if c2 > 0 and c0 > 0 and discriminant > 0:
        return Stability.TO_FIRST_ORDER
    if c2 < 0 or c0 < 0 or discriminant < 0:
        return Stability.UNSTABLE
    return Stability.UNDECIDED


# Small algebra on balls.


def _cross(v: arb_mat) -> arb_mat:
    """[v]x, so that [v]x w = v x w."""
    a, b, c = v.entries()
    return arb_mat([[0, -c, b], [c, 0, -a], [-b, a, 0]])


def _blocks(a: arb_mat, b: arb_mat, c: arb_mat, d: arb_mat) -> arb_mat:
    """The matrix [[a, b], [c, d]]."""
    pairs = ((a, b), (c, d))
    return arb_mat(
        [p + q for left, right in pairs for p, q in zip(left.tolist(), right.tolist(), strict=True)]
    )


def _length(v: Sequence[arb]) -> arb:
    return sum((entry * entry for entry in v), arb(0)).sqrt()


def _middle(value: arb) -> float:
    return float(value.mid())
