"""The whole momentum of a gyrostat as a rational function of Weierstrass's p and p'.

Legend: as in pencil; P = p(t), P' = p'(t), and G has the four poles p_k. With constants of the start

    X = P - xb,    V = P' + vb,    Q = prod (P - p(p_k)) = X^4 - 2 B X^2 + 8 beta X + B^2 - 4 Pi > 0,

    G(t) = G(0) + (V Gamma(X) + kappa(X))/2 Q,    Gamma of degree 2 and kappa of degree 3 in X.

It is the sum over the poles of c_k (P' + p'(p_k))/2 (P - p(p_k)), c_k the residues of G, in which the
principal axes and every square root have cancelled.

On a circle two of the poles are at the double point, which a separatrix approaches for ever: there both
parts of the quotient go to zero. With r = mu.d/nu.d as in point, and mu = G'(0), the circle itself gives

    G = G(0) - 2 (nu.G(0)) (r mu + (mu.mu/nu.nu) nu)/(r^2 nu.nu + mu.mu).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, final

from taylor_verify.exact.gyrostat.curve_point import OnCircle, point_map
from taylor_verify.exact.gyrostat.pencil import FreeGyrostat
from taylor_verify.exact.real_roots import value_of
from taylor_verify.numbers import tensors
from taylor_verify.numbers.rotation import scalar_product
from taylor_verify.numbers.tensors import Vector, cross, dot


@final
@dataclass(frozen=True)
class WeierstrassForm:
    """The constants of G(t). A polynomial in X is the list of its coefficients, the constant one first."""

    start: Vector
    xb: Any
    vb: Any
    quartic: Sequence[Any]
    gamma: Sequence[Sequence[Any]]
    kappa: Sequence[Sequence[Any]]

    @classmethod
    def of(cls, free: FreeGyrostat) -> WeierstrassForm:
        """Return the exact constants of one start."""
        K, g, G, (S, c2, _) = free.K, free.g, free.momentum, free.cubic
        _, G1, half_G2, *_ = free.jet
        G2 = tensors.scaled(Fraction(2), half_G2)
        q, w1 = tensors.apply(K, G), tensors.apply(K, G1)
        C = cross(G1, w1)
        W = tuple(
            tuple(3 * square - 2 * S * k + c2 * (i == j) for j, (square, k) in enumerate(rows))
            for i, rows in enumerate(
                list(zip(a, b, strict=True)) for a, b in zip(free.square, K, strict=True)
            )
        )
        B = -dot(G1, tensors.apply(W, G1)) / 16
        beta = dot(G1, cross(w1, tensors.apply(free.square, G1))) / 64
        Pi = -dot(C, tensors.apply(W, C)) / 256
        Y = tensors.scaled(Fraction(1, 64), _bracket(K, C, G1))
        b = tensors.minus(tensors.scaled(B / 4, G1), Y)
        m = tensors.scaled(Fraction(-1, 4), _bracket(K, G2, G1))
        k2 = tensors.scaled(Fraction(1, 16), _bracket(K, G2, C))
        k3 = tensors.minus(
            tensors.scaled(Fraction(-8), _bracket(K, G2, b)), tensors.scaled(4 * B, m)
        )
        quarter = Fraction(1, 4)
        return cls(
            start=G,
            xb=(
                -3 * dot(q, q)
                + 3 * dot(g, q)
                + 3 * S * dot(g, G)
                + 2 * S * free.E
                - c2 * free.n
                - dot(g, g)
            )
            / 12,
            vb=(2 * dot(q, w1) - dot(g, w1) - S * dot(g, G1)) / 4,
            quartic=(B**2 - 4 * Pi, 8 * beta, -2 * B, Fraction(0), Fraction(1)),
            gamma=(
                tensors.scaled(Fraction(4), tensors.minus(b, Y)),
                tensors.scaled(Fraction(-1, 2), C),
                tensors.scaled(Fraction(-1), G1),
            ),
            kappa=(
                tensors.plus(tensors.scaled(2 * beta, G2), tensors.scaled(quarter, k3)),
                tensors.plus(tensors.scaled(-B, G2), tensors.scaled(Fraction(2), k2)),
                tensors.scaled(Fraction(-1), m),
                G2,
            ),
        )

    def converted(self, convert: Callable[[Fraction], Any]) -> WeierstrassForm:
        """Return the same constants in another arithmetic."""

        def vectors(rows: Sequence[Sequence[Any]]) -> list[Any]:
            return [[convert(c) for c in row] for row in rows]

        start = vectors([self.start])[0]
        quartic = [convert(c) for c in self.quartic]
        return WeierstrassForm(
            start,
            convert(self.xb),
            convert(self.vb),
            quartic,
            vectors(self.gamma),
            vectors(self.kappa),
        )

    def at(self, P: Any, slope: Any) -> list[Any]:
        """G where p = P and p' = slope."""
        X, V = P - self.xb, slope + self.vb
        below = 2 * value_of(self.quartic, X)
        components = zip(
            self.start, zip(*self.gamma, strict=True), zip(*self.kappa, strict=True), strict=True
        )
        return [
            G + (V * value_of(gamma, X) + value_of(kappa, X)) / below
            for G, gamma, kappa in components
        ]


@final
@dataclass(frozen=True)
class CircleForm:
    """G(t) on a circle where p + 2 e >= 0 is the square of c = k coth(k t)."""

    place: OnCircle

    def converted(self, convert: Callable[[Fraction], Any]) -> CircleForm:
        """Return the same constants in another arithmetic."""
        return CircleForm(self.place.converted(convert))

    def at(self, P: Any, slope: Any) -> list[Any]:
        """G where p = P and p' = slope, which has the sign of -c."""
        start, mu, nu = self.place.start, self.place.mu, self.place.nu
        c = (P + 2 * self.place.double_root) ** 0.5
        r = ((-c if slope > 0 else c) - self.place.constant) / self.place.scale
        size, across, height = (scalar_product(*pair) for pair in ((mu, mu), (nu, nu), (nu, start)))
        factor = -2 * height / (r * r * across + size)
        components = zip(start, mu, nu, strict=True)
        return [G + factor * (r * p + size / across * q) for G, p, q in components]


def momentum_form(free: FreeGyrostat) -> WeierstrassForm | CircleForm:
    """Return the exact constants of G(t), a motion that is not steady."""
    if free.is_circle and free.double_root >= 0:
        place = point_map(free)
        assert isinstance(place, OnCircle)
        return CircleForm(place)
    return WeierstrassForm.of(free)


def _bracket(K: Any, a: Vector, b: Vector) -> Vector:
    """a x K b + b x K a."""
    return tensors.plus(cross(a, tensors.apply(K, b)), cross(b, tensors.apply(K, a)))
