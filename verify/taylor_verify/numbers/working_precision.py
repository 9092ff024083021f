"""The working precision of mpmath and FLINT, of which a whole process has one.

Two threads that both set it compute wrong numbers, so that threads take turns.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from threading import RLock
from typing import Final, ParamSpec, TypeVar

Parameters = ParamSpec("Parameters")
Result = TypeVar("Result")

ONE_AT_A_TIME: Final = RLock()


def in_turn(function: Callable[Parameters, Result]) -> Callable[Parameters, Result]:
    """Return the function, whose calls in other threads wait for the end of a call in one."""

    @wraps(function)
    def call(*given: Parameters.args, **named: Parameters.kwargs) -> Result:
        with ONE_AT_A_TIME:
            return function(*given, **named)

    return call
