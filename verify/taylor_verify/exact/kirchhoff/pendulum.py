"""Motion in a plane of the body by the pendulum's formulas, in mpmath.

Legend: that of plane.py. With m the parameter of the elliptic functions and u = u0 + rate t,

    swing  h < omega0^2:  m = h/omega0^2,  rate = omega0:     sin alpha = k sn u,  cos alpha = +-dn u;
    turn   h > omega0^2:  m = omega0^2/h,  rate = +-sqrt(h):  sin alpha = sn u,    cos alpha = cn u;
    front  h = omega0^2:                   rate = +-omega0:   sin alpha = tanh u,  cos alpha = +-sech u.

The body turns about k by side (alpha - alpha0). Its centre goes along F at F (p_a + (p_b - p_a)
sin^2 alpha), and across F, in the plane, by (y_k - y_k0)/F (Hydromechanics 49 (18), (19)).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final, final

import numpy as np
from mpmath import mp, mpc, mpf

from taylor_verify.exact.elliptic import Landen
from taylor_verify.exact.frames import start_frame
from taylor_verify.exact.kirchhoff.displaced import as_given
from taylor_verify.exact.kirchhoff.plane import Plane
from taylor_verify.exact.kirchhoff.solid import short_digits, solid, velocities
from taylor_verify.exact.solution import Quantities, Settled, Time, longest
from taylor_verify.scenes.scene import Scene

_GUARD_DIGITS: Final = 12


@dataclass(frozen=True)
class Swept:
    """The pendulum at one instant: e^{i alpha}, alpha', and int sin^2 alpha dt."""

    direction: mpc
    rate: mpf
    squares: mpf


@final
class Pendulum(Settled):
    """A motion in a plane by the pendulum's formulas."""

    route = "mpmath"

    def __init__(self, kind: str, plane: Plane, scene: Scene) -> None:
        self.regime = kind
        self._plane, self._track = plane, scene.track
        body, self._start = solid(scene)
        self._velocity, _ = velocities(body, self._start)

    def evaluate(self, elapsed: Sequence[Time], digits: int) -> Quantities:
        fastest = max(self._plane.omega0_squared, self._plane.h)
        swept = math.isqrt(math.ceil(fastest * longest(elapsed) ** 2))
        lost = len(str(swept))
        if "centre" in self._track and self._plane.F2:
            lost += short_digits(self._velocity, self._start, elapsed)
        with mp.workdps(digits + _GUARD_DIGITS + lost):
            course = _COURSES.get(self.regime, Even)(self._plane)
            return self._quantities([course.at(t) for t in elapsed], elapsed)

    def elements(self, digits: int) -> dict[str, mpf]:
        """The period after which x and y recur, where they do, and the rate and parameters."""
        with mp.workdps(digits + _GUARD_DIGITS):
            return _COURSES.get(self.regime, Even)(self._plane).elements()

    def _quantities(self, rows: Sequence[Swept], elapsed: Sequence[Time]) -> Quantities:
        place = self._plane
        F, r = mp.sqrt(mp.convert(place.F2)), mp.convert(place.r)
        x, y, path = (np.full((len(rows), 3), mpf(0), dtype=object) for _ in range(3))
        frames = np.full((len(rows), 3, 3), mpf(0), dtype=object)
        i, j, k = (place.k + 1) % 3, (place.k + 2) % 3, place.k
        back = mp.conj(_direction(place))
        for n, (row, t) in enumerate(zip(rows, elapsed, strict=True)):
            x[n, place.a], x[n, place.b] = F * row.direction.real, -F * row.direction.imag
            y[n, k] = place.side * row.rate / r
            # From the body's axes to those of the start, in the components of the body.
            turn = row.direction * back
            frames[n, i, i], frames[n, j, j], frames[n, k, k] = turn.real, turn.real, mpf(1)
            frames[n, j, i], frames[n, i, j] = place.side * turn.imag, -place.side * turn.imag
            # (a, b, side k) is a right-handed frame: k x F stands at side times (-b, a).
            way = self._way(row, t) * back
            path[n, place.a], path[n, place.b] = way.real, way.imag
        first = np.array(start_frame(self._start.attitude))
        centre = np.array([mp.convert(c) for c in self._start.centre])
        quantities = {"linear_impulse": x, "angular_impulse": y}
        if self._track:
            quantities["attitude"] = first @ frames
        if "centre" in self._track:
            quantities["centre"] = as_given(
                centre + path @ first.T, self._start.centre, elapsed, mp.convert
            )
        # A y or a centre that starts from zero must be exactly zero at the start.
        as_given(y, self._start.angular, elapsed, mp.convert)
        return quantities

    def _way(self, row: Swept, t: Time) -> mpc:
        """The way of the centre since the start, along F and across it."""
        place = self._plane
        F = mp.sqrt(mp.convert(place.F2))
        if not F:
            return mpc(0)
        p_a, spread = mp.convert(place.p[0]), mp.convert(place.p[1] - place.p[0])
        across = (row.rate - mp.convert(place.rate)) / (mp.convert(place.r) * F)
        return mpc(F * (p_a * mp.convert(t) + spread * row.squares), across)


def _direction(place: Plane) -> mpc:
    """e^{i alpha} at the start; where F = 0 the angle is counted from there."""
    F = mp.sqrt(mp.convert(place.F2))
    x_a, x_b = (mp.convert(c) for c in place.x)
    return mpc(x_a / F, -x_b / F) if F else mpc(1)


# The pendulum's angle.


class Even:
    """alpha grows evenly, or not at all."""

    def __init__(self, place: Plane) -> None:
        self._start, self._speed = _direction(place), mp.convert(place.rate)

    def at(self, t: Time) -> Swept:
        time = mp.convert(t)
        # The integral enters where p_a = p_b, with no weight, or where alpha is constant.
        squares = self._start.imag**2 * time
        return Swept(self._start * mp.expj(self._speed * time), self._speed, squares)

    def elements(self) -> dict[str, mpf]:
        return {"period": 2 * mp.pi / abs(self._speed)} if self._speed else {}


class Front:
    """The pendulum's separatrix."""

    def __init__(self, place: Plane) -> None:
        x_a, x_b = (mp.convert(c) for c in place.x)
        self._sign = mpf(1 if place.x[0] > 0 else -1)
        self._u0 = mp.asinh(-x_b / abs(x_a))
        self._speed = (1 if place.rate * place.x[0] > 0 else -1) * mp.sqrt(
            mp.convert(place.omega0_squared)
        )

    def at(self, t: Time) -> Swept:
        u = self._u0 + self._speed * mp.convert(t)
        tanh, sech = mp.tanh(u), mp.sech(u)
        squares = mp.convert(t) - (tanh - mp.tanh(self._u0)) / self._speed
        return Swept(mpc(self._sign * sech, tanh), self._sign * self._speed * sech, squares)

    def elements(self) -> dict[str, mpf]:
        return {}


class Elliptic:
    """Swing and turn; to be used at one precision."""

    def __init__(self, place: Plane) -> None:
        omega2, h = place.omega0_squared, place.h
        self._swings = place.lack > 0
        ratios = (
            (h / omega2, place.lack / omega2) if self._swings else (omega2 / h, -place.lack / h)
        )
        self._m, self._m_prime = (mp.convert(ratio) for ratio in ratios)
        self._landen = Landen(self._m, self._m_prime)
        # Squares of sn, cn and dn at the start, rational; alpha' says which way.
        sine2, cosine2, rate2 = place.x[1] ** 2, place.x[0] ** 2, place.rate**2
        if self._swings:
            self._sign = mpf(1 if place.x[0] > 0 else -1)
            self._speed = mp.sqrt(mp.convert(omega2))
            sn2, cn2, dn2 = place.spread * sine2 / h, rate2 / h, cosine2 / place.F2
            onward = place.rate * place.x[0] >= 0
        else:
            self._sign = mpf(1 if place.rate > 0 else -1)
            self._speed = self._sign * mp.sqrt(mp.convert(h))
            sn2, cn2, dn2 = sine2 / place.F2, cosine2 / place.F2, rate2 / h
            onward = place.x[0] >= 0
        sn = mp.sqrt(mp.convert(sn2)) * (1 if place.x[1] <= 0 else -1)
        u0 = sn * mp.elliprf(mp.convert(cn2), mp.convert(dn2), 1)
        K = self._landen.quarter_period
        self._u0 = u0 if onward else 2 * K - u0
        self._first = self._landen.squared_sine(self._u0)

    def at(self, t: Time) -> Swept:
        u = self._u0 + self._speed * mp.convert(t)
        sn, cn, dn = self._landen.jacobi(u)
        squares = (self._landen.squared_sine(u) - self._first) / self._speed
        if self._swings:
            k = mp.sqrt(self._m)
            rate = self._sign * k * self._speed * cn
            return Swept(mpc(self._sign * dn, k * sn), rate, squares)
        return Swept(mpc(cn, sn), self._speed * dn, squares / self._m)

    def elements(self) -> dict[str, mpf]:
        """A turn takes 4 K of its argument to bring x back, as a swing does."""
        rate = abs(self._speed)
        period = 4 * self._landen.quarter_period / rate
        return {"period": period, "rate": rate, "m": self._m, "m_prime": self._m_prime}


_COURSES: Final[Mapping[str, type[Front | Elliptic]]] = {
    "planar-front": Front,
    "planar-swing": Elliptic,
    "planar-turn": Elliptic,
}
