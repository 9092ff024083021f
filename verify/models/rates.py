"""How fast a motion is at a state: the rate on which the longest step rests."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from verify.models.problem import Problem

_SLOWEST = 2.0**-10  # keeps a step finite for a body that is (almost) at rest


def fastest_rate(problem: Problem, state: Sequence[float]) -> float:
    """The spectral radius of the linearised equations at a state, in the problem's units of time.

    A component too small for the error control to see grows or turns at one of these rates; they do
    not depend on the units of the components. All rates are quadratic in (x, y, H) and linear in a
    quaternion, so that central differences with step one are exact up to rounding. Doubles
    suffice: the rate is used to within a few per cent.
    """
    # The centre enters no rate, and its own row is the only one that is cubic.
    kept = [i for i, name in enumerate(problem.form.states) if not name.startswith("c")]
    point = np.array(state, dtype=float)
    parameters = [float(value) for value in problem.parameters]
    columns = []
    for i in kept:
        step = np.zeros(len(point))
        step[i] = 1.0
        ahead = problem.form.rates(list(point + step), parameters)
        behind = problem.form.rates(list(point - step), parameters)
        columns.append([(float(ahead[j]) - float(behind[j])) / 2 for j in kept])
    jacobian = np.array(columns)
    if not np.all(np.isfinite(jacobian)):
        return float("inf")
    return max(float(np.max(np.abs(np.linalg.eigvals(jacobian)))), _SLOWEST)
