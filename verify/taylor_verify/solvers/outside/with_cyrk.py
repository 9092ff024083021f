# /// script
# requires-python = ">=3.11,<3.15"
# dependencies = [
#   "CyRK==0.20.0",
#   "numba==0.68.1",
#   "numpy==2.4.6",
#   "scipy==1.17.1",
# ]
# [tool.taylor-verify]
# title = "CyRK"
# serves = true
# [tool.taylor-verify.methods]
# dop853 = "Dormand-Prince 8(5,3)"
# tsit5 = "Tsitouras 5(4)"
# vern7 = "Verner 7(6)"
# vern8 = "Verner 8(7)"
# lsoda = "ODEPACK's LSODA"
# [tool.taylor-verify.settings]
# rtol = 1e-9
# atol = "rtol"
# ///
"""CyRK: explicit Runge-Kutta methods and LSODA in C++, called with equations compiled by numba.

Nothing of a propagation is Python. The states at the samples are the interpolants of the methods.
CyRK's solver for numba, `nbsolve2_ivp`, takes twenty seconds to compile and then hands its arguments
to a C function; here that function is called directly. CyRK does not count evaluations: the compiled
right-hand side does, in the argument that CyRK keeps for it.
"""

from __future__ import annotations

import ctypes
from typing import Any

from question import (
    Question,
    Settings,
    Solved,
    answer,
    compiled_rates,
    once_for_equations,
    twice,
)

METHODS = {
    "dop853": "DOP853",
    "tsit5": "Tsit5",
    "vern7": "Vern7",
    "vern8": "Vern8",
    "lsoda": "LSODA",
}
# Megabytes, above which CyRK refuses to go on.
MOST_MEMORY = 2000


def solve(question: Question, settings: Settings) -> Solved:
    def propagate() -> tuple[Any, int, int]:
        return _propagated(_right_hand_side(question).address, question, settings)

    (states, steps, evaluations), seconds, compiling = twice(propagate)
    return Solved(states, steps, evaluations, seconds, compiling, again=propagate)


# Compiled by the first propagation; whoever holds the address must hold the code behind it too.
@once_for_equations
def _right_hand_side(question: Question) -> Any:
    from CyRK import cyjit
    from numba import carray

    fill, n = compiled_rates(question), len(question.state)

    def counted(out: Any, t: float, state: Any, count: Any) -> None:
        count[0] += 1.0
        fill(carray(state, (n,)), carray(out, (n,)))

    return cyjit(counted)


def _propagated(address: int, question: Question, settings: Settings) -> tuple[Any, int, int]:
    """Return the states, the steps and the evaluations, by the C function of CyRK itself."""
    import numpy
    from CyRK.cy.common import MAX_SIZE
    from CyRK.cy.pyhelpers import find_ode_method_int
    from CyRK.nb import numba_solver as c

    start, instants = numpy.array(question.state), numpy.array(question.instants)
    rtol, atol, count = (numpy.array([value]) for value in (settings.rtol, settings.atol, 0.0))
    solution = c.c_numba_cysolve_ivp(
        address,
        0.0,
        question.end,
        start.ctypes.data,
        start.size,
        find_ode_method_int(METHODS[settings.method]),
        0,  # no size is expected
        0,  # nothing extra
        count.ctypes.data,
        count.nbytes,
        0,  # any number of steps
        MOST_MEMORY,
        False,  # noqa: FBT003 (no names; the interpolant is not kept)
        instants.ctypes.data,
        instants.size,
        0,  # nothing is called before an evaluation
        0,  # no events
        0,  # no events
        rtol.ctypes.data,
        rtol.size,
        atol.ctypes.data,
        atol.size,
        MAX_SIZE,  # the longest step
        0.0,  # the first step
        True,  # noqa: FBT003 (no names; the counts are kept)
    )
    try:
        size = c.c_get_size(solution)
        if not c.c_get_success(solution) or size != instants.size:
            raise SystemExit(f"CyRK: status {c.c_get_status(solution)} after {size} samples")
        states = numpy.ctypeslib.as_array(c.c_get_y_ptr(solution), (size, start.size)).copy()
        counted = ctypes.cast(c.c_get_args_ptr(solution), ctypes.POINTER(ctypes.c_double))
        return states, c.c_get_steps(solution), int(counted[0])
    finally:
        c.c_free(solution)


if __name__ == "__main__":
    answer(solve)
