# /// script
# requires-python = ">=3.11,<3.15"
# dependencies = [
#   "scikit-sundae==1.2.0",
#   "numba==0.68.1",
#   "numpy==2.4.6",
#   "scipy==1.17.1",
# ]
# [tool.taylor-verify]
# title = "SUNDIALS CVODE, by scikit-sundae"
# serves = true
# [tool.taylor-verify.methods]
# adams = "Adams-Moulton, order 1 to 12"
# bdf = "BDF, order 1 to 5; Jacobian by differences"
# [tool.taylor-verify.settings]
# rtol = 1e-9
# atol = "rtol"
# ///
"""CVODE of SUNDIALS, by scikit-sundae: variable-order Adams (to order 12) and BDF (to order 5).

The right-hand side is compiled by numba; the library calls it by way of Python. The states at the
samples are CVODE's own interpolation, a polynomial of the method's order. CVODE counts its steps, but
scikit-sundae does not hand the count on: a run step by step, not timed, counts them.
"""

from __future__ import annotations

import time
from typing import Any

from question import Question, Settings, Solved, answer, compiled_rates, twice

METHODS = {"adams": "Adams", "bdf": "BDF"}
# CVODE stops after 500 steps between two samples where nothing is said.
MOST_STEPS = 10**7


def solve(question: Question, settings: Settings) -> Solved:
    import numpy
    from sksundae.cvode import CVODE

    began = time.perf_counter()
    fill = compiled_rates(question)
    start = numpy.array(question.state)
    # Compiled for arrays that are read-only, as CVODE's are.
    read_only = start.copy()
    read_only.flags.writeable = False
    fill(read_only, numpy.empty_like(start))
    compiling = time.perf_counter() - began

    def rates(t: float, y: Any, yp: Any) -> None:
        fill(y, yp)

    solver = CVODE(
        rates,
        method=METHODS[settings.method],
        rtol=settings.rtol,
        atol=settings.atol,
        max_num_steps=MOST_STEPS,
    )

    def propagate() -> Any:
        return solver.solve(question.instants, start)

    solution, seconds, more = twice(propagate)
    if not solution.success:
        raise SystemExit(f"CVODE: {solution.message}")
    steps = _steps(solver, question, start)
    return Solved(solution.y, steps, solution.nfev, seconds, compiling + more, again=propagate)


def _steps(solver: Any, question: Question, start: Any) -> int:
    solver.init_step(0.0, start)
    steps, now = 0, 0.0
    while now < question.end:
        now = float(solver.step(question.end, method="onestep").t)
        steps += 1
    return steps


if __name__ == "__main__":
    answer(solve)
