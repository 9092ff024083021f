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
    steps = np.zeros((len(point), 2 * len(kept)))
    for column, i in enumerate(kept):
        steps[i, column], steps[i, column + len(kept)] = 1.0, -1.0
    # All the neighbours at once: the equations work on rows as they do on numbers.
    found = problem.form.rates(list(point[:, None] + steps), parameters)
    rows = [np.broadcast_to(np.asarray(found[j], dtype=float), 2 * len(kept)) for j in kept]
    ahead, behind = np.hsplit(np.array(rows), 2)
    jacobian = (ahead - behind) / 2
    if not np.all(np.isfinite(jacobian)):
        return float("inf")
    return max(float(np.max(np.abs(np.linalg.eigvals(jacobian)))), _SLOWEST)
