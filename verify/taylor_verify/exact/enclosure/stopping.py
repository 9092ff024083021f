"""Limits of a course: it stops for more bits, or for good."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from decimal import MAX_EMAX, MIN_EMIN, Decimal, localcontext
from fractions import Fraction
from math import ceil
from statistics import median
from typing import Final

from taylor_verify.exact.enclosure.box import Box
from taylor_verify.exact.enclosure.step import size_of
from taylor_verify.exact.solution import Unsettled
from taylor_verify.numbers.precision import double_text, float_text, power_of_two
from taylor_verify.records.faults import shown
from taylor_verify.scenes.loads.loads import Loads

MOST_STEPS: Final = 1_000_000
# A box this large, as a power of two of its vector, is lost: further steps would shrink without end.
_LOST: Final = -10
_SHRUNK: Final = -20
_SEVERAL: Final = 16
_BEFORE_A_KINK: Final = 3
_DIGITS_PER_BIT: Final = Fraction(301, 1000)


class Coarse(ArithmeticError):
    """The motion cannot be followed to its end at this precision; ``bits`` may suffice.

    ``stuck`` is the first time that was not reached though the box was narrow, and ``because`` says why;
    None where the box was lost.
    """

    def __init__(self, bits: int, stuck: Fraction | None = None, because: str = "") -> None:
        super().__init__()
        self.bits, self.stuck, self.because = bits, stuck, because


class Unreached(Unsettled):
    """More steps or more bits would be needed than there may be; ``time`` is the first one to need them.

    With ``is_end`` the motion itself ends before that time.
    """

    def __init__(self, because: str, time: Fraction, is_end: bool = False) -> None:
        super().__init__(because, is_end=is_end)
        self.time = time


def reaching(loads: Loads, time: Fraction) -> Loads:
    """The loads as far as an elapsed time; stairs of floor are listed so far. Raises Unreached."""
    try:
        further = loads.reaching(time)
        _ = further.switches
    except ValueError as fault:
        raise Unreached(str(fault), time) from None
    return further


@dataclass(frozen=True)
class Watch:
    """The limits of a course of so many ``bits``; ``spans`` are the blocks by which a box is lost."""

    bits: int
    most_bits: int
    most_steps: int
    begin: Fraction
    spans: Sequence[range]

    def stuck(self, because: str, now: Fraction, pending: Sequence[Fraction]) -> Coarse:
        """The exception for a motion that cannot be followed from here, with however many bits."""
        return Coarse(
            2 * self.bits, pending[-1], f"{because} near t = {float_text(self.begin + now)}"
        )

    def check(
        self,
        box: Box,
        largest: Sequence[float],
        lengths: Sequence[Fraction],
        steps: int,
        now: Fraction,
        pending: Sequence[Fraction],
    ) -> None:
        """Raise Coarse where the box is lost: as large as the motion, or steps that end nowhere.

        Raises Unreached where there would be too many steps. ``pending`` has the nearest time last, and
        ``lengths`` are those of the steps that nothing cut short.
        """
        apart = box.apart.entries()
        is_lost = any(
            size_of(apart, span) > largest[k] + _LOST for k, span in enumerate(self.spans)
        )
        if is_lost and not lengths:
            raise Coarse(self.needed(now, pending))
        if lengths and (is_lost or len(lengths) % _SEVERAL == 0):
            usual = median(lengths if is_lost else lengths[-8 * _SEVERAL :])
            # A step or two that end before a kink, and are next to nothing, are no end of the motion.
            has_shrunk = max(lengths[-_BEFORE_A_KINK - 1 :]) < usual * power_of_two(_SHRUNK)
            # Steps that shrink in front of an end of the motion lose every box at last.
            if has_shrunk and (is_lost or self._is_narrow(box)):
                because = "steps become ever shorter, as where a motion ends or a kink is touched,"
                raise self.stuck(because, now, pending)
            if is_lost or has_shrunk:
                raise Coarse(self.needed(now, pending))
            limit = abs(now) + (self.most_steps - steps) * usual
            if abs(pending[0]) > limit and not _still_shrinks(lengths):
                time = next(time for time in reversed(pending) if abs(time) > limit)
                needed, usual_text = steps + abs(time - now) / usual, float_text(usual)
                raise Unreached(
                    f"the Taylor series would take about {_brief(needed)} steps to reach "
                    f"t = {self._shown(time)}, each of about {usual_text} from "
                    f"t = {double_text(self.begin + now)} on; expected at most {self.most_steps}",
                    time,
                )

    def _is_narrow(self, box: Box) -> bool:
        """True if half of the bits are right in every block."""
        apart = box.apart.entries()
        return all(
            size_of(apart, span) <= size_of(box.point, span) - self.bits / 2 for span in self.spans
        )

    def needed(self, lost: Fraction, pending: Sequence[Fraction]) -> int:
        """The bits with which the box would reach the last time, if it grows as it did so far."""
        rate = self.bits / abs(lost)
        for time in reversed(pending):
            needed = ceil(rate * abs(time))
            if needed > self.most_bits:
                raise Unreached(
                    f"the motion loses about {_brief(rate * _DIGITS_PER_BIT)} digits per unit of time; "
                    f"t = {self._shown(time)} needs more than {self.most_bits} bits",
                    time,
                )
        return min(max(needed, self.bits * 5 // 4), 6 * self.bits)

    def _shown(self, time: Fraction) -> str:
        """The time on the clock, for a time since the start."""
        return shown(self.begin + time)


def has_shrunk_at_last(lengths: Sequence[Fraction]) -> bool:
    """True if the last step is next to nothing beside the longest one, as where a motion ends."""
    return bool(lengths) and lengths[-1] < max(lengths) * power_of_two(_SHRUNK)


def _still_shrinks(lengths: Sequence[Fraction]) -> bool:
    """True if steps become ever shorter, and further ones may show that the motion ends there."""
    return 2 * lengths[-1] < lengths[-_SEVERAL] and not has_shrunk_at_last(lengths)


def _brief(value: Fraction) -> str:
    """Two digits of a number of any size."""
    with localcontext(Emax=MAX_EMAX, Emin=MIN_EMIN):
        return f"{Decimal(value.numerator) / Decimal(value.denominator):.2g}"
