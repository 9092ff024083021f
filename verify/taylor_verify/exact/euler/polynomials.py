"""A free orbit about an axis at many instants: omega and R by polynomials in the cosine of the angle.

Legend as in moduli, phase and exact.theta_series; v = u/2K. sn, cn, dn are theta_1, theta_2, theta_3 over
theta_4. Of M = Rz(psi) B the third row is h = H/|H|, and with xi the first row plus i times the second one,

    xi_c = i rho e^{i psi},    xi_a = xi_c (i h_b - h_a h_c)/rho^2,    xi_b = -xi_c (i h_a + h_b h_c)/rho^2,

because the rows are orthonormal. By the addition theorem |theta_1(v + y)|^2 is a constant times
(rho theta_4(v))^2: both are theta_4(v)^2 (1 + nu sn^2) but for a constant. So there is no root in

    xi_c = constant e^{i Om t} theta_1(v + y)/theta_4(v),

nor a branch: of Jacobi's nine direction cosines none needs the angle psi.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, final

from flint import acb, arb, arb_mat

from taylor_verify.exact.balls import balls_of
from taylor_verify.exact.euler.moduli import Moduli
from taylor_verify.exact.euler.phase import Periodic
from taylor_verify.exact.rotation import cross
from taylor_verify.exact.solution import Time
from taylor_verify.exact.theta_series import Places, ThetaSeries

Rows = list[Sequence[arb]]

_ONE: Final = arb(1)


@final
class Polynomials:
    """The functions of one orbit at the ambient precision of flint; ``series`` is that of its tau."""

    def __init__(self, moduli: Moduli, functions: Periodic, series: ThetaSeries) -> None:
        self._moduli, self._functions, self._series = moduli, functions, series
        a, b, c = (p * q for p, q in zip(moduli.amplitudes, functions.multiples, strict=True))
        self._speed, self._start = arb.pi() * functions.speed, arb.pi() * functions.place
        lead = series.lead.real
        self._three, self._four = series.three_and_four(a)
        self._one, self._two = series.one(b * lead), series.two(c * lead)

    def omega(self, times: Sequence[Time]) -> Rows:
        """(w_a, w_b, w_c) at each time."""
        return self._omega(self._places(balls_of(times)))[0]

    def motion(self, times: Sequence[Time], to_space: arb_mat) -> tuple[Rows, list[Rows]]:
        """(w_a, w_b, w_c), and the rows of R by their components along (a, b, c), at each time.

        ``to_space`` is R P at the start.
        """
        elapsed = balls_of(times)
        places = self._places(elapsed)
        omega, over = self._omega(places)
        return omega, self._frames(elapsed, places, omega, over, to_space)

    def _places(self, elapsed: Sequence[arb]) -> Places:
        speed, start = self._speed, self._start
        return Places([speed * t + start for t in elapsed])

    def _omega(self, places: Places) -> tuple[Rows, list[arb]]:
        """(w_a, w_b, w_c), and 1/theta_4."""
        over = [_ONE / four for four in places.at(self._four)]
        parts = zip(
            over,
            *(places.at(p) for p in (self._three, self._one, self._two)),
            places.sines,
            places.cosines,
            strict=True,
        )
        omega: Rows = [[p3 * w, s * p1 * w, c * p2 * w] for w, p3, p1, p2, s, c in parts]
        return omega, over

    def _xi(
        self, elapsed: Sequence[arb], places: Places, over: Sequence[arb]
    ) -> list[Sequence[arb]]:
        """A constant multiple of xi_c, real and imaginary parts."""
        rate, z0 = self._functions.drift
        # Where sig < 0, psi is the negative of the argument: the conjugate of theta_1.
        shift = acb(0, z0.imag * self._moduli.sense)
        multiples: list[Sequence[arb]] = []
        for t, w, x, y in zip(
            elapsed, over, *self._series.shifted(shift, acb(1)).parts(places), strict=True
        ):
            sin, cos = (rate * t).sin_cos()
            x, y = x * w, y * w
            multiples.append((cos * x - sin * y, sin * x + cos * y))
        return multiples

    def _frames(
        self,
        elapsed: Sequence[arb],
        places: Places,
        omega: Rows,
        over: Sequence[arb],
        to_space: arb_mat,
    ) -> list[Rows]:
        moduli = self._moduli
        J_a, J_b, J_c = (J / moduli.momentum for J in moduli.moments)
        # Entry by entry: to make a matrix of balls takes longer than the product.
        matrix = (to_space * self._unwound()).tolist()
        frames: list[Rows] = []
        for (w_a, w_b, w_c), (x, y) in zip(omega, self._xi(elapsed, places, over), strict=True):
            a, b, c = J_a * w_a, J_b * w_b, J_c * w_c
            w = _ONE / (a * a + b * b)
            p, q, ac, bc = x * w, y * w, a * c, b * c
            a1, b1 = p * ac + q * b, q * a - p * bc
            a2, b2 = p * b - q * ac, q * bc + p * a
            frames.append(
                [
                    (h * a - f * a1 + g * a2, h * b + f * b1 - g * b2, h * c + f * x + g * y)
                    for f, g, h in matrix
                ]
            )
        return frames

    def _unwound(self) -> arb_mat:
        """B(0)^T, for rows of which the first two are a constant times theirs."""
        a, b, c = (
            h * f for h, f in zip(self._moduli.direction, self._moduli.functions, strict=True)
        )
        rho = (a * a + b * b).sqrt()
        first, third = [-b / rho, a / rho, arb(0)], [a, b, c]
        second = cross(third, first)
        zero = [arb(0)]
        places = self._places(zero)
        ((x, y),) = self._xi(zero, places, self._omega(places)[1])
        constant = acb(0, rho) / acb(x, y)
        re, im = constant.real, constant.imag
        back = zip(first, second, third, strict=True)
        return arb_mat([[p * re + q * im, q * re - p * im, r] for p, q, r in back])
