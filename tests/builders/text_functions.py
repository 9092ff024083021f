"""Functions of written texts in mpmath, and the sides of their kinks on which a motion was."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import Any

from mpmath import mp, mpf

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
