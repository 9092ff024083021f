"""Kinks of written loads as terminal events of heyoka, at each of which a branch is chosen anew."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, final

import numpy as np
from mpmath import mp

from taylor_verify.models.form import Form
from taylor_verify.models.functions import FLOATS, functions_of
from taylor_verify.models.kinks import Kink, changing, smooth, values
from taylor_verify.models.lengths import lengths, radicands
from taylor_verify.models.problem import Problem
from taylor_verify.models.written import Written
from taylor_verify.numbers.precision import Rung, held_exactly, power_of_two
from taylor_verify.solvers.straight_line import straight_line
from taylor_verify.solvers.taylor.numbers import arithmetic

# Vectors whose second singular value is a smaller part of their first lie on one line.
_ON_A_LINE = 1e-10
# The power of 1/2, in units of time, after which it shows where a start on a kink goes.
_LITTLE = 12
# The power of two, in roundings of a unit of time, that is nothing beside it.
_NEAR = 10
# The power of 1/2 that something has crossed which may be zero nearby.
_SMALL = 40
# A difference that is no matter of rounding on any rung, beside the largest step.
_CLEAR = 1e-3


@final
@dataclass(frozen=True)
class _Choice:
    """Callback of heyoka at a crossing: the kink's parameters become those of the branch behind it."""

    kink: Kink
    first: int
    rung: Rung

    def __call__(self, integrator: Any, direction: int) -> bool:
        # The direction is that in time; a motion backwards in time crosses the other way. An event before
        # the first step is none: the branch was chosen for it.
        step = float(integrator.last_h)
        if direction and step:
            sign = direction if step > 0 else -direction
            numbers = arithmetic(self.rung)
            for k, value in enumerate(self.kink.chosen(sign), start=self.first):
                integrator.pars[k] = numbers.number(Fraction(value))
        return True


def crossings(form: Form, kinks: Sequence[Kink], coefficients: Sequence[Any], rung: Rung) -> Any:
    """Return the events of a smooth form's kinks; the parameters of their choices are its last.

    The last ones end the way where something comes near zero of which a root is taken.
    """
    import heyoka as hy

    moving = changing(form)
    near_zero = [place for place in radicands(form) if place in moving]
    if not near_zero and not any(kink.place in moving for kink in kinks):
        return []
    steps = values(form, hy.make_vars(*form.states), coefficients, hy.time)
    numbers = arithmetic(rung)
    # heyoka's own choice is endless where a motion begins on a kink at rest against it. Two crossings
    # within this time leave an error of its square.
    rest = numbers.number(power_of_two(-(rung.bits // 2)))
    first, events = len(form.parameters) - sum(len(kink.names) for kink in kinks), []
    for kink in kinks:
        # heyoka takes no event of parameters alone, and such a one cannot come.
        if kink.place in moving:
            choice = _Choice(kink, first, rung)
            event = steps[kink.place]
            events.append(
                hy.t_event(event, callback=choice, fp_type=numbers.fp_type, cooldown=rest)
            )
        first += len(kink.names)
    little = hy.expression(numbers.number(power_of_two(-_SMALL)))
    events += [hy.t_event(steps[place] - little, fp_type=numbers.fp_type) for place in near_zero]
    return events


def smoothed(problem: Problem) -> tuple[Problem, tuple[Kink, ...]]:
    """Return the problem with smooth equations, the branches chosen as its start needs them."""
    form, kinks = smooth(problem.form)
    if not kinks:
        return problem, ()
    parameters = list(problem.parameters)
    for kink in kinks:
        sign = _clear_sign(problem, form, parameters, kink) or _sign(
            problem, form, parameters, kink
        )
        parameters += map(Fraction, kink.chosen(sign))
    return replace(problem, form=form, parameters=tuple(parameters)), kinks


def _clear_sign(problem: Problem, form: Form, known: Sequence[Fraction], kink: Kink) -> int:
    """Return the sign of a kink's difference at the start, 0 where doubles do not tell it clearly."""
    later = [0.0] * (len(form.parameters) - len(known))
    state = [float(value) for value in problem.initial_momenta]
    steps = _steps(form, state, [*map(float, known), *later], float(problem.begin))
    difference = steps[kink.place] if steps else 0.0
    if not abs(difference) > _CLEAR * max(map(abs, steps), default=0.0):
        return 0
    return 1 if difference > 0 else -1


def _steps(
    form: Form, state: Sequence[float], parameters: Sequence[float], time: float
) -> list[float]:
    """Return the value of each step in doubles; none where some step has no value."""
    places = tuple(range(len(form.equations.steps))) if isinstance(form.equations, Written) else ()
    try:
        return straight_line(form, parameters, FLOATS, places)(time, state)
    except (ArithmeticError, ValueError):
        return []


def _sign(problem: Problem, form: Form, known: Sequence[Fraction], kink: Kink) -> int:
    """Return the sign of a kink's difference just behind the start; later kinks do not enter it."""
    later = [Fraction(0)] * (len(form.parameters) - len(known))
    with mp.workprec(problem.rung.bits + 64):
        numbers = [held_exactly(value) for value in (*known, *later)]
        state = [held_exactly(value) for value in problem.initial_momenta]
        time = held_exactly(problem.begin)
        step = mp.mpf(2) ** -_LITTLE * (1 if problem.times[-1] > problem.begin else -1)
        ahead = _moved(problem, state, time, step)
        here, there = (
            values(form, *at)[kink.place]
            for at in ((state, numbers, time), (ahead, numbers, time + step))
        )
        # What crosses zero within a rounding of the start is behind it.
        is_past = abs(here) * abs(step) < abs(there - here) * mp.mpf(2) ** (
            _NEAR - problem.rung.bits
        )
        return 1 if (there if is_past else here) >= 0 else -1


def missed(problem: Problem, kinks: Sequence[Kink], state: Sequence[Any], chosen: Any) -> bool:
    """Return True where the last state is on another branch than the parameters ``chosen`` say."""
    numbers = [float(value) for value in chosen]
    steps = _steps(problem.form, list(map(float, state)), numbers, float(problem.times[-1]))
    first = len(numbers) - sum(len(kink.names) for kink in kinks)
    for kink in kinks if steps else ():
        difference, width = steps[kink.place], len(kink.names)
        expected = [float(value) for value in kink.chosen(1 if difference > 0 else -1)]
        if (
            abs(difference) > _CLEAR * max(map(abs, steps))
            and numbers[first : first + width] != expected
        ):
            return True
        first += width
    return False


def _moved(problem: Problem, state: Sequence[Any], time: Any, step: Any) -> list[Any]:
    """Return the state a step later, by the classical method of Runge and Kutta."""
    parameters = [held_exactly(value) for value in problem.parameters]

    def ahead(rates: Sequence[Any], part: Any) -> list[Any]:
        return [a + part * step * rate for a, rate in zip(state, rates, strict=True)]

    half = mp.mpf(1) / 2
    rates = [problem.form.rates(state, parameters, time)]
    for part in (half, half, mp.one):
        rates.append(problem.form.rates(ahead(rates[-1], part), parameters, time + part * step))
    mean = [(a + 2 * b + 2 * c + d) / 6 for a, b, c, d in zip(*rates, strict=True)]
    return ahead(mean, mp.one)


class Lengths:
    """The vectors whose lengths the loads of a problem take."""

    def __init__(self, problem: Problem) -> None:
        form, self._parts = problem.form, lengths(problem.form)
        self._places = tuple(sorted({place for parts in self._parts for place in parts}))
        self._constant = set(self._places) - changing(form)
        self._start = [float(value) for value in problem.initial_momenta]
        self._times = np.array([float(t) for t in (problem.begin, *problem.times)])
        self._values = straight_line(
            form, list(map(float, problem.parameters)), functions_of(self._times), self._places
        )

    def along(self, rows: np.ndarray[Any, Any]) -> tuple[frozenset[int], bool]:
        """Return the places of the parts that are zero at the start and at all rows of a way.

        And return whether a vector stays on one line: it may go through zero there.
        """
        states = np.vstack([self._start, *rows.astype(float)])
        times = self._times[: len(states)]
        with np.errstate(all="ignore"):
            values = self._values(times, list(states.T))
        numbers = (np.nan_to_num(value + 0 * times) for value in values)
        steps = dict(zip(self._places, numbers, strict=True))
        zeros = frozenset(place for place, step in steps.items() if not step.any())
        return zeros, any(self._is_on_a_line(steps, places) for places in self._parts)

    def _is_on_a_line(self, steps: Mapping[int, Any], places: Sequence[int]) -> bool:
        if any(place in self._constant and steps[place].all() for place in places):
            # A part that keeps a value is never zero.
            return False
        vectors = np.array([steps[place] for place in places])
        sizes = np.linalg.svd(vectors, compute_uv=False)
        return len(sizes) < 2 or not sizes[1] > _ON_A_LINE * sizes[0]
