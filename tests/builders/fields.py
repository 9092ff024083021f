"""Fields drawn at random, and their motion by an integrator that reads the same texts by itself."""

from __future__ import annotations

import re
from dataclasses import dataclass
from fractions import Fraction
from random import Random
from typing import Any

import mpmath
from mpmath import mp, mpf

from builders.integrators import Vector, extrapolated
from taylor_verify import enclose
from taylor_verify.exact.solution import Unsettled
from taylor_verify.records.faults import Refused

DIGITS = 20
COLUMNS = 12
STEPS = 64
ALLOWED = mpf(10) ** -(DIGITS + 4)


@dataclass(frozen=True)
class Field:
    """Rates as texts, the start, and the two times between which they are followed."""

    rates: dict[str, str]
    start: dict[str, Fraction]
    begin: Fraction
    end: Fraction


def drawn(seed: int) -> Field:
    """Draw one to four equations with sums, products, quotients, powers, functions and the time."""
    draw = Random(seed)
    names = ["x", "y", "u", "v"][: draw.randint(1, 4)]
    begin = Fraction(draw.randint(-8, 8), 4)
    return Field(
        {name: _term(draw, [*names, "t"], draw.randint(1, 4)) for name in names},
        {name: Fraction(draw.randint(-64, 64), 32) for name in names},
        begin,
        begin + draw.choice([-1, 1]) * Fraction(draw.randint(1, 8), 8),
    )


def _term(draw: Random, names: list[str], depth: int) -> str:
    if depth == 0:
        number = f"{draw.randint(1, 40)}/{draw.randint(1, 20)}"
        return draw.choice([*names, *names, f"({number})"])
    a, b = _term(draw, names, depth - 1), _term(draw, names, depth - 1)
    forms = (
        "({a} + {b})", "({a} - {b})", "(-{a}*{b})", "({a}*{b})", "{a}/(2 + cos({b}))", "{a}/{b}",
        "sin({a})", "cos({a})", "exp(-({a})^2)", "tanh({a})", "atan({a})", "({a})^2", "({a})^3",
        "sqrt(1 + ({a})^2)", "log(1 + ({a})^2)",
    )  # fmt: skip
    return draw.choice(forms).format(a=a, b=b)


def verdict(field: Field, followed: Field | None = None) -> str:
    """Return "inside", "outside", "refused" by `enclose`, or "not judged" where the integrator is too slow.

    The integrator follows another field if one is given.
    """
    try:
        motion = enclose(field.rates, field.start, [field.end], DIGITS, field.begin)
    except (Refused, Unsettled):
        return "refused"
    with mp.workdps(2 * DIGITS):
        end = _followed(followed or field)
        if end is None:
            return "not judged"
        state, missed = end
        errors = [mpf(motion.errors[name][0]) + missed for name in field.rates]
        off = [abs(motion[name][0] - z) for name, z in zip(field.rates, state, strict=True)]
    return "inside" if all(a <= b for a, b in zip(off, errors, strict=True)) else "outside"


def _followed(field: Field) -> tuple[Vector, Any] | None:
    text = ", ".join(field.rates.values()).replace("^", "**")
    rates = compile("[" + re.sub("([0-9]+)", r"mpf(\1)", text) + "]", "field", "eval")

    def rule(t: Any, state: Vector) -> Vector:
        return list(
            eval(rates, vars(mpmath) | dict(zip(field.rates, state, strict=True)) | {"t": t})
        )

    now, state, missed = _real(field.begin), [_real(z) for z in field.start.values()], mpf(0)
    end = _real(field.end)
    h = (end - now) / 4
    for _ in range(STEPS):
        if now == end:
            return state, missed
        h = h if abs(h) <= abs(end - now) else end - now
        after, error = extrapolated(rule, now, state, h, COLUMNS)
        if error <= ALLOWED * (1 + max(map(abs, after))):
            now = end if h == end - now else now + h
            state, missed, h = after, missed + error, 2 * h
        else:
            h /= 2
    return None


def _real(number: Fraction) -> Any:
    return mpf(number.numerator) / number.denominator
