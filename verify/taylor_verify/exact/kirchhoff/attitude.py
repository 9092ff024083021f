"""How Clebsch's body is turned in space, Hydromechanics 49 (10)-(17), without Euler's angles.

Legend: F = |x|, z = x3, xi = x1 + i x2, eta = y1 + i y2. In space axes with Z along F the body has
the Cayley-Klein parameters (a, b), with |a|^2 + |b|^2 = 1, so that with Euler's angles

    a = cos(theta/2) e^{i (psi + phi)/2},  b = i sin(theta/2) e^{i (psi - phi)/2}.

Then |a|^2 = (F + z)/2F, |b|^2 = (F - z)/2F, xi = 2F conj(a) b, and the phase of each has only one
pole, where the other one vanishes:

    arg a = (q F t - L)/2 + D,   L' = (r - r') y3 - (q' - q) z,   D' = (r/2) (FG + F y3)/(F + z),
    arg b = (q F t + L)/2 + U,                                    U' = (r/2) (FG - F y3)/(F - z).

A modulus changes its sign where it vanishes; so both are smooth wherever the axis points.
"""

from __future__ import annotations

from dataclasses import dataclass

from mpmath import mp, mpc, mpf

from taylor_verify.exact.frames import Frame


@dataclass(frozen=True)
class CayleyKlein:
    """The attitude of the body in some space axes."""

    a: mpc
    b: mpc

    def frame(self) -> Frame:
        """The matrix of the attitude, body to space, by rows."""
        a, b = self.a, self.b
        # X + i Y of the three body axes.
        first, second, third = a**2 - b**2, 1j * (a**2 + b**2), -2 * a * b
        level = 2 * mp.conj(a) * b
        upright = (abs(a) - abs(b)) * (abs(a) + abs(b))
        return [
            [first.real, second.real, third.real],
            [first.imag, second.imag, third.imag],
            [level.real, level.imag, upright],
        ]

    def across(self, transverse: mpc, along: mpf) -> mpc:
        """X + i Y of the vector (v1, v2, v3), where transverse is v1 + i v2 and along v3."""
        a, b = self.a, self.b
        return a**2 * transverse - b**2 * mp.conj(transverse) - 2 * a * b * along
