"""Weierstrass's function of one cubic, Y^2 = 4 X^3 - g2 X - g3, in balls, degenerate cubics included.

Legend: (X, Y) = (p(u), p'(u)) is Weierstrass's p; e_i are the roots of the cubic and Delta = g2^3 -
27 g3^2 its discriminant; L is the real period, L tau the other one. s(u) is an odd function with a
simple zero at every period: theta_1(u/L), a sine, a hyperbolic sine or u itself. A quotient of
products of s is one of sigma functions up to the exponential of a linear function of u, and the rate
of that one is found by whoever makes the quotient anyway.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from fractions import Fraction
from typing import Final, final

from flint import acb, arb, ctx

from taylor_verify.exact.balls import Undecidable, sign
from taylor_verify.numbers.irrational import ball

_I: Final = acb(0, 1)
# An argument is told from its neighbours, 2 pi away, by a sum that is known to about this much.
_ROUGH_BITS: Final = 64
_ROUGH_TAIL: Final = 0.25


class Lattice(ABC):
    """The periods of p, with numbers of one precision, and to be used at that precision.

    ``period`` is the real one; None where p has none. ``parameters`` are m = k^2 and 1 - m of Jacobi's
    functions; None where p is elementary.
    """

    period: arb | None
    parameters: tuple[arb, arb] | None = None

    @abstractmethod
    def jet(self, u: acb, order: int) -> list[acb]:
        """s(u), s'(u), ... up to that order, which is 0, 1 or 2."""

    @abstractmethod
    def p(self, u: acb) -> tuple[acb, acb]:
        """(p(u), p'(u)); not finite at a period."""

    @final
    def real(self, u: arb) -> tuple[arb, arb]:
        """(p(u), p'(u)) of a real u, where both are real."""
        p, slope = self.p(acb(u))
        return p.real, slope.real

    @abstractmethod
    def argument(self, X: acb, Y: acb) -> acb:
        """A u with p(u) = X and p'(u) = Y, for a point of the curve that is no double point."""

    @abstractmethod
    def turn(self, u: arb, w: acb, quotient: acb) -> arb:
        """The argument of the quotient s(u - w)/s(-w), continuous in the real u; w is not real."""


def lattice(g2: Fraction, g3: Fraction) -> Lattice:
    """The lattice with these invariants; its kind is decided in rationals."""
    discriminant = g2**3 - 27 * g3**2
    if discriminant > 0:
        return _rectangular(g2, g3, discriminant)
    if discriminant < 0:
        return _rhombic(g2, g3, discriminant)
    double_root = -3 * g3 / (2 * g2) if g2 != 0 else Fraction(0)
    return Elementary(double_root)


def _rectangular(g2: Fraction, g3: Fraction, discriminant: Fraction) -> Periods:
    """The lattice of three real roots e_k = (g2/3)^(1/2) cos(theta - 2 pi k/3), e1 > e2 > e3.

    For 4 c^3 - 3 c is the cosine of three times the angle whose cosine is c: here of 3 theta, which lies
    between 0 and pi, with the sine Delta^(1/2) and the cosine 27^(1/2) g3 but for a factor. Differences of
    the roots are sines of theta, of pi/3 - theta and of their sum times g2^(1/2). Delta is exact, and no
    ball loses bits however nearly two roots agree; nor e2, which is g3/(4 e1 e3).
    """
    sine, cosine = ball(discriminant).sqrt(), arb(27).sqrt() * ball(g3)
    theta, rest = arb.atan2(sine, cosine) / 3, arb.atan2(sine, -cosine) / 3
    size, turn = (ball(g2) / 3).sqrt(), arb.pi() / 3
    e1, e3 = size * theta.cos(), -size * rest.cos()
    e2 = ball(g3) / (4 * e1 * e3)
    upper, lower, whole = (ball(g2).sqrt() * angle.sin() for angle in (rest, theta, theta + turn))
    across, along = whole.sqrt().agm(upper.sqrt()), whole.sqrt().agm(lower.sqrt())
    parameters = lower / whole, upper / whole
    roots = [acb(e) for e in (e1, e2, e3)]
    return Periods(roots, arb.pi() / across, acb(0, across / along), parameters)


def _rhombic(g2: Fraction, g3: Fraction, discriminant: Fraction) -> Periods:
    """The lattice of one real root e and a pair. With H^2 = 3 e^2 - g2/4 the parameters are 1/2 -+ 3e/4H.

    Their product is -Delta/(256 H^6), from which the smaller one comes without cancellation.

    By Cardano |e| = c + w with c^3 = (|g3| + (-Delta/27)^(1/2))/8, a sum of positive numbers, and c w =
    g2/12, whose size is at most half of c^2 + w^2. So e^2 - g2/4 = c^2 + w^2 - g2/12 and
    H^2/3 = c^2 + w^2 + g2/12 lose two bits at most. The product of the pair is e^2 - g2/4 = g3/(4 e), and
    the pair is -e/2 +- i (-Delta)^(1/2)/(8 H^2).
    """
    root = ball(-discriminant).sqrt()
    c = ((abs(ball(g3)) + root / arb(27).sqrt()) / 8).root(3)
    squares, product = c * c + (ball(g2) / (12 * c)) ** 2, ball(g2) / 12
    e = ball(g3) / (4 * (squares - product))
    H2 = 3 * (squares + product)
    H, b = H2.sqrt(), root / (8 * H2)
    larger = arb(1) / 2 + abs(3 * e / (4 * H))
    smaller = ball(-discriminant) / (256 * H2**3 * larger)
    m, m_prime = (smaller, larger) if g3 >= 0 else (larger, smaller)  # e has the sign of g3
    real, imaginary = arb(1).agm(m_prime.sqrt()), arb(1).agm(m.sqrt())
    roots = [acb(e), acb(-e / 2, b), acb(-e / 2, -b)]
    tau = acb(0.5, real / imaginary / 2)
    return Periods(roots, arb.pi() / (real * H.sqrt()), tau, (m, m_prime))


@final
class Periods(Lattice):
    """Two periods, L > 0 and L tau: s(u) = theta_1(u/L). The first of the roots is p(L/2)."""

    period: arb

    def __init__(
        self, roots: Sequence[acb], length: arb, tau: acb, parameters: tuple[arb, arb]
    ) -> None:
        self._roots, self._length, self._tau = roots, length, tau
        self.period, self.parameters = length, parameters
        _, th2, th3, th4 = acb.modular_theta(acb(0), tau)
        scale = arb.pi() / length
        # p - e_1 = (pi/L)^2 (th3 th4 theta_2/theta_1)^2, DLMF 23.6.5
        self._from_root = (scale * th3 * th4) ** 2
        self._slope = -2 * scale**3 * (th2 * th3 * th4) ** 2

    def jet(self, u: acb, order: int) -> list[acb]:
        v = u / self._length
        return [acb.modular_theta(v, self._tau, k)[0] / self._length**k for k in range(order + 1)]

    def p(self, u: acb) -> tuple[acb, acb]:
        th1, th2, th3, th4 = acb.modular_theta(u / self._length, self._tau)
        p = self._roots[0] + self._from_root * (th2 / th1) ** 2
        return p, self._slope * th2 * th3 * th4 / th1**3

    def argument(self, X: acb, Y: acb) -> acb:
        """Carlson's R_F, which is right up to its sign and periods, whatever square roots it takes."""
        if Y.is_zero():
            return self._half_period(X)
        u = self._reduced(_integral_to_infinity([X - root for root in self._roots]))
        _, slope = self.p(u)
        right, wrong = slope.overlaps(Y), slope.overlaps(-Y)
        if right != wrong:
            return u if right else -u
        # Beside a half period, where u and -u are all but one point of the torus: both are covered.
        return u.union(2 * u - self._reduced(2 * u) - u)

    def turn(self, u: arb, w: acb, quotient: acb) -> arb:
        end, start = (u - w) / self._length, -w / self._length
        return nearest_turn(quotient, self._rough_turn(end) - self._rough_turn(start))

    def _half_period(self, X: acb) -> acb:
        """The half period whose root X is, the other two being excluded."""
        unity, tau = acb(1), self._tau
        # Which of the pair belongs to tau/2 and which to (1 + tau)/2 is asked of p itself.
        halves = [
            h for h in (unity, tau, unity + tau) if self.p(h * self._length / 2)[0].overlaps(X)
        ]
        if len(halves) != 1:
            raise Undecidable
        return self._reduced(halves[0] * self._length / 2)

    def _reduced(self, u: acb) -> acb:
        """u less a period, chosen so that |Im u| is at most about half of L Im tau."""
        v = u / self._length
        rows = _nearest(v.imag / self._tau.imag)
        v = v - rows * self._tau
        return self._length * (v - _nearest(v.real))

    def _rough_turn(self, v: acb) -> arb:
        """arg theta_1(v), continuous in Re v, up to a constant, while 0 < |Im v| < Im tau.

        For Im v > 0, theta_1(v) is a constant times e^{-i pi v} (1 - x) times the product of
        (1 - q^2n x)(1 - q^2n/x), with x = e^{2 pi i v} and q = e^{i pi tau}; no factor leaves the
        unit circle about 1. Below the real line it is the conjugate, up to a constant sign.
        """
        whole = abs(v.real).upper().floor().unique_fmpz()
        if whole is None:
            raise Undecidable
        with ctx.workprec(_ROUGH_BITS + int(whole).bit_length()):
            side = sign(v.imag)
            v = v if side > 0 else v.conjugate()
            x, q2 = (2 * v).exp_pi_i(), (2 * self._tau).exp_pi_i()
            total = (1 - x).arg() - arb.pi() * v.real
            power, ratio = q2, float(abs(q2).upper())
            while True:
                up, down = power * x, power / x
                size = float(abs(up).upper()) + float(abs(down).upper())
                if not float(abs(down).upper()) < 1:
                    raise Undecidable
                total += (1 - up).arg() + (1 - down).arg()
                power = power * q2
                # |arg(1 - z)| <= (pi/2)|z|, and the sizes fall in the ratio |q|^2.
                tail = 1.6 * size * ratio / (1 - ratio)
                if tail < _ROUGH_TAIL:
                    return side * (total + arb(0, _ROUGH_TAIL))


@final
class Elementary(Lattice):
    """A double root e: p = e + 1/s^2 with s'' = rho^2 s, rho^2 = 3 e, s'(0) = 1.

    So s(u) is sinh(rho u)/rho, a multiple of a sine where e < 0, and u itself for the triple root 0.
    """

    def __init__(self, double_root: Fraction) -> None:
        self._e, self._square = ball(double_root), ball(3 * double_root)
        size = abs(self._square).sqrt()
        self._rho = acb(size) if double_root >= 0 else acb(0, size)
        self.period = arb.pi() / size if double_root < 0 else None

    def jet(self, u: acb, order: int) -> list[acb]:
        if self._rho.is_zero():
            return [u, acb(1), acb(0)][: order + 1]
        sinh, cosh = (self._rho * u).sinh_cosh()
        return [sinh / self._rho, cosh, self._rho * sinh][: order + 1]

    def p(self, u: acb) -> tuple[acb, acb]:
        s, slope = self.jet(u, order=1)
        rise = 1 / s**2
        return self._e + rise, -2 * rise * slope / s

    def argument(self, X: acb, Y: acb) -> acb:
        """Solved from e^{2 rho u} = (coth + 1)/(coth - 1), with p'/(p - e) = -2 rho coth = -2 s'/s."""
        if self._rho.is_zero():
            return -2 * X / Y
        slant = 2 * self._rho * (X - self._e)
        return _logarithm((Y - slant) / (Y + slant)) / (2 * self._rho)

    def turn(self, u: arb, w: acb, quotient: acb) -> arb:
        if self.period is None:
            # Im sinh(a + i b) = cosh a sin b, and Im (a + i b), have one sign along the line.
            start = self.jet(-w, order=0)[0]
            across = -sign(start.imag) * _I * start
            return (across * quotient).arg() - across.arg()
        # sin v is a constant times e^{-i v}(1 - e^{2 i v}) for Im v > 0; below, the conjugate.
        kappa, side = self._rho.imag, sign((-w).imag)
        end, start = (v if side > 0 else v.conjugate() for v in (kappa * (u - w), kappa * -w))
        bend = (1 - (2 * _I * end).exp()).arg() - (1 - (2 * _I * start).exp()).arg()
        return side * (bend - kappa * u)


def nearest_turn(quotient: acb, rough: arb) -> arb:
    """arg quotient, on the branch that agrees with the rough value."""
    is_left = quotient.real.mid() < 0  # the cut of arg is kept away from
    principal = (-quotient).arg() + arb.pi() if is_left else quotient.arg()
    turns = ((rough - principal) / (2 * arb.pi()) + arb(1) / 2).floor().unique_fmpz()
    if turns is None:
        raise Undecidable
    return principal + 2 * arb.pi() * turns


def _integral_to_infinity(from_roots: Sequence[acb]) -> acb:
    """R_F of three numbers, turned in the plane where one of them lies across Carlson's cut."""
    for factor in (acb(1), _I, acb(-1)):
        integral = factor.sqrt() * acb.elliptic_rf(*(factor * z for z in from_roots))
        if integral.is_finite():
            return integral
    raise Undecidable


def _logarithm(z: acb) -> acb:
    """A logarithm of z, away from the cut."""
    if z.real.mid() < 0:
        return (-z).log() + _I * arb.pi()
    return z.log()


def _nearest(value: arb) -> int:
    """An integer near the middle of the ball: any will do, the nearest is best."""
    integer = (value.mid() + arb(1) / 2).floor().unique_fmpz()
    if integer is None:
        raise Undecidable
    return int(integer)
