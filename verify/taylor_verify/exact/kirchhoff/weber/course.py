"""Weber's motion in balls: the impulses, and with them the attitude and the centre by certified quadrature.

Legend: that of panels.py. With M = (m1, m2, m3), m3 = n = x/F, m1 along the part of c across n and
m2 = m3 x m1,

    R = S Rz(phi) M^T,    centre = X0 (X0.c0/F + Z)/F + X0 x (M0 - R y)/F^2,

where X0 = R x and M0 = R y + centre x X0 are constant in space, and S = R0 M at the start. The angle phi is
added up over the panels; where the next one has another axis, the angle between both m1 is added too. So no
rotations are multiplied on the way, and the radius grows with the number of panels alone.

The panels and the angles at their ends are kept for later times.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import cache, lru_cache
from math import ceil, log2
from typing import Any, NamedTuple, final

from flint import arb, arb_mat, ctx

from taylor_verify.exact.balls import Enclosed, Enclosure, Undecidable, ball, ball_matrix, balls
from taylor_verify.exact.kirchhoff.weber.curve import REGIME, Curve
from taylor_verify.exact.kirchhoff.weber.enclosure import Quotients
from taylor_verify.exact.kirchhoff.weber.panels import (
    BEYOND,
    RHO,
    Integrands,
    Panel,
    Panels,
    exactly,
)
from taylor_verify.exact.rotation import cross, rotation_matrix
from taylor_verify.exact.solution import Time
from taylor_verify.scenes import tensors
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Impulse


@final
class WeberBalls(Enclosed):
    """A motion of Weber's case in balls."""

    regime = REGIME

    def __init__(self, curve: Curve, body: ImmersedBody, track: frozenset[str]) -> None:
        self._curve, self._body, self._track = curve, body, track
        self.by_quadrature = bool(track)
        self._frames: dict[int, Frames] = {}

    def enclose(self, elapsed: Sequence[Time], bits: int) -> Enclosure:
        if bits not in self._frames:
            self._frames[bits] = Frames(self._curve, self._body, bits)
        frames, start = self._frames[bits], self._curve.start
        # The start as given: a zero of the start must be exactly zero.
        given_start = {
            "linear_impulse": balls(start.linear),
            "angular_impulse": balls(start.angular),
            "attitude": ball_matrix(rotation_matrix(start.attitude)).tolist(),
            "centre": balls(start.centre),
        }
        rows = [given_start if t == 0 else frames.at(ball(t), self._track) for t in elapsed]
        names = ("linear_impulse", "angular_impulse", *sorted(self._track))
        return {name: [row[name] for row in rows] for name in names}


class _End(NamedTuple):
    """phi, of the axis of the panel that begins here, and Z."""

    azimuth: arb
    rise: arb


@final
class Frames:
    """The motion at one precision, to be used at that precision."""

    def __init__(self, curve: Curve, body: ImmersedBody, bits: int) -> None:
        self._curve, self._body, self._bits = curve, body, bits
        self._motion = Quotients(curve)
        self._integrands = Integrands.of(body, self._motion.F, ball)
        self._ends: dict[int, list[_End]] = {}
        self._integrals: dict[tuple[Fraction, Fraction], tuple[arb, arb]] = {}
        self._space = _Space(curve.start, self._motion.F)

    def at(self, t: arb, track: frozenset[str]) -> dict[str, Any]:
        """Return all tracked quantities at a time that is not zero."""
        x, y = self._motion.at(t)
        row: dict[str, Any] = {"linear_impulse": x, "angular_impulse": y}
        if track:
            n = [entry / self._motion.F for entry in x]
            first, last, (azimuth, rise) = self._reached(t)
            R = self._space.attitude(first, last, azimuth, n)
            row["attitude"] = R.tolist()
            row["centre"] = self._space.centre(R, y, rise)
        return row

    def _reached(self, t: arb) -> tuple[int, int, _End]:
        """The axes at the start and at a time, and phi and Z then."""
        middle = exactly(t.mid())
        side = 1 if middle > 0 else -1
        panels = _panels(self._curve, self._body, side).until(middle)
        number = next(k for k, panel in enumerate(panels) if abs(panel.end) >= abs(middle))
        panel, begin = panels[number], self._begins(side, panels, number)
        azimuth, rise = self._integral(panel, middle)
        # The middle lies in the panel, and the bounds hold in its ellipse: the ball must not leave it.
        if not t.rad() <= ball(panel.half * BEYOND):
            raise Undecidable
        spread = arb(0, 1) * t.rad()
        end = _End(
            begin.azimuth + azimuth + panel.azimuth * spread,
            begin.rise + rise + panel.rise * spread,
        )
        return panels[0].axis, panel.axis, end

    def _begins(self, side: int, panels: Sequence[Panel], number: int) -> _End:
        """phi and Z at the beginning of the panel of this number."""
        ends = self._ends.setdefault(side, [_End(arb(0), arb(0))])
        while len(ends) <= number:
            last, panel = ends[-1], panels[len(ends) - 1]
            azimuth, rise = self._integral(panel, panel.end)
            angle = last.azimuth + azimuth
            following = panels[len(ends)]
            if following.axis != panel.axis:
                x, _ = self._motion.at(ball(panel.end))
                n = [entry / self._motion.F for entry in x]
                angle += _angle_between(n, panel.axis, following.axis)
            ends.append(_End(angle, last.rise + rise))
        return ends[number]

    def _integral(self, panel: Panel, end: Fraction) -> tuple[arb, arb]:
        """The integrals of both integrands from the start of the panel to a point of it, found once."""
        if (panel.start, end) not in self._integrals:
            self._integrals[panel.start, end] = self._by_gauss(panel, end)
        return self._integrals[panel.start, end]

    def _by_gauss(self, panel: Panel, end: Fraction) -> tuple[arb, arb]:
        # The error of the azimuth is below its last place.
        bound = ball(panel.half) * panel.azimuth * 5
        excess = ceil(float(bound.log() / arb(2).log()))
        count = max(2, ceil((self._bits + max(excess, 0) + 2) / (2 * log2(RHO))))
        half, middle = ball((end - panel.start) / 2), ball((end + panel.start) / 2)
        azimuth, rise = arb(0), arb(0)
        for node, weight in _gauss(count, ctx.prec):
            n, y = self._motion.impulses(self._motion.jets(middle + half * node))
            azimuth += weight * self._integrands.azimuth(n, y, panel.axis)
            rise += weight * self._integrands.rise(n, y)
        part = (
            arb(64) / 15 * ball(Fraction(1, RHO ** (2 * count))) / (1 - ball(Fraction(1, RHO**2)))
        )
        return (
            half * (azimuth + arb(0, 1) * part * panel.azimuth),
            half * (rise + arb(0, 1) * part * panel.rise),
        )


# No panel depends on the precision of the motion: one body's rungs may share them.
@lru_cache(maxsize=8)
def _panels(curve: Curve, body: ImmersedBody, side: int) -> Panels:
    return Panels(curve, body, side)


@cache
def _gauss(count: int, bits: int) -> list[tuple[arb, arb]]:
    """The nodes and weights of Gauss's rule; ``bits`` is the ambient precision."""
    return [arb.legendre_p_root(count, k, weight=True) for k in range(count)]


@final
class _Space:
    """The quantities that are constant in space, in balls."""

    def __init__(self, start: Impulse, F: arb) -> None:
        self._F, self._start = F, start
        to_space = rotation_matrix(start.attitude)
        self._to_space = ball_matrix(to_space)
        X0 = tensors.apply(to_space, start.linear)
        moment = tensors.plus(
            tensors.apply(to_space, start.angular), tensors.cross(start.centre, X0)
        )
        self._X0, self._moment = balls(X0), balls(moment)
        self._along = ball(tensors.dot(X0, start.centre))

    def attitude(self, first: int, axis: int, azimuth: arb, n: Sequence[arb]) -> arb_mat:
        """R = S Rz(phi) M^T."""
        sine, cosine = azimuth.sin_cos()
        turn = arb_mat([[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1]])
        start = [ball(entry) / self._F for entry in self._start.linear]
        columns, inverse = _triad(start, first).transpose(), _triad(n, axis)
        return self._to_space * columns * turn * inverse

    def centre(self, R: arb_mat, y: Sequence[arb], rise: arb) -> list[arb]:
        moment = (R * arb_mat(3, 1, list(y))).entries()
        aside = cross(self._X0, [a - b for a, b in zip(self._moment, moment, strict=True)])
        F = self._F
        along = (self._along / F + rise) / F
        return [x * along + a / F**2 for x, a in zip(self._X0, aside, strict=True)]


def _triad(n: Sequence[arb], axis: int) -> arb_mat:
    """M^T: its rows are m1, m2 and m3."""
    i, j = (axis + 1) % 3, (axis + 2) % 3
    square = n[i] * n[i] + n[j] * n[j]
    length = square.sqrt()
    m1 = [-n[axis] * entry / length for entry in n]
    m1[axis] = length  # 1 - n_c^2 over the length
    return arb_mat([m1, cross(list(n), m1), list(n)])


def _angle_between(n: Sequence[arb], before: int, after: int) -> arb:
    """The angle about n from the m1 of the axis ``before`` to that of the axis ``after``."""
    old, new = _triad(n, before), _triad(n, after)
    cosine, sine = (sum((old[row, k] * new[0, k] for k in range(3)), arb(0)) for row in (0, 1))
    if cosine.mid() < 0:  # away from the cut
        return arb.atan2(-sine, -cosine) + arb.pi()
    return arb.atan2(sine, cosine)
