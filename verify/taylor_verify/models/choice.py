"""Which equations a rounded body needs: the fewest operations that are exactly its own.

Every decision is one between rationals, the numbers of the rung themselves: a coefficient is left out
if it is zero, two are one if they are equal, and a difference is a coefficient if the rung holds it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction

from taylor_verify.models.form import Equations, Form
from taylor_verify.scenes.precision import Rung

Numbers = Mapping[str, Fraction]


@dataclass(frozen=True)
class Choice:
    """Equations, all numbers that may enter them, those they replace, and why, in sentences."""

    equations: Equations
    numbers: Numbers
    replaced: Numbers
    because: tuple[str, ...]

    def form(self, states: tuple[str, ...]) -> Form:
        """The equations in these states, without what is zero or constant.

        Of the impulses those stay states that something changes; H stays whole.
        """
        present = tuple(n for n, value in self.numbers.items() if n not in states and value)
        form = Form(self.equations, states, present)
        still = form.constants()
        moving = tuple(n for n in states if n not in still)
        kept = tuple(n for n, value in self.numbers.items() if n not in moving and value)
        form = replace(form, states=moving, parameters=kept)
        return replace(form, parameters=form.entering())


def constants_told(asked: tuple[str, ...], form: Form) -> tuple[str, ...]:
    """Which components are no states, as nothing changes them."""
    still = [name for name in asked if name not in form.states]
    verb = "is a constant" if len(still) == 1 else "are constants"
    return (f"{', '.join(still)} {verb}, and no state",) if still else ()


def holds(rung: Rung, value: Fraction) -> bool:
    """Return True if the value is a number of the rung."""
    try:
        return rung.holds(value)
    except OverflowError:
        return False
