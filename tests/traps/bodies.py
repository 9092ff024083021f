"""Traps of the integration itself, on a free body of moments 1, 2, 3."""

from __future__ import annotations

from math import log
from typing import Final

from taylor_verify.scenes.precision import rung as rung_named
from taylor_verify.solvers.taylor.plain import Plain, euler_equations, free_body
from traps.document import TrapCase
from traps.measured import GENERIC, compared, free
from traps.trap import Cause, Trap

# The rate at which a spin about axis 2 of this body is left: sqrt((I2 - I1)(I3 - I2)/(I1 I3)).
_RATE: Final = 3**-0.5
_TURNS: Final = 10.0
_WIDEST: Final = "mp237"


def _literals() -> list[TrapCase]:
    """Return cases with moments as doubles on every rung, and as numbers of the widest rung."""
    rungs = [rung for rung in ("f64", "f80", "f128", _WIDEST) if _has(rung)]
    cases = [compared(free(rung, GENERIC, _TURNS), rung) for rung in rungs]
    typed = free(f"{_WIDEST}, moments of its own type", GENERIC, _TURNS)
    return [*cases, compared(typed, _WIDEST, typed=True)]


def _has(rung: str) -> bool:
    return not Plain().unavailable(rung_named(rung))


def _of_size(*sizes: float) -> list[TrapCase]:
    """Return cases of the generic spin made faster or slower, over the same turns."""
    return [
        compared(free(f"omega of size {size:g}", _sized(size), _TURNS / size)) for size in sizes
    ]


def _small() -> list[TrapCase]:
    return _of_size(1.0, 1e-5, 1e-8, 1e-10)


def _tiny() -> list[TrapCase]:
    return _of_size(1e-16, 1e-40)


def _large() -> list[TrapCase]:
    return _of_size(1e14, 1e15, 1e20)


def _sized(size: float) -> list[float]:
    return [size * value for value in GENERIC]


def first_tumble(d: float) -> float:
    """Return the time at which a start at the distance d from the spin about axis 2 has left it."""
    return log(1 / d) / _RATE


def _tumbles() -> list[TrapCase]:
    """Return cases in doubles at many distances, and on wide rungs with moments of their types."""
    asked = [(d, "f64") for d in (1e-4, 1e-6, 1e-8, 1e-12, 1e-16, 1e-20, 1e-40)]
    asked += [(d, rung) for d, rung in ((1e-20, "f128"), (1e-80, _WIDEST)) if _has(rung)]
    return [
        compared(
            free(f"d = {d:g}, {rung}", (d, 1.0, 0.0), first_tumble(d)), rung, typed=rung != "f64"
        )
        for d, rung in asked
    ]


def _returns() -> list[TrapCase]:
    """Return the case of a body back at the unstable spin, a motion that doubles cannot determine."""
    return [compared(free("d = 1e-15, back twice", (1e-15, 1.0, 0.0), 300.0, samples=41))]


_UNIT: Final = (
    "Absolute error control mode is activated when all elements of the state vector have a "
    "magnitude less than 1, while relative error control mode is activated when at least one "
    "element of the state vector has a magnitude greater than 1"
)
_CUSTOMISING: Final = "notebooks/Customising%20the%20adaptive%20integrator.html"
_ADAPTIVE: Final = "notebooks/The%20adaptive%20integrator.html"
_CALLS: Final = (euler_equations, free_body)

BODIES: Final = (
    Trap(
        "T1",
        "a literal in an expression is a double on every rung",
        _CALLS,
        _literals,
        "divides by the moment 3.0, which is exact; heyoka multiplies by 1/3.0, rounded to a double "
        "when the expression is built",
        "every coefficient is a parameter, typed and rounded once to the rung",
        Cause.FAULT,
        documented="The issue here is that the Python literal 1.1 is first interpreted as a "
        "double-precision value, and then widened",
        where="notebooks/ext_precision.html",
        remark="That is said of a number that is no double; 3.0 is one.",
        script="literal_division",
    ),
    Trap(
        "T2a",
        "below one, errors are absolute: a small state is kept to fewer digits",
        _CALLS,
        _small,
        "integrates a slow body in its own units; the smaller omega, the fewer steps",
        "the problem is posed in units of its own size, exact powers of two",
        Cause.CONSEQUENCE,
        documented=_UNIT,
        where=_CUSTOMISING,
        script="small_state",
    ),
    Trap(
        "T2b",
        "a tiny state takes one step of any length",
        _CALLS,
        _tiny,
        "integrates a body so slow that its last Taylor coefficients underflow; the step that they "
        "ask for has no bound, and the whole span is taken at once",
        "the problem is posed in units of its own size, exact powers of two",
        Cause.FAULT,
        documented="the automatic timestep deduction algorithm may return a timestep of infinity",
        where=_ADAPTIVE,
        remark="That is said of solutions that are polynomials, and the functions that propagate are "
        "said not to be affected.",
        script="tiny_state_single_step",
    ),
    Trap(
        "T3",
        "beside the unstable axis a component is lost next to its large neighbour",
        _CALLS,
        _tumbles,
        "starts a spin about the middle axis at a distance d and stops at the first tumble; the "
        "error of a step is measured against the whole state, so that d carries an error of 1e-16 "
        "and not one of 1e-16 d",
        "no step is longer than half the fastest linear time scale, in which d cannot hide",
        Cause.CONSEQUENCE,
        documented=_UNIT,
        where=_CUSTOMISING,
        script="unstable_axis",
    ),
    Trap(
        "T10",
        "a conserved quantity certifies no state",
        _CALLS,
        _returns,
        "lets a body come back to the unstable spin, which no double determines, and keeps energy "
        "and momentum to the last digit",
        "no better, and nobody could be; the judge finds the gate of the state vacuous and says so",
        Cause.ARITHMETIC,
    ),
    Trap(
        "S1",
        "a large state overflows",
        _CALLS,
        _large,
        "integrates a fast body in its own units; the coefficient of order 20 overflows",
        "the problem is posed in units of its own size, exact powers of two",
        Cause.DOCUMENTED,
        silent=False,
        documented="the time-limited propagation methods will stop integrating if a non-finite value "
        "is detected in the state vector at the end of the timestep",
        where=_ADAPTIVE,
    ),
)
