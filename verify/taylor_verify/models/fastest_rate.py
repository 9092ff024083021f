"""The fastest rate of a motion at a state, which limits the step.

s  state, in the problem's units       J(s)  the Jacobian of the rates
"""

from __future__ import annotations

from math import inf, isfinite
from typing import Any, Final

import numpy as np

from taylor_verify.models.form import Form
from taylor_verify.models.problem import Problem

SLOWEST = 2.0**-10  # keeps a step finite for a body that is (almost) at rest
_SQUARINGS: Final = 4
_NEARLY: Final = 1.2
# A step so small that its square is nothing beside one.
_ASIDE: Final = 2.0**-300

Floats = np.ndarray[Any, np.dtype[np.float64]]


class Linearised:
    """The linearised equations of one problem, built once and evaluated at many states.

    The rates of the momenta are quadratic in them, so that J(s) = J(0) + sum_k s_k dJ/ds_k exactly.
    Doubles suffice, because the rate is needed to some per cent only. The momenta do not depend on the
    attitude. The attitude turns at |omega|/2, which is linear in the momenta. The centre enters no rate.
    """

    def __init__(self, problem: Problem) -> None:
        self._momenta = momenta(problem.form)
        self._table = _table(problem.form, np.array([float(v) for v in problem.parameters]))
        self._turns = "e0" in problem.form.states

    def fastest(self, states: Any, times: Any = ()) -> float:
        """Return the fastest rate at a state, or at all rows of an array; infinite where not finite.

        The unit is radians per unit of time. A component that is too small for the error control grows or
        turns at an eigenvalue of J, in any units. The attitude turns at |omega|/2. No equation reads the
        ``times``.
        """
        del times
        n = self._momenta
        with np.errstate(all="ignore"):
            entries = self._augmented(np.asarray(states)).dot(self._table)
        omega = _largest(entries[..., -4:]) if self._turns else 0.0
        bound = largest_eigenvalue(entries[..., :-4].reshape(*entries.shape[:-1], n, n))
        if not isfinite(bound + omega):
            return inf
        if 2 * omega > bound:
            # Scaled, so that no square overflows.
            turns = np.linalg.norm(entries[..., -4:] / omega, axis=-1)
            bound = max(bound, omega * float(turns.max()))
        return max(bound, SLOWEST)

    def _augmented(self, states: Any) -> Floats:
        """Return 1 and the momenta of a state, or of each row of an array."""
        augmented = np.empty((*states.shape[:-1], self._momenta + 1))
        augmented[..., 0] = 1.0
        augmented[..., 1:] = states[..., : self._momenta]
        return augmented


def largest_eigenvalue(J: Floats) -> float:
    """Return a bound of the eigenvalues of all matrices of an array, some tenths too large.

    It is |J^16|^(1/16); if that is worse, the eigenvalues are computed. Infinite where J is not finite.
    """
    n = J.shape[-1]
    bound = size = n * _largest(J)
    if not isfinite(size):
        return inf
    power, before = J / size if size else J, bound
    for k in range(_SQUARINGS):
        power, before = power @ power, bound
        bound = size * (n * _largest(power)) ** (0.5 / 2**k)
    # A norm may exceed the spectral radius by a factor, of which only the N-th root remains.
    return bound if before <= _NEARLY * bound else float(np.abs(np.linalg.eigvals(J)).max())


def _largest(numbers: Floats) -> float:
    """Return the largest size of a number, NaN if there is one; NumPy's maximum takes longer."""
    sizes = np.abs(numbers).ravel()
    return float(sizes[sizes.argmax()])


def momenta(form: Form) -> int:
    """Return the number of the momenta, which come first of all states."""
    return sum(name[0] not in "ec" for name in form.states)


def _table(form: Form, parameters: Floats) -> Floats:
    """Return the entries of J and of 0 and omega/2: a row for the constant, and one for each momentum.

    J comes from steps into the complex plane, so small that nothing is neglected and nothing cancels.
    The factor of e0 in the rate of the quaternion is (0, omega)/2.
    """
    n = momenta(form)
    others = [float(name == "e0") for name in form.states[n:]]
    points = np.vstack([np.zeros(n), np.eye(n)])
    # Axes: the momenta, the points, the directions.
    around = points.T[:, :, None] + 1j * _ASIDE * np.eye(n)[:, None, :]
    rates = form.rates([*around, *others], [*parameters])
    whole = np.array([rate + np.zeros_like(around[0]) for rate in rates])
    turns = whole[n : n + 4, :, 0] if "e0" in form.states else np.zeros((4, n + 1))
    J = np.moveaxis(whole[:n].imag, 0, 1).reshape(n + 1, n * n) / _ASIDE
    entries = np.hstack([J, turns.real.T])
    entries[1:] -= entries[0]
    return np.ascontiguousarray(entries)
