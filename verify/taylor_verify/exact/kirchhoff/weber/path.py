"""The attitude and the centre of Weber's motion in mpmath, from the azimuth of the body's own y.

Legend: n = x/F; X0 = R x and M0 = R y + centre x X0, constant in space. As x.y = 0, y is across the
impulse, and (R y)' = R (x x U) gives its azimuth about X0 at once; along it the centre goes by Z, by T:

    psi' = F y.U/y.y = F (b + sum p_i x_i y_i/y.y),    Z' = (2 T - y.C y)/F.

In a panel where y comes near to zero, the azimuth is that of a body axis, as in panels.py. The angles are
added up over panels of Gauss's rule, each halved until the last Legendre coefficients of both integrands
are small: the squares of these tell what the rule misses. Nothing here bounds an error: two precisions
must agree, which take panels of different widths.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Final, NamedTuple

from mpmath import mp, mpf
from mpmath.calculus.quadrature import GaussLegendre

from taylor_verify.exact.frames import Frame, applied, product, start_frame, transposed
from taylor_verify.exact.kirchhoff.weber.panels import Integrands
from taylor_verify.exact.solution import Unsettled
from taylor_verify.scenes import tensors
from taylor_verify.scenes.bodies import ImmersedBody
from taylor_verify.scenes.motion import Impulse

Row = list[mpf]
Impulses = tuple[Row, Row]

# mpmath's rules have 3 2^(degree - 1) nodes, enough for this many digits each.
_DEGREES: Final = ((5, 40), (6, 90), (7, 190), (8, 400))
_HALVINGS: Final = 30
# y is not used where its square becomes less than this part of the largest one in a panel.
_SHORT: Final = 0.25


class _Place(NamedTuple):
    """A time with the azimuth of the reference and Z there."""

    t: mpf
    azimuth: mpf
    rise: mpf


@dataclass(frozen=True)
class _Stage:
    """A panel: its end, its reference (a body axis, or None for y), and where it begins.

    ``width`` is the one to try next.
    """

    end: mpf
    axis: int | None
    begin: _Place
    width: mpf


class Path:
    """The frames of one motion, at one precision of mpmath and good only there.

    ``impulses`` gives x and y at a time, ``width`` is that of the first panel tried.
    """

    def __init__(
        self, impulses: Callable[[mpf], Impulses], body: ImmersedBody, start: Impulse, width: mpf
    ) -> None:
        self._impulses, self._width = impulses, width
        self._F = mp.sqrt(mp.convert(tensors.dot(start.linear, start.linear)))
        self._integrands = Integrands.of(body, self._F, mp.convert)
        z = start.moving
        self._twice_T = mp.convert(tensors.dot(z, tensors.apply(body.energy_matrix, z)))
        self._x, self._y = ([mp.convert(c) for c in v] for v in (start.linear, start.angular))
        self._to_space = start_frame(start.attitude)
        X0, Y0 = (applied(self._to_space, v) for v in (self._x, self._y))
        self._centre = [mp.convert(c) for c in start.centre]
        self._X0, self._moment = X0, _plus(Y0, _cross(self._centre, X0))
        self._stages: dict[int, list[_Stage]] = {1: [], -1: []}
        self._last: tuple[tuple[mpf, mpf] | None, list[Impulses]] = (None, [])

    def at(self, t: mpf, x: Row, y: Row) -> tuple[Frame, Row]:
        """The attitude and the centre at a time, where the impulses are x and y."""
        stage = self._stage(t)
        first = self._stages[1 if t > 0 else -1][0]
        _, azimuth, rise = self._advanced(stage, t)
        space = product(self._to_space, transposed(self._triad(self._x, self._y, first.axis)))
        cosine, sine = mp.cos_sin(azimuth)
        turn = [[cosine, -sine, mpf(0)], [sine, cosine, mpf(0)], [mpf(0), mpf(0), mpf(1)]]
        R = product(product(space, turn), self._triad(x, y, stage.axis))
        aside = _cross(self._X0, _plus(self._moment, [-entry for entry in applied(R, y)]))
        along = (mp.fdot(self._X0, self._centre) / self._F + rise) / self._F
        F2 = self._F**2
        return R, [along * a + b / F2 for a, b in zip(self._X0, aside, strict=True)]

    def _stage(self, t: mpf) -> _Stage:
        """The panel that holds a time, found after those before it."""
        stages, side = (self._stages[1], 1) if t > 0 else (self._stages[-1], -1)
        while not stages or abs(stages[-1].end) < abs(t):
            stages.append(self._next(stages[-1] if stages else None, side))
        return next(stage for stage in stages if abs(stage.end) >= abs(t))

    def _next(self, last: _Stage | None, side: int) -> _Stage:
        begin = _Place(mpf(0), mpf(0), mpf(0)) if last is None else self._advanced(last, last.end)
        width = self._width if last is None else last.width
        for halved in range(_HALVINGS):
            end = begin.t + side * width
            axis = self._reference(begin.t, end)
            if self._is_smooth(begin.t, end, axis):
                if last is not None and axis != last.axis:
                    x, y = self._impulses(begin.t)
                    turned = self._angle_between(x, y, last.axis, axis)
                    begin = begin._replace(azimuth=begin.azimuth + turned)
                return _Stage(end, axis, begin, width if halved else 2 * width)
            width /= 2
        raise Unsettled("an integral along Weber's motion does not settle")

    def _advanced(self, stage: _Stage, t: mpf) -> _Place:
        begin = stage.begin
        columns = zip(*self._rates(begin.t, t, stage.axis), strict=True)
        azimuth, rise = (mp.fdot(_rule()[1], rates) for rates in columns)
        half = (t - begin.t) / 2
        return _Place(t, begin.azimuth + half * azimuth, begin.rise + half * rise)

    def _states(self, start: mpf, end: mpf) -> list[Impulses]:
        """x and y at the nodes of Gauss's rule; those of the last panel are kept."""
        if self._last[0] != (start, end):
            half, middle = (end - start) / 2, (end + start) / 2
            states = [self._impulses(middle + half * node) for node in _rule()[0]]
            self._last = (start, end), states
        return self._last[1]

    def _rates(self, start: mpf, end: mpf, axis: int | None) -> list[tuple[mpf, mpf]]:
        """psi' and Z' at the nodes."""
        return [self._rate(x, y, axis) for x, y in self._states(start, end)]

    def _rate(self, x: Row, y: Row, axis: int | None) -> tuple[mpf, mpf]:
        own = self._integrands
        rise = self._twice_T - sum(r * entry**2 for r, entry in zip(own.r, y, strict=True))
        if axis is not None:
            azimuth = own.azimuth([entry / self._F for entry in x], y, axis)
        else:
            pull = sum(p * a * b for p, a, b in zip(own.p, x, y, strict=True))
            azimuth = self._F * (own.b + pull / mp.fdot(y, y))
        return azimuth, rise / self._F

    def _reference(self, start: mpf, end: mpf) -> int | None:
        """None for y, unless it comes near to zero; else the axis farthest from the impulse."""
        states = self._states(start, end)
        squares = [mp.fdot(y, y) for _, y in states]
        if min(squares) >= _SHORT * max(squares):
            return None
        return min(range(3), key=lambda c: max(abs(x[c]) for x, _ in states))

    def _is_smooth(self, start: mpf, end: mpf, axis: int | None) -> bool:
        """Return True if the last two Legendre coefficients say that the rule sees all."""
        nodes, weights = _rule()
        count = len(nodes)
        columns = list(zip(*self._rates(start, end, axis), strict=True))
        # At the nodes |P| of the degree count - 1 follows from the weights, and its sign alternates.
        last = [
            (-1) ** k * mp.sqrt(2 * (1 - node**2) / weight) / count
            for k, (node, weight) in enumerate(zip(nodes, weights, strict=True))
        ]
        before = [
            mpf(2 * count - 1) / (count - 1) * node * value
            for node, value in zip(nodes, last, strict=True)
        ]
        for rates in columns:
            scale = max(map(abs, rates))
            tail = sum(
                abs(mp.fsum(w * f * p for w, f, p in zip(weights, rates, basis, strict=True)))
                for basis in (last, before)
            )
            if not (count * tail) ** 2 <= mp.eps * scale**2:
                return False
        return True

    def _triad(self, x: Row, y: Row, axis: int | None) -> Frame:
        """M^T: the rows m1 along the part of the reference across n, m2 and m3 = n."""
        n = [entry / self._F for entry in x]
        v = y if axis is None else [mpf(k == axis) for k in range(3)]
        share = mp.fdot(v, n)
        across = [a - share * b for a, b in zip(v, n, strict=True)]
        length = mp.norm(across)
        m1 = [entry / length for entry in across]
        return [m1, _cross(n, m1), n]

    def _angle_between(self, x: Row, y: Row, before: int | None, after: int | None) -> mpf:
        old, new = self._triad(x, y, before), self._triad(x, y, after)
        return mp.atan2(mp.fdot(old[1], new[0]), mp.fdot(old[0], new[0]))


def _rule() -> tuple[Sequence[mpf], Sequence[mpf]]:
    """The nodes and weights of Gauss's rule for the ambient precision, in ascending order."""
    degree = next((d for d, digits in _DEGREES if mp.dps <= digits), _DEGREES[-1][0] + 1)
    return _nodes(degree, mp.prec)


@cache
def _nodes(degree: int, prec: int) -> tuple[Sequence[mpf], Sequence[mpf]]:
    pairs = sorted(GaussLegendre(mp).calc_nodes(degree, prec))
    return [node for node, _ in pairs], [weight for _, weight in pairs]


def _cross(a: Row, b: Row) -> Row:
    return [a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)]


def _plus(a: Row, b: Row) -> Row:
    return [p + q for p, q in zip(a, b, strict=True)]
