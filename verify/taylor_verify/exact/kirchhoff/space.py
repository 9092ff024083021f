"""The attitude and the path of Clebsch's body, Hydromechanics 49 (10)-(22), without Euler's angles.

Legend: F = |x|, z = x3, xi = x1 + i x2, eta = y1 + i y2. In space axes with Z along F the body has
the Cayley-Klein parameters (a, b), with |a|^2 + |b|^2 = 1, so that with Euler's angles

    a = cos(theta/2) e^{i (psi + phi)/2},  b = i sin(theta/2) e^{i (psi - phi)/2}.

Then |a|^2 = (F + z)/2F, |b|^2 = (F - z)/2F, xi = 2F conj(a) b, and the phase of each has only one
pole, where the other one vanishes:

    arg a = (q F t - L)/2 + D,   L' = (r - r') y3 - (q' - q) z,   D' = (r/2) (FG + F y3)/(F + z),
    arg b = (q F t + L)/2 + U,                                    U' = (r/2) (FG - F y3)/(F - z).

A modulus changes its sign where it vanishes; so both are smooth wherever the axis points. The moment
of the impulse about a fixed point is constant, which gives the centre across F without an integral,

    F (X + i Y) = -i Delta(y_X + i y_Y),        F Z' = p F^2 + q FG + (p' - p) z^2 + (q' - q) y3 z.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import final

from mpmath import mp, mpc, mpf

from taylor_verify.exact.frames import Frame, applied, product, start_frame, transposed
from taylor_verify.exact.kirchhoff.axis_of_revolution import Axes
from taylor_verify.scenes.motion import Impulse

Axial = tuple[mpc, mpf]  # (v1 + i v2, v3) of a vector v in body axes


def transverse(vector: Sequence[Fraction], axes: Axes) -> mpc:
    """v1 + i v2, in the units of these axes."""
    return mpc(*axes.across(tuple(vector), mp.convert))


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


@dataclass(frozen=True)
class Pose:
    """The motion at an instant, in body axes and in space axes with Z along F.

    ``turned`` is the attitude, and ``rise`` is Z, the way of the centre along F since the start.
    """

    x: Axial
    y: Axial
    turned: CayleyKlein
    rise: mpf

    @property
    def moment(self) -> mpc:
        """y_X + i y_Y."""
        (eta, y3), a, b = self.y, self.turned.a, self.turned.b
        return a**2 * eta - b**2 * mp.conj(eta) - 2 * a * b * y3


@final
class SpaceAxes:
    """The scene's space axes, from those with Z along F in which an orbit is given."""

    def __init__(self, start: Impulse, first: Pose, F: mpf) -> None:
        """``first`` is the pose at the start in the orbit's axes, F = |x| in its units."""
        to_space = start_frame(start.attitude)
        self._axes = product(to_space, transposed(first.turned.frame()))
        self._centre = [mp.convert(c) for c in start.centre]
        self._F, self._moment = F, first.moment

    def place(self, pose: Pose) -> tuple[Frame, list[mpf]]:
        """R, body to space, and the centre."""
        across = -1j * (pose.moment - self._moment) / self._F
        moved = applied(self._axes, [across.real, across.imag, pose.rise])
        centre = [c + d for c, d in zip(self._centre, moved, strict=True)]
        return product(self._axes, pose.turned.frame()), centre
