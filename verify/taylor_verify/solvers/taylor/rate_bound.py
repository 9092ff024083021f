"""A bound of the fastest rate of a form's motions, compiled, for many states of one motion at once."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any, final

import numpy as np

from taylor_verify.models.form import Form
from taylor_verify.models.problem import Problem
from taylor_verify.models.rates import momenta
from taylor_verify.numbers.decimal_point import decimal_point
from taylor_verify.solvers.taylor.equations import equations


@final
@dataclass(frozen=True)
class RateBound:
    """The bounds of `rates.py` for one form, as functions of the momenta and the parameters.

    One is the square of |J^2| in Frobenius's norm. The other, where an attitude turns, is |omega/2|^4.
    """

    momenta: int
    evaluate: Any


@final
class Look:
    """The bound for one problem at ``count`` of its states, time and again."""

    def __init__(self, problem: Problem, count: int) -> None:
        self._bound = rate_bound(problem.form)
        inputs = np.empty((self._bound.momenta + len(problem.parameters), count))
        # What does not change is in its place.
        inputs[self._bound.momenta :].T[:] = [float(value) for value in problem.parameters]
        self._inputs, self._momenta = inputs, inputs[: self._bound.momenta]

    def is_within(self, states: Any, rate: float) -> bool:
        """Return True if the bound is not above ``rate`` at any row of the states; False proves nothing."""
        self._momenta[:] = states.T[: len(self._momenta)]
        bounds, square = self._bound.evaluate(self._inputs).ravel(), rate * rate
        # The largest is NaN where one is.
        return bool(bounds[bounds.argmax()] <= square * square)


@lru_cache(maxsize=32)
@decimal_point()
def rate_bound(form: Form) -> RateBound:
    """Return the bound for a form, compiled in some hundredths of a second."""
    import heyoka as hy

    coefficients = [hy.expression(name) for name in form.parameters]
    states, rates = zip(*equations(form, coefficients), strict=True)
    n = momenta(form)
    J = np.array([[hy.diff(rate, state) for state in states[:n]] for rate in rates[:n]])
    bounds = [hy.sum([entry**2 for entry in J.dot(J).ravel()])]
    if "e0" in form.states:
        # The factors of e0 in the rates of e1, e2 and e3 are omega/2.
        e0 = form.states.index("e0")
        omega = [hy.diff(rate, states[e0]) for rate in rates[e0 + 1 : e0 + 4]]
        bounds.append(hy.sum([entry**2 for entry in omega]) ** 2)
    return RateBound(n, hy.cfunc(bounds, [*states[:n], *coefficients], compact_mode=False))
