"""Arithmetic on samples in MPFR's own numbers, which takes a tenth of the time of mpmath's.

Both libraries round every operation to nearest at one precision, so that sums, products, quotients and
roots are the same to the last bit. `to_mpfr` and `to_mpf` convert exactly. The arithmetic between them
stands in a block `with precision()`, which gives MPFR the ambient precision of mpmath.
"""

from __future__ import annotations

from contextlib import AbstractContextManager
from functools import lru_cache
from typing import Any

import gmpy2
import numpy as np
from mpmath import libmp, mp

from taylor_verify.scenes.motion import Motion

Array = np.ndarray[Any, Any]


def precision() -> AbstractContextManager[Any]:
    """Return a context in which MPFR has the ambient precision of mpmath."""
    return _bits(mp.prec)


def to_mpfr(values: Array) -> Array:
    """Convert numbers of mpmath or of Python to MPFR's, exactly, whatever their length."""
    converted = _each(mp.convert, values)
    with _bits(max((value._mpf_[3] for value in converted.flat), default=1)):
        return _each(_mpfr, converted)


def to_mpf(values: Array) -> Array:
    """Convert numbers of MPFR to mpmath's, exactly."""
    return _each(_mpf, values)


def in_mpfr(motion: Motion) -> Motion:
    """Return the same motion in MPFR's numbers; the radii stay as they are."""
    quantities = {name: to_mpfr(rows) for name, rows in motion.quantities.items()}
    return Motion(quantities, motion.radius, motion.radii)


def real(values: Any, like: Array | None = None) -> Array:
    """Round rationals to numbers of the library that the array `like` is made of; mpmath's without one."""
    is_mpfr = like is not None and _is_mpfr(like)
    return _each(gmpy2.mpfr if is_mpfr else mp.convert, np.array(values, dtype=object))


def alike(values: Array, like: Array) -> Array:
    """Convert numbers of mpmath to those of the library that the array `like` is made of."""
    return to_mpfr(values) if _is_mpfr(like) else values


def sqrt(values: Array) -> Array:
    """Return the square root of each number, of either library."""
    return _each(gmpy2.sqrt if _is_mpfr(values) else mp.sqrt, values)


def _is_mpfr(values: Array) -> bool:
    return isinstance(next(values.flat, None), gmpy2.mpfr)


def _each(convert: Any, values: Array) -> Array:
    """Convert each number; the result is an array also where there are none."""
    return np.array([convert(value) for value in values.flat], dtype=object).reshape(values.shape)


def _bits(count: int) -> AbstractContextManager[Any]:
    context: AbstractContextManager[Any] = gmpy2.context(precision=max(count, 1))
    return context


def _mpfr(value: Any) -> Any:
    sign, size, exponent, _ = value._mpf_
    if not size:  # zero, or what is not finite
        return gmpy2.mpfr(float(value))
    # A product is five times as fast as a number made from an integer.
    return gmpy2.mpz(-size if sign else size) * _power_of_two(exponent)


@lru_cache(maxsize=4096)
def _power_of_two(exponent: int) -> Any:
    return gmpy2.exp2(exponent)


def _mpf(value: Any) -> Any:
    if not gmpy2.is_finite(value):
        return mp.mpf(float(value))
    count, exponent = value.as_mantissa_exp()
    return mp.make_mpf(libmp.from_man_exp(libmp.MPZ(count), int(exponent)))
