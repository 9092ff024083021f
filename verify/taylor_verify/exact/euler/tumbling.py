"""The free motion of a body with three different moments, in balls.

Legend as in moduli; h = H/|H| in (a, b, c), rho^2 = h_a^2 + h_b^2, P = [e_a e_b e_c], and B(t) the
rotation that takes h to axis 3 and c into the plane of axes 1 and 3:
    R(t) = R0 P B(0)^T Rz(psi) B(t) P^T.
The spherical angle of h about c never winds, because h_a > 0: all the winding is in psi.
"""

from __future__ import annotations

from fractions import Fraction
from functools import cached_property

from flint import arb, arb_mat

from taylor_verify.exact.balls import ball
from taylor_verify.exact.euler.moduli import Moduli, Triple
from taylor_verify.exact.euler.phase import Periodic, Separatrix
from taylor_verify.exact.euler.quaternion import Quaternion
from taylor_verify.exact.euler.regime import FreeSpin, Regime
from taylor_verify.exact.rotation import conjugate, product


class Tumbling:
    """omega and the turn since the start, at the precision of flint at which this was made."""

    def __init__(self, spin: FreeSpin) -> None:
        self._moduli = moduli = Moduli(spin)
        is_separatrix = spin.regime is Regime.SEPARATRIX
        self._functions = Separatrix(moduli) if is_separatrix else Periodic(moduli)
        self._to_body = arb_mat([list(row) for row in zip(*moduli.axes, strict=True)])

    def at(self, t: Fraction, turned: bool) -> tuple[list[arb], Quaternion]:
        """omega in body axes, and the turn since the start, of the sign that follows without a jump."""
        time = ball(t)
        functions = self._functions.at(time)
        parts = zip(self._moduli.amplitudes, functions, strict=True)
        omega = (self._to_body * arb_mat(3, 1, [size * f for size, f in parts])).entries()
        if not turned:
            return omega, []
        cos, sin = self._functions.half_phase(time, functions)
        w, x, y, z = self._half_tilt(functions)
        # The turn by psi about axis 3, after the tilt.
        tilted = [cos * w - sin * z, cos * x - sin * y, cos * y + sin * x, cos * z + sin * w]
        return omega, (self._tilted_back * arb_mat(4, 1, tilted)).entries()

    @cached_property
    def _tilted_back(self) -> arb_mat:
        """P B(0)^T as it acts on a quaternion, whose vector part comes out in body axes."""
        back = conjugate(self._half_tilt(self._moduli.functions))
        images = [product(back, [arb(int(i == k)) for i in range(4)]) for k in range(4)]
        scalars, *vectors = zip(*images, strict=True)
        in_body = (self._to_body * arb_mat([list(row) for row in vectors])).tolist()
        return arb_mat([list(scalars), *in_body])

    def _half_tilt(self, functions: Triple) -> Quaternion:
        """The quaternion of B: B^T = Rz(al) Ry(th), |al| < pi/2 and 0 < th < pi.

        So the cosines of both half angles, and the sine of the second, are positive.
        """
        h_a, h_b, h_c = (h * f for h, f in zip(self._moduli.direction, functions, strict=True))
        rho = (h_a * h_a + h_b * h_b).sqrt()
        cos_al, cos_th = ((1 + h_a / rho) / 2).sqrt(), ((1 + h_c) / 2).sqrt()
        sin_al, sin_th = h_b / (2 * rho * cos_al), rho / (2 * cos_th)
        return [cos_al * cos_th, sin_al * sin_th, -cos_al * sin_th, -sin_al * cos_th]
