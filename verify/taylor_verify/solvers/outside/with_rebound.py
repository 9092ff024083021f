# /// script
# requires-python = ">=3.11,<3.15"
# dependencies = [
#   "rebound==5.2.2",
#   "numba==0.68.1",
#   "numpy==2.4.6",
# ]
# [tool.taylor-verify]
# title = "REBOUND"
# [tool.taylor-verify.methods]
# bs = "Gragg-Bulirsch-Stoer"
# [tool.taylor-verify.settings]
# rtol = 1e-9
# atol = "rtol"
# ///
"""REBOUND's Bulirsch-Stoer integrator, which takes arbitrary equations besides particles.

There are no particles; the right-hand side is compiled by numba and called from C. A step is cut to
end on each sample, so nothing is interpolated. REBOUND does not count evaluations: the compiled
right-hand side does, in ``ref``, the field of its ODE that REBOUND leaves to the user.
"""

from __future__ import annotations

import ctypes
from functools import cache
from typing import Any

from question import Question, Settings, Solved, answer, compiled_rates, twice


def solve(question: Question, settings: Settings) -> Solved:
    # Compiled by the first propagation, and held as long as its address is in use.
    compiled = cache(lambda: _right_hand_side(question))
    (states, steps, evaluations), seconds, compiling = twice(
        lambda: _propagated(compiled().address, question, settings)
    )
    return Solved(states, steps, evaluations, seconds, compiling)


def _right_hand_side(question: Question) -> Any:
    from numba import carray, cfunc, types
    from rebound.ode import ODE

    fill, n = compiled_rates(question), len(question.state)
    # The ODE as an array of words, of which ref is one.
    ref = ODE.ref.offset // 8
    numbers = types.CPointer(types.float64)
    signature = types.void(types.CPointer(types.int64), numbers, numbers, types.float64)

    def rates(ode: Any, out: Any, state: Any, t: float) -> None:
        ode[ref] += 1
        fill(carray(state, (n,)), carray(out, (n,)))

    return cfunc(signature)(rates)


def _propagated(address: int, question: Question, settings: Settings) -> tuple[Any, int, int]:
    import rebound

    sim = rebound.Simulation()
    sim.integrator = settings.method
    sim.integrator.eps_rel, sim.integrator.eps_abs = settings.rtol, settings.atol
    ode = sim.create_ode(len(question.state), needs_nbody=False)
    ode._derivatives = ctypes.cast(address, type(ode._derivatives))
    ode.ref = 0
    for i, value in enumerate(question.state):
        ode.y[i] = value
    states = []
    for instant in question.instants:
        sim.integrate(instant)
        states.append(ode.y[: len(question.state)])
    return states, sim.steps_done, ode.ref or 0


if __name__ == "__main__":
    answer(solve)
