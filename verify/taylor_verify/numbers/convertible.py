"""Exact numbers that NumPy, JAX and PyTorch convert without a type, each to the nearest double.

A `Fraction` or a tuple of them converts by `float` and with a type. Without one, NumPy makes an array of
objects of them, and JAX and PyTorch refuse them.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from importlib import import_module
from typing import Any, Final, final

from taylor_verify.records.faults import Refused

_CPU: Final = (1, 0)


class Convertible:
    """The base class of exact numbers that convert to doubles by the protocols of array libraries."""

    __slots__ = ()

    def nested(self, kind: Callable[[Fraction], Any]) -> Any:
        """Return the number, or lists of the numbers, each made by ``kind`` of its rational."""
        raise NotImplementedError

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Any:
        import numpy as np

        kind = Fraction if dtype is not None and np.dtype(dtype).hasobject else float
        return np.array(self.nested(kind), float if dtype is None else dtype, copy=copy)

    def __dlpack__(self, **options: Any) -> Any:
        """PyTorch takes this way: a list of Python's floats becomes float32 there."""
        return self.__array__().__dlpack__(**options)

    def __dlpack_device__(self) -> tuple[int, int]:
        return _CPU

    def __jax_array__(self) -> Any:
        doubles = self.__array__()
        converted = import_module("jax.numpy").asarray(doubles)
        # JAX would round both sides of a comparison: it is made by NumPy.
        if (doubles != converted.__array__()).any():
            mend = 'jax.config.update("jax_enable_x64", True)'
            got = "one that rounds these to float32"
            raise Refused([f"expected JAX with jax_enable_x64, got {got} ({mend})"])
        return converted


@final
class Number(Convertible, Fraction):
    """A rational that converts to a double."""

    __slots__ = ()

    def nested(self, kind: Callable[[Fraction], Any]) -> Any:
        return kind(Fraction(self))


@final
class Numbers(Convertible, tuple[Any, ...]):
    """A vector, or a matrix row by row, that converts to an array of doubles."""

    __slots__ = ()

    def nested(self, kind: Callable[[Fraction], Any]) -> Any:
        return [entry.nested(kind) for entry in self]


def convertible(value: Any) -> Any:
    """Return a rational, or a tuple of rationals nested to any depth, as numbers that convert."""
    if isinstance(value, tuple):
        return Numbers(map(convertible, value))
    return Number(value)


def as_rationals(value: Any) -> Any:
    """Return an answer with plain rationals, so that NumPy keeps them as they are."""
    if isinstance(value, Convertible):
        return value.nested(Fraction)
    # SciPy's OdeResult is a dict with attributes.
    if type(value) is dict:
        return {name: as_rationals(entry) for name, entry in value.items()}
    if type(value) in (list, tuple):
        return type(value)(map(as_rationals, value))
    return value
