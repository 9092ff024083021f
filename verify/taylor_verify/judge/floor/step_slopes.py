"""The steps of written loads in float64, and the derivatives of one of them by all."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final

import numpy as np

from taylor_verify.models.functions import functions_of
from taylor_verify.scenes.loads.steps import Step

Floats = np.ndarray[Any, np.dtype[np.float64]]
Values = Sequence[Floats]


def values_of(steps: Sequence[Step], inputs: Mapping[str, Floats], count: int) -> list[Floats]:
    """Return the value of each step at so many times, from rows of inputs by name."""
    values: list[Floats] = []
    with np.errstate(all="ignore"):
        for step in steps:
            if step.operation == "input":
                values.append(inputs[step.name])
            elif step.operation in ("number", "pi"):
                number = np.pi if step.number is None else float(step.number)
                values.append(np.full(count, number))
            else:
                operands = [values[place] for place in step.operands]
                values.append(_value(step, operands))
    return values


def _value(step: Step, operands: Sequence[Floats]) -> Floats:
    if step.operation in _ARITHMETIC:
        value: Floats = _ARITHMETIC[step.operation](*operands)
        return value
    exponent = () if step.number is None else (step.number,)
    value = functions_of(operands[0])[step.operation](*operands, *exponent)
    return value


def gradient(steps: Sequence[Step], values: Values, output: int) -> list[Floats]:
    """Return the derivative of one step by each step."""
    by = [np.zeros(len(values[output])) for _ in steps]
    by[output] = np.ones(len(values[output]))
    with np.errstate(all="ignore"):
        for k in range(output, -1, -1):
            step = steps[k]
            if not step.operands or not by[k].any():
                continue
            operands = [values[place] for place in step.operands]
            slopes = _SLOPES[step.operation](step, values[k], *operands)
            for place, slope in zip(step.operands, slopes, strict=True):
                # Where a load has no derivative, as a root at zero, no error is carried.
                by[place] = by[place] + by[k] * np.where(np.isfinite(slope), slope, 0.0)
    return by


def _exponent(step: Step) -> float:
    assert step.number is not None
    return float(step.number)


_ARITHMETIC: Final = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
}
# The derivative of a function of one step, by its value and its operand.
_DERIVATIVES: Final[Mapping[str, Callable[[Any, Any], Any]]] = {
    "abs": lambda v, a: np.sign(a),
    "sqrt": lambda v, a: 0.5 / v,
    "exp": lambda v, a: v,
    "log": lambda v, a: 1 / a,
    "sin": lambda v, a: np.cos(a),
    "cos": lambda v, a: -np.sin(a),
    "tan": lambda v, a: 1 + v * v,
    "asin": lambda v, a: 1 / np.sqrt(1 - a * a),
    "acos": lambda v, a: -1 / np.sqrt(1 - a * a),
    "atan": lambda v, a: 1 / (1 + a * a),
    "sinh": lambda v, a: np.cosh(a),
    "cosh": lambda v, a: np.sinh(a),
    "tanh": lambda v, a: 1 - v * v,
}
_SLOPES: Final[Mapping[str, Callable[..., tuple[Floats, ...]]]] = {
    "+": lambda s, v, a, b: (np.ones_like(a), np.ones_like(b)),
    "-": lambda s, v, a, b: (np.ones_like(a), -np.ones_like(b)),
    "*": lambda s, v, a, b: (b, a),
    "/": lambda s, v, a, b: (1 / b, -v / b),
    "min": lambda s, v, a, b: (1.0 * (a <= b), 1.0 * (a > b)),
    "max": lambda s, v, a, b: (1.0 * (a >= b), 1.0 * (a < b)),
    "atan2": lambda s, v, a, b: (b / (a * a + b * b), -a / (a * a + b * b)),
    "norm": lambda s, v, *parts: tuple(p / v for p in parts),
    "choose": lambda s, v, a, b, c: (0 * a, 1.0 * (a >= 0), 1.0 * (a < 0)),
    **{name: lambda s, v, a: (0 * a,) for name in ("sign", "step", "floor")},
    "power": lambda s, v, a: (_exponent(s) * a ** (_exponent(s) - 1),),
    **{name: lambda s, v, a, d=d: (d(v, a),) for name, d in _DERIVATIVES.items()},
}
