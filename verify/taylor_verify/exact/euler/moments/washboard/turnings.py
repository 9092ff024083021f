"""The turning points of the bead on the washboard, in balls.

Legend as in board. nu^2 = F(sigma) >= 0 confines sigma to the component about 0 of where F is not
negative. There is always a ``lower`` end. Where there is an ``upper`` one the motion is a swing.

kappa > 0: F is concave, so that each side of 0 has one root at most; the upper one is missing where the
part of v that grows is exactly zero.
kappa < 0: F' = slope - R cos(x + delta) with x = 2 Omega sigma, R^2 = 4 |kappa| P^2 + Q^2; if R > slope
it has minima at x_n = gamma - delta + 2 pi n, cos gamma = slope/R, and F rises by pi slope/Omega from
each to the next. So there is an upper end if and only if F < 0 at the first minimum above 0.
"""

from __future__ import annotations

from itertools import count
from typing import Final, NamedTuple

from flint import arb, ctx

from taylor_verify.exact.balls import Undecidable
from taylor_verify.exact.euler.moments.washboard.board import Washboard, WashboardRegime
from taylor_verify.exact.euler.moments.washboard.speed import Growing, Speed, Swinging, speed
from taylor_verify.exact.solution import NoClosedForm

# Each factor of ten takes a digit of the place on a tooth, and what is lost is computed in addition.
MOST_TEETH: Final = 10**40
# So far from its turn a body turns so much faster than the moment slows it that the first teeth are narrow
# gaps in deep walls: at 1e15 they take ten seconds, and at 1e30 more than a minute.
_MOST_BEFORE: Final = 10**20
TOO_MANY_TEETH: Final = (
    f"the time asked for lies more than {MOST_TEETH:.0e} teeth of the washboard after the turning "
    "point, and each factor of ten takes a digit of the place on a tooth"
)
_FIRST_BITS: Final = 128
_MOST_BITS: Final = 8192
_DOUBLINGS: Final = 1100


class Turnings(NamedTuple):
    """Balls about the ends of the interval of sigma; there is no ``upper`` one in a run."""

    lower: arb
    upper: arb | None


def regime(board: Washboard) -> WashboardRegime:
    """The kind of motion; a swing is told from a run in balls, at whatever precision that takes.

    Raises NoClosedForm where the motion is so near to the separatrix that thousands of digits do not
    tell, or where it began too many teeth of the washboard away from its turning point.
    """
    if board.is_steady:
        return WashboardRegime.STEADY
    if board.is_straight:
        return WashboardRegime.STRAIGHT
    return WashboardRegime.RUN if located(board).upper is None else WashboardRegime.SWING


def located(board: Washboard) -> Turnings:
    """The turnings at the least precision that tells them, some forty digits or more."""
    bits = _FIRST_BITS
    while bits <= _MOST_BITS:
        try:
            with ctx.workprec(bits):
                return turnings(board)
        except Undecidable:
            bits *= 2
    raise NoClosedForm("the start is too near to a separatrix")


def turnings(board: Washboard) -> Turnings:
    """The ends of the interval, at the ambient precision of flint.

    Raises Undecidable where the precision does not tell, NoClosedForm where there are too many teeth.
    """
    F = speed(board)
    if isinstance(F, Growing):
        return _of_growth(F)
    return _of_steep(F) if board.tilt_squared >= 0 else _of_teeth(F)


def _of_growth(F: Growing) -> Turnings:
    """kappa > 0."""
    top = arb(0) if F.board.nu else _summit(F)
    lower = _end(F, -1, top, _beyond(F, top, -1))
    return Turnings(lower, None if F.board.never_climbs else _end(F, 1, top, _beyond(F, top, 1)))


def _summit(F: Growing) -> arb:
    """The place where F, kappa > 0, is largest; anywhere above 0 if it grows for ever."""
    if F.board.never_climbs:
        return 1 / F.rate
    p, q = F.growing, F.falling
    half = F.slope / (4 * F.rate)
    # p is not zero, but its ball may hold zero.
    if not p > 0:
        raise Undecidable
    root = (half * half + p * q.nonnegative_part()).sqrt()
    return (((half + root) / p).log() / (2 * F.rate)).mid()


def _beyond(F: Growing, top: arb, side: int) -> arb:
    """A point on this side of the top where F is negative."""
    step = 1 / (2 * F.rate.mid())
    for _ in range(_DOUBLINGS):
        point = (top + side * step).mid()
        if F.squared(point) < 0:
            return point
        step *= 2
    raise Undecidable


def _of_steep(F: Swinging) -> Turnings:
    """kappa < 0 and F never falls: one root, where slope sigma has used up nu0^2 and what swings."""
    if not F.board.nu:
        return Turnings(arb(0), None)
    start, most = F.squared(arb(0)), 2 * F.swing / F.rate
    reach = (start + most + F.slope / F.rate) / F.slope
    _counted(reach * F.rate / arb.pi())
    before = ((start - most) / F.slope).max(arb(0))
    return Turnings(_root(F, -before.mid(), -reach.mid()), None)


def _of_teeth(F: Swinging) -> Turnings:
    """kappa < 0 and F has minima."""
    gamma = (F.slope / F.swing).acos()
    delta = arb.atan2(2 * F.rate * F.even, F.odd)

    def minimum(n: int) -> arb:
        return (gamma - delta + 2 * n * arb.pi()) / (2 * F.rate)

    # The first minimum that is not surely below the start; the one before it is. Where it cannot be told
    # whether this one is above the start, F is nu0^2 there, all but exactly.
    n = next(n for n in count(-2) if not minimum(n) < 0)
    top, floor = minimum(n), F.squared(minimum(n))
    # From a start at rest the search begins at the maximum between the two minima.
    middle = arb(0) if F.board.nu else (top - gamma / F.rate).mid()
    if floor > 0:
        teeth = _counted(floor / (arb.pi() * F.slope / F.rate)) + 1
        before = minimum(n - teeth + 1) if teeth > 1 else middle
        return Turnings(_end(F, -1, before, minimum(n - teeth)), None)
    if not (floor < 0 and top > 0):
        raise Undecidable
    return Turnings(_end(F, -1, middle, minimum(n - 1)), _end(F, 1, middle, top))


def _end(F: Speed, side: int, inside: arb, outside: arb) -> arb:
    """The end on this side: exactly the start, where the motion begins at rest there, or a root."""
    if not F.board.nu and side * F.board.push < 0:
        return arb(0)
    return _root(F, inside, outside)


def _counted(teeth: arb) -> int:
    """The whole part; raises NoClosedForm beyond what is computed."""
    if not teeth < _MOST_BEFORE:
        if teeth > _MOST_BEFORE - 1:
            raise NoClosedForm(
                f"more than {_MOST_BEFORE:.0e} teeth of the washboard lie between the start and the "
                "turning point: the moment is too weak"
            )
        raise Undecidable
    count = teeth.floor().unique_fmpz()
    if count is None:
        raise Undecidable
    return int(count)


def _root(F: Speed, inside: arb, outside: arb) -> arb:
    """A ball about the one change of sign of F between a point where F >= 0 and one where F < 0.

    Newton's steps as long as they stay between the two, else halves; both ends are points, and what is
    returned is what lies between two points at which the signs are proven.
    """
    inside, outside = inside.mid(), outside.mid()
    if not F.squared(outside) < 0:
        raise Undecidable
    point = ((inside + outside) / 2).mid()
    for _ in range(2 * ctx.prec):
        value = F.squared(point)
        if value > 0:
            inside = point
        elif value < 0:
            outside = point
        else:
            return _certified(F, point, inside, outside)
        step = value / F.derivative(point)
        ahead = (point - step).mid()
        low, high = (inside, outside) if inside < outside else (outside, inside)
        point = ahead if low < ahead < high else ((inside + outside) / 2).mid()
    return _certified(F, point, inside, outside)


def _certified(F: Speed, point: arb, inside: arb, outside: arb) -> arb:
    """The point and as much beside it as it takes to prove both signs."""
    width = abs(inside - outside).mid()
    side = 1 if outside > inside else -1
    slack = (abs(point) + width) * arb(2) ** -ctx.prec
    while slack < width:
        within, beyond = (point - side * slack).mid(), (point + side * slack).mid()
        if F.squared(within) > 0 and F.squared(beyond) < 0:
            return within.union(beyond)
        slack *= 4
    return inside.union(outside)
