# /// script
# requires-python = ">=3.11,<3.15"
# dependencies = [
#   "extensisq==0.6.0",
#   "numba==0.68.1",
#   "numpy==2.4.6",
#   "scipy==1.17.1",
# ]
# [tool.uv]
# no-binary-package = ["extensisq"]
# [tool.taylor-verify]
# title = "extensisq on SciPy"
# [tool.taylor-verify.methods]
# pr7 = "Prince 7(6)"
# pr8 = "Prince 8(7)"
# pr9 = "Prince 9(8)"
# swag = "Shampine-Gordon-Watts, Adams, order 1 to 12"
# [tool.taylor-verify.settings]
# rtol = 1e-9
# atol = "rtol"
# ///
"""extensisq: methods for SciPy's solve_ivp, Prince's pairs of order 7, 8 and 9, and Shampine-Gordon.

The right-hand side is compiled by numba; the steps are Python and NumPy. The states at the samples
are the interpolants of the methods.
"""

from __future__ import annotations

from typing import Any

from question import Question, Settings, Solved, answer, compiled_rates, twice

METHODS = {"pr7": "Pr7", "pr8": "Pr8", "pr9": "Pr9", "swag": "SWAG"}


def solve(question: Question, settings: Settings) -> Solved:
    import extensisq
    import numpy
    from scipy.integrate import solve_ivp

    fill = compiled_rates(question)
    method = getattr(extensisq, METHODS[settings.method])
    steps = 0

    class Counted(method):  # type: ignore[valid-type]
        """The method with its steps counted: solve_ivp counts evaluations alone."""

        def step(self) -> Any:
            nonlocal steps
            steps += 1
            return super().step()

    def rates(t: float, state: Any) -> Any:
        out = numpy.empty_like(state)
        fill(state, out)
        return out

    def propagate() -> Any:
        nonlocal steps
        steps = 0
        return solve_ivp(
            rates,
            (0.0, question.end),
            question.state,
            method=Counted,
            t_eval=question.instants,
            rtol=settings.rtol,
            atol=settings.atol,
        )

    solution, seconds, compiling = twice(propagate)
    if solution.status != 0:
        raise SystemExit(f"extensisq: {solution.message}")
    return Solved(solution.y.T, steps, solution.nfev, seconds, compiling)


if __name__ == "__main__":
    answer(solve)
