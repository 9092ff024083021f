"""The nutating motion of Clebsch's body, Hydromechanics 49 (1)-(22), as numbers of one precision.

Legend: z = x3; F = |x|, FG = x.y; f(z) = z'^2 is the quartic; A^2 = F^2 - z^2, so that
x1 + i x2 = A e^{i chi}. Derived from x' = x x Omega alone:

    chi' = (r - r') y3 - (q' - q) z + (r/2) (FG - F y3)/(F - z) - (r/2) (FG + F y3)/(F + z)
    y1 + i y2 = e^{i chi} (FG - y3 z + i z'/r)/A

A has a sign, which it changes where the orbit passes a pole x3 = +-F; chi is smooth there. With
L, U and D of space.py, chi = L + U - D: the attitude takes no other integrals than x and y do.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Final, final

from mpmath import mp, mpc, mpf

from taylor_verify.exact.kirchhoff.quartic import Nutation
from taylor_verify.exact.kirchhoff.regime import TurningPoints, turning_points
from taylor_verify.exact.kirchhoff.space import CayleyKlein, Pose, SpaceAxes, transverse
from taylor_verify.exact.kirchhoff.wave import CosineWave, Place, Rise, SquareWave, Wave
from taylor_verify.scenes.motion import Impulse

# Of a root that goes from -1 to 1 or so: whatever the precision, beyond this its sign is no rounding.
_NEAR_POLE: Final = 2.0**-3


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

    def root(self, place: Place, weight: mpf) -> tuple[mpf, mpf]:
        """sqrt(F - side x3), signed if the pole is reached, and root_b (side -1: root_a) over it.

        The quotient is finite also where both vanish, at the pole itself.
        """
        size = place.b + weight * place.a
        vanishing = place.root_b if self.side > 0 else place.root_a
        if self.reached:
            scale = mp.sqrt((self.from_1 if self.side > 0 else weight * self.from_2) / size)
            return scale * vanishing, 1 / scale
        root = mp.sqrt((self.from_1 * place.b + weight * self.from_2 * place.a) / size)
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
class Phase:
    """A phase, L, U or D: linear but for bend times int a/(b + beta a) du, and zero at the start."""

    def __init__(self, rate: mpf, wave: Wave, bend: mpf | int = 0, beta: mpf | int = 1) -> None:
        self.rate, self.bend, self.beta = rate, bend, beta
        if bend:
            self._integral = wave.integral(beta)
            self._at_start = self._integral.at(wave.place(wave.start))

    def at(self, t: mpf, place: Place) -> mpf:
        linear = self.rate * t
        if not self.bend:
            return linear
        return linear + self.bend * (self._integral.at(place) - self._at_start)


@final
class EllipticOrbit:
    """A motion whose x3 swings between two simple roots of f; to be used at one precision."""

    def __init__(self, nutation: Nutation, start: Impulse) -> None:
        body, axes = nutation.body, nutation.axes
        self._start = start
        self._F = mp.sqrt(mp.convert(nutation.F2))
        self._y3, root = mp.convert(nutation.y3), mp.sqrt(mp.convert(axes.nu))
        self._r = mp.convert(body.r) / root
        # L' is linear + screw z, and the phase of both parameters grows at half of glide.
        self._linear = mp.convert((body.r - body.r_prime) * nutation.y3) / root
        self._screw = mp.convert(body.q - body.q_prime) / root
        self._glide = mp.convert(body.q) / root * self._F
        # x1 + i x2 and y1 + i y2 at the start.
        self._xi, self._eta = (transverse(v, axes) for v in (start.linear, start.angular))
        points = turning_points(nutation, mp.dps)
        self._wave: Wave = (SquareWave if points.pair is None else CosineWave)(nutation, points)
        self._z1, self._width = mp.convert(points.z1), mp.convert(points.z2 - points.z1)
        self._poles = _poles(nutation, points)
        self._phases = self._spin_phase(), *map(self._pole_phase, self._poles)
        self._rise = Rise(nutation, points.z1, self._wave, self._r * self._F)
        self._turn = self._first_turn()

    @cached_property
    def axes(self) -> SpaceAxes:
        """The scene's space axes."""
        return SpaceAxes(self._start, self.pose(mpf(0)), self._F)

    def pose(self, t: mpf) -> Pose:
        """x, y, the attitude and Z at the time t since the start."""
        place = self._wave.place(self._wave.start + self._wave.rate * t)
        up, down, z, partner = self._shape(place)
        L, U, D = (phase.at(t, place) for phase in self._phases)
        turn = self._turn * mp.expj(L + U - D)
        half = mp.expj((self._glide * t - L) / 2 + D) / mp.sqrt(2 * self._F)
        return Pose(
            x=(turn * up * down, z),
            y=(turn * partner, self._y3),
            turned=CayleyKlein(half * down, half * turn * up),
            rise=self._rise.at(t, place),
        )

    @property
    def elements(self) -> dict[str, mpf]:
        """The period of nutation, the rate of the elliptic argument, m and m'."""
        wave = self._wave
        return {"period": wave.period, "rate": wave.rate, "m": wave.m, "m_prime": wave.m_prime}

    def losses(self, t: mpf) -> list[mpf]:
        """Estimates of the factors by which errors have grown by the time t >= 0.

        They save repetitions; whether they were enough is decided by two precisions.
        """
        linear = abs(self._glide) + sum(abs(phase.rate) for phase in self._phases)
        betas = [phase.beta + 1 / phase.beta for phase in self._phases if phase.bend]
        return [1 + self._wave.rate * t, 1 / self._wave.m_prime, 1 + linear * t, *betas]

    def _spin_phase(self) -> Phase:
        """L, by x3 = z1 + width w a/(b + w a)."""
        wave = self._wave
        bend = self._screw * self._width * wave.weight / wave.rate
        return Phase(self._linear + self._screw * self._z1, wave, bend, wave.weight)

    def _pole_phase(self, pole: Pole) -> Phase:
        """U or D: 1/(F -+ x3) has the form of x3 with the pole's own weight."""
        wave = self._wave
        if pole.pull == 0:
            return Phase(mpf(0), wave)
        rate = self._r / 2 * pole.pull / pole.from_1
        bend = rate * pole.side * self._width * wave.weight / (wave.rate * pole.from_1)
        return Phase(rate, wave, bend, wave.weight * pole.from_2 / pole.from_1)

    def _shape(self, place: Place) -> tuple[mpf, mpf, mpf, mpc]:
        """The motion turned back about axis 3 by chi: the factors of A, x3, (y1 + i y2) e^{-i chi}.

        The factors are sqrt(F - x3) and sqrt(F + x3), with the signs of Pole.root.
        """
        top, bottom = self._poles
        w = self._wave.weight
        size = place.b + w * place.a
        z = self._z1 + self._width * w * place.a / size
        up, up_slope = top.root(place, w)
        down, down_slope = bottom.root(place, w)
        # dx3/dt = slope root_a root_b, and the roots stand in the two quotients already.
        slope = 2 * self._wave.rate * self._width * w * place.dn / size**2
        if z >= 0:
            radial = (top.pull_on(up) + self._y3 * up) / down
        else:
            radial = (bottom.pull_on(down) - self._y3 * down) / up
        return up, down, z, mpc(radial, slope * up_slope * down_slope / self._r)

    def _first_turn(self) -> mpc:
        """e^{i chi} at the start: from x, or from y near a pole that the orbit passes.

        There the sign of A is that of a number that vanishes on the way, and y does not vanish.
        """
        place = self._wave.place(self._wave.start)
        up, down, _, partner = self._shape(place)
        vanishing = zip(self._poles, (place.root_b, place.root_a), strict=True)
        is_near = any(pole.reached and abs(root) < _NEAR_POLE for pole, root in vanishing)
        from_y = self._xi == 0 or is_near
        turn = self._eta / partner if from_y else self._xi * mp.sign(up * down)
        return turn / abs(turn)
