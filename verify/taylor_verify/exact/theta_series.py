"""Jacobi's theta functions at many real arguments: polynomials in balls that share one cosine an instant.

Legend: theta_i(v) has the nome q = e^{i pi tau}, Im tau = y; h = q^2, which is real where Re tau is 0 or
1/2; v is real and x = cos 2 pi v; s is a complex constant, b = |Im s|. With

    T_n(x) = cos 2n pi v,  V_n(x) = cos((2n+1) pi v)/cos(pi v),  W_n(x) = sin((2n+1) pi v)/sin(pi v),

three sequences of integer polynomials with P_{n+1} = 2x P_n - P_{n-1}, a series of theta functions is

    theta_1(v + s)/2q^(1/4) = sin(pi v) sum c_n W_n(x) + cos(pi v) sum s_n V_n(x),
    c_n, s_n = (-1)^n h^{n(n+1)/2} times the cosine and the sine of (2n+1) pi s.

A polynomial is the row of its coefficients, which are balls. It is evaluated at all arguments by one call
of FLINT. Of several, that is a product with the matrix of all powers, which is made once.

The terms that are left out stand as a ball in the constant coefficient. It encloses them because, for a
real v, |T_n| <= 1 and |V_n|, |W_n| <= 2n + 1, and cosine and sine of (2n+1) pi s are at most
cosh((2n+1) pi b): each sum is at most its first term left out times 1/(1 - r), with r a bound of the
quotient of a term by the one before, which falls with n.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache, partial
from math import log, pi
from typing import Final, Self, final

from flint import acb, arb, arb_mat, arb_poly, ctx, fmpz_mat, fmpz_poly

from taylor_verify.exact.balls import Undecidable

# From so many arguments on, less time is spent on the polynomials than is gained with them.
MANY: Final = 12
# Beyond these, an evaluation of the four functions by the modular group costs less than the polynomials.
MOST_TERMS: Final = 40
# Near a separatrix theta functions are as small as e^{-pi/4y} beside their terms, which cancel to as many
# bits: more than half of those that a first precision has to spare are not given up.
_MOST_BITS_CANCELLED: Final = 16
# The matrix of all powers costs as much as three polynomials without it.
_WORTH_A_MATRIX: Final = 4

Parts = Sequence[arb_mat | None]


@final
class Places:
    """Many real arguments v, given as the angles pi v."""

    # Of x, a row for each exponent: as many as were needed so far.
    _powers = arb_mat(0, 0)

    def __init__(self, angles: Sequence[arb]) -> None:
        both = [angle.sin_cos() for angle in angles]
        self.sines, self.cosines = [s for s, _ in both], [c for _, c in both]
        self.x = [1 - 2 * (s * s) for s in self.sines]

    @cached_property
    def doubled(self) -> Places:
        """The arguments 2v."""
        doubled = object.__new__(Places)
        doubled.sines = [2 * s * c for s, c in zip(self.sines, self.cosines, strict=True)]
        doubled.cosines = self.x
        doubled.x = [2 * (x * x) - 1 for x in self.x]
        return doubled

    def at(self, polynomial: arb_mat) -> list[arb]:
        """The values of a polynomial in x."""
        values: list[arb] = arb_poly(polynomial.entries()).evaluate(self.x, "iter")
        return values

    def at_each(self, polynomials: Sequence[arb_mat]) -> list[list[arb]]:
        """The values of several polynomials in x."""
        if len(polynomials) < _WORTH_A_MATRIX:
            return [self.at(polynomial) for polynomial in polynomials]
        count = max(polynomial.ncols() for polynomial in polynomials)
        if count > self._powers.nrows():
            self._powers = _matrix_of_powers(self.x, count)
        rows = arb_mat(len(polynomials), self._powers.nrows())
        for k, polynomial in enumerate(polynomials):
            for n, coefficient in enumerate(polynomial.entries()):
                rows[k, n] = coefficient
        values: list[list[arb]] = (rows * self._powers).tolist()
        return values


@final
@dataclass(frozen=True)
class Odd:
    """A sum of sines and cosines of odd multiples of pi v: sin(pi v) S(x) + cos(pi v) C(x).

    Of each polynomial the real and the imaginary part; None for one that is zero.
    """

    sine: Parts
    cosine: Parts

    def parts(self, places: Places) -> tuple[list[arb], list[arb]]:
        """The real and the imaginary part at each place."""
        asked = [part for part in (*self.sine, *self.cosine) if part is not None]
        values = iter(places.at_each(asked) if asked else [])
        sines, cosines = (
            [None if part is None else next(values) for part in parts]
            for parts in (self.sine, self.cosine)
        )
        real, imaginary = map(partial(_added, places), sines, cosines)
        return real, imaginary

    def at(self, places: Places) -> list[acb]:
        """The values at each place."""
        return [acb(re, im) for re, im in zip(*self.parts(places), strict=True)]


def _matrix_of_powers(x: Sequence[arb], count: int) -> arb_mat:
    """The powers of numbers, a row for each exponent from 0 on."""
    rows = [[arb(1)] * len(x), list(x)][:count]
    while len(rows) < count:
        rows.append([power * each for power, each in zip(rows[-1], x, strict=True)])
    return arb_mat(count, len(x), [power for row in rows for power in row])


def _added(places: Places, sine: list[arb] | None, cosine: list[arb] | None) -> list[arb]:
    """sin(pi v) S + cos(pi v) C at each place, from the values of S and C; None for zeros."""
    if sine is None and cosine is None:
        return [arb(0)] * len(places.x)
    if cosine is None:
        assert sine is not None
        return [s * S for s, S in zip(places.sines, sine, strict=True)]
    odd = [c * C for c, C in zip(places.cosines, cosine, strict=True)]
    if sine is None:
        return odd
    return [s * S + rest for s, S, rest in zip(places.sines, sine, odd, strict=True)]


@final
class ThetaSeries:
    """The theta functions of one tau with Re tau 0 or 1/2, at the ambient precision of flint."""

    def __init__(self, tau: acb) -> None:
        y = tau.imag
        self._q = (-arb.pi() * y).exp()  # |q|
        self._size = self._q * self._q  # |h|
        self._h = self._size if tau.real.is_zero() else -self._size
        self._decay = 2 * pi * float(y.mid())
        self.lead = 2 * (tau / 4).exp_pi_i()  # 2 q^(1/4)

    @classmethod
    def where_short(cls, tau: acb) -> Self | None:
        """The series, or None where more terms or more bits are lost than the present way takes."""
        y = float(tau.imag.mid())
        if not pi / (4 * y) <= _MOST_BITS_CANCELLED * log(2):
            return None
        series = cls(tau)
        # An argument is known up to periods: its imaginary part is at most half of y, in either direction.
        return series if series._count(y / 2, 1) <= MOST_TERMS else None

    def shifted(self, s: acb, K: acb, order: int = 0) -> Odd:
        """K theta_1(v + s)/2q^(1/4), or for order 1 its derivative by v."""
        b = abs(s.imag)
        count = self._count(float(b.upper()), order)
        sines, cosines = self._multiples(s, count)
        sign, weights = -1, []
        for n, power in enumerate(self._powers(count)):
            weights.append(K * power * (sign**n * (2 * n + 1) ** order))
        if order:
            # (d/dv) sin((2n+1) pi (v + s)) = (2n+1) pi cos((2n+1) pi (v + s))
            weights = [arb.pi() * weight for weight in weights]
            sines, cosines = cosines, [-sine for sine in sines]
        on_sine = [w * c for w, c in zip(weights, cosines, strict=True)]
        on_cosine = [w * c for w, c in zip(weights, sines, strict=True)]
        tail = abs(K) * arb.pi() ** order * self._tail(count, b, order)
        # Where every coefficient of an axis is zero, so are the terms left out.
        plain = s.real.is_zero() and K.imag.is_zero()
        by_cosines = True, not plain
        by_sines = not s.is_zero() and not plain, not s.is_zero()
        sine, cosine = (by_sines, by_cosines) if order else (by_cosines, by_sines)
        return Odd(
            _polynomials(on_sine, "W", tail, sine), _polynomials(on_cosine, "V", tail, cosine)
        )

    def one(self, scale: arb) -> arb_mat:
        """``scale`` times theta_1(v)/(2q^(1/4) sin pi v)."""
        return self._alone(scale, "W", -1)

    def two(self, scale: arb) -> arb_mat:
        """``scale`` times theta_2(v)/(2q^(1/4) cos pi v)."""
        return self._alone(scale, "V", 1)

    def three_and_four(self, scale: arb) -> tuple[arb_mat, arb_mat]:
        """``scale`` times theta_3(v), and theta_4(v), for an imaginary tau."""
        count, q = self._even_count(), self._q
        terms = [arb(1), *(2 * q ** (n * n) for n in range(1, count))]
        tail = self._even_tail(count)
        return (
            _polynomial([scale * term for term in terms], "T", abs(scale) * tail),
            _polynomial([(-1) ** n * term for n, term in enumerate(terms)], "T", tail),
        )

    def _alone(self, scale: arb, basis: str, sign: int) -> arb_mat:
        count = self._count(0.0, order=0)
        coefficients = [scale * power * sign**n for n, power in enumerate(self._powers(count))]
        return _polynomial(coefficients, basis, abs(scale) * self._tail(count, arb(0), order=0))

    def _count(self, b: float, order: int) -> int:
        """The number of terms before one that is below the ambient precision of the first one."""
        n, bits = 1, ctx.prec * log(2)
        while self._decay * n * (n + 1) / 2 - 2 * pi * b * n - (1 + order) * log(2 * n + 1) < bits:
            n += 1
        return n

    def _even_count(self) -> int:
        """The number of terms of theta_3, likewise."""
        n, bits = 1, ctx.prec * log(2)
        while self._decay / 2 * n**2 < bits:
            n += 1
        return n

    def _even_tail(self, count: int) -> arb:
        """A bound of sum 2 |q|^{n^2} from n = count on, of which each is |q|^{2n+1} of the one before."""
        first: arb = 2 * self._q ** (count * count)
        return first / (1 - self._q ** (2 * count + 1))

    def _powers(self, count: int) -> list[arb]:
        """h^{n(n+1)/2}."""
        power, step, powers = arb(1), arb(1), []
        for _ in range(count):
            powers.append(power)
            step = step * self._h
            power = power * step
        return powers

    def _multiples(self, s: acb, count: int) -> tuple[list[acb], list[acb]]:
        """The sines and the cosines of (2n+1) pi s."""
        angle = arb.pi() * s
        sin, cos = angle.sin(), angle.cos()
        twice_sin, twice_cos = 2 * sin * cos, 1 - 2 * (sin * sin)
        sines, cosines = [sin], [cos]
        for _ in range(1, count):
            sin, cos = sin * twice_cos + cos * twice_sin, cos * twice_cos - sin * twice_sin
            sines.append(sin)
            cosines.append(cos)
        return sines, cosines

    def _tail(self, count: int, b: arb, order: int) -> arb:
        """A bound of sum |h|^{n(n+1)/2} (2n+1)^(1+order) cosh((2n+1) pi b) from n = count on."""
        n, grown = count, 1 + order
        first: arb = self._size ** (n * (n + 1) // 2) * (2 * n + 1) ** grown
        first = first * ((2 * n + 1) * arb.pi() * b).cosh()
        growth = (arb(2 * n + 3) / (2 * n + 1)) ** grown * (2 * arb.pi() * b).exp()
        ratio = self._size ** (n + 1) * growth
        if not ratio < 1:
            raise Undecidable
        tail: arb = first / (1 - ratio)
        return tail


def _polynomials(
    coefficients: Sequence[acb], basis: str, tail: arb, axes: tuple[bool, bool]
) -> Parts:
    """The real and the imaginary part of a polynomial; None for an axis on which it is zero."""
    parts = [c.real for c in coefficients], [c.imag for c in coefficients]
    return [
        _polynomial(part, basis, tail) if is_wanted else None
        for part, is_wanted in zip(parts, axes, strict=True)
    ]


def _polynomial(coefficients: Sequence[arb], basis: str, tail: arb) -> arb_mat:
    """The polynomial in x of a sum over a sequence T, V or W, and what is left out of it as a ball."""
    count = len(coefficients)
    row = arb_mat(1, count, list(coefficients)) * _integers(basis, count)
    row[0, 0] = row[0, 0] + arb(0, tail.upper())
    return row


@lru_cache(maxsize=256)
def _integers(basis: str, count: int) -> arb_mat:
    """The first polynomials of a sequence, by rows: T_-1 = T_1 = x, V_-1 = V_0 = 1, W_-1 = -W_0 = -1."""
    x = fmpz_poly([0, 1])
    before = {"T": x, "V": fmpz_poly([1]), "W": fmpz_poly([-1])}[basis]
    rows = [fmpz_poly([1])]
    for _ in range(1, count):
        rows.append(2 * x * rows[-1] - before)
        before = rows[-2]
    return arb_mat(fmpz_mat([[int(row[k]) for k in range(count)] for row in rows]))
