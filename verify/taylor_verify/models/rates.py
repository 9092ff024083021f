"""The fastest rate of a motion at a state, which limits the step.

s  state, in the problem's units       J(s)  the Jacobian of the rates
"""

from __future__ import annotations

import operator
from collections.abc import Iterator, Mapping
from fractions import Fraction
from functools import lru_cache
from math import inf, isfinite, sqrt
from typing import Any, Final, NamedTuple

import numpy as np
from flint import Ordering, fmpq, fmpq_mpoly_ctx

from taylor_verify.models.algebra import is_absent
from taylor_verify.models.form import Form
from taylor_verify.models.problem import Problem
from taylor_verify.models.symbol import Symbol

_SLOWEST = 2.0**-10  # keeps a step finite for a body that is (almost) at rest
_ENOUGH, _NEARLY = 4, 1.2
_ONES = np.ones(4)
# Numbers whose squares add up to this have fourth powers far below the largest double.
_MODERATE: Final = 2.0**400
_OPERATIONS: Final[Mapping[tuple[str, int], Any]] = {
    ("+", 2): operator.add,
    ("-", 2): operator.sub,
    ("-", 1): operator.neg,
    ("*", 2): operator.mul,
    ("/", 2): operator.truediv,
}

Floats = np.ndarray[Any, np.dtype[np.float64]]
Indices = np.ndarray[Any, np.dtype[np.intp]]


class Linearised:
    """The linearised equations of one problem, built once and evaluated at many states.

    The rates of the momenta are quadratic in them, so that J(s) = J(0) + sum_k s_k dJ/ds_k exactly.
    Doubles suffice, because the rate is needed to some per cent only. The momenta do not depend on the
    attitude. The attitude turns at |omega|/2, which is linear in the momenta. The centre enters no rate.
    """

    def __init__(self, problem: Problem) -> None:
        self._momenta, terms = _linearised(problem.form)
        n = self._momenta
        parameters = np.array([1.0, *map(float, problem.parameters)])
        values = terms.coefficients * parameters[terms.factors].prod(axis=0)
        entries = np.bincount(terms.places, values, (n * n + 4) * (n + 1)).reshape(-1, n + 1)
        # A row for the constant, and one for each momentum.
        self._table = np.ascontiguousarray(entries.T)
        self._square = float(np.vdot(entries, entries))
        self._shape, self._turns = (-1, n, n), "e0" in problem.form.states
        self._ones = np.ones(n * n)

    def fastest(self, states: Any, squarings: int = _ENOUGH) -> float:
        """Return the fastest rate at a state, or at all rows of an array; infinite where not finite.

        The unit is radians per unit of time. A component that is too small for the error control grows or
        turns at an eigenvalue of J, in any units. The eigenvalues are bounded by |J^N|^(1/N) with N =
        2^squarings. For N = 16 the bound is some tenths too large; if it is worse, the eigenvalues are
        computed. The attitude turns at |omega|/2.
        """
        rows = np.atleast_2d(states)[:, : self._momenta].astype(float)
        with np.errstate(all="ignore"):
            entries = rows @ self._table[1:] + self._table[0]
            J = entries[:, :-4].reshape(self._shape)
            bound = size = self._norm(J)
            turned = self._turned(entries) if self._turns else 0.0
        if not isfinite(size + turned):
            return inf
        power, before = J / size if size else J, bound
        for k in range(squarings):
            power, before = power @ power, bound
            bound = size * self._norm(power) ** (0.5 / 2**k)
        # A norm may exceed the spectral radius by a factor, of which only the N-th root remains.
        if squarings == _ENOUGH and not before <= _NEARLY * bound:
            bound = float(np.abs(np.linalg.eigvals(J)).max())
        return max(bound, turned, _SLOWEST)

    def is_within(self, states: Any, rate: float) -> bool:
        """Return True if no row of an array of states has a faster rate.

        Most rows are decided by a cheap bound, |J^2|^(1/2) in Frobenius's norm.
        """
        rows = states[:, : self._momenta]
        augmented = np.empty((len(rows), self._momenta + 1))
        augmented[:, 0] = 1.0
        augmented[:, 1:] = rows if rows.dtype == float else rows.astype(float)
        numbers = augmented.ravel()
        # NumPy's dot never warns, and what follows cannot overflow. NaN is not moderate.
        if numbers.dot(numbers) * self._square <= _MODERATE:
            entries = augmented.dot(self._table)
            J = entries[:, :-4].reshape(self._shape)
            squares = (J @ J).reshape(-1, len(self._ones))
            squares *= squares
            bound = _largest(squares.dot(self._ones))
            if bound <= rate**4 and (not self._turns or self._turned(entries) <= rate):
                return True
        return self.fastest(states) <= rate

    def _turned(self, entries: Any) -> float:
        """Return the largest |omega|/2."""
        omega = entries[:, -4:]
        return sqrt(_largest((omega * omega).dot(_ONES)))

    def _norm(self, matrices: Any) -> float:
        """Return a bound of Frobenius's norm of each: the largest entry times the order."""
        return self._shape[1] * float(np.maximum.reduce(np.abs(matrices), axis=None))


def _largest(numbers: Floats) -> float:
    """Return the largest number, NaN if there is one; NumPy's maximum takes four times as long."""
    return float(numbers[numbers.argmax()])


class _Terms(NamedTuple):
    """Terms c p_i p_j ... of a table: their places in it, row by row, c, and i, j, ... in columns.

    p_0 is 1, and p_i the i-th parameter. The table has a row for each entry of J, by rows, and one for each
    component of the attitude's rate; its columns are the constant and the factor of each s_k.
    """

    places: Indices
    coefficients: Floats
    factors: Indices


@lru_cache(maxsize=64)
def _linearised(form: Form) -> tuple[int, _Terms]:
    """Return the number of the momenta, which come first of all states, and the terms of J and omega/2."""
    n = sum(name[0] not in "ec" for name in form.states)
    terms = list[tuple[int, float, list[int]]]()
    for i, c, variables, factors in _monomials(form):
        if i < n:
            entries = [
                (n * i + k, variables[:p] + variables[p + 1 :]) for p, k in enumerate(variables)
            ]
        elif form.states[i][0] == "e" and n in variables:
            # The factor of e0 in the rate of the quaternion is (0, omega)/2.
            entries = [(n * n + i - n, [k for k in variables if k != n])]
        else:
            continue
        terms += [((n + 1) * row + sum(k + 1 for k in of), c, factors) for row, of in entries]
    degree = max((len(factors) for *_, factors in terms), default=0)
    padded = [factors + [0] * (degree - len(factors)) for *_, factors in terms]
    return n, _Terms(
        np.array([place for place, *_ in terms], dtype=np.intp),
        np.array([c for _, c, _ in terms], dtype=float),
        np.array(padded, dtype=np.intp).reshape(len(terms), degree).T,
    )


def _monomials(form: Form) -> Iterator[tuple[int, float, list[int], list[int]]]:
    """Yield the terms of every rate, multiplied out: the state's place, c, its variables, and parameters.

    A variable is repeated according to its power. Parameters are counted from 1.
    """
    names, n = [*form.states, *form.parameters], len(form.states)
    variables = fmpq_mpoly_ctx.get([f"v{i}" for i in range(len(names))], Ordering.lex).gens()
    known = dict(zip(names, variables, strict=True))
    for place, rate in enumerate(form.symbolic()):
        for powers, c in () if is_absent(rate) else _polynomial(rate, known).to_dict().items():
            factors = [i for i, power in enumerate(powers) for _ in range(int(power))]
            number = int(c.p) / int(c.q)
            yield (
                place,
                number,
                [i for i in factors if i < n],
                [i - n + 1 for i in factors if i >= n],
            )


def _polynomial(term: Any, known: Mapping[str, Any]) -> Any:
    """Return a symbolic rate as a polynomial; its numbers may be doubles, which flint does not take."""
    if not isinstance(term, Symbol):
        return fmpq(*Fraction(term).as_integer_ratio())
    if term.name:
        return known[term.name]
    operands = [_polynomial(operand, known) for operand in term.operands]
    return _OPERATIONS[term.operation, len(operands)](*operands)
