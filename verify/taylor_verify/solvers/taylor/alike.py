"""Problems of one form in float64 as arrays, as heyoka's batches take them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from taylor_verify.models.form import Form
from taylor_verify.models.problem import Problem
from taylor_verify.models.rates import Linearised
from taylor_verify.solvers.taylor.numbers import arithmetic
from taylor_verify.solvers.taylor.rate_bound import RateBound, rate_bound

Floats = np.ndarray[Any, np.dtype[np.float64]]


@dataclass(frozen=True, eq=False)
class Alike:
    """n problems of one form with as many samples, each in its own units.

    ``parameters`` (p, n), ``starts`` (s, n), ``grid`` (n, m) of the times, and ``rates`` (n), the fastest
    ones at the starts.
    """

    form: Form
    parameters: Floats
    starts: Floats
    grid: Floats
    rates: Floats
    linearised: tuple[Linearised, ...]
    bound: RateBound

    @classmethod
    def of(cls, problems: Sequence[Problem]) -> Alike:
        """Return problems on f64 as arrays; they must have one form, and as many samples."""
        numbers = arithmetic(problems[0].rung)
        parameters = [numbers.array(problem.parameters) for problem in problems]
        linearised = tuple(map(Linearised, problems, parameters))
        starts = [numbers.array(problem.initial_momenta) for problem in problems]
        return cls(
            problems[0].form,
            np.transpose(parameters),
            np.transpose(starts),
            np.array([numbers.times(problem.times) for problem in problems]),
            np.array([of.fastest(start) for of, start in zip(linearised, starts, strict=True)]),
            linearised,
            rate_bound(problems[0].form),
        )

    def __len__(self) -> int:
        return len(self.rates)

    def at(self, places: Any) -> Alike:
        """Return some of the problems."""
        return Alike(
            self.form,
            self.parameters[:, places],
            self.starts[:, places],
            self.grid[places],
            self.rates[places],
            tuple(self.linearised[k] for k in places),
            self.bound,
        )

    def grown(self, states: Floats, rates: Floats) -> Floats:
        """Return the fastest rate (n) at any of the states (s, n, m); 0 where it is not above ``rates``.

        Most are decided by a bound.
        """
        bounds = self.bound.fourth_powers(states, self.parameters)
        grown = np.zeros(len(self))
        for k in np.flatnonzero(~(bounds <= rates**4)):
            fastest = self.linearised[k].fastest(states[:, k].T)
            grown[k] = 0.0 if fastest <= rates[k] else fastest
        return grown
