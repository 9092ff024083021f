"""Traps of time: late times, times that an equation sees, and times beyond the end."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any, Final

import heyoka as hy
import numpy as np
from continuous_output_view import kept as overwritten
from mpmath import mp
from time_in_equations import driven

from taylor_verify.scenes.motion import Clock
from taylor_verify.scenes.precision import exact_value, held_exactly
from traps.document import TrapCase
from traps.measured import GENERIC, driver_on, error_at, free, typed_equations
from traps.trap import Cause, Trap

Array = np.ndarray[Any, Any]

# The calls that no script of upstream has.


def until(equations: Any, w: Sequence[float], start: float, end: float) -> tuple[Any, int, Array]:
    """Propagate from one late time to another."""
    ta = hy.taylor_adaptive(equations, w, time=start)
    outcome, _, _, steps, _, _ = ta.propagate_until(end)
    return outcome, steps, ta.state


def beyond(equations: Any, w: Sequence[float], end: float, asked: float) -> Array:
    """Continuous output up to the end, asked for a later time."""
    ta = hy.taylor_adaptive(equations, w)
    *_, c_out, _ = ta.propagate_until(end, c_output=True)
    return np.array(c_out(asked))


# The cases.

_DURATION: Final = 100.0
_DIGITS: Final = 30


def _starting_late() -> list[TrapCase]:
    cases = []
    for start in (0, 10**6, 10**10, 10**15):
        outcome, x = driven(float(start), _DURATION)
        with mp.workdps(_DIGITS):
            truth = mp.sin(held_exactly(Fraction(_DURATION)))
            error = float(abs(held_exactly(exact_value(x)) - truth))
        ending, of_driver = driver_on(free("", GENERIC, _DURATION, start=start))
        cases.append(TrapCase(f"start at {start:g}", outcome.name, error, ending, of_driver))
    return cases


def _until_late() -> list[TrapCase]:
    cases = []
    for start in (10**10, 10**16):
        wanted = Fraction(3, 10)
        end = float(start + wanted)
        outcome, steps, state = until(typed_equations(), GENERIC, float(start), end)
        scene = free("", GENERIC, 1.0, start=start)
        scene = replace(scene, clock=Clock(Fraction(start), (start + wanted,)))
        ending, driven = driver_on(scene)
        case = f"from {start:g} for 0.3"
        cases.append(TrapCase(case, outcome.name, error_at(state, wanted), ending, driven, steps))
    return cases


def _beyond() -> list[TrapCase]:
    state = beyond(typed_equations(), GENERIC, 10.0, _DURATION)
    ending, driven = driver_on(free("", GENERIC, _DURATION))
    where = "output over [0, 10], asked at 100"
    return [TrapCase(where, "three numbers", error_at(state, Fraction(_DURATION)), ending, driven)]


def _views() -> list[TrapCase]:
    state = overwritten(typed_equations(), GENERIC, 1.0, 2.0)
    ending, driven = driver_on(free("", GENERIC, 2.0, samples=3))
    what = "output at 1, kept while that at 2 is asked for"
    return [TrapCase(what, "three numbers", error_at(state, Fraction(1)), ending, driven)]


_DENSE: Final = "notebooks/Dense%20output.html"

CLOCK: Final = (
    Trap(
        "T7",
        "an equation sees one double of the time, which is kept as two",
        (driven,),
        _starting_late,
        "integrates x' = cos(t - t0) from t0 over 100 units; the error is absolute, of a sine",
        "the equations have no time in them, and each run starts at zero: a body from the same t0",
        Cause.DESIGN,
        script="time_in_equations",
    ),
    Trap(
        "T8a",
        "continuous output answers for any time",
        (beyond,),
        _beyond,
        "asks for a time beyond the end",
        "integrates up to the last sample asked for, and has nothing to ask beyond it",
        Cause.DOCUMENTED,
        documented="heyoka.py will not prevent the use of a continuous_output object outside the "
        "guaranteed accuracy range",
        where=_DENSE,
    ),
    Trap(
        "T8b",
        "the next call overwrites the last answer",
        (overwritten,),
        _views,
        "keeps the answer of one call of the continuous output and makes another",
        "every sample is a row of its own",
        Cause.DESIGN,
        script="continuous_output_view",
    ),
    Trap(
        "S3",
        "a late end is one double",
        (until,),
        _until_late,
        "propagates until t0 + 0.3, a sum that is rounded before heyoka sees it; a body that has "
        "not moved is reported to have reached its time",
        "times since the start are formed exactly and rounded once",
        Cause.ARITHMETIC,
    ),
)
