"""The free motions of many rigid bodies at once, in balls about pairs of doubles.

The bodies have three different moments about the axes of the body, and are not on their
separatrix. The legend is that of moduli, where FLINT's balls have one body at a time. Written in
the momentum H = I w and in K = 1/J, with g_ab = |K_a - K_b| and so on,

    A = g_ac H_a^2 + g_bc H_b^2,    C = g_ab H_b^2 + g_ac H_c^2,    N = g_ab H_a^2 - g_bc H_c^2,
    lam^2 = g_ab A,    m = g_bc C/(g_ab A),    m' = g_ac N/(g_ab A),

the motion is H_a = (A/g_ac)^(1/2) dn u, H_b = -sig (C/g_ab)^(1/2) sn u, H_c = (C/g_ac)^(1/2) cn u.
The addition theorem is that of phase, with theta functions at w = lam agm(1, k') t.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final, NamedTuple, final

import numpy as np

from taylor_verify.exact.euler.series import mean, nome_of, powers, sine_cosine, thetas
from taylor_verify.exact.euler.turns import Numbers, Turning, in_body, turning
from taylor_verify.scenes.pairs import Floats, Pairs, difference

# A body with a larger nome is too near to its separatrix: m' is below 10^-4.
_LARGEST_NOME: Final = 0.45
# The steps of differences, as powers of two of the size of the momentum.
_ROUGH: Final = -36
_SHARP: Final = -30


class States(NamedTuple):
    """The momentum (3, n, m) in body axes, and the attitude as a unit quaternion (4, n, m), or None."""

    momentum: Pairs
    quaternion: Pairs | None


class Transition(NamedTuple):
    """The states of a motion in doubles, and their derivatives (n, m, 3, 3) by the momentum at the start.

    ``turn`` is that of the attitude, a rotation vector in space axes; None where it is not asked for.
    """

    momentum: Floats
    quaternion: Floats | None
    moved: Floats
    turn: Floats | None


@final
@dataclass(frozen=True)
class Tops:
    """Bodies of inverse moments ``inverse`` (3, n), exactly, that start with ``momentum`` (3, n).

    Both are of size one, in suitable units. ``attitude`` (4, n) is the unit
    quaternion at the start, where attitudes are asked for.
    """

    inverse: Floats
    momentum: Pairs
    attitude: Pairs | None = None

    def states(self, times: Floats) -> States:
        """Return the states at the times (n, m) since the start; unknown states have infinite radii."""
        orbit = self._orbit
        with np.errstate(all="ignore"):
            sine, cosine = sine_cosine(orbit.speed * times)
            frame = _functions(orbit, sine, cosine)
            rows = [row.scaled(sign) for row, sign in zip(frame, orbit.signs, strict=True)]
            H = in_body(rows, orbit.axes).widened(np.where(orbit.is_known[:, None], 0.0, np.inf))
            quaternion = None
            if self._turning is not None:
                quaternion = self._turning.at(times, frame, sine, cosine)
        # At time zero the given start is returned, to the last bit.
        start = Pairs(*(np.broadcast_to(p, H.hi.shape[:2])[:, :, None] for p in self.momentum))
        return States(start.chosen(times == 0, H), quaternion)

    def at(self, places: Any) -> Tops:
        """Return some of the bodies."""
        attitude = None if self.attitude is None else self.attitude[:, places]
        return Tops(self.inverse[:, places], self.momentum[:, places], attitude)

    def transition(self, times: Floats, is_sharp: bool = False) -> Transition:
        """Return the states at the times (n, m), and their derivatives by the momentum at the start.

        H moves as H'(0) does into H'(t), and the attitude turns by R w - R(0) w(0). And lam H(lam t) is a
        motion too, so that H(0) moves into H + t H', and the attitude turns by t R w. The third direction
        is that of H x H' at the start, by a difference of two motions: to about 10^-10 of its square, or
        ``is_sharp``, at the price of a third motion, 10^-18 of its cube.
        """
        begin, K = self.momentum.hi, self.inverse
        begin_rate = cross(begin, K * begin)
        beside = cross(begin, begin_rate)
        size = np.frexp(np.sqrt(_squared(begin) / _squared(beside)))[1]
        step = np.ldexp(1.0, size + (_SHARP if is_sharp else _ROUGH))
        states, after = self.states(times), self._moved(beside * step).states(times)
        before = self._moved(beside * -step).states(times) if is_sharp else states
        length = (2 * step if is_sharp else step)[:, None]
        H, start_vectors = states.momentum.hi, (begin, begin_rate, beside)
        omega = K[:, :, None] * H
        rate = cross(H, omega)
        vectors = (H + times * rate, rate, _change(before.momentum, after.momentum) / length)
        widths = states.momentum.radius() + after.momentum.radius() + before.momentum.radius()
        is_known = np.all(np.isfinite(widths), axis=0).reshape(*times.shape, 1, 1)
        moved = np.where(is_known, _derivative(vectors, start_vectors), np.nan)
        if states.quaternion is None or after.quaternion is None or before.quaternion is None:
            return Transition(H, None, moved, None)
        q = states.quaternion.hi
        spin = turned(q, omega)
        assert self.attitude is not None
        spin_begin = turned(self.attitude.hi, K * begin)[:, :, None]
        change = _change(before.quaternion, after.quaternion) / length
        angles = (times * spin, spin - spin_begin, 2 * between(conjugate(change), conjugate(q)))
        return Transition(
            H, q, moved, np.where(is_known, _derivative(angles, start_vectors), np.nan)
        )

    def _moved(self, amount: Floats) -> Tops:
        return Tops(self.inverse, self.momentum + amount, self.attitude)

    @cached_property
    def _orbit(self) -> _Orbit:
        with np.errstate(all="ignore"):
            return _orbit(self.inverse, self.momentum)

    @cached_property
    def _turning(self) -> Turning | None:
        if self.attitude is None:
            return None
        with np.errstate(all="ignore"):
            return turning(self._orbit.turning, self.attitude)


# Vectors (3, ...) and quaternions (4, ...) of doubles.


def cross(a: Floats, b: Floats) -> Floats:
    """Return the products of vectors."""
    return np.stack(
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    )


def conjugate(q: Floats) -> Floats:
    """Return the conjugate quaternions."""
    return np.concatenate([q[:1], -q[1:]])


def between(p: Floats, q: Floats) -> Floats:
    """Return the vector part of p* q: half of a small turn from one to the other, in body axes."""
    vector: Floats = p[0] * q[1:] - q[0] * p[1:] - cross(p[1:], q[1:])
    return vector


def turned(q: Floats, vectors: Floats) -> Floats:
    """Return vectors turned by unit quaternions."""
    across = 2 * cross(q[1:], vectors)
    rotated: Floats = vectors + q[0] * across + cross(q[1:], across)
    return rotated


def _squared(vectors: Floats) -> Floats:
    squared: Floats = np.sum(vectors * vectors, axis=0)
    return squared


def _change(before: Pairs, after: Pairs) -> Floats:
    change: Floats = (after.hi - before.hi) + (after.lo - before.lo)
    return change


def _derivative(vectors: tuple[Floats, ...], start_vectors: tuple[Floats, ...]) -> Floats:
    """The matrices (n, m, 3, 3) that lead from three orthogonal vectors (3, n) to others (3, n, m)."""
    derivative: Floats = sum(
        np.einsum("inm,jn->nmij", end, start / _squared(start))
        for end, start in zip(vectors, start_vectors, strict=True)
    )
    return derivative


class _Orbit(NamedTuple):
    """The numbers of n orbits, in columns (n, 1).

    ``axes`` (3, n) are the places of a, b, c; ``is_known`` (n) tells the orbits that are decided.
    """

    axes: Any
    is_known: Any
    signs: Any
    speed: Pairs
    nome: Pairs
    forms: tuple[tuple[Pairs, Pairs], ...]
    squares: tuple[Pairs, Pairs]
    turning: Numbers


def _orbit(inverse: Floats, momentum: Pairs) -> _Orbit:
    order = np.argsort(inverse, axis=0)
    K = np.take_along_axis(inverse, order, axis=0)
    H = Pairs(
        *(np.take_along_axis(np.broadcast_to(part, K.shape), order, axis=0) for part in momentum)
    )
    upper, lower, g_ac = difference(K[1], K[0]), difference(K[2], K[1]), difference(K[2], K[0])
    square = H * H
    N = square[0] * upper - square[2] * lower
    # About the axis of the largest moment, or of the least.
    is_max = N.hi > 0
    axes = np.where(is_max, order, order[::-1])
    parity = np.where((axes[1] - axes[0]) % 3 == 1, 1.0, -1.0)
    H_a, H_b, H_c = H[0].chosen(is_max, H[2]), H[1], H[2].chosen(is_max, H[0])
    g_ab, g_bc = upper.chosen(is_max, lower), lower.chosen(is_max, upper)
    N = N.chosen(is_max, -N)
    sense, side = np.where(is_max, 1.0, -1.0), np.where(H_a.hi < 0, -1.0, 1.0)

    A = g_ac * (H_a * H_a) + g_bc * (H_b * H_b)
    C = g_ab * (H_b * H_b) + g_ac * (H_c * H_c)
    rate_squared = g_ab * A
    m, m_prime = g_bc * C / rate_squared, g_ac * N / rate_squared
    a_a, a_b, a_c = (A / g_ac).sqrt(), (C / g_ab).sqrt(), (C / g_ac).sqrt()
    dn, sn = H_a.scaled(side) / a_a, H_b.scaled(-sense) / a_b
    cn = H_c.scaled(side * parity) / a_c

    k_prime = m_prime.sqrt()
    nome, middle = nome_of(m, k_prime), mean(k_prime)
    zero = thetas(powers(nome), Pairs(np.zeros_like(K[0])), Pairs(np.ones_like(K[0])))
    alpha, beta, gamma = zero.r / zero.t, zero.s / zero.t, zero.s / zero.r
    forms = (
        ((dn * gamma, -(m * sn) * (cn * alpha) * beta), a_a),
        (((sn * beta) * gamma, (alpha * cn) * dn), a_b.scaled(-sense)),
        ((cn * beta, -(sn * dn) * (alpha * gamma)), a_c),
    )
    is_known = (N.hi > N.rad) & (abs(H_a.hi) > H_a.rad) & (nome.hi < _LARGEST_NOME) & (K[0] > 0)
    speed, signs = rate_squared.sqrt() * middle, (side, np.ones_like(side), side * parity)
    size = (square[0] + square[1] + square[2]).sqrt()
    numbers = Numbers(
        functions=(dn, sn, cn),
        mean=middle,
        nome=nome,
        m=m,
        nu=C / A,
        speed=speed,
        steady=size * np.where(is_max, K[0], K[2]),
        momentum=size,
        start=(H_a.scaled(signs[0]), H_b, H_c.scaled(signs[2])),
        sense=sense,
        signs=signs,
        axes=axes,
    )
    return _Orbit(
        axes=axes,
        is_known=is_known,
        signs=[sign[:, None] for sign in signs],
        speed=_column(speed),
        nome=_column(nome),
        forms=tuple((_column(even * size), _column(odd * size)) for (even, odd), size in forms),
        squares=(_column(cn * cn), _column((sn * gamma) * (sn * gamma))),
        turning=numbers,
    )


def _column(values: Pairs) -> Pairs:
    shape = np.shape(values.hi)
    return Pairs(*(np.broadcast_to(part, shape)[:, None] for part in values))


def _functions(orbit: _Orbit, sine: Pairs, cosine: Pairs) -> list[Pairs]:
    """The components of H along a, b, c, of which the first is positive."""
    p, t, r, s = thetas(powers(orbit.nome), sine, cosine)
    cosine, sine = orbit.squares
    whole = 1.0 / (cosine * (s * s) + sine * (r * r))
    pairs = ((r * s, p * t), (t * r, p * s), (t * s, p * r))
    return [
        (even * left + odd * right) * whole
        for (even, odd), (left, right) in zip(orbit.forms, pairs, strict=True)
    ]
