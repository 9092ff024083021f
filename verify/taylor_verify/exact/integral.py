"""Arb's certified integral of a function of Python, which an interrupt ends at once."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from flint import acb, ctx

from taylor_verify.exact.solution import Unsettled

Integrand = Callable[[acb, bool], acb]

_NOTHING: Final = acb(0)
# The nodes of one Gauss rule are made in one call, in which no interrupt is heard: of a degree below this
# over the bits they take about a second.
_DEGREE_TIMES_BITS: Final = 7_000_000
# Rules of so low a degree need a thousand intervals and more beyond it: hours of work.
_MOST_BITS: Final = 10_000


def integral(integrand: Integrand, start: acb, stop: acb, **limits: Any) -> acb:
    """Return the integral, which may be not finite; ``limits`` are those of flint's ``acb.integral``.

    Raises whatever the integrand raises. Flint goes on after an exception, and so loses an interrupt: from
    then on every value is zero here, with which the integral is soon at its end.
    Raises Unsettled beyond ten thousand bits.
    """
    if ctx.prec > _MOST_BITS:
        raise Unsettled(f"an integral to {ctx.prec} bits would take hours")
    errors: list[BaseException] = []

    def value(z: acb, analytic: bool) -> acb:
        try:
            # An exception that came before the first line of the call before this one is pending: acb(z)
            # raises it.
            return _NOTHING if errors else integrand(acb(z), analytic)
        except BaseException as error:
            errors.append(error)
            return _NOTHING

    degree = min(ctx.prec // 2 + 60, _DEGREE_TIMES_BITS // ctx.prec)
    try:
        result = acb.integral(value, start, stop, deg_limit=degree, **limits)
    except SystemError as error:
        errors.append(error)
    if errors:
        raise _origin(errors[0])
    return result


def _origin(error: BaseException) -> BaseException:
    """Return the first exception behind the reports of Python that a call gave a result beside it."""
    while isinstance(error, SystemError) and error.__cause__ is not None:
        error = error.__cause__
    return error
