"""Operations that jump with the state: they stand in values that are taken at an instant, never in rates.

Each is decided over a whole box: which side of its jump the box lies on.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Self

from flint import arb

from taylor_verify.exact.enclosure.operations import ONE, ZERO, OfOne, Operation
from taylor_verify.scenes.loads.steps import JUMPS


class OnJump(ArithmeticError):
    """A box that may lie on both sides of a jump."""


def is_at_least_zero(value: arb | Fraction) -> bool:
    """True for a value that is not negative. Raises OnJump where that is not known."""
    if value >= 0:
        return True
    if value < 0:
        return False
    raise OnJump


@dataclass(frozen=True)
class Jump(OfOne):
    """sign, step or floor of the node ``a``, by its ``name``."""

    name: str

    def of(self, value: Fraction) -> Fraction:
        """The value at a rational number."""
        return JUMPS[self.name](value)

    def decided(self, value: arb) -> arb:
        """The one value over a ball. Raises OnJump where there are two."""
        if self.name == "floor":
            whole = value.floor().unique_fmpz()
            if whole is None:
                raise OnJump
            return arb(whole)
        if self.name == "step":
            return ONE if is_at_least_zero(value) else ZERO
        if value.is_zero():
            return ZERO
        if value > 0 or value < 0:
            return ONE if value > 0 else -ONE
        raise OnJump


@dataclass(frozen=True)
class Choice(Operation):
    """The node ``first_choice`` where ``condition`` is not negative, else ``second_choice``."""

    condition: int
    first_choice: int
    second_choice: int

    @property
    def operands(self) -> tuple[int, ...]:
        return (self.condition, self.first_choice, self.second_choice)

    def moved(self, places: Sequence[int]) -> Self:
        return replace(
            self,
            condition=places[self.condition],
            first_choice=places[self.first_choice],
            second_choice=places[self.second_choice],
        )

    def chosen(self, condition: arb | Fraction) -> int:
        """The node that is chosen over a condition. Raises OnJump for a ball over which both may be."""
        return self.first_choice if is_at_least_zero(condition) else self.second_choice
