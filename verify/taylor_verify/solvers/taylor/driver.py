"""heyoka's Taylor integrator as a solver: typed, scaled, step-capped, bounded and checked.

What heyoka does silently by itself and why it cannot happen here:
a coefficient rounded to a double      all coefficients are parameters of the rung's own type
a state far from size one              the problem is posed in units of its own size
a small component lost beside a large  no step is longer than the fastest linear time scale allows
impulses lost beside a long path       the path is counted in a unit of its own
an interrupt held until the end        no stretch takes longer than about half a second
an endless or a broken run             the number of steps is bounded and the outcome is read
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache, partial
from time import perf_counter
from typing import Any, Final, NamedTuple, final

import numpy as np

from taylor_verify.models.form import Form
from taylor_verify.models.kinks import Kink
from taylor_verify.models.lengths import lengths, radicands, unsquared
from taylor_verify.models.problem import Problem
from taylor_verify.numbers.decimal_point import decimal_point
from taylor_verify.numbers.precision import Rung
from taylor_verify.numbers.precision import rung as rung_named
from taylor_verify.solvers.between_switches import piece_by_piece
from taylor_verify.solvers.solver import Solver, refused
from taylor_verify.solvers.taylor.crossings import Lengths, crossings, missed, smoothed
from taylor_verify.solvers.taylor.heyoka_equations import equations
from taylor_verify.solvers.taylor.numbers import arithmetic, unavailable
from taylor_verify.solvers.taylor.package import heyoka_cache_off
from taylor_verify.solvers.taylor.way import Way
from taylor_verify.solvers.trajectory import Outcome, Postponed, Trajectory

# Beyond this many states optimising straight-line code takes longer than it runs once.
_LARGEST_STRAIGHT_LINE = 5
# The standard set asks for nearly four hundred, a scene's rungs one after the other.
_MOST_COMPILED = 128
# Ways are kept for whoever asks many questions in turns, and their instants only where they are few.
_MOST_WAYS, _MOST_INSTANTS = 128, 1000
_NO_LENGTH: Final = "is made for loads whose norms and roots do not vanish on the way"
# As many instants of the way in doubles tell the fastest rate.
_SCOUTED = 24


@final
@dataclass(frozen=True)
class Taylor(Solver):
    """heyoka at a tolerance, which bounds the error of a step: the rung's machine epsilon if None.

    heyoka takes the order from it. With ``is_optimised`` code for short ways too is compiled for seconds,
    and its steps take half the time from six states on: that of heyoka as its user writes it.
    """

    name: str = "taylor"
    tolerance: Fraction | None = None
    is_optimised: bool = False
    counts_steps = True
    takes_loads = True

    def unavailable(self, rung: Rung) -> str:
        if self.tolerance is not None and not rung.round(self.tolerance) > 0:
            # heyoka would take it for its own default.
            return f"{rung.name} has no number for a tolerance so small"
        return unavailable(rung)

    @decimal_point()
    def solve(self, problem: Problem) -> Trajectory:
        if reason := self.unsuited(problem):
            return refused(reason)
        return piece_by_piece(problem, self._solve)

    def _solve(self, problem: Problem) -> Trajectory:
        began = perf_counter()
        tolerance = None if self.tolerance is None else self.tolerance.as_integer_ratio()
        # What follows from a question is made once, for whoever asks it many times to time a solver.
        prepared = prepared_once if len(problem.times) <= _MOST_INSTANTS else _prepared
        way, form, turned, kinks, vectors, has_roots = prepared(
            problem, tolerance, self.is_optimised
        )
        ready = perf_counter()
        outcome, rows, _, steps, inner = way.run(partial(_foreseen, problem))
        seconds = perf_counter() - ready
        if vectors is not None and outcome in (Outcome.FINISHED, Outcome.NON_FINITE):
            zeros, are_on_a_line = vectors.along(rows)
            if outcome is Outcome.NON_FINITE or are_on_a_line:
                if (other := unsquared(form, zeros)) != form:
                    return self._solve(replace(problem, form=other))
                return refused(f"{self.name} {_NO_LENGTH}")
        if outcome is Outcome.INTERRUPTED and has_roots:
            return refused(f"{self.name} {_NO_LENGTH}")
        if kinks and len(rows) and missed(turned, kinks, rows[-1], way.parameters):
            return Trajectory(Outcome.INTERRUPTED, detail="a crossing of a kink was not noticed")
        if kinks and outcome is Outcome.STEP_LIMIT:
            return refused(f"{self.name} is made for kinks that are crossed, and not only touched")
        quantities: Mapping[str, Any] = {}
        if outcome is Outcome.FINISHED:
            # Exact numbers of many samples take longer than the samples: the judge asks for them.
            quantities = Postponed(problem, rows, way.numbers.exact)
        return Trajectory(
            outcome=outcome,
            quantities=quantities,
            steps=steps,
            evaluations=steps * way.order,
            seconds=seconds,
            compile_seconds=ready - began,
            inner_seconds=inner,
        )


@lru_cache(maxsize=_MOST_COMPILED)
@decimal_point()
def compiled(
    form: Form,
    rung: Rung,
    tolerance: Fraction | None,
    is_optimised: bool,
    kinks: tuple[Kink, ...] = (),
) -> Any:
    """Return the one compiled integrator of a form, rung and tolerance; the rest is filled in per problem.

    Parameters cost what literals cost, and serve every body. Optimised loops compute the same as others to
    the last bit. Optimised straight-line code of doubles does not, because it fuses products with sums.
    ``kinks`` are those that `smooth` has taken out of the form.
    """
    import heyoka as hy

    numbers = arithmetic(rung)
    zero = numbers.number(Fraction(0))
    coefficients = [hy.par[i] for i in range(len(form.parameters))]
    system = equations(form, coefficients)
    is_straight_line = numbers.is_quick_plain or len(system) <= _LARGEST_STRAIGHT_LINE
    options = {
        "state": np.array([zero] * len(system), dtype=numbers.fp_type),
        "time": zero,
        "pars": np.array([zero] * len(coefficients), dtype=numbers.fp_type),
        "fp_type": numbers.fp_type,
        "compact_mode": numbers.is_software or not is_straight_line,
        # Code of level 3 computes the same, runs no faster, and compiles up to twice as long.
        "opt_level": 1 if is_optimised else 0,
        # heyoka takes 0 for the machine epsilon of the type.
        "tol": zero if tolerance is None else numbers.number(rung.round(tolerance)),
    }
    if events := crossings(form, kinks, coefficients, rung):
        options["t_events"] = events
    heyoka_cache_off()
    return hy.taylor_adaptive(system, **options)


def pays(problem: Problem) -> bool:
    """Return True where optimised code is worth its compiling: of small systems, and on long ways.

    All legs of a way have one code.
    """
    numbers, size = arithmetic(problem.rung), len(problem.form.states)
    if numbers.is_quick_plain and size <= _LARGEST_STRAIGHT_LINE:
        return True
    length = abs(float(problem.given.clock.elapsed[-1] / problem.units.time))
    return length * size > numbers.optimised_from


def _foreseen(problem: Problem) -> float:
    """Return the fastest rate of a whole way in slow numbers; doubles find it in a thousandth of the time.

    Such a way then need not be gone twice because its rate grew. The rate is infinite where doubles do not
    reach the end.
    """
    if not arithmetic(problem.rung).is_software:
        return 0.0
    rung = rung_named("f64")
    begin, end = rung.round(problem.begin), rung.round(problem.times[-1])
    scout = replace(
        problem,
        rung=rung,
        parameters=tuple(map(rung.round, problem.parameters)),
        initial_momenta=tuple(map(rung.round, problem.initial_momenta)),
        begin=begin,
        times=[
            rung.round(begin + (end - begin) * Fraction(k, _SCOUTED))
            for k in range(1, _SCOUTED + 1)
        ],
    )
    turned, kinks = smoothed(scout)
    integrator = compiled(turned.form, rung, None, pays(scout), kinks=kinks)
    return Way(integrator, turned, scout).fastest()


class _Prepared(NamedTuple):
    """The way of the problem ``turned``, which has no kinks, and all else that a question needs.

    ``form`` has kinks in place of lengths that have one part alone; ``vectors`` are those of its lengths.
    """

    way: Way
    form: Form
    turned: Problem
    kinks: tuple[Kink, ...]
    vectors: Lengths | None
    has_roots: bool


def _prepared(problem: Problem, tolerance: tuple[int, int] | None, is_optimised: bool) -> _Prepared:
    """Return what follows from a question.

    The tolerance is a quotient, which is looked up sooner than a Fraction.
    """
    if lengths(problem.form):
        problem = replace(problem, form=unsquared(problem.form))
    turned, kinks = smoothed(problem)
    integrator = compiled(
        turned.form,
        problem.rung,
        None if tolerance is None else Fraction(*tolerance),
        is_optimised or pays(problem),
        kinks=kinks,
    )
    return _Prepared(
        Way(integrator, turned, problem),
        problem.form,
        turned,
        kinks,
        Lengths(problem) if lengths(problem.form) else None,
        bool(radicands(turned.form)),
    )


prepared_once = lru_cache(maxsize=_MOST_WAYS)(_prepared)
