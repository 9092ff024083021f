"""The bead on the washboard in balls: the time as a certified integral, and its inverse.

Legend as in board and turnings. Near an end e of the interval, side = +1 at the lower and -1 at the
upper one, put sigma = e + side y^2. Then F = y^2 g with an entire g, the quotient of speed times
side: g(0) = |F'(e)|, and g > 0 up to the other end. So

    t = int_0^y 2 dy/g^(1/2),    y' = g^(1/2)/2,    nu = side y g^(1/2),

where t counts from the turn and y from minus to plus through it: nu changes its sign with y, and there is
no branch of a root to be chosen. A swing goes from one end to the other; a point between them parts
the two integrals. The integrals are Arb's, adaptive and proven (Petras 2002); what they give at an exact y
is carried to the time asked for by the mean value theorem.
"""

from __future__ import annotations

from bisect import bisect_left
from contextlib import suppress
from fractions import Fraction
from typing import Final

from flint import acb, arb, ctx
from mpmath import mp, mpf

from taylor_verify.exact.balls import Undecidable, ball, balls, midpoint
from taylor_verify.exact.euler.moments.washboard.board import Washboard
from taylor_verify.exact.euler.moments.washboard.speed import Speed, Swinging, speed
from taylor_verify.exact.euler.moments.washboard.teeth import FarTeeth
from taylor_verify.exact.euler.moments.washboard.turnings import (
    MOST_TEETH,
    TOO_MANY_TEETH,
    regime,
    turnings,
)
from taylor_verify.exact.euler.rotations import OneByOne, RotationBalls, Rows
from taylor_verify.exact.integral import integral
from taylor_verify.exact.solution import Unsettled

_GUARD_BITS: Final = 40
_ATTEMPTS: Final = 8
_STEPS_PER_BIT: Final = 4
# An integral over a tooth takes ten, one past a crest that is all but a double root a hundred. Where the
# precision does not resolve the crest, no number of evaluations would.
_EVALUATIONS_PER_BIT: Final = 200
_WIDENINGS: Final = 20
# The last step of Newton's iteration is a few hundred last bits: the integrals are not better.
_ARRIVED_BITS: Final = 12


def motion(board: Washboard) -> RotationBalls:
    """omega of a triaxial body under a moment along a principal axis, which omega does not keep."""
    return RotationBalls(regime(board).value, lambda: Course(board), by_quadrature=True)


def period(board: Washboard) -> mpf:
    """The time after which omega of a swing recurs, to mpmath's precision.

    Raises Unsettled so near to a separatrix that some thousand digits do not suffice.
    """
    bits = mp.prec + _GUARD_BITS
    for _ in range(_ATTEMPTS):
        with ctx.workprec(bits), suppress(Undecidable):
            period = Course(board).period
            assert period is not None
            if period.rad() <= period * arb(2) ** -mp.prec:
                return +midpoint(period)
        bits *= 2
    raise Unsettled(f"the period is not known with {bits // 2} bits")


class Turn:
    """The motion through one turning point, at the precision of flint at which this was made."""

    def __init__(self, speed: Speed, end: arb, side: int) -> None:
        self._end, self.side = end, side
        self._quotient, self._rate = speed.quotient(end), speed.rate
        self._teeth = FarTeeth(speed) if isinstance(speed, Swinging) else None
        # The time at any place beyond the first teeth is this less the level there.
        self._level: arb | None = None
        # Exact places, sorted, and the times at which the bead is there; it is at 0 at the turn.
        self._places, self._times = [arb(0)], [arb(0)]

    def sigma(self, y: arb) -> arb:
        return self._end + self.side * y * y

    def nu(self, y: arb) -> arb:
        return self.side * y * self._root(y)

    def place(self, sigma: arb) -> arb:
        """y >= 0 of a phase on this side."""
        squared = self.side * (sigma - self._end)
        if not squared >= 0:
            raise Undecidable
        return squared.sqrt()

    def time(self, y: arb) -> arb:
        """t of a ball y >= 0."""
        at = y.mid()
        return self._time(at) + (y - at) * 2 / self._root(y)

    def at(self, t: arb) -> arb:
        """y of a ball t."""
        middle = t.mid()
        side = -1 if middle < 0 else 1
        y = self._near(abs(middle))
        # t(y) is monotonic: where y + (t - t(y)) y' lies inside the ball about y in which y' was taken,
        # the place at the time t does too.
        missing = side * t - self._time(y)
        if missing.is_zero():
            return side * y
        reach = abs(missing).upper() * self._root(y).upper()
        for _ in range(_WIDENINGS):
            about = arb(y, reach)
            better = y + missing * self._root(about) / 2
            if about.contains_interior(better):
                return side * better
            reach *= 2
        raise Undecidable

    def _near(self, t: arb) -> arb:
        """A place y >= 0 at about the exact time t >= 0, by Newton's iteration from the nearest known.

        Where it leaves the known places before and after t, or does not gain, that interval is halved:
        t rises like a step where the bead all but stops on a crest.
        """
        k = bisect_left(self._times, t, key=arb.mid)
        low = self._places[max(k - 1, 0)]
        high = self._places[k] if k < len(self._places) else None
        y = low
        if k and high is not None and self._times[k].mid() - t < t - self._times[k - 1].mid():
            y = high
        last: arb | None = None
        for _ in range(_STEPS_PER_BIT * ctx.prec):
            missing = (t - self._time(y)).mid()
            step = (missing * self._root(y) / 2).mid()
            if abs(step) <= y * arb(2) ** (_ARRIVED_BITS - ctx.prec):
                return y
            low, high = (y, high) if missing > 0 else (low, y)
            ahead = (y + step).mid()
            gains = last is None or abs(step) < last / 2
            last = abs(step)
            if high is None:
                y = min(ahead, self._further(y))
            else:
                y = ahead if gains and low < ahead < high else ((low + high) / 2).mid()
        raise Undecidable

    def _further(self, y: arb) -> arb:
        """The next place to try beyond the furthest known one: twice as far."""
        if y * y * self._rate > MOST_TEETH * arb.pi():
            raise Unsettled(TOO_MANY_TEETH)
        return (2 * y + 1 / self._rate.sqrt()).mid()

    def _time(self, y: arb) -> arb:
        """t at an exact y >= 0, from the nearest known place or, where that is far, over all teeth."""
        self._cross_teeth(y)
        k = bisect_left(self._places, y)
        if k < len(self._places) and self._places[k] == y:
            return self._times[k]
        beside = range(max(k - 1, 0), min(k + 1, len(self._places)))
        nearest = min(beside, key=lambda j: abs(self._places[j] - y))
        if (
            self._teeth is None
            or self._level is None
            or abs(y * y - self._places[nearest] ** 2) < 2 * self._teeth.width
        ):
            time = self._times[nearest] + self._way(self._places[nearest], y)
        else:
            time = self._level - self._teeth.level(self.sigma(y))
        self._places.insert(k, y)
        self._times.insert(k, time)
        return time

    def _cross_teeth(self, y: arb) -> None:
        """Sum the time tooth by tooth from the turn to y, or to where the teeth are summed all at once.

        An adaptive integral over many teeth would halve its interval without an end.
        """
        while self._teeth is not None and self._level is None:
            last = self._places[-1]
            if last * last >= self._teeth.first * self._teeth.width:
                self._level = self._times[-1] + self._teeth.level(self.sigma(last))
            elif y * y > last * last + self._teeth.width:
                stop = (last * last + self._teeth.width).sqrt().mid()
                self._times.append(self._times[-1] + self._way(last, stop))
                self._places.append(stop)
            else:
                break

    def _way(self, start: arb, stop: arb) -> arb:
        """The time from one exact place to another, which are at most a few teeth apart."""
        limit = _EVALUATIONS_PER_BIT * ctx.prec
        way = integral(self._integrand, acb(start), acb(stop), eval_limit=limit).real
        # Written so that what is not finite is not narrow.
        if not way.rad() <= abs(way) * arb(2) ** (-ctx.prec // 2):
            raise Undecidable
        return way

    def _root(self, y: arb) -> arb:
        """g^(1/2), which is positive."""
        g = self._g(acb(y)).real
        if not g > 0:
            raise Undecidable
        return g.sqrt()

    def _integrand(self, y: acb, analytic: bool) -> acb:
        return 2 / self._g(y).sqrt(analytic=analytic)

    def _g(self, y: acb) -> acb:
        return self.side * self._quotient(self.side * y * y)


class Course(OneByOne):
    """The course at one precision of flint."""

    def __init__(self, board: Washboard) -> None:
        self._speed, self._moment = speed(board), balls(board.moment)
        ends = turnings(board)
        self._lower = Turn(self._speed, ends.lower, 1)
        self._upper: Turn | None = None
        turn, start = self._lower, arb(0)
        if ends.upper is not None:
            self._upper = Turn(self._speed, ends.upper, -1)
            parting = ((ends.lower + ends.upper) / 2).mid()
            self._rise = self._lower.time(self._lower.place(parting))
            self._half = self._rise + self._upper.time(self._upper.place(parting))
            if parting < 0:
                turn, start = self._upper, self._half
        self._lead = start
        if board.nu:
            since = turn.time(turn.place(arb(0)))
            self._lead += since if (board.nu > 0) == (turn.side > 0) else -since

    @property
    def period(self) -> arb | None:
        """The time after which omega recurs; None for a run."""
        return None if self._upper is None else 2 * self._half

    def at(self, t: Fraction, turned: bool) -> tuple[list[arb], Rows]:
        """omega in body axes; of the turn nothing is known."""
        turn, since = self._turn(self._lead + ball(t))
        y = turn.at(since)
        nu, across = turn.nu(y), self._speed.across(turn.sigma(y))
        return [v + nu * m for v, m in zip(across, self._moment, strict=True)], []

    def _turn(self, since: arb) -> tuple[Turn, arb]:
        """The turn that is nearest at this time since one at the lower end, and the time since that."""
        if self._upper is None:
            return self._lower, since
        whole = (since / (2 * self._half)).mid() + arb("0.5")
        count = whole.floor().unique_fmpz()
        if count is None:
            raise Undecidable
        since -= 2 * int(count) * self._half
        if abs(since).mid() <= self._rise.mid():
            return self._lower, since
        return self._upper, since - self._half if since.mid() > 0 else since + self._half
