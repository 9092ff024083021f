"""The numbers of a free orbit in balls: its frame, its rate, its modulus, and where it starts.

Legend (see also regime and principal): (a, b, c) right-handed principal axes, b the intermediate
one, a the one encircled by the orbit, turned so that w_a > 0, and c = a x b; J_a, J_b, J_c their
moments, sig = sgn(J_a - J_c). With
    A = |H^2 - 2T J_c|,  C = |2T J_a - H^2|,  D = |H^2 - 2T J_b|,
    lam^2 = |J_a - J_b| A/(J_a J_b J_c),  m = |J_b - J_c| C/(|J_a - J_b| A),  m' = 1 - m,
the motion is w_a = a_a dn u, w_b = -sig a_b sn u, w_c = a_c cn u with u = lam t + u_0; on the
separatrix a_b and a_c have the sign of w_c besides, and dn u = cn u = sech u, sn u = tanh u.
"""

from __future__ import annotations

from flint import arb

from taylor_verify.exact.balls import balls, sign
from taylor_verify.exact.euler.principal import principal_balls
from taylor_verify.exact.euler.regime import FreeSpin, Regime
from taylor_verify.exact.rotation import cross, scalar_product
from taylor_verify.numbers.irrational import ball

Triple = tuple[arb, arb, arb]


class Moduli:
    """The numbers of one orbit at the ambient precision of flint, and (dn, sn, cn) at its start.

    ``axes`` and ``moments`` are those of (a, b, c); an amplitude carries the sign of its component;
    ``direction`` holds the amplitudes of h = H/|H|, ``momentum`` is |H|, ``nu`` J_c C/(J_a A) and
    ``sense`` sig. On the separatrix m' is a ball about zero of radius zero.
    """

    def __init__(self, spin: FreeSpin) -> None:
        frame = principal_balls(spin)
        about_max = spin.regime is not Regime.MIN_AXIS  # on the separatrix either choice is right
        self.sense = 1 if about_max else -1
        a, b, c = (0, 1, 2) if about_max else (2, 1, 0)
        self.moments = J_a, J_b, J_c = frame.moments[a], frame.moments[b], frame.moments[c]
        gaps = (frame.upper_gap, frame.lower_gap)
        ab, bc = gaps if about_max else gaps[::-1]
        ac = frame.whole_gap

        omega = balls(spin.omega)
        side = sign(scalar_product(frame.axes[a], omega))
        e_a, e_b = [side * component for component in frame.axes[a]], frame.axes[b]
        self.axes = (e_a, e_b, cross(e_a, e_b))
        w_a, w_b, w_c = (scalar_product(axis, omega) for axis in self.axes)

        # Sums of positive terms, and for D an exact numerator: nothing cancels.
        # (Products, because a power of a ball about zero is NaN in flint.)
        A = J_a * ac * (w_a * w_a) + J_b * bc * (w_b * w_b)
        C = J_b * ab * (w_b * w_b) + J_c * ac * (w_c * w_c)
        D = ball(abs(spin.separation)) / (A * C)
        self.m = bc * C / (ab * A)
        self.m_prime = ac * D / (ab * A)
        self.rate = (ab * A / ball(spin.determinant)).sqrt()
        # On the separatrix w_c keeps its sign; elsewhere cn changes its own.
        s_c = sign(w_c) if spin.regime is Regime.SEPARATRIX else 1
        self.amplitudes = (
            (A / (J_a * ac)).sqrt(),
            (C / (J_b * ab)).sqrt() * (-self.sense * s_c),
            (C / (J_c * ac)).sqrt() * s_c,
        )
        dn, sn, cn = (w / size for w, size in zip((w_a, w_b, w_c), self.amplitudes, strict=True))
        self.functions: Triple = (dn, sn, cn)

        self.momentum = ball(spin.momentum_squared).sqrt()
        a_a, a_b, a_c = self.amplitudes
        self.direction = (
            J_a * a_a / self.momentum,
            J_b * a_b / self.momentum,
            J_c * a_c / self.momentum,
        )
        self.nu = J_c * C / (J_a * A)
