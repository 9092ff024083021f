"""The course of a motion: from a start to requested times, at one precision."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

from flint import arb

from taylor_verify.exact.enclosure.step import Step, Stepper
from taylor_verify.exact.enclosure.stopping import MOST_STEPS
from taylor_verify.exact.enclosure.system import System
from taylor_verify.exact.enclosure.walk import Row, Walk


@dataclass(frozen=True)
class Course:
    """Steps from a start, away from it, at one precision; to be used at that precision.

    ``start`` are balls about the state.
    More than ``most_bits`` bits, or ``most_steps`` steps, are never asked for. ``begin`` is what a clock
    shows at the start, for messages alone; ``origin`` is the start's time since that of the scene.
    With ``differentiates`` the rows have derivatives; then no component of the start is exact. Held
    values are taken at the start too unless it ``has_values``.
    """

    stepper: Stepper
    start: Sequence[arb]
    bits: int
    most_bits: int
    most_steps: int = MOST_STEPS
    begin: Fraction = Fraction(0)
    origin: Fraction = Fraction(0)
    differentiates: bool = False
    has_values: bool = False

    @classmethod
    def of(cls, system: System, start: Sequence[arb], bits: int, most_bits: int) -> Course:
        """The course of a system, at the ambient precision of ``bits`` bits."""
        return cls(Stepper(system), start, bits, most_bits)

    @property
    def system(self) -> System:
        return self.stepper.system

    def first_row(self) -> Row:
        """The start itself."""
        return Walk(self, [Fraction(0)]).first_row()

    def steps(self, until: Fraction) -> Iterator[tuple[Fraction, Step]]:
        """The steps to a time, each with the time at which it begins. Raises as ``rows`` does."""
        yield from Walk(self, [until]).steps()

    def rows(self, times: Sequence[Fraction]) -> Iterator[tuple[Fraction, Row]]:
        """The state at these times, which go away from zero on one side.

        Raises Coarse where more bits are needed, and Unreached where more than a million steps, or
        more than ``most_bits`` bits, would be. What was yielded until then stands.
        """
        yield from Walk(self, times).rows()
