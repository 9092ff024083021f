"""Where the bead on the washboard turns back, in balls: what both routes know of it beforehand.

Legend as in board. nu^2 = F(sigma) >= 0 confines sigma to the component about 0 of where F is not
negative. There is always a ``lower`` end. Where there is an ``upper`` one the motion is a swing.

kappa > 0: F is concave, so that each side of 0 has one root at most; the upper one is missing where the
part of v that grows is exactly zero.
kappa < 0: F' = slope - R cos(x + delta) with x = 2 Omega sigma, R^2 = 4 |kappa| P^2 + Q^2; if R > slope
it has minima at x_n = gamma - delta + 2 pi n, cos gamma = slope/R, and F rises by pi slope/Omega from
each to the next. So there is an upper end if and only if F < 0 at the first minimum above 0.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

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


@dataclass(frozen=True)
class Turnings:
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
    found = speed(board)
    if isinstance(found, Growing):
        return _of_growth(found)
    assert isinstance(found, Swinging)
    return _of_steep(found) if board.tilt_squared >= 0 else _of_teeth(found)


def _of_growth(F: Growing) -> Turnings:
    """kappa > 0."""
    board, zero = F.board, arb(0)
    top = zero if board.nu else _summit(F)
    starts_above = not board.nu and board.push < 0
    starts_below = not board.nu and board.push > 0
    lower = zero if starts_below else _root(F, top, _beyond(F, top, -1))
    if board.never_climbs:
        return Turnings(lower, None)
    upper = zero if starts_above else _root(F, top, _beyond(F, top, 1))
    return Turnings(lower, upper)


def _summit(F: Growing) -> arb:
    """Where F, kappa > 0, is largest; anywhere above 0 if it grows for ever."""
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
    board = F.board
    if not board.nu:
        return Turnings(arb(0), None)
    amplitude = _swing(F) / (2 * F.rate)
    start, most = F.squared(arb(0)), 4 * amplitude
    reach = (start + most + F.slope / F.rate) / F.slope
    _counted(reach * F.rate / arb.pi())
    before = ((start - most) / F.slope).max(arb(0))
    return Turnings(_root(F, -before.mid(), -reach.mid()), None)


def _of_teeth(F: Swinging) -> Turnings:
    """kappa < 0 and F has minima."""
    board, zero = F.board, arb(0)
    minimum = _minima(F)
    n = _first(minimum)
    top, floor = minimum(n), F.squared(minimum(n))
    starts_below = not board.nu and board.push > 0
    starts_above = not board.nu and board.push < 0
    # From a start at rest the search begins at the maximum between the two minima.
    middle = zero if board.nu else (top - _descent(F)).mid()
    drop = arb.pi() * F.slope / F.rate
    if floor > 0:
        teeth = _counted(floor / drop) + 1
        deep = minimum(n - teeth)
        before = minimum(n - teeth + 1).mid() if teeth > 1 else middle
        lower = zero if starts_below else _root(F, before, deep.mid())
        return Turnings(lower, None)
    if not (floor < 0 and top > 0):
        raise Undecidable
    lower = zero if starts_below else _root(F, middle, minimum(n - 1).mid())
    upper = zero if starts_above else _root(F, middle, top.mid())
    return Turnings(lower, upper)


def _swing(F: Swinging) -> arb:
    """R."""
    sine = 2 * F.rate * F.even
    return (sine * sine + F.odd * F.odd).sqrt()


def _minima(F: Swinging) -> Callable[[int], arb]:
    """sigma of the minimum number n of F."""
    gamma = (F.slope / _swing(F)).acos()
    delta = arb.atan2(2 * F.rate * F.even, F.odd)
    return lambda n: (gamma - delta + 2 * n * arb.pi()) / (2 * F.rate)


def _descent(F: Swinging) -> arb:
    """The way in sigma from a maximum to the next minimum above it."""
    return (F.slope / _swing(F)).acos() / F.rate


def _first(minimum: Callable[[int], arb]) -> int:
    """The number of the first minimum that is not surely below the start; the one before it is.

    Where it cannot be told whether this one is above the start, F is nu0^2 there, all but exactly.
    """
    n = -2
    while minimum(n) < 0:
        n += 1
    return n


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
