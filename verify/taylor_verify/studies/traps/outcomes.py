"""Traps of what is reported: outcomes, step sizes, tolerances, and what is asked by way of them."""

from __future__ import annotations

from fractions import Fraction
from math import exp
from typing import Final

import numpy as np

from taylor_verify.scenes.reading.faults import Refused
from taylor_verify.scenes.reading.reader import read
from taylor_verify.solvers.taylor.driver import at_tolerance
from taylor_verify.solvers.taylor.plain import body
from taylor_verify.solvers.taylor.plain import outcomes as plain
from taylor_verify.studies.traps.document import TrapCase
from taylor_verify.studies.traps.measured import GENERIC, driver_on, error_at, free, typed_equations
from taylor_verify.studies.traps.trap import Cause, Trap

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
    outcomes, times, states = plain.lanes(typed_equations(), w, _END)
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
    ta, (outcome, *_) = plain.decay(float("nan"), 1.0)
    said = f"{outcome.name}; time {ta.time}, state {ta.state[0]}"
    return [TrapCase("x' = -x from NaN", said, None, _refusal(_NAN_SCENE))]


def _blown_up() -> list[TrapCase]:
    ta, (outcome, min_h, _, steps, *_) = plain.blow_up(1.0, 2.0)
    said = f"{outcome.name} at t = {ta.time:.17g} after steps down to {min_h:.2g}"
    driver = "no such equation: energy bounds every omega and impulse, and loads are constant"
    return [TrapCase("x' = x^2 from 1, until 2", said, None, driver, steps=steps)]


def _stopped() -> list[TrapCase]:
    ta, (outcome, _, _, steps, *_) = plain.decay(1.0, _END, max_steps=3)
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
    ta, (outcome, *_) = plain.decay(1.0, _END, callback=lambda ta: None)
    return [
        TrapCase(
            "a callback that returns nothing",
            f"{outcome.name}, at t = {ta.time:.3g}",
            abs(ta.state[0] / exp(-_END) - 1),
            "passes no callback",
        )
    ]


def _truth_of_outcomes() -> list[TrapCase]:
    found = {}
    _, (outcome, *_) = plain.decay(1.0, 1.0)
    found[outcome.name] = bool(outcome)
    _, (outcome, *_) = plain.decay(float("nan"), 1.0)
    found[outcome.name] = bool(outcome)
    said = ", ".join(f"{name} is {value}" for name, value in found.items())
    driver = "each outcome is looked up, and an unknown one is no success"
    return [TrapCase("if outcome: ...", said, None, driver)]


def _clamped() -> list[TrapCase]:
    _, (outcome, min_h, max_h, steps, *_) = plain.decay(1.0, 1.0, max_delta_t=0.125)
    said = f"{outcome.name}; smallest step {min_h:g}, largest {max_h:g}"
    return [TrapCase("steps of at most 0.125, until 1", said, None, "reads neither", steps=steps)]


def _zero_tolerance() -> list[TrapCase]:
    try:
        driver = at_tolerance("0").setting
    except ValueError as refusal:
        driver = f"refused: {refusal}"
    return [TrapCase("tol=0.0", f"tol = {plain.tolerance_of_zero():.3g}", None, driver)]


def _held_back() -> list[TrapCase]:
    at = plain.interrupted(_SOON, _LONG)
    case = f"Ctrl-C after {_SOON:g} s of a run until {_LONG:g}"
    driver = "returns to Python between its stretches, at most 24 of a run"
    return [TrapCase(case, f"KeyboardInterrupt at t = {at:g}", None, driver)]


def _forgotten() -> list[TrapCase]:
    outcome, state = body.unset(GENERIC, _END)
    driver, driver_error = driver_on(free("", GENERIC, _END))
    error = error_at(state, Fraction(_END))
    return [TrapCase("three parameters, none given", outcome.name, error, driver, driver_error)]


def _stored_code() -> list[TrapCase]:
    driver = "one folder for each type of processor"
    return [TrapCase("what compiled code is stored under", plain.cache_key(), None, driver)]


def _never_found() -> list[TrapCase]:
    found = f"{plain.stored_by(processes=3)} pieces of code on disk"
    return [TrapCase("one system in MPFR, compiled by three processes", found, None, "none")]


OUTCOMES: Final = (
    Trap(
        "T9",
        "one lane that is not finite stops all lanes of a batch",
        (plain.lanes,),
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
        (plain.decay,),
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
        (plain.blow_up,),
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
        (plain.decay,),
        _stopped,
        "reads the state of a run that was stopped by max_steps",
        "an outcome other than success has no rows and no score",
        Cause.DESIGN,
        silent=False,
    ),
    Trap(
        "S7",
        "a callback that returns nothing stops the run",
        (plain.decay,),
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
        (plain.decay,),
        _truth_of_outcomes,
        "asks whether an outcome is true",
        "outcomes are compared, never tested for truth",
        Cause.DESIGN,
    ),
    Trap(
        "S9",
        "steps that were cut are not counted among the smallest and largest",
        (plain.decay,),
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
        (plain.tolerance_of_zero,),
        _zero_tolerance,
        "asks for no error at all",
        "a tolerance that is not positive is refused",
        Cause.DESIGN,
    ),
    Trap(
        "S11",
        "Ctrl-C is heard at the end",
        (plain.swung,),
        _held_back,
        "is interrupted during a long run without a callback",
        "a long run is done in stretches",
        Cause.DESIGN,
        script="interrupt",
    ),
    Trap(
        "S12",
        "stored code does not know its processor",
        (plain.stored_key,),
        _stored_code,
        "stores compiled code under a key in which no processor occurs; that code carried to "
        "another type of processor may not run there is inferred, not reproduced",
        "keeps a folder for each type of processor",
        Cause.PARTLY,
        documented="Network file systems (e.g., NFS, SMB/CIFS) are not supported",
        where="notebooks/jit_caching.html",
        remark="Nothing is said of processors.",
    ),
    Trap(
        "S13",
        "parameters that are not given are zero",
        (body.unset,),
        _forgotten,
        "leaves out the parameters; the body keeps its omega, as one would that nothing turns",
        "every parameter of a problem is set, in the order in which its equations name them",
        Cause.DOCUMENTED,
        documented="heyoka.py detected that ode_sys contains one parameter, and set its value to "
        "zero",
        where="notebooks/ODEs%20with%20parameters.html",
    ),
    Trap(
        "S14",
        "stored code for MPFR numbers is never found again",
        (plain.stored_by,),
        _never_found,
        "compiles one system in several processes with the cache on disk; each stores it anew, under "
        "a key that addresses enter, and whoever next opens the cache reads all of it",
        "stores no code for MPFR numbers, and opens the cache once in a process",
        Cause.FAULT,
        script="real_is_never_found",
    ),
)
