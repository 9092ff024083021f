"""Elementary steps as a solver gets them: only those that are needed, and every number on its rung."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from typing import Any, Final

from flint import arb, ctx

from taylor_verify.numbers.irrational import ball
from taylor_verify.numbers.precision import Rung, power_of_two
from taylor_verify.scenes.loads.steps import MOST_BITS, NoStep, Step, needed, too_long

# A constant such as sqrt(2) is rounded to a rung from so many bits more than the rung has.
_SPARE_BITS: Final = 64
# A constant that so many bits do not tell from zero, or from a jump, has no value.
_MOST_BITS: Final = 2**16


def finished(
    steps: Sequence[Step], outputs: Sequence[int], rung: Rung | None
) -> tuple[list[Step], list[int]]:
    """Return the steps that the outputs need, and where the outputs are among them.

    On a rung every number is rounded once, and an expression of numbers alone is one number. The exponent
    of a power is a part of the operation, and stays what it is.
    """
    if rung is not None:
        steps = _on_rung(steps, rung)
    order = needed(steps, outputs)
    places = {old: new for new, old in enumerate(order)}
    left = [
        Step(s.operation, tuple(places[i] for i in s.operands), s.number, s.name)
        for s in (steps[old] for old in order)
    ]
    return left, [places[output] for output in outputs]


def _on_rung(steps: Sequence[Step], rung: Rung) -> list[Step]:
    """The steps with a rounded number in place of every expression that has no input."""
    is_constant: list[bool] = []
    for step in steps:
        is_constant.append(
            step.operation != "input" and all(is_constant[place] for place in step.operands)
        )
    return [
        Step("number", number=rung.round(_value(steps, place, rung.bits + _SPARE_BITS)))
        if is_constant[place]
        else step
        for place, step in enumerate(steps)
    ]


def _value(steps: Sequence[Step], place: int, bits: int) -> Fraction:
    """The number that a step without inputs is, to so many bits.

    Raises NoStep where it may be zero, or may lie on a jump.
    """
    number = steps[place].number
    if steps[place].operation == "number" and number is not None:
        return number
    working = bits
    while working <= _MOST_BITS:
        with ctx.workprec(working):
            value = _ball(steps, place)
            if value.rel_accuracy_bits() >= bits:
                mantissa, exponent = value.mid().man_exp()
                if abs(exponent) > MOST_BITS:
                    raise too_long()
                return int(mantissa) * power_of_two(int(exponent))
            if value.is_zero():
                return Fraction(0)
        working *= 2
    raise NoStep("constants that are told from zero and from jumps", "one that may be either")


def _ball(steps: Sequence[Step], place: int) -> arb:
    step = steps[place]
    if step.number is not None and step.operation == "number":
        return ball(step.number)
    operands = [_ball(steps, operand) for operand in step.operands]
    if step.operation == "power" and step.number is not None:
        exponent = ball(step.number)
        operands = [operands[0] ** exponent]
        return operands[0]
    value: arb = _FUNCTIONS[step.operation](*operands)
    return value


def _choice(condition: arb, first: arb, second: arb) -> arb:
    """The first if the condition is not negative; both, where that is not decided."""
    if condition >= 0 or condition < 0:
        return first if condition >= 0 else second
    return first.union(second)


_FUNCTIONS: Final[Mapping[str, Callable[..., Any]]] = {
    "pi": arb.pi,
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": lambda a, b: a / b,
    "min": lambda a, b: a.min(b),
    "max": lambda a, b: a.max(b),
    "norm": lambda *parts: sum((part * part for part in parts), arb(0)).sqrt(),
    "atan2": lambda y, x: arb.atan2(y, x),
    "abs": abs,
    "sign": arb.sgn,
    "floor": arb.floor,
    "step": lambda a: _choice(a, arb(1), arb(0)),
    "choose": lambda a, b, c: _choice(a, b, c),
    **{
        name: getattr(arb, name)
        for name in (
            "sqrt", "exp", "log", "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh",
        )
    },
}  # fmt: skip
