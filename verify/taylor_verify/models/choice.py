"""Choice of the equations of a rounded body: the fewest operations that are exactly its own.

Every decision is one between rationals, the numbers of the rung themselves: a coefficient is left out
if it is zero, two are one if they are equal, and a difference is a coefficient if the rung holds it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction

from taylor_verify.models.form import Equations, Form

Numbers = Mapping[str, Fraction]


@dataclass(frozen=True)
class Choice:
    """Equations, all numbers that may enter them, those they replace, and why, in sentences."""

    equations: Equations
    numbers: Numbers
    replaced: Numbers
    because: tuple[str, ...]

    def form(self, states: tuple[str, ...]) -> Form:
        """Return the equations in these states, without what is zero or constant.

        Of the impulses those stay states that something changes; H stays whole.
        """
        present = [name for name, value in self.numbers.items() if value]
        form = Form(self.equations, states, tuple(n for n in present if n not in states))
        still = form.constants()
        moving = tuple(name for name in states if name not in still)
        form = replace(form, states=moving, parameters=tuple(n for n in present if n not in moving))
        return replace(form, parameters=form.entering())


def constants_told(asked: tuple[str, ...], form: Form) -> tuple[str, ...]:
    """Return a sentence on the components that are no states, as nothing changes them."""
    still = [name for name in asked if name not in form.states]
    verb = "is a constant" if len(still) == 1 else "are constants"
    return (f"{', '.join(still)} {verb}, and no state",) if still else ()
