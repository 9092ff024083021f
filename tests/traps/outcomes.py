"""Traps of what is reported: outcomes, step sizes, tolerances, and what is asked by way of them."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import exp
from typing import Any, Final

import heyoka as hy
import numpy as np
from batch_lane import lanes
from clamped_steps import decay
from interrupt import interrupted, swung

from taylor_verify.scenes.reading.faults import Refused
from taylor_verify.scenes.reading.reader import read
from taylor_verify.solvers.taylor.names import at_tolerance
from traps.document import TrapCase
from traps.measured import GENERIC, driver_on, error_at, free, typed_equations
from traps.trap import Cause, Trap

Array = np.ndarray[Any, Any]

# The calls that no script of upstream has.


def blow_up(x0: float, end: float) -> tuple[Any, Any]:
    """x' = x^2, which is infinite at t = 1/x0."""
    x = hy.make_vars("x")
    ta = hy.taylor_adaptive([(x, x * x)], [x0])
    return ta, ta.propagate_until(end)


def tolerance_of_zero() -> Any:
    """The tolerance of an integrator that was asked for none."""
    x = hy.make_vars("x")
    ta = hy.taylor_adaptive([(x, -x)], [1.0], tol=0.0)
    return ta.tol


def unset(w: Sequence[float], end: float) -> tuple[Any, Array]:
    """Propagate the same body with parameters that are never set."""
    w1, w2, w3 = hy.make_vars("w1", "w2", "w3")
    equations = [
        (w1, hy.par[0] * (w2 * w3)),
        (w2, hy.par[1] * (w3 * w1)),
        (w3, hy.par[2] * (w1 * w2)),
    ]
    ta = hy.taylor_adaptive(equations, w)
    outcome, *_ = ta.propagate_until(end)
    return outcome, ta.state


# The cases.

_ADAPTIVE: Final = "notebooks/The%20adaptive%20integrator.html"
_LANES: Final = 4
_END: Final = 10.0
# A run of many steps, of which there is time to do a part before it is interrupted.
_LONG: Final = 2e5
_SOON: Final = 0.02

_NAN_SCENE: Final = """
title = "A spin that is not a number"
model = "euler"
[body]
inertia = [1, 2, 3]
[initial]
omega = [nan, 1, 0]
[time]
end = 1
samples = 2
"""


def _refusal(text: str) -> str:
    try:
        read(text, "a scene with a NaN")
    except Refused as refused:
        return f"refused: {refused}"
    return "accepted"


def _lanes() -> list[TrapCase]:
    w = np.array([[value] * _LANES for value in GENERIC])
    w[0, -1] = np.nan
    outcomes, times, states = lanes(typed_equations(), w, _END)
    driver, driver_error = driver_on(free("", GENERIC, _END))
    healthy = [
        TrapCase(
            f"lane {lane + 1} of {_LANES}, sound; asked until {_END:g}",
            f"{outcomes[lane].name}, at t = {times[lane]:.3g}",
            error_at(states[:, lane], Fraction(_END)),
            driver,
            driver_error,
        )
        for lane in range(_LANES - 1)
    ]
    broken = TrapCase(
        f"lane {_LANES}, omega = (NaN, ...)", outcomes[-1].name, None, _refusal(_NAN_SCENE)
    )
    return [*healthy, broken]


def _not_finite() -> list[TrapCase]:
    ta, (outcome, *_) = decay(float("nan"), 1.0)
    ending = f"{outcome.name}; time {ta.time}, state {ta.state[0]}"
    return [TrapCase("x' = -x from NaN", ending, None, _refusal(_NAN_SCENE))]


def _blown_up() -> list[TrapCase]:
    ta, (outcome, min_h, _, steps, *_) = blow_up(1.0, 2.0)
    ending = f"{outcome.name} at t = {ta.time:.17g} after steps down to {min_h:.2g}"
    driver = "no such equation: energy bounds every omega and impulse, and loads are constant"
    return [TrapCase("x' = x^2 from 1, until 2", ending, None, driver, steps=steps)]


def _stopped() -> list[TrapCase]:
    ta, (outcome, _, _, steps, *_) = decay(1.0, _END, max_steps=3)
    driver, _ = driver_on(free("", GENERIC, 1e12))
    return [
        TrapCase(
            f"x' = -x until {_END:g}, at most 3 steps",
            f"{outcome.name}, at t = {ta.time:.3g}",
            abs(ta.state[0] / exp(-_END) - 1),
            f"a body over 1e12 radians: {driver}",
            steps=steps,
        )
    ]


def _without_return() -> list[TrapCase]:
    ta, (outcome, *_) = decay(1.0, _END, callback=lambda ta: None)
    return [
        TrapCase(
            "a callback that returns nothing",
            f"{outcome.name}, at t = {ta.time:.3g}",
            abs(ta.state[0] / exp(-_END) - 1),
            "passes no callback",
        )
    ]


def _truth_of_outcomes() -> list[TrapCase]:
    truth = {}
    _, (outcome, *_) = decay(1.0, 1.0)
    truth[outcome.name] = bool(outcome)
    _, (outcome, *_) = decay(float("nan"), 1.0)
    truth[outcome.name] = bool(outcome)
    ending = ", ".join(f"{name} is {value}" for name, value in truth.items())
    driver = "each outcome is looked up, and an unknown one is no success"
    return [TrapCase("if outcome: ...", ending, None, driver)]


def _clamped() -> list[TrapCase]:
    _, (outcome, min_h, max_h, steps, *_) = decay(1.0, 1.0, max_delta_t=0.125)
    ending = f"{outcome.name}; smallest step {min_h:g}, largest {max_h:g}"
    return [TrapCase("steps of at most 0.125, until 1", ending, None, "reads neither", steps=steps)]


def _zero_tolerance() -> list[TrapCase]:
    try:
        driver = at_tolerance("0").setting
    except ValueError as refusal:
        driver = f"refused: {refusal}"
    return [TrapCase("tol=0.0", f"tol = {tolerance_of_zero():.3g}", None, driver)]


def _held_back() -> list[TrapCase]:
    at = interrupted(_SOON, _LONG)
    case = f"Ctrl-C after {_SOON:g} s of a run until {_LONG:g}"
    driver = "returns to Python between its stretches, at most 24 of a run"
    return [TrapCase(case, f"KeyboardInterrupt at t = {at:g}", None, driver)]


def _forgotten() -> list[TrapCase]:
    outcome, state = unset(GENERIC, _END)
    driver, driver_error = driver_on(free("", GENERIC, _END))
    error = error_at(state, Fraction(_END))
    return [TrapCase("three parameters, none given", outcome.name, error, driver, driver_error)]


OUTCOMES: Final = (
    Trap(
        "T9",
        "one lane that is not finite stops all lanes of a batch",
        (lanes,),
        _lanes,
        "integrates four bodies side by side, one of them from NaN; the sound ones stop after one "
        "step and report success",
        "one body at a time, and a NaN is refused where it is read",
        Cause.PARTLY,
        documented="when a batch element reaches the final time, further steps for that batch "
        "element will be taken with a timestep of zero, until all batch elements reach the final "
        "time",
        where="notebooks/Batch%20mode%20overview.html",
        remark="Nothing is said of an element that fails.",
        script="batch_lane",
    ),
    Trap(
        "S4",
        "a state that is not finite takes the time with it",
        (decay,),
        _not_finite,
        "integrates from NaN; the outcome says so, and neither time nor state can be used again "
        "until both are set",
        "a NaN is refused where it is read; a run that comes to one has no rows",
        Cause.PARTLY,
        silent=False,
        documented="the time-limited propagation methods will stop integrating if a non-finite value "
        "is detected in the state vector at the end of the timestep",
        where=_ADAPTIVE,
        remark="Nothing is said of the time.",
    ),
    Trap(
        "S5",
        "a solution that ends before its time",
        (blow_up,),
        _blown_up,
        "integrates x' = x^2 across its pole; it is told, at the pole",
        "has no such equations",
        Cause.DOCUMENTED,
        silent=False,
        documented="In such case, the outcome of the integration will be err_nf_state",
        where=_ADAPTIVE,
    ),
    Trap(
        "S6",
        "a bound on the steps returns what there is",
        (decay,),
        _stopped,
        "reads the state of a run that was stopped by max_steps",
        "an outcome other than success has no rows and no score",
        Cause.DESIGN,
        silent=False,
    ),
    Trap(
        "S7",
        "a callback that returns nothing stops the run",
        (decay,),
        _without_return,
        "passes a callback that only looks",
        "passes no callback",
        Cause.DOCUMENTED,
        silent=False,
        documented="If the callback returns True then the integration will continue after the "
        "invocation of the callback, otherwise the integration will be interrupted",
        where=_ADAPTIVE,
    ),
    Trap(
        "S8",
        "every outcome is true",
        (decay,),
        _truth_of_outcomes,
        "asks whether an outcome is true",
        "outcomes are compared, never tested for truth",
        Cause.DESIGN,
    ),
    Trap(
        "S9",
        "steps that were cut are not counted among the smallest and largest",
        (decay,),
        _clamped,
        "bounds the step and asks which steps were taken",
        "reads the number of steps alone",
        Cause.CONTRADICTED,
        documented="the minimum and maximum integration timesteps that were used in the propagation",
        where=_ADAPTIVE,
        script="clamped_steps",
    ),
    Trap(
        "S10",
        "a tolerance of zero is the default one",
        (tolerance_of_zero,),
        _zero_tolerance,
        "asks for no error at all",
        "a tolerance that is not positive is refused",
        Cause.DESIGN,
    ),
    Trap(
        "S11",
        "Ctrl-C is heard at the end",
        (swung,),
        _held_back,
        "is interrupted during a long run without a callback",
        "a long run is done in stretches",
        Cause.DESIGN,
        script="interrupt",
    ),
    Trap(
        "S13",
        "parameters that are not given are zero",
        (unset,),
        _forgotten,
        "leaves out the parameters; the body keeps its omega, as one would that nothing turns",
        "every parameter of a problem is set, in the order in which its equations name them",
        Cause.DOCUMENTED,
        documented="heyoka.py detected that ode_sys contains one parameter, and set its value to "
        "zero",
        where="notebooks/ODEs%20with%20parameters.html",
    ),
)
