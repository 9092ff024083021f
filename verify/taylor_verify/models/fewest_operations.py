"""The choice of the equations of a rounded body: the fewest operations that represent it exactly.

Every decision compares rationals, the exact values of the numbers of the rung. A coefficient is left out
if it is zero. Two equal coefficients become one. A difference becomes a coefficient if the rung can
represent it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction

from taylor_verify.models.form import Equations, Form

Numbers = Mapping[str, Fraction]


@dataclass(frozen=True)
class Choice:
    """Equations, the numbers that may enter them, the numbers that these replace, and the reasons."""

    equations: Equations
    numbers: Numbers
    replaced: Numbers
    because: tuple[str, ...]

    def form(self, states: tuple[str, ...]) -> Form:
        """Return the equations in these states, without zero parameters and constant states.

        Impulses that no term changes become parameters; all components of H stay states.
        """
        present = [name for name, value in self.numbers.items() if value]
        form = Form(self.equations, states, tuple(n for n in present if n not in states))
        still = form.constants()
        moving = tuple(name for name in states if name not in still)
        form = replace(form, states=moving, parameters=tuple(n for n in present if n not in moving))
        return replace(form, parameters=form.entering())


def constant_states_sentence(asked: tuple[str, ...], form: Form) -> tuple[str, ...]:
    """Return a sentence on the components that are no states, because no term changes them."""
    still = [name for name in asked if name not in form.states]
    verb = "is a constant" if len(still) == 1 else "are constants"
    return (f"{', '.join(still)} {verb}, and no state",) if still else ()
