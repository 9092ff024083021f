"""The path of the centre of Clebsch's body, Hydromechanics 49 (18)-(22).

Legend: X, Y, Z are the coordinates of the centre in space axes with Z along F, from its start; F, z,
FG as in orbit.py; a0 = r (p' - p) and 4 a1 = 2 r (q' - q) y3 are the first coefficients of the
quartic f. The moment of the impulse about a fixed point is constant, which gives X and Y without an
integral,

    F (X + i Y) = -i Delta(y_X + i y_Y),        r F Z' = r (p F^2 + q FG) + a0 z^2 + 2 a1 z.

The right-hand side has no residue at the poles of z, whatever the body is: Z is an integral of the
second kind, and in the wave's terms, with n = 1 - w and j = 4/quarters,

    a0 z^2 + 2 a1 z = a0 z1^2 + 2 a1 z1 - (j rate)^2 n/2
                      + j rate d/dt [n root_a root_b dn/(b + w a) + m int sn^2 du].
"""

from __future__ import annotations

from fractions import Fraction
from typing import final

from mpmath import mp, mpc, mpf

from taylor_verify.exact.frames import Frame, applied, product, start_frame, transposed
from taylor_verify.exact.kirchhoff.attitude import CayleyKlein
from taylor_verify.exact.kirchhoff.quartic import Nutation
from taylor_verify.exact.kirchhoff.wave import Place, Swing, Wave
from taylor_verify.exact.kirchhoff.zeta import SquaredSine
from taylor_verify.scenes import tensors
from taylor_verify.scenes.motion import Impulse


def drift(nutation: Nutation, z: Fraction) -> Fraction:
    """r F Z' where x3 = z."""
    body = nutation.body
    steady = body.p * nutation.F2 + body.q * nutation.FG
    screw = (body.q_prime - body.q) * nutation.y3
    return body.r * (steady + (body.p_prime - body.p) * z**2 + screw * z)


@final
class Rise:
    """Z along an elliptic wave; to be used at one precision."""

    def __init__(self, nutation: Nutation, z1: Fraction, wave: Wave) -> None:
        self._weight, self._bend = wave.weight, 1 - wave.weight
        self._sine = SquaredSine(wave.m, wave.m_prime)
        self._quarter_period = wave.quarter_period
        pace = 4 * wave.rate / wave.quarters
        scale = mp.convert(nutation.body.r) * mp.sqrt(mp.convert(nutation.F2))
        self._linear = (mp.convert(drift(nutation, z1)) - pace**2 * self._bend / 2) / scale
        self._pace = pace / scale
        start = wave.place(wave.start)
        self._at_start = self._swung(start, wave.swing(start))

    def at(self, t: mpf, place: Place, swing: Swing) -> mpf:
        """Z at the time t, when the wave is there."""
        return self._linear * t + self._pace * (self._swung(place, swing) - self._at_start)

    def _swung(self, place: Place, swing: Swing) -> mpf:
        size = swing.b + self._weight * swing.a
        periodic = self._bend * swing.root_a * swing.root_b * swing.dn / size
        remainder = place.u - 2 * place.turns * self._quarter_period
        return periodic + self._sine.at(place.u, remainder)


@final
class SpaceAxes:
    """The scene's space axes, from those with Z along F in which an orbit is given."""

    def __init__(self, start: Impulse, turned: CayleyKlein, moment: mpc) -> None:
        """``turned`` and ``moment``, y_X + i y_Y, are those of the start in the orbit's axes."""
        to_space = start_frame(start.attitude)
        self._axes = product(to_space, transposed(turned.frame()))
        self._centre = [mp.convert(c) for c in start.centre]
        self._F = mp.sqrt(mp.convert(tensors.dot(start.linear, start.linear)))
        self._moment = moment

    def attitude(self, turned: CayleyKlein) -> Frame:
        """R, body to space."""
        return product(self._axes, turned.frame())

    def centre(self, moment: mpc, rise: mpf) -> list[mpf]:
        """The centre in space, from y_X + i y_Y and Z."""
        across = -1j * (moment - self._moment) / self._F
        moved = applied(self._axes, [across.real, across.imag, rise])
        return [c + d for c, d in zip(self._centre, moved, strict=True)]
