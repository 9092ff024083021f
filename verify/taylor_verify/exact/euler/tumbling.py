"""The free motion of a body with three different moments, in balls: omega, R and the quaternion.

Legend as in moduli; h = H/|H| in (a, b, c), rho^2 = h_a^2 + h_b^2, P = [e_a e_b e_c], and B(t) the
rotation that takes h to axis 3 and c into the plane of axes 1 and 3:
    R(t) = R0 P B(0)^T Rz(psi) B(t) P^T.
The spherical angle of h about c never winds, because h_a > 0: all the winding is in psi.
"""

from __future__ import annotations

from functools import cached_property

from flint import arb, arb_mat

from taylor_verify.exact.euler import quaternion
from taylor_verify.exact.euler.moduli import Moduli, Triple
from taylor_verify.exact.euler.phase import Periodic, Separatrix, Turning
from taylor_verify.exact.euler.quaternion import Quaternion, Rows
from taylor_verify.exact.euler.regime import FreeSpin, Regime


class Tumbling:
    """omega and attitude of one start, at the precision of flint at which it was made."""

    def __init__(self, spin: FreeSpin, start: Quaternion) -> None:
        self._start = start
        self._moduli = moduli = Moduli(spin)
        separatrix = spin.regime is Regime.SEPARATRIX
        self._turning: Turning = Separatrix(moduli) if separatrix else Periodic(moduli)
        self._to_body = arb_mat([list(row) for row in zip(*moduli.axes, strict=True)])
        self._from_body = self._to_body.transpose()

    def at(self, t: arb, tracks_attitude: bool) -> tuple[list[arb], Rows | None]:
        """omega in body axes, and R where it is tracked."""
        functions = self._turning.functions(t)
        parts = zip(self._moduli.amplitudes, functions, strict=True)
        omega = self._to_body * arb_mat(3, 1, [size * f for size, f in parts])
        return omega.entries(), self._attitude(t, functions) if tracks_attitude else None

    def _attitude(self, t: arb, functions: Triple) -> Rows:
        cos, sin = self._turning.phase(t, functions)
        n, s, h = self._tilt(functions)
        turned = [
            [cos * p - sin * q for p, q in zip(n, s, strict=True)],
            [sin * p + cos * q for p, q in zip(n, s, strict=True)],
            h,
        ]
        rows: Rows = (self._to_space * arb_mat(turned) * self._from_body).tolist()
        return rows

    def quaternion(self, t: arb) -> Quaternion:
        """q at the time t, of the sign that follows from the start without a jump."""
        functions = self._turning.functions(t)
        cos, sin = self._turning.half_phase(t, functions)
        turned = quaternion.product([cos, arb(0), arb(0), sin], self._half_tilt(functions))
        scalar, *vector = quaternion.product(self._half_tilt_at_start, turned)
        in_body = (self._to_body * arb_mat(3, 1, vector)).entries()
        return quaternion.product(self._start, [scalar, *in_body])

    @cached_property
    def _to_space(self) -> arb_mat:
        """R0 P B(0)^T."""
        tilt = arb_mat(self._tilt(self._moduli.functions))
        return arb_mat(quaternion.matrix(self._start)) * self._to_body * tilt.transpose()

    @cached_property
    def _half_tilt_at_start(self) -> Quaternion:
        return quaternion.conjugate(self._half_tilt(self._moduli.functions))

    def _direction(self, functions: Triple) -> tuple[arb, arb, arb, arb]:
        """h and rho = (h_a^2 + h_b^2)^(1/2)."""
        h_a, h_b, h_c = (
            size * f for size, f in zip(self._moduli.direction, functions, strict=True)
        )
        return h_a, h_b, h_c, (h_a * h_a + h_b * h_b).sqrt()

    def _tilt(self, functions: Triple) -> Rows:
        """B: rows are unit vectors in (a, b, c), the last one h, the middle one normal to c."""
        h_a, h_b, h_c, rho = self._direction(functions)
        cos, sin = h_a / rho, h_b / rho
        return [[h_c * cos, h_c * sin, -rho], [-sin, cos, arb(0)], [h_a, h_b, h_c]]

    def _half_tilt(self, functions: Triple) -> Quaternion:
        """The quaternion of B: B^T = Rz(al) Ry(th), |al| < pi/2 and 0 < th < pi.

        So the cosines of both half angles, and the sine of the second, are positive.
        """
        h_a, h_b, h_c, rho = self._direction(functions)
        cos_al, cos_th = ((1 + h_a / rho) / 2).sqrt(), ((1 + h_c) / 2).sqrt()
        sin_al, sin_th = h_b / (2 * rho * cos_al), rho / (2 * cos_th)
        return [cos_al * cos_th, sin_al * sin_th, -cos_al * sin_th, -sin_al * cos_th]
