"""The squared speed F of the bead on the washboard, and the v that it carries along, in balls.

Legend as in board, x = 2 Omega sigma. Where kappa < 0 (v swings),

    F = nu0^2 + slope sigma - P (cos x - 1) - Q sin x/(2 Omega),
    (F(e + z) - F(e))/z = slope + s ((F'(e) - slope) cos(Omega z) + F''(e) z s/2),
                                                             s = sin(Omega z)/(Omega z),

and where kappa > 0 (v grows), with p, q = (P +- Q/(2 Omega))/2,

    F = nu0^2 + slope sigma + P - p e^x - q e^-x,
    (F(e + z) - F(e))/z = slope - 2 Omega s (p e^(x + Omega z) - q e^-(x + Omega z)),
                                                             s = sinh(Omega z)/(Omega z), x at e.

The quotients come from the differences of sines and of exponentials: nothing cancels in them as z -> 0.
Where the growing part of v is zero, p is exactly 0: v and F stay accurate however small the rest becomes.
On a wide ball away from the end, F(e + z)/z comes from Taylor's formula about the middle: on a crest that
is all but a double root, F is small by its second order, and that must be seen.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Final, TypeVar, final

from flint import acb, arb, ctx

from taylor_verify.exact.balls import ball, balls
from taylor_verify.exact.euler.moments.washboard.board import Washboard

Quotient = Callable[[acb], acb]
Number = TypeVar("Number", arb, acb)

# Taylor's formula is used so far from the end, in units of 1/Omega, on what is no node of a quadrature:
# those are wide by a few last bits.
_AWAY: Final = 0.25
_NODE_BITS: Final = 24


class Speed(ABC):
    """F with the numbers of one precision of flint, good only there."""

    def __init__(self, board: Washboard) -> None:
        self.board = board
        self.slope, self.even, self.odd = (ball(e) for e in (board.slope, board.even, board.odd))
        self.rate = ball(abs(board.kappa)).sqrt()
        self._odd = self.odd / (2 * self.rate)
        self._start = ball(board.nu**2)
        self._across = balls(board.across)
        self._ahead = [entry / self.rate for entry in balls(board.ahead)]

    @final
    def squared(self, sigma: Number) -> Number:
        """Return F."""
        return self._start + self.slope * sigma - self._wave(sigma, order=0)

    @final
    def derivative(self, sigma: Number) -> Number:
        """Return F'."""
        return self.slope - self._wave(sigma, order=1)

    @abstractmethod
    def _wave(self, sigma: Number, order: int) -> Number:
        """The part of F that swings or grows, 0 at the start, or its derivative of this order."""

    @final
    def quotient(self, end: arb) -> Quotient:
        """F(end + z)/z as a function of a complex z, entire, where F(end) = 0."""
        difference, away = self._quotient(end), _AWAY / self.rate

        def of(z: acb) -> acb:
            if not (z.abs_lower() > away and self._is_wide(z)):
                return difference(z)
            return self.around(end + z) / z

        return of

    @final
    def around(self, sigma: acb) -> acb:
        """F of a ball; by Taylor's formula if it is wide: what is small by its second order stays so."""
        if not self._is_wide(sigma):
            return self.squared(sigma)
        middle = sigma.mid()
        d = sigma - middle
        tangent = self.squared(middle) + self.derivative(middle) * d
        return tangent - self._wave(sigma, order=2) * d * d / 2

    def _is_wide(self, z: acb) -> bool:
        """Return True if a ball of sigma is wider than a node of a quadrature."""
        return bool(z.rad() > arb(2) ** (_NODE_BITS - ctx.prec) / self.rate)

    @abstractmethod
    def _quotient(self, end: arb) -> Quotient:
        """(F(end + z) - F(end))/z from the differences of the functions in F."""

    @abstractmethod
    def across(self, sigma: arb) -> list[arb]:
        """v in body axes."""


def speed(board: Washboard) -> Swinging | Growing:
    """F at the ambient precision of flint."""
    return Swinging(board) if board.kappa < 0 else Growing(board)


@final
class Swinging(Speed):
    """kappa < 0: the moment is along the axis of greatest or least inertia."""

    @property
    def swing(self) -> arb:
        """R = (4 |kappa| P^2 + Q^2)^(1/2)."""
        sine = 2 * self.rate * self.even
        return (sine * sine + self.odd * self.odd).sqrt()

    def _wave(self, sigma: Number, order: int) -> Number:
        sin, cos = (2 * self.rate * sigma).sin_cos()
        a, b = self.even, self._odd
        for _ in range(order):
            a, b = 2 * self.rate * b, -2 * self.rate * a
        return a * (cos if order else cos - 1) + b * sin

    def _quotient(self, end: arb) -> Quotient:
        rate, slope = self.rate, self.slope
        first, second = -self._wave(end, order=1), -self._wave(end, order=2) / 2

        def of(z: acb) -> acb:
            x = rate * z
            s = x.sinc()
            return slope + s * (first * x.cos() + second * z * s)

        return of

    def across(self, sigma: arb) -> list[arb]:
        sin, cos = (self.rate * sigma).sin_cos()
        parts = zip(self._across, self._ahead, strict=True)
        return [cos * v + sin * u for v, u in parts]


@final
class Growing(Speed):
    """kappa > 0: the moment is along the middle axis."""

    def __init__(self, board: Washboard) -> None:
        super().__init__(board)
        self.growing = arb(0) if board.never_climbs else (self.even + self._odd) / 2
        self.falling = (self.even - self._odd) / 2

    def _wave(self, sigma: Number, order: int) -> Number:
        up, down = self._powers(2 * sigma)
        p, q = self.growing, self.falling
        for _ in range(order):
            p, q = 2 * self.rate * p, -2 * self.rate * q
        grown = p * up + q * down
        return grown if order else grown - self.even

    def _quotient(self, end: arb) -> Quotient:
        rate, slope = self.rate, self.slope
        up, down = self._powers(2 * end)
        p, q = 2 * rate * self.growing * up, 2 * rate * self.falling * down

        def of(z: acb) -> acb:
            x = rate * z
            # Of an imaginary argument, the circular function is the hyperbolic one.
            s = (acb(0, 1) * x).sinc()
            return slope - s * (p * x.exp() - q * (-x).exp())

        return of

    def across(self, sigma: arb) -> list[arb]:
        up, down = self._powers(sigma)
        shrunk = [(v - u) / 2 * down for v, u in zip(self._across, self._ahead, strict=True)]
        if self.board.never_climbs:
            return shrunk
        grown = [(v + u) / 2 * up for v, u in zip(self._across, self._ahead, strict=True)]
        return [g + f for g, f in zip(grown, shrunk, strict=True)]

    def _powers(self, sigma: Number) -> tuple[Number, Number]:
        """e^(Omega sigma) and its inverse."""
        x = self.rate * sigma
        # Of a wide ball, the exponential may contain 0.
        return x.exp(), (-x).exp()
