"""The motion of any scene, enclosed: the steps, the outputs and the precision."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import ceil, log2
from statistics import median
from typing import Any, Final, final

from flint import arb, ctx

from verify.exact.balls import Coarse, Enclosed, Enclosure, ball, balls
from verify.exact.enclosure.box import Box, Flow, carried, exponent, flow, within
from verify.exact.enclosure.placing import Leg, Place, leg
from verify.exact.enclosure.series import Series, scaled, state_series
from verify.exact.enclosure.system import Balls, Bounds, System, column, magnitudes, posed
from verify.exact.enclosure.tube import (
    BOUND_BITS,
    StepTooLong,
    Tube,
    rates_of_change,
    tube,
)
from verify.exact.rotation import rotation_matrix
from verify.exact.solution import NO_CLOSED_FORM, Unsettled
from verify.scenes.motion import Impulse
from verify.scenes.precision import floor_log2, power_of_two
from verify.scenes.scene import Scene

# The cheapest step is the radius of convergence over e^2: bits ln 2/2 orders. The linear part of the
# cost asks for a few more.
_ORDERS_PER_BIT: Final = 0.36
_STEP_BITS: Final = 8
# Beside a steady motion the series converges for ever, and the bounds do not close.
_MOST_GROWTH: Final = 5.0
_HALVINGS: Final = 30
# A turn by this share of the order has its last term below the last bit.
_TURN_PER_ORDER: Final = 1 / 20
_MOST_STEPS: Final = 1_000_000
_MOST_BITS: Final = 10_000
# A box so large, as a power of two of its vector, is lost: steps shrink with it for ever.
_LOST: Final = -10
_SHRUNK: Final = -20
_SEVERAL: Final = 16


@final
@dataclass(frozen=True)
class EnclosedMotion(Enclosed):
    """The motion of any scene, free or loaded, in balls that are proven to contain it."""

    scene: Scene

    route = "taylor"
    regime = NO_CLOSED_FORM

    def enclose(self, elapsed: Sequence[Fraction], bits: int) -> Enclosure:
        """Balls about the tracked quantities. Raises Coarse where more bits are needed.

        Raises Unsettled where more than a million steps, or ten thousand bits, would be needed.
        """
        rows = {Fraction(0): self._start()}
        later = sorted({t for t in elapsed if t > 0})
        earlier = sorted({t for t in elapsed if t < 0}, reverse=True)
        for times in filter(None, (later, earlier)):
            rows.update(_Course(self._system, self._place, bits).rows(times))
        return self._quantities([rows[t] for t in elapsed])

    @cached_property
    def _system(self) -> System:
        return posed(self.scene)

    @property
    def _place(self) -> Place | None:
        """The frame at the start, at the ambient precision; None where it is not tracked."""
        if not self.scene.track:
            return None
        initial = self.scene.initial
        has_centre = "centre" in self.scene.track and isinstance(initial, Impulse)
        centre = initial.centre if has_centre and isinstance(initial, Impulse) else None
        return Place.of(rotation_matrix(initial.attitude), centre)

    def _start(self) -> _Row:
        initial = self.scene.initial
        turn = [entry for row in rotation_matrix(initial.attitude) for entry in row]
        centre = balls(initial.centre) if isinstance(initial, Impulse) else None
        return _Row(balls(self._system.start), balls(turn), centre)

    def _quantities(self, rows: Sequence[_Row]) -> Enclosure:
        found: dict[str, Any] = {}
        if self.scene.model == "euler":
            found["omega"] = [row.state[:3] for row in rows]
        else:
            found["linear_impulse"] = [row.state[:3] for row in rows]
            found["angular_impulse"] = [row.state[3:6] for row in rows]
        if self.scene.track:
            found["attitude"] = [[row.turn[i : i + 3] for i in (0, 3, 6)] for row in rows]
        if "centre" in self.scene.track:
            found["centre"] = [row.centre for row in rows]
        return found


@dataclass(frozen=True)
class _Row:
    """The state at one time in balls; ``turn`` is R, nine entries row by row."""

    state: list[arb]
    turn: list[arb]
    centre: list[arb] | None


@dataclass(frozen=True)
class _Step:
    """One step of length h from a box, and everything that is known about the motion within it."""

    length: Fraction
    state: Series
    tube: Tube
    flow: Flow | None
    leg: Leg | None


@dataclass(frozen=True)
class _Course:
    """Steps from the start, away from it, at one precision."""

    system: System
    place: Place | None
    bits: int

    @property
    def order(self) -> int:
        return ceil(_ORDERS_PER_BIT * self.bits) + 2

    def rows(self, times: Sequence[Fraction]) -> Iterator[tuple[Fraction, _Row]]:
        """The state at these times, which go away from zero on one side."""
        system, now, last = Balls.of(self.system), Fraction(0), times[-1]
        with ctx.workprec(BOUND_BITS):
            bounds = Bounds.of(system)
        box, place = Box.about(balls(self.system.start)), self.place
        pending, lengths = list(times[::-1]), []
        largest = [_size(box.point, span) for span in self.system.spans]
        length = last
        while pending:
            step = self._step(system, bounds, box, length, last - now)
            while pending and abs(pending[-1] - now) <= abs(step.length):
                time = pending.pop()
                yield time, self._row(box, place, step, ball((time - now) / step.length))
            box = carried(box, step.state, step.tube, step.flow, self.system.spans)
            place = None if place is None or step.leg is None else step.leg.carried(place)
            now, length = now + step.length, 2 * step.length
            lengths.append(abs(step.length))
            self._refuse_endless(len(lengths) + abs(last - now) / lengths[-1], last)
            self._watch(box, largest, lengths, now, last)

    def _row(self, box: Box, place: Place | None, step: _Step, s: arb) -> _Row:
        state = within(box, step.state, step.tube, step.flow, s)
        if place is None or step.leg is None:
            return _Row(state, [], None)
        turn, centre = step.leg.within(place, s)
        return _Row(state, turn, centre)

    # One step.

    def _step(
        self, system: Balls, bounds: Bounds, box: Box, guess: Fraction, left: Fraction
    ) -> _Step:
        length = self._first(bounds, box, guess, left)
        state = state_series(system, box.point, ball(length), self.order)
        length, state = self._fitted(system, bounds, state, length, left)
        for _ in range(_HALVINGS):
            h = ball(length)
            with ctx.workprec(BOUND_BITS):
                sizes = [[z.abs_upper() for z in row] for row in state]
                try:
                    found = tube(bounds, sizes, h.abs_upper(), box.apart())
                    moving = None
                    if not box.is_point:
                        moving = flow(system, bounds, state, sizes, h, found)
                except StepTooLong:
                    found = None
            if found is not None:
                there = None
                if self.place is not None:
                    has_centre = self.place.centre is not None
                    there = leg(system, bounds, state, h, found, moving, box, has_centre)
                return _Step(length, state, found, moving, there)
            state, length = scaled(state, arb(1) / 2), length / 2
        raise Coarse(2 * self.bits)

    def _first(self, bounds: Bounds, box: Box, guess: Fraction, left: Fraction) -> Fraction:
        """A length at which the coefficients are no giants: no guess can make a result wrong."""
        with ctx.workprec(BOUND_BITS):
            growth = self._growth(bounds, [[abs(z).upper() for z in box.point]])
        length = guess if abs(guess) < abs(left) else left
        if growth == float("-inf"):
            return length
        limit = power_of_two(ceil(-growth))
        return length if abs(length) <= limit else limit * (1 if left > 0 else -1)

    def _growth(self, bounds: Bounds, state: Series) -> float:
        """log2 of the largest row sum of |dF/dz| at the first coefficients, in units of the blocks."""
        rates = rates_of_change(bounds, magnitudes(column(state[0])))
        units = [0.0] * self.system.size
        for span in self.system.spans:
            size = _first_size(state, span)
            for i in span:
                units[i] = size
        total = float("-inf")
        for i in range(self.system.size):
            for j in range(self.system.size):
                if not rates[i, j].is_zero() and units[i] > float("-inf") < units[j]:
                    total = max(total, exponent(rates[i, j]) + units[j] - units[i])
        return total

    def _fitted(
        self, system: Balls, bounds: Bounds, state: Series, length: Fraction, left: Fraction
    ) -> tuple[Fraction, Series]:
        """The length at which the last coefficients fall below the last bit, and the series there."""
        factor = self._root_test(state)
        with ctx.workprec(BOUND_BITS):
            growth = self._growth(bounds, state) + log2(abs(length))
            factor = min(factor, log2(_MOST_GROWTH) - growth)
            if self.place is not None:
                factor = min(factor, self._turning(system, state, length))
        fitted = left if factor > 1e9 else _cut(length, factor)
        if abs(fitted) >= abs(left):
            fitted = left
        return fitted, scaled(state, ball(fitted / length))

    def _root_test(self, state: Series) -> float:
        """log2 of the factor by which the length may grow; infinite where the series has ended."""
        factor = float("inf")
        for span in self.system.spans:
            size = _first_size(state, span)
            for k in range(max(1, self.order - 2), self.order + 1):
                last = _size(state[k], span)
                if last > float("-inf"):
                    factor = min(factor, (size - self.bits - last) / k)
        return factor

    def _turning(self, system: Balls, state: Series, length: Fraction) -> float:
        """log2 of the factor at which the frame turns by no more than its series can follow."""
        most = log2(max(1.0, self.order * _TURN_PER_ORDER))
        spins = [
            _size((system.spin * column(z)).entries(), range(3)) + log2(abs(length)) for z in state
        ]
        return min((most - spin) / (k + 1) for k, spin in enumerate(spins))

    # When to stop.

    def _watch(
        self, box: Box, largest: list[float], lengths: list[Fraction], now: Fraction, last: Fraction
    ) -> None:
        """Raise Coarse where the box is lost: as large as the motion, or steps that end nowhere."""
        apart = box.apart().entries()
        for k, span in enumerate(self.system.spans):
            largest[k] = max(largest[k], _size(box.point, span))
            if _size(apart, span) > largest[k] + _LOST and now != last:
                raise Coarse(self._needed(now, last))
        if len(lengths) % _SEVERAL == 0:
            usual = float(median(lengths[-8 * _SEVERAL :]))
            if float(lengths[-1]) < usual * 2.0**_SHRUNK:
                raise Coarse(self._needed(now, last))

    def _needed(self, lost: Fraction, last: Fraction) -> int:
        """The bits with which the box would reach the end, if it grows as it did so far."""
        rate = self.bits / abs(lost)
        needed = ceil(rate * abs(last))
        if needed > _MOST_BITS:
            digits = float(rate) * log2(2) / log2(10)
            raise Unsettled(
                f"the motion loses about {digits:.2g} digits per unit of time; a time of "
                f"{float(abs(last)):g} from the start needs more than {_MOST_BITS} bits"
            )
        return min(max(needed, self.bits * 5 // 4), 6 * self.bits)

    def _refuse_endless(self, steps: Fraction, last: Fraction) -> None:
        if steps > _MOST_STEPS:
            raise Unsettled(
                f"the Taylor enclosure would take about {float(steps):.1e} steps to reach a time of "
                f"{float(last):g}; expected at most {_MOST_STEPS}: ask for a shorter time"
            )


def _cut(length: Fraction, log2_factor: float) -> Fraction:
    """The length times 2^log2_factor, cut to so few bits that sums of lengths stay short."""
    whole = int(log2_factor // 1)
    wide = length * power_of_two(whole) * Fraction(2.0 ** (log2_factor - whole))
    unit = power_of_two(floor_log2(abs(wide)) - _STEP_BITS + 1)
    return int(wide / unit) * unit


def _first_size(state: Series, span: range) -> float:
    """log2 of a block, or of what it first becomes; -inf where it stays zero."""
    for row in state[:3]:
        size = _size(row, span)
        if size > float("-inf"):
            return size
    return float("-inf")


def _size(entries: Sequence[arb], span: range) -> float:
    """log2 of the largest entry, rounded upwards; -inf of zeros."""
    sizes = [exponent(entries[i]) for i in span if not entries[i].abs_upper().is_zero()]
    return float(max(sizes, default=float("-inf")))
