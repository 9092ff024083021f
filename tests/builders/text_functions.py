"""Functions of written texts in mpmath with the sides of their kinks, and random fields of them."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from random import Random
from typing import Any

import mpmath
from mpmath import mp, mpf

from builders.integrators import extrapolated
from taylor_verify import enclose
from taylor_verify.exact.solution import Unsettled
from taylor_verify.records.faults import Refused
from taylor_verify.scenes.loads.tables import Table

Vector = list[Any]


def value(number: Fraction) -> Any:
    return mpf(number.numerator) / number.denominator


FUNCTIONS: Mapping[str, Callable[..., Any]] = {
    name: getattr(mp, name)
    for name in ("sqrt", "exp", "log", "sin", "cos", "tan", "asin", "acos", "atan", "atan2")
} | {
    "sinh": mp.sinh, "cosh": mp.cosh, "tanh": mp.tanh, "abs": abs, "min": min, "max": max,
    "pow": lambda a, b: a**b, "norm": lambda *parts: mp.sqrt(sum(p * p for p in parts)),
    "clip": lambda x, low, high: min(max(x, low), high),
    "step": lambda x: mpf(x >= 0), "sign": mp.sign, "floor": mp.floor,
}  # fmt: skip


class Sides:
    """The sides of its kinks on which a motion was, in the order in which its texts ask for them."""

    def __init__(self) -> None:
        self.crosses = False
        self.begin_piece()

    def begin_piece(self) -> None:
        self._signs: list[int] = []
        self.begin_evaluation()

    def begin_evaluation(self) -> None:
        self._next = 0

    def _watch(self, value: Any) -> None:
        side = int(mp.sign(value))
        if self._next == len(self._signs):
            self._signs.append(side)
        elif side and self._signs[self._next] != side:
            self.crosses |= bool(self._signs[self._next])
            self._signs[self._next] = side
        self._next += 1

    def functions(self) -> Mapping[str, Callable[..., Any]]:
        def watched(function: str, *differences: Callable[..., Any]) -> Callable[..., Any]:
            def value(*arguments: Any) -> Any:
                for difference in differences:
                    self._watch(difference(*arguments))
                return FUNCTIONS[function](*arguments)

            return value

        return {
            "abs": watched("abs", lambda a: a),
            "min": watched("min", lambda a, b: a - b),
            "max": watched("max", lambda a, b: a - b),
            "clip": watched("clip", lambda x, low, _: x - low, lambda x, _, high: x - high),
        }


def tabulated(table: Table, t: Any, clock: Any) -> Any:
    """The value of a table at t, which is in the same piece as the clock."""
    times, values = ([value(entry) for entry in entries] for entries in (table.times, table.values))
    k = sum(time <= clock for time in times) - 1
    if k < 0 or k == len(times) - 1:
        return values[max(k, 0)]
    if table.kind == "hold":
        return values[k]
    bends = _bends(times, values) if table.kind == "cubic" else [mpf(0)] * len(times)
    width = times[k + 1] - times[k]
    a, b = (times[k + 1] - t) / width, (t - times[k]) / width
    bend = (a**3 - a) * bends[k] + (b**3 - b) * bends[k + 1]
    return a * values[k] + b * values[k + 1] + bend * width**2 / 6


def _bends(times: Vector, values: Vector) -> Vector:
    """The second derivatives of the natural spline, by a linear system of all of them."""
    n = len(times)
    matrix, right = mp.eye(n), mp.zeros(n, 1)
    for k in range(1, n - 1):
        before, after = times[k] - times[k - 1], times[k + 1] - times[k]
        matrix[k, k - 1], matrix[k, k], matrix[k, k + 1] = before, 2 * (before + after), after
        right[k] = 6 * ((values[k + 1] - values[k]) / after - (values[k] - values[k - 1]) / before)
    return list(mp.lu_solve(matrix, right))


# Fields

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
