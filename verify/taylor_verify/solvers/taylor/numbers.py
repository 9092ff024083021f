"""Exact passage between rationals and the number types that heyoka demands on each rung.

Every argument of an integrator must be of its own type. A Python float given to a float128 or MPFR
run would be a double first, so numbers pass as integers and powers of two.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from math import inf, ldexp
from typing import Any, Final

import numpy as np
from mpmath import libmp

from taylor_verify.numbers.decimal_point import decimal_point
from taylor_verify.numbers.precision import Rung, exact_value, power_of_two
from taylor_verify.solvers.solver import Lack
from taylor_verify.solvers.taylor.package import lack
from taylor_verify.solvers.trajectory import Outcome

# hy.real(int) passes through a decimal string, which Python limits to 4300 digits.
_LARGEST_INTEGER_BITS = 14000


@dataclass(frozen=True)
class Arithmetic:
    """The numbers of one rung in heyoka: its fp_type, and conversions that round nothing.

    ``scaled`` makes one of a significand and an exponent of two; ``double`` rounds a double to nearest
    where the rung is the narrower. ``exact`` leads back. Where ``is_software``, a library computes, some
    hundred times slower than a processor; without compact mode its code compiles for seconds to minutes,
    and runs no faster. Straight-line code ``is_quick_plain``: without any optimising it compiles in a tenth
    of a second, and its steps take 1.8 to 2.6 times as long. Code is optimised for ways whose length in
    units of time, times the number of states, exceeds ``optimised_from``.
    """

    fp_type: Any
    scaled: Callable[[int, int], Any]
    double: Callable[[float], Any]
    exact: Callable[[Any], Fraction] = exact_value
    is_software: bool = False
    is_quick_plain: bool = False
    optimised_from: float = inf

    def number(self, value: Fraction) -> Any:
        return self.scaled(value.numerator, 1 - value.denominator.bit_length())

    def array(self, values: Iterable[Fraction]) -> np.ndarray[Any, Any]:
        if self.fp_type is float:
            # A quotient of integers is rounded once, and is exact where a double holds it.
            return np.array([value.numerator / value.denominator for value in values])
        return np.array([self.number(value) for value in values], dtype=self.fp_type)


# Straight-line code is optimised for ways of more than one or two thousand steps.
_THOUSANDS_OF_STEPS: Final = 10_000
_OF_NUMPY: Final = {
    "f32": Arithmetic(
        np.float32,
        lambda m, e: np.float32(ldexp(m, e)),
        np.float32,
        is_quick_plain=True,
        optimised_from=_THOUSANDS_OF_STEPS,
    ),
    "f64": Arithmetic(float, ldexp, float, is_quick_plain=True, optimised_from=_THOUSANDS_OF_STEPS),
    # Optimised loops run twice as fast, and compile in a twentieth of a second.
    "f80": Arithmetic(
        np.longdouble,
        lambda m, e: np.ldexp(np.longdouble(m), e),
        np.longdouble,
        optimised_from=150,
    ),
}


def arithmetic(rung: Rung) -> Arithmetic:
    """Return the number type of a rung that is available here; ``unavailable`` tells which are not."""
    return _OF_NUMPY.get(rung.name) or _of_heyoka(rung)


@lru_cache(maxsize=16)
@decimal_point()
def _of_heyoka(rung: Rung) -> Arithmetic:
    import heyoka as hy

    if rung.name == "f128":
        # Nearly all of the time is spent in the library, which nothing here optimises.
        return Arithmetic(
            hy.real128,
            lambda m, e: hy.real128(_real(m, e, 113)),
            hy.real128,
            _from_real128,
            is_software=True,
        )
    bits = rung.bits
    return Arithmetic(
        hy.real,
        lambda m, e: _real(m, e, bits),
        lambda v: hy.real(v, bits),
        _from_real,
        is_software=True,
        # A fifth of the time goes into calls, and not into MPFR.
        optimised_from=100,
    )


def unavailable(rung: Rung) -> str:
    """Return the reason why heyoka cannot compute on a rung here; empty where it can."""
    if (missing := lack()) is not None:
        return missing
    import heyoka as hy

    reason = ""
    if rung.name == "f80" and np.finfo(np.longdouble).nmant != 63:
        reason = "the long double of this processor is not the 80-bit x87 format"
    if rung.name == "f128" and not hasattr(hy, "real128"):
        reason = "this build of heyoka has no float128"
    if rung.name.startswith("mp") and not hasattr(hy, "real"):
        reason = "this build of heyoka has no MPFR numbers"
    return Lack(reason, Outcome.NO_FORMAT) if reason else ""


def _real(significand: int, exponent: int, bits: int) -> Any:
    """Return significand times 2^exponent: the odd part as an integer, times exact powers of two."""
    import heyoka as hy

    zeros = (significand & -significand).bit_length() - 1 if significand else 0
    result, exponent = hy.real(significand >> zeros, bits), exponent + zeros
    while exponent:
        step = max(-_LARGEST_INTEGER_BITS, min(_LARGEST_INTEGER_BITS, exponent))
        power = _power(abs(step), bits)
        result = result * power if step > 0 else result / power
        exponent -= step
    return result


@lru_cache(maxsize=256)
def _power(exponent: int, bits: int) -> Any:
    import heyoka as hy

    return hy.real(2**exponent, bits)


def _from_real128(value: Any) -> Fraction:
    """IEEE binary128: sign, 15 bits of exponent, 112 of fraction, little-endian."""
    import heyoka as hy

    raw = int.from_bytes(np.array([value], dtype=hy.real128).tobytes(), "little")
    fraction, biased = raw & (2**112 - 1), raw >> 112 & 0x7FFF
    significand = fraction + (2**112 if biased else 0)
    magnitude = significand * power_of_two(max(biased, 1) - 16383 - 112)
    return -magnitude if raw >> 127 else magnitude


def _from_real(value: Any) -> Fraction:
    """Printed digits always read back to the same number at the number's own precision."""
    sign, man, exponent, _ = libmp.from_str(str(value), value.prec, libmp.round_nearest)
    magnitude = Fraction(int(man)) * power_of_two(exponent)
    return -magnitude if sign else magnitude
