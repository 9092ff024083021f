"""The search for the worst: its scenes pass, are reproducible, and are published unchanged."""

from __future__ import annotations

from collections.abc import Sequence

import pytest
from builders.studies.hard import searched_family, verdict
from hypothesis import example, given
from hypothesis import strategies as st

from taylor_verify.records.quantities import GATE_FACTOR
from taylor_verify.records.status import Status
from taylor_verify.run import run
from taylor_verify.scenes import library
from taylor_verify.scenes.families.family import Family
from taylor_verify.scenes.families.shipped import family
from taylor_verify.scenes.reading.reader import load
from taylor_verify_reports.studies.hard import search as hunt
from taylor_verify_reports.studies.hard.search import SEARCHED, Candidate, search
from taylor_verify_reports.studies.study import NotMeasured

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
