"""The prices: one motion is compared, ratios are of one round, the page says what was stored."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from random import Random
from typing import Any

import pytest
from builders.studies.prices import named, study

from taylor_verify.models.general import in_general_form
from taylor_verify.models.problem import Problem
from taylor_verify.numbers.precision import rung
from taylor_verify.solvers.taylor.pace import Pace
from taylor_verify_reports.studies.prices.document import PricesStudy
from taylor_verify_reports.studies.prices.variants import variants

F64 = rung("f64")
NAMES = [variant.name for variant in variants()]


def rates_at(problem: Problem, state: Mapping[str, Fraction]) -> dict[str, Any]:
    form = problem.form
    parameters = [state.get(n, problem.parameter.get(n)) for n in form.parameters]
    rates = form.rates([state[n] for n in form.states], parameters)
    return dict(zip(form.states, rates, strict=True))


@pytest.mark.parametrize("name", NAMES)
def test_a_variant_is_another_form_of_the_same_body(name: str) -> None:
    """The rates of a variant are those of the general equations, in rationals at random points."""
    problem, random = named(name).posed(F64), Random(1)
    general = in_general_form(problem)
    for _ in range(3):
        state = {n: Fraction(random.randint(-99, 99), 8) for n in general.form.states}
        constants = {n: problem.parameter.get(n, Fraction(0)) for n in state}
        state |= {n: constants[n] for n in state if n not in problem.form.states}
        chosen = rates_at(problem, state)
        assert rates_at(general, state) == {n: chosen.get(n, 0) for n in state}


@pytest.mark.parametrize("name", ["literals", "differences", "zeros"])
def test_variants_of_one_scene_take_the_same_steps(name: str) -> None:
    """The very motion is compared: one step more or less may come of rounding, no more."""
    steps = [
        Pace(named(n).posed(F64), Fraction(64), literals=named(n).literals) for n in ("omega", name)
    ]
    first, other = (pace.run() for pace in steps)
    assert abs(first - other) <= 1
    assert [pace.run() for pace in steps] == [first, other]


@pytest.fixture(scope="module")
def measured() -> PricesStudy:
    return study()


def test_rows_count_what_is_built(measured: PricesStudy) -> None:
    """States and operations are those of the form, and the interval holds the median."""
    for row in measured.rows:
        form = named(row.variant).posed(F64).form
        assert row.states == len(form.states)
        assert {k: getattr(row, k) for k in ("sums", "products", "quotients")} == form.operations()
        median, low, high = row.step_ratio
        assert 0 < low <= median <= high
