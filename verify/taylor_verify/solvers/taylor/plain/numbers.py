"""heyoka's wide numbers in the hands of NumPy, Python's formats and other libraries.

A *real* is heyoka's MPFR number of any precision, a *real128* an IEEE binary128.
"""

from __future__ import annotations

import math
from importlib import import_module
from typing import Any

import numpy as np


def norm(vector: Any) -> Any:
    """The length of a vector of reals, as of any other array."""
    return np.linalg.norm(vector)


def root(number: Any) -> Any:
    """The square root from Python's own library."""
    return math.sqrt(number)


def printed(number: Any, form: str = "%.40e") -> Any:
    """Forty digits, as of any other number; format() would have raised."""
    return form % number


def to_real128(number: Any) -> Any:
    """A real of more bits made a real128."""
    import heyoka as hy

    return hy.real128(number)


def equal(number: Any, other: Any) -> Any:
    """Whether a real is the same number as one of another library."""
    return number == other


def from_sympy(digits: str) -> Any:
    """A SymPy number of 50 digits as a heyoka expression; ImportError without SymPy."""
    import heyoka as hy

    sympy = import_module("sympy")
    return hy.from_sympy(sympy.Float(digits, 50) * sympy.Symbol("x"))
