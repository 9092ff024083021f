"""Motions of Clebsch's body in elementary functions: f is a quadratic, or has a repeated root d.

Legend: z = x3, xi = x1 + i x2, eta = y1 + i y2; v is z itself if f is a quadratic, else 1/(z - d).
Then v'^2 = Q(v) = A v^2 + 2 B v + C with rational A, B, C, so that v'' = A v + B. With ch and sh
the cosh of sqrt(A) t/2 and its sinh over sqrt(A), and v = a where z is at a pole,

    n = ch + (v0' + i delta) sh/(v0 - a),    delta^2 = -Q(a),    |n|^2 = (v - a)/(v0 - a),
    arg n = delta/2 int dt/(v - a),

which turns the phases U and -D of space.py into one factor n for each pole: that of the upper
pole is in b, the conjugate of that of the lower one in a, and xi has both. Where a pole is passed,
its delta is zero, and n is real and changes its sign. Z needs no integral: if d is a repeated root,
r F Z' is its value at x3 = d less (v'/v)'; if f is a quadratic, Z' is constant.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import final

from mpmath import mp, mpc, mpf

from taylor_verify.exact.kirchhoff.orbit import Orbit, distances, pulls
from taylor_verify.exact.kirchhoff.quartic import Nutation, derivative, repeated_root, value
from taylor_verify.exact.kirchhoff.space import CayleyKlein, Pose
from taylor_verify.scenes.motion import Impulse


@dataclass(frozen=True)
class Carrier:
    """v at the start, and the coefficients of Q; ``d`` is None where v is z itself."""

    d: Fraction | None
    v: Fraction
    speed: Fraction
    A: Fraction
    B: Fraction
    C: Fraction

    @classmethod
    def of(cls, nutation: Nutation) -> Carrier:
        """Return the carrier of an f of degree two, or with one repeated root and no start there."""
        f, z, speed = nutation.f, nutation.z, nutation.speed
        if len(f) == 3:
            return cls(None, z, speed, f[0], f[1] / 2, f[2])
        d = repeated_root(f)
        assert d is not None
        second = derivative(derivative(f))
        lead = f[0] if len(f) == 5 else Fraction(0)
        v = 1 / (z - d)
        A, B = value(second, d) / 2, value(derivative(second), d) / 12
        return cls(d, v, -speed * v**2, A, B, lead)


@dataclass(frozen=True)
class Beat:
    """ch and sh at the time t; where they are circular, the angle is ``half_turns`` pi longer."""

    t: mpf
    ch: mpf
    sh: mpf
    half_turns: int


@dataclass(frozen=True)
class Factor:
    """The factor of one pole in xi, up to a constant: constant + ch times cosh + sh times sinh."""

    constant: mpc
    ch: mpc
    sh: mpc

    def at(self, beat: Beat) -> mpc:
        return self.constant + self.ch * beat.ch + self.sh * beat.sh

    def slope(self, beat: Beat, A: mpf) -> mpc:
        """Time derivative of the factor."""
        return (self.ch * A * beat.sh + self.sh * beat.ch) / 2


@final
class ElementaryOrbit(Orbit):
    """v in hyperbolic, trigonometric or algebraic functions; to be used at one precision."""

    def __init__(self, nutation: Nutation, start: Impulse) -> None:
        super().__init__(nutation, start)
        carrier = Carrier.of(nutation)
        self._d = None if carrier.d is None else mp.convert(carrier.d)
        self._A, self._B, self._C = (mp.convert(c) for c in (carrier.A, carrier.B, carrier.C))
        self._v0, self._v0_slope = mp.convert(carrier.v), mp.convert(carrier.speed)
        self._rate = mp.sqrt(abs(self._A))
        self._FG = mp.convert(nutation.FG)
        self._drift = mp.convert(nutation.drift(nutation.z if carrier.d is None else carrier.d))
        # xi' = i r x3 eta on the axis, and the factor 2 sh has the slope 1.
        self._origin = self._xi or 1j * self._r * mp.convert(nutation.z) * self._eta
        self._face_poles(nutation, carrier)
        self._spin = self._r * self._y3 + self._up_rate - self._down_rate
        self._a, self._b = self._first_parameters(nutation)

    def pose(self, t: mpf) -> Pose:
        beat = self._beat(t)
        v, v_slope = self._carried(beat)
        L = self._linear * t + self._screw * self._integral_of_z(beat)
        U, D = self._up_rate * t, self._down_rate * t
        turn = self._origin * mp.expj(L + U - D)
        top, bottom = (factor.at(beat) for factor in self._factors)
        top_slope, bottom_slope = (factor.slope(beat, self._A) for factor in self._factors)
        shape, slope = top * bottom, top_slope * bottom + top * bottom_slope
        if self._d is None:
            shrinking, rise = mpf(1), self._drift * t
            z, z_slope = v, v_slope
        else:
            shrinking, growth = self._v0 / v, v_slope / v
            rise = self._drift * t - (growth - self._v0_slope / self._v0)
            z, z_slope = self._d + 1 / v, -growth / v
            shape, slope = shape * shrinking, (slope - shape * growth) * shrinking
        xi = turn * shape
        if 2 * abs(z) >= self._F:
            # From xi' = i r z eta - i (r' y3 + (q' - q) z) xi, which is regular at the poles.
            eta = turn * (slope / 1j + self._spin * shape) / (self._r * z)
        else:
            eta = mpc(self._FG - self._y3 * z, z_slope / self._r) / mp.conj(xi)
        half = self._glide * t / 2
        a = self._a * mp.expj(half - L / 2 + D) * mp.conj(bottom)
        b = self._b * mp.expj(half + L / 2 + U) * top
        size = mp.sqrt(shrinking)
        turned = CayleyKlein(size * a, size * b)
        return Pose((xi, z), (eta, self._y3), turned, rise / (self._r * self._F))

    @property
    def elements(self) -> dict[str, mpf]:
        return {"period": 2 * mp.pi / self._rate} if self._A < 0 else {}

    def losses(self, t: mpf) -> list[mpf]:
        pace = abs(self._linear) + abs(self._up_rate) + abs(self._down_rate)
        pace += abs(self._screw) * self._F + abs(self._glide)
        losses = [1 + self._rate * t, 1 + pace * t]
        if self._d is not None:
            # Falling away from near d, v is a small difference on the way, and grows from another,
            # smaller in proportion to 1/v0^2, when it returns.
            losses.append(1 + (self._F * self._v0) ** 2)
        return losses

    def _face_poles(self, nutation: Nutation, carrier: Carrier) -> None:
        """The factor of each pole, the upper first, and the linear parts of U and D."""
        gaps_at_start = distances(nutation.F2, nutation.z)
        gaps = None if carrier.d is None else distances(nutation.F2, carrier.d)
        factors: list[Factor] = []
        rates = [mpf(0), mpf(0)]
        for k, pull in enumerate(pulls(nutation)):
            if gaps is None:
                away, delta = (2 * k - 1) * gaps_at_start[k], -self._r * pull
            elif gaps[k] != 0:
                away = gaps_at_start[k] * self._v0 / gaps[k]
                delta = self._r * pull / gaps[k] ** 2
                rates[k] = self._r / 2 * pull / gaps[k]
            else:  # the pole is d itself
                factors.append(Factor(mpc(1), mpc(0), mpc(0)))
                continue
            if gaps_at_start[k] == 0:  # a start at the pole: v - a is a multiple of sh^2
                factors.append(Factor(mpc(0), mpc(0), mpc(2)))
            else:
                slant = mpc(self._v0_slope, delta) / away
                factors.append(Factor(mpc(0), mpc(1), slant))
        self._factors = factors
        self._up_rate, self._down_rate = rates

    def _first_parameters(self, nutation: Nutation) -> tuple[mpc, mpc]:
        """a and b at the start, where a > 0; where one is zero, what its factor is to be given."""
        _, down = distances(nutation.F2, nutation.z)
        if down == 0:
            return mp.conj(self._origin) / (2 * self._F), mpc(1)
        a = mpc(mp.sqrt(down / (2 * self._F)))
        return a, self._origin / (2 * self._F * a)

    def _beat(self, t: mpf) -> Beat:
        angle = self._rate * t / 2
        if self._A > 0:
            return Beat(t, mp.cosh(angle), mp.sinh(angle) / self._rate, 0)
        if self._A == 0:
            return Beat(t, mpf(1), t / 2, 0)
        half_turns = int(mp.nint(angle / mp.pi))
        return Beat(t, mp.cos(angle), mp.sin(angle) / self._rate, half_turns)

    def _carried(self, beat: Beat) -> tuple[mpf, mpf]:
        """v and v'."""
        bend = self._A * self._v0 + self._B
        v = self._v0 + 2 * beat.sh * (self._v0_slope * beat.ch + bend * beat.sh)
        whole = 1 + 2 * self._A * beat.sh**2
        return v, self._v0_slope * whole + 2 * bend * beat.sh * beat.ch

    def _integral_of_z(self, beat: Beat) -> mpf:
        """int_0^t z dt; left out where no rate depends on it."""
        if self._screw == 0:
            return mpf(0)
        if self._d is not None:
            return self._d * beat.t + self._integral_of_1_over_v(beat)
        sine, versed = 2 * beat.sh * beat.ch, 2 * beat.sh**2
        rest = self._B * (sine - beat.t) / self._A
        return self._v0 * sine + self._v0_slope * versed + rest

    def _integral_of_1_over_v(self, beat: Beat) -> mpf:
        """int_0^t dt/v = 2/sigma artanh(sigma sh/(v0 ch + v0' sh)), where sigma^2 = Q(0) = C.

        If C < 0 this is the arc tangent, on the branch that is continuous in t.
        """
        sigma = mp.sqrt(abs(self._C))
        near = beat.ch + self._v0_slope / self._v0 * beat.sh
        far = beat.sh / self._v0
        if self._C == 0:
            return 2 * far / near
        if self._C > 0:
            return 2 / sigma * mp.atanh(sigma * far / near)
        # A circular beat of half_turns pi more has both signs changed as often.
        sign = -1 if beat.half_turns % 2 else 1
        turned = mp.sign(self._v0) * beat.half_turns * mp.pi
        return 2 / sigma * (turned + mp.atan2(sign * sigma * far, sign * near))


@final
class Front(Orbit):
    """f = c^2 (F^2 - z^2)^2: x3 goes from one pole to the other, z' = c (F^2 - z^2), xi' ~ xi.

    F + z and F - z are as p e^{lambda t} and m e^{-lambda t}, with lambda = c F, whose sum over 2F is
    1/|xi| up to a factor; G = y3 = 0. To be used at one precision.
    """

    def __init__(self, nutation: Nutation, start: Impulse) -> None:
        super().__init__(nutation, start)
        self._minus, self._plus = distances(nutation.F2, nutation.z)
        self._c = mp.sqrt(mp.convert(nutation.f[0])) * (-1 if nutation.speed < 0 else 1)
        self._origin = self._xi
        # r F Z' = drift + c^2 (z^2 - F^2), and z' = c (F^2 - z^2).
        self._drift = mp.convert(
            nutation.drift(nutation.z) + nutation.f[0] * (nutation.F2 - nutation.z**2)
        )
        self._z0 = self._z(self._plus, self._minus)  # as at t = 0, so that Z is zero there

    def pose(self, t: mpf) -> Pose:
        growth = mp.exp(self._c * self._F * t)
        up, down = self._plus * growth, self._minus / growth
        spread = (up + down) / (2 * self._F)
        # int z dt = log(spread)/c, and F G - y3 z = 0 leaves eta = i z'/(r conj xi).
        L = self._screw / self._c * mp.log(spread)
        turn = self._origin / abs(self._origin) * mp.expj(L)
        xi = abs(self._origin) * turn / spread
        z = self._z(up, down)
        rise = (self._drift * t - self._c * (z - self._z0)) / (self._r * self._F)
        a = mp.expj((self._glide * t - L) / 2) * mp.sqrt(up / (up + down))
        b = mp.expj((self._glide * t - L) / 2) * turn * mp.sqrt(down / (up + down))
        return Pose((xi, z), (1j * self._c / self._r * xi, mpf(0)), CayleyKlein(a, b), rise)

    def _z(self, up: mpf, down: mpf) -> mpf:
        return self._F * (up - down) / (up + down)

    @property
    def elements(self) -> dict[str, mpf]:
        return {}

    def losses(self, t: mpf) -> list[mpf]:
        turned = abs(self._screw) * self._F + abs(self._glide)
        return [1 + abs(self._c) * self._F * t, 1 + turned * t]
