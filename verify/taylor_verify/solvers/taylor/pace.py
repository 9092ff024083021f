"""The pace of heyoka's steps: one compiled form, run again and again over a stretch, unsampled.

This measures the cost of a form. Use the driver for runs whose results count.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from taylor_verify.models.problem import Problem
from taylor_verify.models.rates import Linearised
from taylor_verify.solvers.taylor.driver import compiled, pays
from taylor_verify.solvers.taylor.numbers import arithmetic
from taylor_verify.solvers.taylor.way import longest_step


class Pace:
    """A problem's own start, again and again, over ``span`` of its own units of time.

    ``literals`` writes the coefficients into the code instead of passing them to it.
    """

    def __init__(
        self,
        problem: Problem,
        span: Fraction,
        tolerance: Fraction | None = None,
        literals: bool = False,
    ) -> None:
        numbers = arithmetic(problem.rung)
        values = problem.parameters if literals else None
        self._integrator: Any = compiled(
            problem.form, problem.rung, tolerance, pays(problem.form, problem.rung), values
        )
        self._zero, self._end = numbers.array([Fraction(0), problem.rung.round(span)])
        self._start = numbers.array(problem.initial_momenta)
        self._parameters = numbers.array(() if literals else problem.parameters)
        rate = Linearised(problem).fastest([float(value) for value in problem.initial_momenta])
        self._longest = numbers.double(longest_step(self.order) / rate)

    @property
    def order(self) -> int:
        return int(self._integrator.order)

    def run(self) -> int:
        """Step from the start to the end of the stretch, and return the number of steps."""
        self._integrator.time = self._zero
        self._integrator.state[:] = self._start
        self._integrator.pars[:] = self._parameters
        outcome = self._integrator.propagate_until(self._end, max_delta_t=self._longest)
        return int(outcome[3])
