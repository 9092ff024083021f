"""Powers of two in which a motion is of size one."""

from __future__ import annotations

from dataclasses import dataclass

from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import floor_log2
from taylor_verify.numbers.tensors import Vector


@dataclass(frozen=True)
class Units:
    """log2 of a unit for each block of the state, for the centre and for time."""

    blocks: tuple[int, ...]
    centre: int
    time: int


def exponent(vector: Vector) -> int | None:
    """log2 of the length, rounded; None for zero."""
    square = tensors.dot(vector, vector)
    return floor_log2(square) // 2 if square else None


def halved(exponent: int | None) -> int | None:
    """log2 of the root."""
    return None if exponent is None else exponent // 2


def later(exponent: int | None, time: int) -> int | None:
    """The size of what grows at this rate, after one unit of time."""
    return None if exponent is None else exponent + time


def largest(*exponents: int | None, default: int) -> int:
    """The largest of the exponents that are not those of zero."""
    return max((e for e in exponents if e is not None), default=default)
