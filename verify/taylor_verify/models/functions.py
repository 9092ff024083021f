"""The functions of written loads, in the arithmetic of whoever evaluates them.

An operand of another class brings its own, as a mapping ``FUNCTIONS`` by the names of the operations.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from fractions import Fraction
from functools import cache
from typing import Any, Final

import numpy as np
from mpmath import mp

from taylor_verify.numbers.decimal_point import decimal_point

Functions = Mapping[str, Callable[..., Any]]
# The same name in every library.
_ALIKE: Final = (
    "sqrt", "exp", "log", "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "atan2",
)  # fmt: skip


def functions_of(operand: Any) -> Functions:
    """Return the functions for numbers of the class of an operand."""
    if (own := getattr(operand, "FUNCTIONS", None)) is not None:
        functions: Functions = own
        return functions
    if isinstance(operand, np.ndarray):
        return _of_numpy()
    if isinstance(operand, mp.mpf):
        return _of_mpmath()
    return _of_heyoka() if type(operand).__module__.startswith("heyoka") else FLOATS


FLOATS: Final[Functions] = {
    **{name: getattr(math, name) for name in _ALIKE},
    "abs": abs,
    "min": min,
    "max": max,
    "pi": lambda: math.pi,
    "norm": math.hypot,
    "power": math.pow,
    "floor": math.floor,
    "sign": lambda value: (value > 0) - (value < 0),
    "step": lambda value: int(value >= 0),
    "choose": lambda condition, first, second: first if condition >= 0 else second,
}


@cache
def _of_numpy() -> Functions:
    names = {"asin": "arcsin", "acos": "arccos", "atan": "arctan", "atan2": "arctan2"}
    return {
        **{name: getattr(np, names.get(name, name)) for name in _ALIKE},
        "abs": np.abs,
        "min": np.minimum,
        "max": np.maximum,
        "pi": lambda: math.pi,
        "norm": lambda *parts: np.sqrt(sum(part * part for part in parts)),
        "power": lambda base, exponent: np.power(base, float(exponent)),
        "floor": np.floor,
        "sign": np.sign,
        "step": lambda value: np.where(value >= 0, 1.0, 0.0),
        "choose": lambda condition, first, second: np.where(condition >= 0, first, second),
    }


@cache
def _of_mpmath() -> Functions:
    def real(function: Callable[..., Any]) -> Callable[..., Any]:
        def value(*operands: Any) -> Any:
            result = function(*operands)
            if isinstance(result, mp.mpc):
                raise ValueError(f"expected a real number, got {mp.nstr(result, 5)} in a load")
            return result

        return value

    return {
        **{name: real(getattr(mp, name)) for name in _ALIKE},
        "abs": abs,
        "min": min,
        "max": max,
        "pi": lambda: +mp.pi,
        "norm": lambda *parts: mp.sqrt(sum(part * part for part in parts)),
        "power": real(lambda base, e: mp.power(base, mp.mpf(e.numerator) / e.denominator)),
        **{name: FLOATS[name] for name in ("step", "choose")},
        **{name: getattr(mp, name) for name in ("floor", "sign")},
    }


@cache
@decimal_point()
def _of_heyoka() -> Functions:
    """Return heyoka's functions. It has no abs, min and max."""
    import heyoka as hy

    def power(base: Any, exponent: Fraction) -> Any:
        if exponent.denominator.bit_count() == 1:
            return base ** float(exponent)
        # More digits than any rung has, of which it takes its own.
        return hy.exp(hy.expression(_literal(exponent)) * hy.log(base))

    return {
        **{name: getattr(hy, name) for name in _ALIKE},
        "pi": lambda: hy.pi,
        "norm": lambda *parts: hy.sqrt(hy.sum([part * part for part in parts])),
        "power": power,
    }


def _literal(value: Fraction) -> Any:
    import heyoka as hy

    bits = 400
    return hy.real(value.numerator, bits) / hy.real(value.denominator, bits)
