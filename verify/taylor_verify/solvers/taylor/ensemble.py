"""Many starts at once, in heyoka's batches where it has them: one lane for each start.

On f32 and f64 a processor steps several lanes in one instruction. heyoka then stops all lanes as soon as
one of them is not finite: here that lane is taken out, another's numbers step in its place unseen, and
the others go on as if it had never been there. On the other rungs every lane is a batch of its own.

Nothing is kept between two calls of `advance` but what a `Lane` holds, in exact numbers: a run that
is taken up again from its lanes is the same to the last bit as one that was never left.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from copy import deepcopy
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache
from math import inf, isfinite
from typing import Any, Final, final

import numpy as np

from taylor_verify.models.fastest_rate import Linearised
from taylor_verify.models.form import Form
from taylor_verify.models.problem import Problem
from taylor_verify.numbers.decimal_point import decimal_point
from taylor_verify.numbers.precision import Rung
from taylor_verify.solvers.taylor.driver import compiled
from taylor_verify.solvers.taylor.heyoka_equations import equations
from taylor_verify.solvers.taylor.numbers import arithmetic, unavailable
from taylor_verify.solvers.taylor.package import heyoka_cache_off
from taylor_verify.solvers.taylor.way import MOST_RADIANS, longest_step, most_steps, outcome_of
from taylor_verify.solvers.trajectory import Outcome

Array = np.ndarray[Any, Any]

# The rungs that heyoka has batches for, as NumPy calls them.
_BATCHED: Final = {"f32": np.float32, "f64": float}
# A long run is worth half a second of compiling; beyond this many states it would be many.
_LARGEST_STRAIGHT_LINE: Final = 6


@dataclass(frozen=True)
class Lane:
    """A start on its way: its state at ``time``, both in the units of its problem.

    ``fastest`` is the fastest linear rate that it has met, on which its longest step rests. FINISHED
    means that it has come as far as it was asked to; any other ``outcome`` is where it ended, and
    its state is then the last that is known.
    """

    time: Fraction
    state: tuple[Fraction, ...]
    fastest: float = 0.0
    steps: int = 0
    outcome: Outcome = Outcome.FINISHED

    @property
    def goes_on(self) -> bool:
        return self.outcome is Outcome.FINISHED

    def radians_to(self, target: Fraction) -> float:
        """Return the length of the way to a time, in radians of its fastest rate."""
        return self.fastest * abs(float(target - self.time))


@final
class Ensemble:
    """Problems of one form on one rung, integrated beside each other by the Taylor method.

    ``tolerance`` is as in Taylor. Raises ValueError for problems that differ in form or rung, and
    where the rung is not available.
    """

    def __init__(self, problems: Sequence[Problem], tolerance: Fraction | None = None) -> None:
        _check(problems, tolerance)
        self.problems = tuple(problems)
        form, rung = problems[0].form, problems[0].rung
        self._numbers = arithmetic(rung)
        self._linearised = [Linearised(problem) for problem in problems]
        width = batch_width(rung)
        first = _stepper(form, rung, tolerance, width)
        lanes = range(len(problems))
        self._groups = [lanes[i : i + width] for i in lanes[::width]]
        # They share their code; each has a state of its own, for they run at the same time.
        self._steppers = [deepcopy(first) for _ in self._groups]
        self._is_batch = width > 1

    def start(self) -> tuple[Lane, ...]:
        """Return every lane at its initial state."""
        return tuple(Lane(Fraction(0), problem.initial_momenta) for problem in self.problems)

    def advance(self, lanes: Sequence[Lane], until: Sequence[Fraction]) -> tuple[Lane, ...]:
        """Return every lane that goes on at its time in ``until``: numbers of the rung, in its own units.

        A lane that does not get there is left where it was, with an outcome that says why.
        """
        ready = [
            self._prepared(*arguments)
            for arguments in zip(self._linearised, lanes, until, strict=True)
        ]
        # heyoka steps without the interpreter: threads are as good as processes.
        with ThreadPoolExecutor(_processors()) as pool:
            jobs = [
                pool.submit(
                    self._run, stepper, group, [ready[i] for i in group], [until[i] for i in group]
                )
                for group, stepper in zip(self._groups, self._steppers, strict=True)
            ]
            return tuple(lane for job in jobs for lane in job.result())

    @staticmethod
    def _prepared(linearised: Linearised, lane: Lane, until: Fraction) -> Lane:
        """Return the lane with the rate that it steps by, or taken out where that is not finite."""
        if not lane.goes_on:
            return lane
        rate = max(lane.fastest, linearised.fastest([_double(v) for v in lane.state]))
        if not isfinite(rate):
            return replace(lane, outcome=Outcome.NON_FINITE)
        ready = replace(lane, fastest=rate)
        if not ready.radians_to(until) <= MOST_RADIANS:
            return replace(lane, outcome=Outcome.STEP_LIMIT)
        return ready

    def _run(
        self, stepper: Any, group: Sequence[int], lanes: list[Lane], targets: Sequence[Fraction]
    ) -> list[Lane]:
        if not any(lane.goes_on for lane in lanes):
            return lanes
        if not self._is_batch:
            return [self._run_alone(stepper, group[0], lanes[0], targets[0])]
        return self._run_batch(stepper, group, lanes, targets)

    def _run_alone(self, integrator: Any, i: int, lane: Lane, target: Fraction) -> Lane:
        numbers = self._numbers
        integrator.time, end = numbers.array([lane.time, target])
        integrator.state[:] = numbers.array(lane.state)
        integrator.pars[:] = numbers.array(self.problems[i].parameters)
        status, _, _, steps, *_ = integrator.propagate_until(
            end,
            max_delta_t=numbers.double(longest_step(int(integrator.order)) / lane.fastest),
            max_steps=most_steps(lane.radians_to(target)),
        )
        return self._reached(lane, target, outcome_of(status), int(steps), integrator.state)

    def _run_batch(
        self, integrator: Any, group: Sequence[int], lanes: list[Lane], targets: Sequence[Fraction]
    ) -> list[Lane]:
        numbers, width, lanes = self._numbers, integrator.batch_size, list(lanes)
        # The last group may have fewer lanes than the batch: the places left over stay empty.
        end = _padded(numbers.array(targets), width)
        time = _padded(numbers.array([lane.time for lane in lanes]), width)
        state = _padded(np.array([numbers.array(lane.state) for lane in lanes]).T, width)
        given = [numbers.array(self.problems[i].parameters) for i in group]
        parameters = _padded(np.array(given, dtype=numbers.fp_type).T, width)
        rates = [lane.fastest if lane.goes_on else 1.0 for lane in lanes]
        rates += rates[:1] * (width - len(lanes))
        cap = longest_step(int(integrator.order))
        longest = np.array([numbers.double(cap / rate) for rate in rates])
        steps = np.zeros(width, dtype=int)
        while going := [k for k, lane in enumerate(lanes) if lane.goes_on]:
            # A place without a lane that goes on holds another's numbers, and is where it should be.
            for k in set(range(width)) - set(going):
                state[:, k], parameters[:, k] = state[:, going[0]], parameters[:, going[0]]
                time[k] = end[k] = end[going[0]]
            integrator.set_time(time)
            integrator.state[:], integrator.pars[:] = state, parameters
            most = max(most_steps(lanes[k].radians_to(targets[k])) for k in going)
            integrator.propagate_until(end, max_delta_t=longest, max_steps=most)
            results = integrator.propagate_res
            steps += [int(result[3]) for result in results]
            finite = np.isfinite(integrator.state).all(axis=0) & np.isfinite(integrator.time)
            lost = [k for k in going if not finite[k]]
            for k in lost or going:
                outcome = Outcome.NON_FINITE if lost else outcome_of(results[k][0])
                reached = integrator.state[:, k]
                lanes[k] = self._reached(lanes[k], targets[k], outcome, int(steps[k]), reached)
            if not lost:
                break
            # The others have been stopped where they are, not at their targets: they go on from there.
            time, state = integrator.time.copy(), integrator.state.copy()
        return lanes

    def _reached(
        self, lane: Lane, target: Fraction, outcome: Outcome, steps: int, state: Array
    ) -> Lane:
        lane = replace(lane, steps=lane.steps + steps)
        if outcome is Outcome.FINISHED and not np.isfinite(state).all():
            outcome = Outcome.NON_FINITE
        if outcome is not Outcome.FINISHED:
            return replace(lane, outcome=outcome)
        exact = tuple(self._numbers.exact(value) for value in state)
        return replace(lane, time=target, state=exact)


def batch_width(rung: Rung) -> int:
    """Return the lanes that this processor steps at once; 1 where heyoka has no batch for the rung."""
    import heyoka as hy

    kind = _BATCHED.get(rung.name)
    return 1 if kind is None else int(hy.recommended_simd_size(kind))


def _processors() -> int:
    """Return the number of processors that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _check(problems: Sequence[Problem], tolerance: Fraction | None) -> None:
    if not problems:
        raise ValueError("expected at least one start, got none @ ensemble")
    form, rung = problems[0].form, problems[0].rung
    for i, problem in enumerate(problems):
        if problem.given.body.loads is not None:
            raise ValueError(f"expected a body without loads that a scene writes down @ lane {i}")
        if problem.rung != rung:
            raise ValueError(f"expected starts on {rung.name}, got {problem.rung.name} @ lane {i}")
        if problem.form != form:
            raise ValueError(
                f"expected the states {', '.join(form.states)} and the parameters "
                f"{', '.join(form.parameters)} of lane 0, got other equations @ lane {i}"
            )
    if missing := unavailable(rung):
        raise ValueError(f"expected a rung that is available, got {rung.name}: {missing}")
    if tolerance is not None and not rung.round(tolerance) > 0:
        raise ValueError(f"expected a positive tolerance on {rung.name}, got one too small for it")


@lru_cache(maxsize=32)
@decimal_point()
def _stepper(form: Form, rung: Rung, tolerance: Fraction | None, width: int) -> Any:
    """Return one compiled integrator of so many lanes."""
    if width == 1:
        return compiled(form, rung, tolerance, is_optimised=True)
    import heyoka as hy

    numbers = arithmetic(rung)
    system = equations(form, [hy.par[i] for i in range(len(form.parameters))])

    def empty(*shape: int) -> Array:
        return np.zeros((*shape, width), dtype=numbers.fp_type)

    heyoka_cache_off()
    return hy.taylor_adaptive_batch(
        system,
        state=empty(len(system)),
        time=empty(),
        pars=empty(len(form.parameters)),
        fp_type=numbers.fp_type,
        compact_mode=len(system) > _LARGEST_STRAIGHT_LINE,
        # heyoka takes 0 for the machine epsilon of the type.
        tol=numbers.number(Fraction(0) if tolerance is None else rung.round(tolerance)),
    )


def _double(value: Fraction) -> float:
    """Return a double, infinite beyond its range: nothing to be stepped is so large in its own units."""
    try:
        return float(value)
    except OverflowError:
        return inf


def _padded(values: Array, width: int) -> Array:
    """Return the values with zeros behind the last axis up to so many places."""
    missing = width - values.shape[-1]
    return np.pad(values, [(0, 0)] * (values.ndim - 1) + [(0, missing)])
