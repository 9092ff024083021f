"""The free motion of a gyrostat in balls: omega by Weierstrass's p, the attitude by sigma quotients.

Legend: as in pencil and azimuth; s is the odd function of exact.lattice, alpha_j the argument of
a pole of phi' and sigma_j its sign. With k such that the rate at the start is phi'(0),

    e^{i phi} = e^{i k t} prod (q_j/|q_j|)^sigma_j,    q_j = s(t - alpha_j)/s(-alpha_j):

four factors of modulus one, of which no branch has to be chosen.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from fractions import Fraction
from typing import Any, Final, NamedTuple, Protocol, final

from flint import acb, arb, arb_mat

from taylor_verify.exact.balls import Enclosed, Enclosure, Undecidable, ball, balls
from taylor_verify.exact.gyrostat.azimuth import (
    FRAMES,
    Arithmetic,
    Frame,
    poles,
    rate_at_start,
)
from taylor_verify.exact.gyrostat.pencil import FreeGyrostat
from taylor_verify.exact.gyrostat.point import PointMap, point_map
from taylor_verify.exact.gyrostat.velocity import momentum_form
from taylor_verify.exact.lattice import Lattice, lattice
from taylor_verify.exact.rotation import (
    conjugate,
    cross,
    product,
    rotation_matrix,
    rotation_rows,
    turn,
    unit,
)
from taylor_verify.scenes.motion import Quaternion
from taylor_verify.scenes.tensors import Vector, dot

Row = tuple[list[arb], arb_mat | None]

_BALLS: Final = Arithmetic(ball, acb, lambda z: z.sqrt())


class Course(Protocol):
    """A motion with numbers of one precision, to be used at that one."""

    def at(self, t: arb) -> Row:
        """omega in body axes, and R where it is tracked."""
        ...


@final
class GyrostatBalls(Enclosed):
    """The free motion of a rigid body with wheels: omega(t) in body axes, and R(t) where it is tracked."""

    def __init__(self, free: FreeGyrostat, attitude: Quaternion | None) -> None:
        self.regime = free.regime.value
        self._free, self._attitude = free, attitude
        self._courses: dict[int, Course] = {}
        self._frame: Frame | None = None

    def enclose(self, elapsed: Sequence[Fraction], bits: int) -> Enclosure:
        """``omega``, rows of 3, and ``attitude``, rows of 3x3, where it is tracked."""
        if bits not in self._courses:
            self._courses[bits] = self._course()
        rows = [self._courses[bits].at(ball(t)) for t in elapsed]
        found: dict[str, Any] = {"omega": [omega for omega, _ in rows]}
        if self._attitude is not None:
            found["attitude"] = [R.tolist() for _, R in rows if R is not None]
        return found

    def _course(self) -> Course:
        if self._free.outer is not None:
            return Turning(self._free, self._free.outer, self._attitude)
        if self._attitude is None:
            return Tumbling(self._free, None, FRAMES[0])
        if self._frame is None:
            self._frame = _best_frame(self._free)
        return Tumbling(self._free, self._attitude, self._frame)


@final
class Turning:
    """w turns in the body at a constant rate v, and the body about u: R = R(0) Rot(u t) Rot(-v t)."""

    def __init__(self, free: FreeGyrostat, outer: Vector, attitude: Quaternion | None) -> None:
        self._omega, self._outer, self._inner = free.omega, outer, free.inner
        self._start = None if attitude is None else unit(attitude)

    def at(self, t: arb) -> Row:
        inner = _turn(self._inner, t)
        omega = arb_mat(rotation_rows(inner)) * arb_mat(3, 1, balls(self._omega))
        if self._start is None:
            return omega.entries(), None
        turned = product(_turn(self._outer, t), conjugate(inner))
        return omega.entries(), arb_mat(rotation_rows(product(self._start, turned)))


def _turn(rate: Vector, t: arb) -> list[arb]:
    """The rotation at a constant rate for a time t."""
    speed = ball(dot(rate, rate)).sqrt()
    axis = [w / speed for w in balls(rate)] if any(rate) else balls(rate)
    return turn(axis, speed * t / 2)


@final
class Tumbling:
    """omega and R of a motion that is not a uniform turning."""

    def __init__(self, free: FreeGyrostat, attitude: Quaternion | None, frame: Frame) -> None:
        self._form = momentum_form(free).converted(ball)
        self._K = arb_mat([balls(row) for row in free.K])
        self._g = arb_mat(3, 1, balls(free.g))
        self._lattice = lattice(*free.invariants)
        self._omega = balls(free.omega)
        self._azimuth: Azimuth | None = None
        if attitude is not None:
            self._azimuth = Azimuth(free, point_map(free), frame, self._lattice)
            start = arb_mat([balls(row) for row in rotation_matrix(attitude)])
            self._start = start
            self._to_space = start * self._azimuth.tilt(balls(free.momentum))

    def at(self, t: arb) -> Row:
        if t.is_zero():
            return self._omega, self._start if self._azimuth else None
        P, slope = (value.real for value in self._lattice.p(acb(t)))
        G = self._form.at(P, slope)
        omega = (self._K * arb_mat(3, 1, G) - self._g).entries()
        if self._azimuth is None:
            return omega, None
        turned = self._azimuth.turn(t) * self._azimuth.tilt(G).transpose()
        return omega, self._to_space * turned


@final
class Azimuth:
    """phi(t) of one frame, as the rotation by it, and M(t)."""

    def __init__(self, free: FreeGyrostat, place: PointMap, frame: Frame, curve: Lattice) -> None:
        self._lattice, self._c = curve, balls(frame.c)
        self._N = ball(free.n).sqrt()
        self._factors = []
        self._rate = rate_at_start(free, frame.c, self._N, ball)
        for pole in poles(free, place.converted(ball), frame, _BALLS):
            argument = curve.argument(pole.p, pole.slope)
            value, slope = curve.jet(-argument, 1)
            self._factors.append(_Factor(argument, 1 / value, pole.sigma))
            self._rate -= pole.sigma * (slope / value).imag

    @property
    def distance(self) -> float:
        """The least distance of a pole from the real line; zero if a pole is at no finite place."""
        if not all(f.argument.is_finite() and f.scale.is_finite() for f in self._factors):
            return 0.0
        return min(abs(float(factor.argument.imag.mid())) for factor in self._factors)

    def turn(self, t: arb) -> arb_mat:
        """Rz(phi)."""
        quotient = acb(1)
        for argument, scale, sigma in self._factors:
            value = self._lattice.jet(t - argument, 0)[0] * scale
            quotient *= value if sigma > 0 else value.conjugate()
        sin, cos = (self._rate * t).sin_cos()
        # A factor for sigma = -1 is inverted; once its modulus is left out that is the conjugate.
        circle = quotient / abs(quotient) * acb(cos, sin)
        x, y = circle.real, circle.imag
        return arb_mat([[x, -y, 0], [y, x, 0], [0, 0, 1]])

    def tilt(self, G: Sequence[arb]) -> arb_mat:
        """M, whose columns are m1, m2, m3."""
        m3 = [component / self._N for component in G]
        along = sum((p * q for p, q in zip(self._c, m3, strict=True)), arb(0))
        across = [p - along * q for p, q in zip(self._c, m3, strict=True)]
        length = sum((p * p for p in across), arb(0)).sqrt()
        m1 = [component / length for component in across]
        return arb_mat([m1, cross(m3, m1), m3]).transpose()


class _Factor(NamedTuple):
    argument: acb
    scale: acb
    sigma: int


def _best_frame(free: FreeGyrostat) -> Frame:
    """Return the frame whose poles are farthest from the real line; any that has them would be right."""
    distances, place, curve = {}, point_map(free), lattice(*free.invariants)
    for number, frame in enumerate(FRAMES):
        with suppress(Undecidable, ZeroDivisionError):
            distance = Azimuth(free, place, frame, curve).distance
            if distance > 0:
                distances[number] = distance
    if not distances:
        raise Undecidable
    return FRAMES[max(distances, key=distances.__getitem__)]
