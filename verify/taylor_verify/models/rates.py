"""The fastest rate of a motion at a state, which limits the step.

s  state, in the problem's units       J(s)  the Jacobian of the rates
"""

from __future__ import annotations

import operator
from collections.abc import Iterator, Mapping
from fractions import Fraction
from functools import lru_cache
from math import inf, isfinite
from typing import Any, Final, NamedTuple

import numpy as np
from flint import Ordering, fmpq, fmpq_mpoly_ctx

from taylor_verify.models.algebra import is_absent
from taylor_verify.models.form import Form
from taylor_verify.models.problem import Problem
from taylor_verify.models.symbol import Symbol

SLOWEST = 2.0**-10  # keeps a step finite for a body that is (almost) at rest
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
    ``doubles`` are the problem's parameters as such, from whoever has them.
    """

    def __init__(self, problem: Problem, doubles: Floats | None = None) -> None:
        self._momenta, terms = _linearised(problem.form)
        n = self._momenta
        given = map(float, problem.parameters) if doubles is None else doubles.tolist()
        parameters = np.array([1.0, *given])
        values = terms.coefficients * parameters[terms.factors].prod(axis=0)
        entries = np.bincount(terms.places, values, (n * n + 4) * (n + 1)).reshape(-1, n + 1)
        # A row for the constant, and one for each momentum.
        self._table: Floats = np.ascontiguousarray(entries.T)
        self._square = float(np.vdot(entries, entries))
        self._turns = "e0" in problem.form.states

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
            # Scaled, so that no square overflows.
            turns = np.linalg.norm(entries[..., -4:] / omega, axis=-1)
            bound = max(bound, omega * float(turns.max()))
        return max(bound, SLOWEST)

    def is_within(self, states: Any, rate: float) -> bool:
        """Return True if no row of an array of states has a faster rate.

        Most rows are decided by a cheap bound, |J^2|^(1/2) in Frobenius's norm.
        """
        augmented, square = self._augmented(states), rate * rate
        numbers = augmented.ravel()
        # NumPy's dot never warns, and what follows cannot overflow. NaN is not moderate.
        if numbers.dot(numbers) * self._square <= _MODERATE:
            entries = self._squares(augmented)
            entries *= entries
            sums = entries.dot(_sums(self._momenta, entries.shape[1])).ravel()
            if sums[sums.argmax()] <= square * square:
                return True
        return self.fastest(states) <= rate

    def _squares(self, augmented: Floats) -> Floats:
        """Return the entries of J^2 and, where an attitude turns, |omega|^2/4 at each row."""
        n = self._momenta
        rates = augmented.dot(self._table)
        J, omega = rates[:, :-4].reshape(-1, n, n), rates[:, -4:]
        entries = np.empty((len(rates), n * n + self._turns))
        entries[:, : n * n] = (J @ J).reshape(-1, n * n)
        if self._turns:
            entries[:, -1] = (omega * omega).sum(axis=1)
        return entries

    def _augmented(self, states: Any) -> Floats:
        """Return 1 and the momenta of a state, or of each row of an array."""
        augmented = np.empty((*states.shape[:-1], self._momenta + 1))
        augmented[..., 0] = 1.0
        augmented[..., 1:] = states[..., : self._momenta]
        return augmented


@lru_cache
def _sums(n: int, count: int) -> Floats:
    """Return the matrix that adds the first n^2 of so many numbers, and leaves those after them alone."""
    sums = np.zeros((count, 1 + count - n * n))
    sums[: n * n, 0], sums[n * n :, 1:] = 1.0, 1.0
    return sums


def _largest(numbers: Floats) -> float:
    """Return the largest size of a number, NaN if there is one; NumPy's maximum takes longer."""
    sizes = np.abs(numbers).ravel()
    return float(sizes[sizes.argmax()])


class _Terms(NamedTuple):
    """Terms c p_i p_j ... of a table: their places in it, row by row, c, and i, j, ... in columns.

    p_0 is 1, and p_i the i-th parameter. The table has a row for each entry of J, by rows, and one for each
    component of the attitude's rate; its columns are the constant and the factor of each s_k.
    """

    places: Indices
    coefficients: Floats
    factors: Indices


def momenta(form: Form) -> int:
    """Return the number of the momenta, which come first of all states."""
    return sum(name[0] not in "ec" for name in form.states)


@lru_cache(maxsize=64)
def _linearised(form: Form) -> tuple[int, _Terms]:
    """Return the number of the momenta, and the terms of J and omega/2."""
    n = momenta(form)
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
