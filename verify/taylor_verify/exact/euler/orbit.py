"""The numbers of a torque-free motion at one precision of mpmath: frame, moduli and phase.

Legend (see also regime): (a, b, c) are right-handed principal axes, b the intermediate one, a the
one encircled by the orbit ("dn axis"), c the other ("cn axis"); J_a, J_b, J_c are the moments about
them and w_a, w_b, w_c the components of omega. With
    A = |H^2 - 2T J_c|,  C = |2T J_a - H^2|,  D = |H^2 - 2T J_b|,
    lam^2 = |J_a - J_b| A / (J_a J_b J_c),  m = |J_b - J_c| C / (|J_a - J_b| A),  m' = 1 - m,
the motion is w_a : w_b : w_c = dn u : sn u : cn u, u = lam t + u_0, each times an amplitude.
"""

from __future__ import annotations

from typing import NamedTuple

from mpmath import mp, mpf

from taylor_verify.exact.elliptic import Landen, Triple
from taylor_verify.exact.euler.regime import FreeSpin, Regime
from taylor_verify.numbers import tensors
from taylor_verify.numbers.tensors import cross


class PrincipalFrame(NamedTuple):
    """Moments J1 > J2 > J3, their axes (unit vectors of either sign), and J1 - J2, J2 - J3."""

    moments: list[mpf]
    axes: list[list[mpf]]
    upper_gap: mpf
    lower_gap: mpf


class Orbit:
    """The triaxial motion about the axis of J1 or of J3, and the separatrix between them.

    ``moments``, ``axes``, ``amplitudes`` are those of (a, b, c); an amplitude carries the sign of
    its component: (w_a, w_b, w_c) is amplitudes times (dn u, sn u, cn u) with u = ``rate`` t +
    ``phase``; ``gap`` is J_a - J_c. ``m`` and ``m_prime`` are both accurate relatively; on the
    separatrix m' is 0.
    """

    def __init__(self, spin: FreeSpin) -> None:
        frame = principal_frame(spin)
        about_max = spin.regime is not Regime.MIN_AXIS  # on the separatrix either choice is right
        a, b, c = (0, 1, 2) if about_max else (2, 1, 0)
        self.moments = J_a, J_b, J_c = (frame.moments[a], frame.moments[b], frame.moments[c])
        e_a, e_b = frame.axes[a], frame.axes[b]
        self.axes = (e_a, e_b, cross(e_a, e_b))
        gaps = (frame.upper_gap, frame.lower_gap)
        ab, bc = gaps if about_max else gaps[::-1]
        ac = ab + bc

        w_a, w_b, w_c = (mp.fdot(axis, converted(spin.omega)) for axis in self.axes)
        # Sums of positive terms, and for D an exact numerator: nothing cancels, however close the
        # orbit is to an equilibrium (C) or to the separatrix (D).
        A = J_a * ac * w_a**2 + J_b * bc * w_b**2
        C = J_b * ab * w_b**2 + J_c * ac * w_c**2
        D = mp.convert(abs(spin.separation)) / (A * C)
        self.m = bc * C / (ab * A)
        self.m_prime = ac * D / (ab * A)
        self.rate = mp.sqrt(ab * A / mp.convert(spin.determinant))
        self.gap = ac if about_max else -ac
        self.on_separatrix = spin.regime is Regime.SEPARATRIX

        s_a = _sign(w_a)
        # The sign of w_c never changes on the separatrix; elsewhere cn changes its own sign.
        s_c = _sign(w_c) if self.on_separatrix else 1
        s_b = -s_a * s_c if about_max else s_a * s_c
        self.amplitudes = (
            s_a * mp.sqrt(A / (J_a * ac)),
            s_b * mp.sqrt(C / (J_b * ab)),
            s_c * mp.sqrt(C / (J_c * ac)),
        )
        if not self.on_separatrix:
            self._landen = Landen(self.m, self.m_prime)
            self.quarter_period = self._landen.quarter_period  # K
        dn, sn, cn = (w / size for w, size in zip((w_a, w_b, w_c), self.amplitudes, strict=True))
        self.phase = self._phase_of(sn, cn, dn)

    @property
    def period(self) -> mpf:
        """4K/lam; infinite on the separatrix."""
        return mp.inf if self.on_separatrix else 4 * self.quarter_period / self.rate

    def functions(self, t: mpf) -> Triple:
        """(sn, cn, dn) of lam t + u_0."""
        u = self.rate * t + self.phase
        if self.on_separatrix:
            sech = mp.sech(u)
            return mp.tanh(u), sech, sech
        return self._landen.jacobi(u)

    def omega(self, functions: Triple) -> list[mpf]:
        """omega in body axes, at (sn, cn, dn)."""
        sn, cn, dn = functions
        w_a, w_b, w_c = (p * q for p, q in zip(self.amplitudes, (dn, sn, cn), strict=True))
        return [w_a * a + w_b * b + w_c * c for a, b, c in zip(*self.axes, strict=True)]

    def _phase_of(self, sn: mpf, cn: mpf, dn: mpf) -> mpf:
        """The u_0, up to whole periods 4K, with these values of the functions."""
        if self.on_separatrix:
            return mp.asinh(sn / cn)
        # Carlson's form of the inverse of sn (DLMF 22.15, 19.25.5), on the right branch of cn.
        f = sn * mp.elliprf(cn**2, dn**2, 1)
        return f if cn >= 0 else _sign(sn) * 2 * self.quarter_period - f


def principal_frame(spin: FreeSpin) -> PrincipalFrame:
    """The principal frame of a body with three different moments, at the ambient precision."""
    if tensors.is_diagonal(spin.inertia):
        return _sorted_frame(tuple(spin.inertia[i][i] for i in range(3)))
    # Viete's solution of the cubic. The angle has a sine from the exact discriminant, and the gaps
    # are sines of its third: they are accurate relatively, however nearly two moments agree.
    sine, cosine = mp.sqrt(27 * mp.convert(spin.discriminant)), mp.convert(spin.cubic.skewness)
    third, rest = mp.atan2(sine, cosine) / 3, mp.atan2(sine, -cosine) / 3  # they add up to pi/3
    mean, radius = mp.convert(spin.trace / 3), mp.sqrt(mp.convert(spin.cubic.spread))
    upper, lower = (radius * mp.sin(angle) * 2 / mp.sqrt(3) for angle in (rest, third))
    # Of J2 and J3 the product and the sum, so that the small moments of a needle do not cancel.
    J1 = mean + radius * mp.cos(third) * 2 / 3
    both = mp.convert(spin.determinant) / J1
    J2 = ((mp.convert(spin.cubic.minors) - both) / J1 + lower) / 2
    moments = [J1, J2, both / J2]
    axes = [_eigenvector(spin.inertia, moment) for moment in moments]
    return PrincipalFrame(moments, axes, upper, lower)


def _sorted_frame(diagonal: tensors.Vector) -> PrincipalFrame:
    """The axes of a diagonal tensor, which are exact."""
    order = sorted(range(3), key=lambda n: diagonal[n], reverse=True)
    J1, J2, J3 = (diagonal[n] for n in order)
    axes = [[mpf(int(row == column)) for column in range(3)] for row in order]
    return PrincipalFrame(converted((J1, J2, J3)), axes, *converted((J1 - J2, J2 - J3)))


def _eigenvector(matrix: tensors.Matrix, eigenvalue: mpf) -> list[mpf]:
    """The unit eigenvector of a simple eigenvalue: the longest column of the adjugate of I - J."""
    p, q, r = (
        [mp.convert(entry) - (eigenvalue if i == j else 0) for j, entry in enumerate(row)]
        for i, row in enumerate(matrix)
    )
    columns = (cross(q, r), cross(r, p), cross(p, q))
    longest = max(columns, key=lambda column: mp.fdot(column, column))
    length = mp.sqrt(mp.fdot(longest, longest))
    return [entry / length for entry in longest]


def converted(vector: tensors.Vector) -> list[mpf]:
    return [mp.convert(entry) for entry in vector]


def _sign(value: mpf) -> int:
    """+1 or -1; zero counts as positive."""
    return -1 if value < 0 else 1
