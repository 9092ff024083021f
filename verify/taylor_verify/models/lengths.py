"""Lengths that the loads take: norms, and roots of sums of squares.

A length has a kink where all its parts vanish. With one part u alone it is |u|; so it is where all other
parts are zero all the time. |u| is a kink that an integrator of smooth equations can cross (kinks.py).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache

from taylor_verify.models.form import Form
from taylor_verify.models.written import Growing, Written
from taylor_verify.scenes.loads.steps import Step

# The operations "*" or "/", and the place of a number.
Factors = tuple[tuple[str, int], ...]


@dataclass(frozen=True)
class Length:
    """A power of the root of a sum of squares: of the steps at ``parts``, each to its own whole power.

    Each square is multiplied or divided by the steps at its ``factors``.
    """

    parts: tuple[int, ...]
    factors: tuple[Factors, ...]
    powers: tuple[int, ...]
    power: Fraction = Fraction(1)


@lru_cache
def lengths(form: Form) -> tuple[tuple[int, ...], ...]:
    """Return the places of the steps of which the loads take the length, for each length."""
    equations = form.equations
    if not isinstance(equations, Written):
        return ()
    every = (_length(equations.steps, step) for step in equations.steps)
    return tuple(sorted({length.parts for length in every if length is not None}))


@lru_cache
def radicands(form: Form) -> tuple[int, ...]:
    """Return the places of the steps of which a root is taken that is no length of known parts."""
    equations = form.equations
    if not isinstance(equations, Written):
        return ()
    steps = equations.steps
    places = {step.operands[0] for step in steps if _is_root(step) and _length(steps, step) is None}
    return tuple(sorted(places))


def _is_root(step: Step) -> bool:
    if step.operation == "power":
        return step.number is not None and step.number > 0 and step.number.denominator != 1
    return step.operation == "sqrt"


@lru_cache
def unsquared(form: Form, zeros: frozenset[int] = frozenset()) -> Form:
    """Return the form with |u| for each length of one part u; the steps at ``zeros`` are no parts."""
    equations = form.equations
    if not isinstance(equations, Written):
        return form
    made = _Unsquaring(equations.steps, zeros)
    return replace(form, equations=equations.anew(made, made.turned))


def _length(steps: Sequence[Step], step: Step) -> Length | None:
    """Return the length that a step is, or None."""
    if step.operation == "norm":
        n = len(step.operands)
        return Length(step.operands, ((),) * n, (1,) * n)
    exponent = Fraction(1, 2) if step.operation == "sqrt" else step.number or Fraction(1)
    if step.operation not in ("sqrt", "power") or exponent.denominator == 1:
        return None
    terms = list(_squared(steps, step.operands[0]))
    squares = [term for term in terms if term is not None]
    if len(squares) < len(terms):
        return None
    parts, factors, powers = zip(*squares, strict=True)
    return Length(parts, factors, powers, 2 * exponent)


def _squared(
    steps: Sequence[Step], place: int, factors: Factors = ()
) -> Iterator[tuple[int, Factors, int] | None]:
    """Yield the steps whose squares add up to a step, with factors and powers; None for no square."""
    step = steps[place]
    number = step.number or Fraction(0)
    match step.operation:
        case "+":
            for operand in step.operands:
                yield from _squared(steps, operand, factors)
        case "*" if step.operands[0] == step.operands[1]:
            yield step.operands[0], factors, 1
        case "*" if "number" in (kinds := [steps[operand].operation for operand in step.operands]):
            k = kinds.index("number")
            yield from _squared(steps, step.operands[1 - k], (*factors, ("*", step.operands[k])))
        case "/" if steps[step.operands[1]].operation == "number":
            yield from _squared(steps, step.operands[0], (*factors, ("/", step.operands[1])))
        case "power" if number > 0 and number.denominator == 1 and number % 2 == 0:
            yield step.operands[0], factors, int(number) // 2
        case _:
            yield None


class _Unsquaring(Growing):
    """Steps with |u| in place of each length of one part."""

    def __init__(self, steps: Sequence[Step], zeros: frozenset[int]) -> None:
        super().__init__()
        self._before, self._zeros = steps, zeros

    def turned(self, step: Step) -> int:
        """Return the place of what a step becomes."""
        length = _length(self._before, step)
        if length is None or length.power.denominator != 1:
            return self.moved(step)
        left = [k for k, part in enumerate(length.parts) if part not in self._zeros]
        return self.moved(step) if len(left) > 1 else self._absolute(length, left[0] if left else 0)

    def _absolute(self, length: Length, k: int) -> int:
        """The place of the length of one part u alone: of |u| and the roots of its factors."""
        place = self._powered(
            self.add(Step("abs", (self.places[length.parts[k]],))), length.powers[k]
        )
        for operation, factor in length.factors[k]:
            root = self.add(Step("sqrt", (self.places[factor],)))
            place = self.add(Step(operation, (place, root)))
        return self._powered(place, length.power)

    def _powered(self, place: int, exponent: Fraction | int) -> int:
        return place if exponent == 1 else self.add(Step("power", (place,), Fraction(exponent)))
