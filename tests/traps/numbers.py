"""Traps of heyoka's wide numbers, on numbers whose true value is known to any number of digits."""

from __future__ import annotations

import math
import random
from fractions import Fraction
from importlib import import_module
from importlib.util import find_spec
from typing import Any, Final

import heyoka as hy
import numpy as np
from mpmath import mp

from taylor_verify.scenes.precision import exact_value, held_exactly, power_of_two
from taylor_verify.scenes.precision import rung as rung_named
from taylor_verify.solvers.taylor.numbers import arithmetic, unavailable
from traps.document import TrapCase
from traps.trap import Cause, Trap

# The calls.


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
    return hy.real128(number)


def equal(number: Any, other: Any) -> Any:
    """Compare a real with a number of another library."""
    return number == other


def from_sympy(digits: str) -> Any:
    """A SymPy number of 50 digits as a heyoka expression; ImportError without SymPy."""
    sympy = import_module("sympy")
    return hy.from_sympy(sympy.Float(digits, 50) * sympy.Symbol("x"))


# The cases.

_WIDE: Final = "mp237"
# What the truth is formed with: twice as many bits as any number here has.
_BITS: Final = 512
_DRAWS: Final = 2000
_DRAWN_BITS: Final = 200

_TENTH: Final = rung_named(_WIDE).round(Fraction(1, 10))
_VECTOR: Final = (_TENTH, 2 * _TENTH, 3 * _TENTH)


def _relative(value: Any, truth: Any) -> float:
    with mp.workprec(_BITS):
        return float(abs(value - truth) / abs(truth))


def _held_norm(vector: tuple[Fraction, ...]) -> Any:
    """Return a norm formed like the judge's: of exact numbers, at a precision of its own."""
    with mp.workprec(_BITS):
        return mp.norm([held_exactly(entry) for entry in vector])


def _norms() -> list[TrapCase]:
    vector = arithmetic(rung_named(_WIDE)).array(_VECTOR)
    number, tenth = vector[0], held_exactly(_TENTH)
    with mp.workprec(_BITS):
        length, square_root = mp.sqrt(14) * tenth, mp.sqrt(tenth)
    length_returned = norm(vector)
    root_found = root(number)
    digits = printed(number)
    exact = tuple(arithmetic(rung_named(_WIDE)).exact(entry) for entry in vector)
    with mp.workprec(_BITS):
        read_back = mp.mpf(digits)
    driver = "numbers leave heyoka exactly, and mpmath computes with them"
    return [
        TrapCase(
            "numpy.linalg.norm of a vector of 237 bits",
            f"a number of type {type(length_returned).__name__}",
            _relative(held_exactly(exact_value(length_returned)), length),
            driver,
            _relative(_held_norm(exact), length),
        ),
        TrapCase(
            "math.sqrt of a number of 237 bits",
            f"a number of type {type(root_found).__name__}",
            _relative(held_exactly(exact_value(root_found)), square_root),
            driver,
            _relative(_root(exact[0]), square_root),
        ),
        TrapCase(
            "'%.40e' of a number of 237 bits",
            f"{len(digits.partition('e')[0]) - 1} digits",
            _relative(read_back, tenth),
            driver,
            _relative(held_exactly(exact[0]), tenth),
        ),
    ]


def _root(value: Fraction) -> Any:
    with mp.workprec(_BITS):
        return mp.sqrt(held_exactly(value))


def _to_real128() -> list[TrapCase]:
    """Numbers of 200 bits, which lie between two of 113; the nearer one is asked for.

    No case where heyoka has no real128.
    """
    if unavailable(rung_named("f128")):
        return []
    draw = random.Random(1)
    wide, narrow = arithmetic(rung_named(f"mp{_DRAWN_BITS}")), arithmetic(rung_named("f128"))
    worst, worst_driver, wrong = 0.0, 0.0, 0
    for _ in range(_DRAWS):
        value = Fraction(draw.getrandbits(_DRAWN_BITS) | 1) * power_of_two(-_DRAWN_BITS)
        nearest = rung_named("f128").round(value)
        converted = narrow.exact(to_real128(wide.number(value)))
        driven = narrow.exact(narrow.number(nearest))
        wrong += converted != nearest
        worst = max(worst, float(abs(converted - value) / value))
        worst_driver = max(worst_driver, float(abs(driven - value) / value))
    return [
        TrapCase(
            f"{_DRAWS} numbers of {_DRAWN_BITS} bits, drawn at random",
            f"not the nearest real128 for {wrong} of {_DRAWS}",
            worst,
            "rounded once, to nearest, before heyoka sees it",
            worst_driver,
        )
    ]


def _sympy() -> list[TrapCase]:
    """Return one case with SymPy installed, and none without it."""
    if find_spec("sympy") is None:
        return []
    digits = "0.1"
    expression = str(from_sympy(digits))
    literal = expression.strip("()").partition(" ")[0]
    with mp.workdps(50):
        return [
            TrapCase(
                "sympy.Float('0.1', 50) times a symbol",
                f"the expression {expression}",
                _relative(mp.mpf(literal), mp.mpf(digits)),
                "no coefficient passes through SymPy",
                0.0,
            )
        ]


def _equality() -> list[TrapCase]:
    half = Fraction(1, 2)
    number = arithmetic(rung_named(_WIDE)).number(half)
    is_equal = equal(number, held_exactly(half))
    driven = arithmetic(rung_named(_WIDE)).exact(number) == half
    return [
        TrapCase(
            "1/2 as a real and as a number of mpmath",
            f"equal: {is_equal}",
            None,
            f"compared as rationals: {driven}",
        )
    ]


NUMBERS: Final = (
    Trap(
        "T4",
        "a norm, a root and a printout of wide numbers are doubles",
        (norm, root, printed),
        _norms,
        "asks NumPy, Python's math and a format for what they give of any number",
        "no number of heyoka is computed with: all leave it as rationals",
        Cause.PARTLY,
        documented="more advanced features such as random number generation, nontrivial linear "
        "algebra, etc. will not work with real",
        where="notebooks/arbitrary_precision.html",
        remark="They do not fail either: NumPy makes doubles of numbers whose type it does not know.",
        script="norm_of_real",
    ),
    Trap(
        "T5",
        "a real is cut off, not rounded, to a real128",
        (to_real128,),
        _to_real128,
        "makes a real128 of a real with more bits",
        "numbers are rounded to 113 bits as integers, then passed exactly",
        Cause.PARTLY,
        documented="explicit conversions to/from other types are supported and working as intended",
        where="notebooks/arbitrary_precision.html",
        remark="Nothing is said of their rounding.",
        script="real128_from_real",
    ),
    Trap(
        "T6",
        "a SymPy number of 50 digits arrives as a double",
        (from_sympy,),
        _sympy,
        "converts a SymPy number; the precision is read from mpmath's global context and not from "
        "the number",
        "no coefficient passes through SymPy",
        Cause.FAULT,
        remark="SymPy asks for mpmath below 1.4 and this suite for mpmath from 1.4 on, so that they "
        "are not installed side by side; the script runs in an environment of its own.",
        script="sympy_float",
    ),
    Trap(
        "S2",
        "a real equals no number of mpmath",
        (equal,),
        _equality,
        "compares two equal numbers",
        "numbers are compared as rationals",
        Cause.DESIGN,
    ),
)
