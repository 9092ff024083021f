"""The fastest rate of a motion at a state, which limits the step.

s  state, in the problem's units       J(s)  the Jacobian of the rates
"""

from __future__ import annotations

import operator
from collections.abc import Iterator, Mapping
from fractions import Fraction
from functools import lru_cache
from math import inf, isfinite, nan, sqrt
from typing import Any, Final, NamedTuple

import numpy as np
from flint import Ordering, fmpq, fmpq_mpoly_ctx

from taylor_verify.models.algebra import is_absent
from taylor_verify.models.form import Form
from taylor_verify.models.problem import Problem
from taylor_verify.models.symbol import Symbol

_SLOWEST = 2.0**-10  # keeps a step finite for a body that is (almost) at rest
_SQUARINGS: Final = 4
_NEARLY: Final = 1.2
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
        self._table: Floats = np.ascontiguousarray(entries.T)
        self._square = float(np.vdot(entries, entries))
        self._turns = "e0" in problem.form.states
        self._asked = 0
        self._products: _Products | None = None

    def fastest(self, states: Any) -> float:
        """Return the fastest rate at a state, or at all rows of an array; infinite where not finite.

        The unit is radians per unit of time. A component that is too small for the error control grows or
        turns at an eigenvalue of J, in any units. The eigenvalues are bounded by |J^16|^(1/16), which is
        some tenths too large; if it is worse, they are computed. The attitude turns at |omega|/2.
        """
        n = self._momenta
        with np.errstate(all="ignore"):
            entries = self._augmented(np.asarray(states)).dot(self._table)
        omega = _largest(entries[..., -4:]) if self._turns else 0.0
        J = entries[..., :-4].reshape(*entries.shape[:-1], n, n)
        bound = size = n * _largest(J)
        if not isfinite(size + omega):
            return inf
        power, before = J / size if size else J, bound
        for k in range(_SQUARINGS):
            power, before = power @ power, bound
            bound = size * (n * _largest(power)) ** (0.5 / 2**k)
        # A norm may exceed the spectral radius by a factor, of which only the N-th root remains.
        if not before <= _NEARLY * bound:
            bound = float(np.abs(np.linalg.eigvals(J)).max())
        if 2 * omega > bound:
            turns = entries[..., -4:].reshape(-1, 4) / omega
            bound = max(bound, omega * sqrt(_largest_sum_of_squares(turns)))
        return max(bound, _SLOWEST)

    def is_within(self, states: Any, rate: float) -> bool:
        """Return True if no row of an array of states has a faster rate.

        Most rows are decided by a cheap bound, |J^2|^(1/2) in Frobenius's norm. Whoever asks again, for as
        many rows, is answered from tables, in half the time.
        """
        n, asked, square = self._momenta, self._asked, rate * rate
        self._asked = len(states)
        if asked == len(states):
            if self._products is None or self._products.count != asked:
                self._products = _Products(self._table, asked, self._turns)
            return self._products.largest(states) <= square * square or self.fastest(states) <= rate
        augmented = self._augmented(states)
        numbers = augmented.ravel()
        # NumPy's dot never warns, and what follows cannot overflow. NaN is not moderate.
        if numbers.dot(numbers) * self._square <= _MODERATE:
            entries = augmented.dot(self._table)
            J = entries[:, :-4].reshape(-1, n, n)
            if _largest_sum_of_squares((J @ J).reshape(-1, n * n)) <= square * square and (
                not self._turns or _largest_sum_of_squares(entries[:, -4:]) <= square
            ):
                return True
        return self.fastest(states) <= rate

    def _augmented(self, states: Any) -> Floats:
        """Return 1 and the momenta of a state, or of each row of an array."""
        augmented = np.empty((*states.shape[:-1], self._momenta + 1))
        augmented[..., 0] = 1.0
        augmented[..., 1:] = states[..., : self._momenta]
        return augmented


class _Products:
    """J^2 and |omega|^2/4 at so many states, linear in the products of two numbers of (1, s).

    The rooms for all that is computed are made once.
    """

    def __init__(self, table: Floats, count: int, turns: bool) -> None:
        n = len(table) - 1
        left, right = np.triu_indices(n + 1)
        J, omega = table[:, :-4].reshape(n + 1, n, n), table[:, -4:]
        squares = J[left] @ J[right] + J[right] @ J[left]
        twice = np.where(left == right, 0.5, 1.0)[:, None]
        entries = [squares.reshape(len(left), -1) * twice]
        if turns:
            entries.append(2 * twice * (omega @ omega.T)[left, right][:, None])
        self._table = np.hstack(entries)
        self._square = float(np.vdot(table, table))
        # Of the squares of all entries, those of J^2 are added, and that of |omega|^2/4 stays alone.
        self._sums = np.zeros((self._table.shape[1], len(entries)))
        self._sums[: n * n, 0], self._sums[n * n :, 1:] = 1.0, 1.0
        self.count, self._left, self._right = count, left, right
        self._augmented = np.ones((count, n + 1))
        self._states, self._numbers = self._augmented[:, 1:], self._augmented.ravel()
        self._first, self._second = (np.empty((count, len(left))) for _ in range(2))
        self._entries = np.empty((count, len(self._sums)))
        self._bounds = np.empty((count, len(entries)))
        self._each = self._bounds.ravel()

    def largest(self, states: Any) -> float:
        """Return the largest |J^2|^2 or |omega|^4/16 of a row; NaN where the numbers are not moderate."""
        self._states[:] = states[:, : self._states.shape[1]]
        numbers, first, entries = self._numbers, self._first, self._entries
        if not numbers.dot(numbers) * self._square <= _MODERATE:
            return nan
        self._augmented.take(self._left, 1, first, "clip")
        first *= self._augmented.take(self._right, 1, self._second, "clip")
        first.dot(self._table, entries)
        entries *= entries
        entries.dot(self._sums, self._bounds)
        return float(self._each[self._each.argmax()])


def _largest(numbers: Floats) -> float:
    """Return the largest size of a number, NaN if there is one; NumPy's maximum takes longer."""
    sizes = np.abs(numbers).ravel()
    return float(sizes[sizes.argmax()])


def _largest_sum_of_squares(rows: Floats) -> float:
    """Return the largest sum of the squares of a row."""
    sums = (rows * rows).dot(_ones(rows.shape[1]))
    return float(sums[sums.argmax()])


@lru_cache
def _ones(count: int) -> Floats:
    return np.ones(count)


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
