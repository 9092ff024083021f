"""The hard scenes: the reach of each precision, and the search for the worst."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from math import inf, log10

import pytest
from builders.studies.hard import searched_family, verdict
from hypothesis import example, given
from hypothesis import strategies as st
from mpmath import mp

import taylor_verify
from taylor_verify.exact.elements import elements
from taylor_verify.numbers.precision import rung
from taylor_verify.records.quantities import GATE_FACTOR
from taylor_verify.records.status import Status
from taylor_verify.run import run
from taylor_verify.scenes import library
from taylor_verify.scenes.families.family import Family
from taylor_verify.scenes.families.shipped import family
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.taylor.driver import Taylor
from taylor_verify_reports.studies.hard import reach
from taylor_verify_reports.studies.hard import search as hunt
from taylor_verify_reports.studies.hard.hard_scenes import ReachRow
from taylor_verify_reports.studies.hard.members import (
    FOLLOWED,
    QUARTERS,
    Followed,
    at_quarters,
    period_of,
)
from taylor_verify_reports.studies.hard.search import SEARCHED, Candidate, search
from taylor_verify_reports.studies.study import NotMeasured

# One of each family, the most extreme.
EXTREMES = [(one, [*one.members][-1]) for one in FOLLOWED]


def named(name: str) -> Followed:
    return next(one for one in FOLLOWED if one.name == name)


def short(name: str, far: Mapping[str, int]) -> Followed:
    """The family on these rungs alone, for so many periods."""
    return replace(named(name), most_periods=dict(far))


def measured(one: Followed, value: str, *names: str) -> dict[str, ReachRow]:
    return {r.rung: r for r in reach.reaches(one, value, map(rung, names or one.most_periods))}


# The families


def test_values_lead_to_the_unstable_motion() -> None:
    """The distances of a family fall strictly, and each is that of the scene."""
    for one in FOLLOWED[3:]:
        sizes = [log10(Fraction(value)) for value in one.members]
        assert sizes == sorted(set(sizes), reverse=True)
    start = named("unstable-axis").members["1e-40"].initial
    assert start.omega[0] == Fraction(1, 10**40)


@pytest.mark.parametrize(("one", "value"), EXTREMES, ids=lambda x: getattr(x, "name", x))
def test_every_family_is_periodic_and_free(one: Followed, value: str) -> None:
    """The most extreme member of a family has a period with the elements' digits, and no loads."""
    scene = one.members[value]
    assert scene.body.is_free
    exact = elements(scene, 30)["period"].value
    with mp.workdps(30):
        assert abs(mp.convert(period_of(scene)) - exact) <= mp.mpf(10) ** -11 * exact


@pytest.mark.parametrize("value", ["1e-2", "1e-8", "1e-14"])
def test_the_separatrix_is_as_far_as_it_says(value: str) -> None:
    """1 - k^2 of the member d is d, to as many digits as d has before its square counts."""
    d = Fraction(value)
    m_prime = elements(named("separatrix").members[value], 30)["m_prime"].value
    with mp.workdps(30):
        assert abs(m_prime / mp.convert(d) - 1) <= mp.convert(d)


def test_instants_are_the_quarters_of_the_periods_named() -> None:
    """Four for each number of periods, the last of them its end; exact, and rising."""
    scene = at_quarters(named("unstable-axis").members["1e-6"], (1, 3, 10))
    period, instants = period_of(scene), scene.clock.elapsed
    assert [t / period for t in instants[QUARTERS - 1 :: QUARTERS]] == [1, 3, 10]
    assert [t / period for t in instants[QUARTERS : 2 * QUARTERS]] == [
        Fraction(9, 4),
        Fraction(5, 2),
        Fraction(11, 4),
        3,
    ]
    assert list(instants) == sorted(set(instants))


# The measurement


@pytest.mark.parametrize(
    ("name", "value"),
    [("euler-attitude", "1"), ("unstable-axis", "1e-4"), ("unstable-spin", "1e-2")],
)
def test_errors_and_floors_are_the_judges(name: str, value: str) -> None:
    """The error is the largest that the judge finds in the same run; so is the attainable one there."""
    one = short(name, {"f64": 3})
    row = measured(one, value)["f64"]
    asked = at_quarters(one.members[value], row.periods)
    states = {"omega", "impulse", "attitude"}
    verdicts = [
        v for v in taylor_verify.run(asked, Taylor(), "f64").verdicts if v.quantity in states
    ]
    assert row.errors[-1] == pytest.approx(max(v.max for v in verdicts), rel=1e-3)
    # The judge's stands at the sample of its largest error, ours is the largest of all samples.
    assert max(v.attainable for v in verdicts) <= 1.001 * row.floors[-1]
    assert row.floors[-1] <= 10 * max(v.attainable for v in verdicts)


@pytest.fixture(scope="module")
def axis() -> dict[str, dict[str, ReachRow]]:
    """Two members beside the unstable axis, by value and rung."""
    one = short("unstable-axis", {"f32": 3, "f64": 3, "f80": 3})
    return {value: measured(one, value) for value in ("1e-2", "1e-10")}


def test_solvers_come_near_the_floor(axis: dict[str, dict[str, ReachRow]]) -> None:
    """Errors of motions that are not lost are within the judge's factor of the attainable error."""
    for row in axis["1e-2"].values():
        for error, least in zip(row.errors, row.floors, strict=True):
            assert error <= GATE_FACTOR * least or least >= 0.1


def test_what_is_lost_is_not_followed(axis: dict[str, dict[str, ReachRow]]) -> None:
    """1e-10 beside the axis doubles are lost in the first period: none is run after, and none told."""
    row = axis["1e-10"]["f64"]
    assert row.errors[0] >= 1
    assert row.errors[1:] == (inf,) * (len(row.periods) - 1)
    assert row.floors[0] >= 1
    one = short("unstable-axis", {"f64": 1})
    assert row.steps == measured(one, "1e-10")["f64"].steps
    assert reach.stored(row).errors[1:] == (None,) * (len(row.periods) - 1)


@pytest.mark.parametrize(
    ("name", "value", "why"),
    [
        ("separatrix", "1e-10", "rounded to f32, the orbit is a separatrix one"),
        ("homoclinic", "1e-14", "rounded to f32"),
    ],
)
def test_another_orbit_is_not_followed(name: str, value: str, why: str) -> None:
    """A row has a reason in place of errors if its rounded data have another orbit."""
    row = measured(named(name), value, "f32")["f32"]
    assert row.errors == row.floors == ()
    assert why in row.why


# The search

STORED = library.names(library.WORST)


def test_a_searched_family_is_judged() -> None:
    """A point of a shipped family has the verdict with the largest ratio of all that count."""
    searched, place = family("euler-gaps"), (0.5,) * family("euler-gaps").free
    (candidate,) = hunt.candidates_at(searched, [place])
    verdicts = run(searched.scene(place), "taylor", "f64").verdicts
    assert candidate is not None
    assert candidate.ratio == max(v.ratio or 0 for v in verdicts if hunt.counts(v))


def _peaks(searched: Family, points: Sequence[Sequence[float]]) -> list[Candidate | None]:
    """A smooth hill with its top, 5, at 0.7 everywhere."""
    distances = [sum((value - 0.7) ** 2 for value in place) ** 0.5 for place in points]
    return [
        Candidate(tuple(place), verdict(5 - away))
        for place, away in zip(points, distances, strict=True)
    ]


def test_a_search_climbs(monkeypatch: pytest.MonkeyPatch) -> None:
    """The search goes from its first places to the top of a hill, in five dimensions too."""
    monkeypatch.setattr(hunt, "candidates_at", _peaks)
    result = search(searched_family("euler-hill", 5), "hills", 2000, 1)
    # A cloud of as many places comes no nearer than some 0.1.
    assert result.worst.ratio >= 5 - 0.05


@pytest.mark.parametrize("runs", [10, 77, 400])
def test_a_budget_is_a_number_of_runs(monkeypatch: pytest.MonkeyPatch, runs: int) -> None:
    """No more runs are made than were asked for, and less than a generation is left over."""
    monkeypatch.setattr(hunt, "candidates_at", _peaks)
    result = search(searched_family("euler-hill", 3), "hills", runs, 1)
    assert runs * 0.6 < result.judged <= runs


def test_a_family_without_a_judged_scene_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """The search raises an error that names a family without a gate that is not vacuous."""
    monkeypatch.setattr(hunt, "candidates_at", lambda searched, points: [None] * len(points))
    with pytest.raises(NotMeasured, match="euler-nothing"):
        search(searched_family("euler-nothing"), "nothing", 20, 1)


@example(None)
@given(st.sampled_from([float("nan"), float("inf"), None]))
def test_a_gate_without_a_number_is_the_worst_of_all(ratio: float | None) -> None:
    """A NaN cannot hide from the search: it counts as infinitely bad."""
    assert Candidate((), verdict(ratio, Status.FAIL)).ratio == float("inf")


def test_vacuous_gates_do_not_count() -> None:
    """A vacuous gate cannot be the worst, whatever its ratio."""
    assert not hunt.counts(verdict(1e9, Status.VACUOUS))
    assert hunt.counts(verdict(1e9, Status.FAIL))


# What was found.


@pytest.mark.parametrize("name", STORED)
def test_the_worst_that_was_found_still_passes(name: str) -> None:
    """Every gate on the worst that was found passes or asks nothing, and the file says why it is there."""
    text = library.find(name).read_text(encoding="utf-8")
    assert text.startswith("# Why: of ")
    assert load(name).name == name
    verdicts = run(name, "taylor", "f64").verdicts
    assert {v.verdict for v in verdicts} <= {Status.PASS, Status.VACUOUS}
    assert any(v.ratio is not None and 0 < v.ratio <= GATE_FACTOR for v in verdicts)


def test_the_worst_runs_with_the_extremes() -> None:
    """The folder holds one scene for each family and nothing else, and `run extremes` runs them."""
    assert sorted(STORED) == sorted(f"extremes/worst/{name}" for name in SEARCHED)
    assert set(STORED) <= set(library.named(library.EXTREMES))
