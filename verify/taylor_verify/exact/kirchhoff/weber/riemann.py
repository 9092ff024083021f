"""Riemann's theta functions of two variables, summed by this package in mpmath: tau = iY, Z real.

With half-integer points m/2 = n + a/2, every term of theta[a, b](Z) (characteristics.py) has a twin at
-m of the same value, so that

    theta[a, b](Z) = sum over m = a mod 2 of exp(-pi m.Y m/4) cos(pi m.Z + (pi/2) m.b)

is real, and its rate along a direction g the same sum with -pi m.g sin in place of cos. Kept are the
points of an ellipse, m.Y m/4 <= R. A cell about each point lies within the distance d of it, measured
by Y, so that an ellipse of the square radius s holds at most pi (sqrt s + d)^2/sqrt(det Y) of them, and by
(sqrt s + d)^2 <= 2 (s + d^2) what is left out is, term by term, at most

    int from R to infinity of pi e^{-pi s} 2 pi (s + d^2)/sqrt(det Y) ds
        = 2 pi e^{-pi R} (R + 1/pi + d^2)/sqrt(det Y).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from mpmath import mp, mpf

Symmetric = tuple[mpf, mpf, mpf]  # Y11, Y12, Y22
# m1, m2 and the weight e^{-pi m.Y m/4}, twice where -m stands for another term.
Term = tuple[int, int, mpf]


# cos and sin of pi m.Z for every term.
Waves = tuple[Sequence[mpf], Sequence[mpf]]


@dataclass(frozen=True)
class Series:
    """A characteristic: (-1)^{n.b} times the weights, and these times m1 and m2.

    ``turns`` are the right angles a.b, which leave theta to the sum of the cosines or of the sines.
    """

    turns: int
    weights: Sequence[mpf]
    by_m1: Sequence[mpf]
    by_m2: Sequence[mpf]

    def value(self, waves: Waves) -> mpf:
        return _sum(self.weights, waves, self.turns)

    def slope(self, waves: Waves, along: Sequence[mpf]) -> mpf:
        """The rate along a direction g: another right angle, and pi m.g for a factor."""
        first, second = (_sum(by_m, waves, self.turns + 1) for by_m in (self.by_m1, self.by_m2))
        return mp.pi * (along[0] * first + along[1] * second)


def _sum(weights: Sequence[mpf], waves: Waves, turns: int) -> mpf:
    """The weighted sum of cos(pi m.Z + turns pi/2)."""
    cosines, sines = waves
    total = mp.fdot(weights, sines if turns % 2 else cosines)
    return -total if turns in (1, 2) else total


class Thetas:
    """The theta functions of some characteristics at one precision of mpmath, good only there."""

    def __init__(self, Y: Symmetric, characteristics: Iterable[int]) -> None:
        reach = _reach(Y)
        wanted = sorted(set(characteristics))
        self._terms = {a: _terms(Y, reach, a) for a in {c >> 2 for c in wanted}}
        self._series = {c: _series(self._terms[c >> 2], c) for c in wanted}

    def values(self, Z: Sequence[mpf]) -> Mapping[int, mpf]:
        """theta at Z, by characteristic."""
        waves = self._waves(Z)
        return {c: series.value(waves[c >> 2]) for c, series in self._series.items()}

    def slopes(self, Z: Sequence[mpf], along: Sequence[mpf]) -> Mapping[int, mpf]:
        """The rates of theta at Z along a direction, by characteristic.

        The truncation error of a rate is larger by the size of m, so it is used only for a sign.
        """
        waves = self._waves(Z)
        return {c: series.slope(waves[c >> 2], along) for c, series in self._series.items()}

    def _waves(self, Z: Sequence[mpf]) -> Mapping[int, Waves]:
        """The waves of every a."""
        all_terms = [term for terms in self._terms.values() for term in terms]
        first = _powers(Z[0], max((m1 for m1, _, _ in all_terms), default=0))
        second = _powers(Z[1], max((abs(m2) for _, m2, _ in all_terms), default=0))
        waves_by_a = {}
        for a, terms in self._terms.items():
            waves = [
                first[m1] * (second[m2] if m2 >= 0 else mp.conj(second[-m2])) for m1, m2, _ in terms
            ]
            waves_by_a[a] = ([wave.real for wave in waves], [wave.imag for wave in waves])
        return waves_by_a


def _series(terms: Sequence[Term], characteristic: int) -> Series:
    a, b = characteristic >> 2, characteristic & 3
    b1, b2 = b >> 1, b & 1
    turns = (a & b).bit_count()
    # m = 2 n + a, so that m.b right angles are a.b of them and n.b half turns.
    signed = [
        (m1, m2, -weight if (m1 * b1 + m2 * b2 - turns) // 2 % 2 else weight)
        for m1, m2, weight in terms
    ]
    return Series(
        turns,
        [weight for _, _, weight in signed],
        [m1 * weight for m1, _, weight in signed],
        [m2 * weight for _, m2, weight in signed],
    )


def _terms(Y: Symmetric, reach: mpf, a: int) -> list[Term]:
    """The points of the ellipse that are a mod 2, one of +-m each: m1 > 0, or 0 and m2 >= 0."""
    Y11, Y12, Y22 = Y
    a1, a2 = a >> 1, a & 1
    det = Y11 * Y22 - Y12**2
    farthest = int(mp.ceil(2 * mp.sqrt(reach * Y22 / det)))
    terms = []
    for m1 in range(a1, farthest + 1, 2):
        middle, half = -Y12 * m1 / Y22, mp.sqrt(max(4 * reach * Y22 - det * m1**2, mpf(0))) / Y22
        low, high = int(mp.floor(middle - half)), int(mp.ceil(middle + half))
        for m2 in range(low + (low + a2) % 2, high + 1, 2):
            if m1 or m2 >= 0:
                square = (Y11 * m1**2 + 2 * Y12 * m1 * m2 + Y22 * m2**2) / 4
                twins = 2 if m1 or m2 else 1
                terms.append((m1, m2, twins * mp.exp(-mp.pi * square)))
    return terms


def _reach(Y: Symmetric) -> mpf:
    """R for which what is left out is below the last place of the ambient precision."""
    Y11, Y12, Y22 = Y
    root = mp.sqrt(Y11 * Y22 - Y12**2)
    corners = ((Y11 + 2 * side * Y12 + Y22) / 4 for side in (1, -1))
    d2 = max(corners)
    bits, reach = mp.prec * mp.ln(2) / mp.pi, mpf(1)
    while not reach >= bits + mp.ln(2 * mp.pi * (reach + 1 / mp.pi + d2) / root) / mp.pi:
        reach = reach * mpf("1.0625")
    return reach


def _powers(z: mpf, largest: int) -> list[mpf]:
    """e^{i pi m z} for m = 0, 1, ..."""
    step, powers = mp.expjpi(z), [mp.mpc(1)]
    for _ in range(largest):
        powers.append(powers[-1] * step)
    return powers
