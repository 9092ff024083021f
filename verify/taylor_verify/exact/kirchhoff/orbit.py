"""One nutating motion of Clebsch's body, Hydromechanics 49 (1)-(22), as numbers of one precision.

Legend: z = x3; F = |x|, FG = x.y; f(z) = z'^2 is the quartic; A^2 = F^2 - z^2, so that
x1 + i x2 = A e^{i chi}. Derived from x' = x x Omega alone:

    chi' = (r - r') y3 - (q' - q) z + (r/2) (FG - F y3)/(F - z) - (r/2) (FG + F y3)/(F + z)
    y1 + i y2 = e^{i chi} (FG - y3 z + i z'/r)/A

A has a sign, which it changes where the orbit passes a pole x3 = +-F; chi is smooth there. With
L, U and D of attitude.py, chi = L + U - D: the attitude takes no other integrals than x and y do.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Final, final

from mpmath import mp, mpc, mpf

from taylor_verify.exact.kirchhoff.attitude import CayleyKlein
from taylor_verify.exact.kirchhoff.centre import Rise
from taylor_verify.exact.kirchhoff.quartic import Nutation
from taylor_verify.exact.kirchhoff.regime import TurningPoints, turning_points
from taylor_verify.exact.kirchhoff.wave import CosineWave, Place, SquareWave, Swing, Wave
from taylor_verify.scenes.motion import Impulse

# Of a root that goes from -1 to 1 or so: whatever the precision, beyond this its sign is no rounding.
_NEAR_POLE: Final = 2.0**-3

Axial = tuple[mpc, mpf]  # (v1 + i v2, v3) of a vector v in body axes


def transverse(vector: Sequence[Fraction]) -> mpc:
    """v1 + i v2."""
    return mpc(mp.convert(vector[0]), mp.convert(vector[1]))


@dataclass(frozen=True)
class Pose:
    """Everything about one instant, in body axes and in space axes with Z along F.

    ``turned`` is the attitude, and ``rise`` is Z, the way of the centre along F since the start.
    """

    x: Axial
    y: Axial
    turned: CayleyKlein
    rise: mpf

    @property
    def moment(self) -> mpc:
        """y_X + i y_Y."""
        return self.turned.across(*self.y)


@dataclass(frozen=True)
class Shape:
    """x and y turned back about axis 3 by chi: x3, (y1 + i y2) e^{-i chi}, and the two factors of A.

    They are sqrt(F - x3) and sqrt(F + x3), with the signs of Pole.root.
    """

    up: mpf
    down: mpf
    z: mpf
    partner: mpc

    @property
    def amplitude(self) -> mpf:
        return self.up * self.down


@dataclass(frozen=True)
class Pole:
    """The pole x3 = side F: its distances from z1, z2, FG - side F y3, and whether it is reached.

    The pull is zero exactly where the pole is a root of f, and only then can it be reached.
    """

    side: int
    from_1: mpf
    from_2: mpf
    pull: mpf
    reached: bool

    def root(self, swing: Swing, weight: mpf) -> tuple[mpf, mpf]:
        """sqrt(F - side x3), signed if the pole is reached, and root_b (side -1: root_a) over it.

        The quotient is finite also where both vanish, at the pole itself.
        """
        size = swing.b + weight * swing.a
        vanishing = swing.root_b if self.side > 0 else swing.root_a
        if self.reached:
            scale = mp.sqrt((self.from_1 if self.side > 0 else weight * self.from_2) / size)
            return scale * vanishing, 1 / scale
        root = mp.sqrt((self.from_1 * swing.b + weight * self.from_2 * swing.a) / size)
        return root, vanishing / root

    def pull_on(self, root: mpf) -> mpf:
        """(FG - side F y3)/sqrt(F - side x3)."""
        return self.pull / root if self.pull != 0 else self.pull


def _poles(nutation: Nutation, points: TurningPoints) -> tuple[Pole, Pole]:
    """The upper and the lower pole."""
    up_1, down_1 = distances(nutation.F2, points.z1)
    up_2, down_2 = distances(nutation.F2, points.z2)
    pull_up, pull_down = pulls(nutation)
    zero = mpf(0)
    return (
        Pole(1, up_1, zero if points.at_top else up_2, pull_up, points.at_top),
        Pole(-1, zero if points.at_bottom else down_1, down_2, pull_down, points.at_bottom),
    )


def pulls(nutation: Nutation) -> tuple[mpf, mpf]:
    """(FG - F y3, FG + F y3), zero exactly where they are."""
    FG, F_y3 = mp.convert(nutation.FG), mp.sqrt(mp.convert(nutation.F2)) * mp.convert(nutation.y3)
    both = [FG - F_y3, FG + F_y3]
    # Their product is rational: the smaller one comes from it without cancellation.
    smaller = 0 if FG * F_y3 > 0 else 1
    if both[1 - smaller] != 0:
        product = mp.convert(nutation.FG**2 - nutation.F2 * nutation.y3**2)
        both[smaller] = product / both[1 - smaller]
    return both[0], both[1]


def distances(F2: Fraction, z: Fraction) -> tuple[mpf, mpf]:
    """(F - z, F + z), of which the smaller from their product, which is rational."""
    F = mp.sqrt(mp.convert(F2))
    larger = F + abs(mp.convert(z))
    smaller = mp.convert(F2 - z**2) / larger
    return (smaller, larger) if z >= 0 else (larger, smaller)


@final
class Advance:
    """What a phase has beyond its linear term: bend times int a/(b + beta a) du."""

    def __init__(self, bend: mpf, beta: mpf, wave: Wave) -> None:
        self.beta = beta
        self._bend = bend
        self._integral = wave.integral(beta)
        self._at_start = self._integral.at(wave.place(wave.start))

    def at(self, place: Place) -> mpf:
        return self._bend * (self._integral.at(place) - self._at_start)


@final
@dataclass(frozen=True)
class Phase:
    """One of L, U and D: zero at the start, and without an integral where its bend is zero."""

    rate: mpf
    advance: Advance | None = None

    def at(self, t: mpf, place: Place) -> mpf:
        linear = self.rate * t
        return linear if self.advance is None else linear + self.advance.at(place)


class Orbit:
    """One nutating motion, with numbers of one precision; to be used at that precision."""

    def __init__(self, nutation: Nutation, start: Impulse, digits: int) -> None:
        points = turning_points(nutation, digits)
        self._wave: Wave = (SquareWave if points.pair is None else CosineWave)(nutation, points)
        self._r, self._y3 = mp.convert(nutation.body.r), mp.convert(nutation.y3)
        self._z1, self._width = mp.convert(points.z1), mp.convert(points.z2 - points.z1)
        self._poles = _poles(nutation, points)
        self._F = mp.sqrt(mp.convert(nutation.F2))
        self._glide = mp.convert(nutation.body.q) * self._F
        self._spin = self._spin_phase(nutation)
        self._up, self._down = (self._pole_phase(pole) for pole in self._poles)
        self._rise = Rise(nutation, points.z1, self._wave)
        self._turn = self._first_turn(start)

    def pose(self, t: mpf) -> Pose:
        """x, y, the attitude and Z at the time t since the start."""
        place = self._wave.place(self._wave.start + self._wave.rate * t)
        swing = self._wave.swing(place)
        shape = self._shape(swing)
        L, U, D = (phase.at(t, place) for phase in (self._spin, self._up, self._down))
        turn = self._turn * mp.expj(L + U - D)
        half = mp.expj((self._glide * t - L) / 2 + D) / mp.sqrt(2 * self._F)
        return Pose(
            x=(turn * shape.amplitude, shape.z),
            y=(turn * shape.partner, self._y3),
            turned=CayleyKlein(half * shape.down, half * turn * shape.up),
            rise=self._rise.at(t, place, swing),
        )

    @property
    def period(self) -> mpf:
        """The period of nutation, after which x3 and the shape of (x, y) recur."""
        return self._wave.period

    @property
    def moduli(self) -> dict[str, mpf]:
        """The rate of the elliptic argument, and the parameters m = k^2 and m_prime = 1 - k^2."""
        wave = self._wave
        return {"rate": wave.rate, "m": wave.m, "m_prime": wave.m_prime}

    def lost_digits(self, t: mpf) -> int:
        """An estimate of the digits lost by the time t >= 0.

        It saves repetitions; whether it was enough is what two precisions decide.
        """
        phases = (self._spin, self._up, self._down)
        linear = abs(self._glide) + sum(abs(phase.rate) for phase in phases)
        losses = [1 + self._wave.rate * t, 1 / self._wave.m_prime, 1 + linear * t]
        bent = [phase.advance.beta for phase in phases if phase.advance is not None]
        losses += [beta + 1 / beta for beta in bent]
        return sum(max(0, int(mp.ceil(mp.log10(loss)))) for loss in losses)

    def _spin_phase(self, nutation: Nutation) -> Phase:
        """L, by x3 = z1 + width w a/(b + w a)."""
        body, wave = nutation.body, self._wave
        rate = mp.convert((body.r - body.r_prime) * nutation.y3)
        if body.q_prime == body.q:
            return Phase(rate)
        pace = mp.convert(body.q - body.q_prime)
        bend = pace * self._width * wave.weight / wave.rate
        return Phase(rate + pace * self._z1, Advance(bend, wave.weight, wave))

    def _pole_phase(self, pole: Pole) -> Phase:
        """U or D: 1/(F -+ x3) has the form of x3 with the pole's own weight."""
        if pole.pull == 0:
            return Phase(mpf(0))
        wave = self._wave
        rate = self._r / 2 * pole.pull / pole.from_1
        bend = rate * pole.side * self._width * wave.weight / (wave.rate * pole.from_1)
        return Phase(rate, Advance(bend, wave.weight * pole.from_2 / pole.from_1, wave))

    def _shape(self, swing: Swing) -> Shape:
        """The motion without its turning about axis 3."""
        top, bottom = self._poles
        w = self._wave.weight
        size = swing.b + w * swing.a
        z = self._z1 + self._width * w * swing.a / size
        up, up_slope = top.root(swing, w)
        down, down_slope = bottom.root(swing, w)
        # dx3/dt = slope root_a root_b, and the roots stand in the two quotients already.
        slope = 2 * self._wave.rate * self._width * w * swing.dn / size**2
        if z >= 0:
            radial = (top.pull_on(up) + self._y3 * up) / down
        else:
            radial = (bottom.pull_on(down) - self._y3 * down) / up
        return Shape(up, down, z, mpc(radial, slope * up_slope * down_slope / self._r))

    def _first_turn(self, start: Impulse) -> mpc:
        """e^{i chi} at the start: from x, or from y near a pole that the orbit passes.

        There the sign of A is that of a number that vanishes on the way, and y does not vanish.
        """
        swing = self._wave.swing(self._wave.place(self._wave.start))
        shape = self._shape(swing)
        x = transverse(start.linear)
        vanishing = zip(self._poles, (swing.root_b, swing.root_a), strict=True)
        is_near = any(pole.reached and abs(root) < _NEAR_POLE for pole, root in vanishing)
        if x == 0 or is_near:
            turn = transverse(start.angular) / shape.partner
        else:
            turn = x * mp.sign(shape.amplitude)
        return turn / abs(turn)
