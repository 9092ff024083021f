"""The search for the worst: its scenes pass, are reproducible, and are published unchanged."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pytest
from builders.studies.worst import searched_family, verdict, worst_of
from hypothesis import HealthCheck, example, given, settings, target
from hypothesis import strategies as st

from taylor_verify.cli import main
from taylor_verify.records.quantities import GATE_FACTOR
from taylor_verify.records.status import Status
from taylor_verify.run import run
from taylor_verify.scenes import library
from taylor_verify.scenes.families.family import Family
from taylor_verify.scenes.reading.faults import Refused
from taylor_verify.scenes.reading.reader import load
from taylor_verify_reports.studies.study import NotMeasured
from taylor_verify_reports.studies.worst import measure
from taylor_verify_reports.studies.worst import page as worst
from taylor_verify_reports.studies.worst.measure import Candidate, SearchedFamily, searched_families
from taylor_verify_reports.studies.worst.study import STUDY

FAMILIES = searched_families()
KEPT = library.names(library.WORST)
EACH_FAMILY = pytest.mark.parametrize("family", FAMILIES, ids=lambda family: family.name)


# The families.


def places(searched: SearchedFamily) -> st.SearchStrategy[list[float]]:
    """Places of the cube of a family, its edges too."""
    return st.lists(st.floats(0, 1), min_size=searched.family.free, max_size=searched.family.free)


@EACH_FAMILY
@given(st.data())
@settings(max_examples=20)
def test_every_place_of_a_cube_is_a_scene(family: SearchedFamily, data: st.DataObject) -> None:
    """Every point of the cube and its edges is a scene of the model that the family's name begins with."""
    place = data.draw(places(family))
    try:
        scene = family.family.scene(place)
    except Refused as refused:
        # Where nothing moves there is no motion of another size; a scene that is refused counts for none.
        raise AssertionError(str(refused)) from refused
    assert scene.model == family.name.split("-")[0]
    # Written again it is the same one: the numbers in the file are all there is.
    assert replace(family.family.scene(place), name=scene.name) == scene


@pytest.mark.slow
@EACH_FAMILY
@given(st.data())
@settings(max_examples=12, deadline=None, suppress_health_check=list(HealthCheck))
def test_searched_for_the_worst_the_sound_driver_passes(
    family: SearchedFamily, data: st.DataObject
) -> None:
    """Led by error over attainable, a search finds no scene at which a gate fails."""
    (candidate,) = measure.candidates_at(family.family, [data.draw(places(family))])
    if candidate is not None:
        target(candidate.ratio)
        assert candidate.verdict.verdict is Status.PASS


# The search.


def _peaks(family: Family, points: Sequence[Sequence[float]]) -> list[Candidate | None]:
    """A smooth hill with its top, 5, at 0.7 everywhere."""
    distances = [sum((value - 0.7) ** 2 for value in place) ** 0.5 for place in points]
    return [
        Candidate(tuple(place), verdict(5 - away))
        for place, away in zip(points, distances, strict=True)
    ]


def test_a_search_climbs(monkeypatch: pytest.MonkeyPatch) -> None:
    """The search goes from its first places to the top of a hill, in five dimensions too."""
    monkeypatch.setattr(measure, "candidates_at", _peaks)
    (result,) = measure.search([searched_family("euler-hill", 5)], 2000, 1, lambda name: None)
    # A cloud of as many places comes no nearer than some 0.1.
    assert result.worst.ratio >= 5 - 0.05


@pytest.mark.parametrize("runs", [10, 77, 400])
def test_a_budget_is_a_number_of_runs(monkeypatch: pytest.MonkeyPatch, runs: int) -> None:
    """No more runs are made than were asked for, and less than a generation is left over."""
    monkeypatch.setattr(measure, "candidates_at", _peaks)
    (result,) = measure.search([searched_family("euler-hill", 3)], runs, 1, lambda name: None)
    assert runs * 0.6 < result.judged <= runs


def test_a_search_can_be_repeated(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every place follows from seed and family; another seed has others."""
    asked: list[list[float]] = []

    def noted(family: Family, points: Sequence[Sequence[float]]) -> list[Candidate | None]:
        asked.extend(map(list, points))
        return _peaks(family, points)

    monkeypatch.setattr(measure, "candidates_at", noted)
    rounds = []
    for seed in (1, 1, 2):
        asked.clear()
        measure.search([searched_family("euler-hill", 2)], 60, seed, str)
        rounds.append([*asked])
    assert rounds[0] == rounds[1]
    assert rounds[0][0] != rounds[2][0]


def test_a_family_without_a_judged_scene_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """The search raises an error that names a family without a gate that is not vacuous."""
    monkeypatch.setattr(measure, "candidates_at", lambda family, points: [None] * len(points))
    with pytest.raises(NotMeasured, match="euler-nothing"):
        measure.search([searched_family("euler-nothing")], 20, 1, str)


@example(None)
@given(st.sampled_from([float("nan"), float("inf"), None]))
def test_a_gate_without_a_number_is_the_worst_of_all(ratio: float | None) -> None:
    """A NaN cannot hide from the search: it counts as infinitely bad."""
    assert Candidate((), verdict(ratio, Status.FAIL)).ratio == float("inf")


def test_vacuous_gates_do_not_count() -> None:
    """A vacuous gate cannot be the worst, whatever its ratio."""
    assert not measure._counts(verdict(1e9, Status.VACUOUS))
    assert measure._counts(verdict(1e9, Status.FAIL))


# What was found.


def test_every_family_has_its_worst() -> None:
    """The folder holds one scene for each family and nothing else."""
    assert sorted(KEPT) == sorted(f"extremes/worst/{family.name}" for family in FAMILIES)


@pytest.mark.parametrize("name", KEPT)
def test_the_worst_that_was_found_still_passes(name: str) -> None:
    """Every gate on the worst that was found passes or asks nothing, and the file says why it is there."""
    text = library.find(name).read_text(encoding="utf-8")
    assert text.startswith("# Why: of ")
    assert load(name).name == name
    verdicts = run(name, "taylor", "f64").verdicts
    assert {v.verdict for v in verdicts} <= {Status.PASS, Status.VACUOUS}
    assert any(v.ratio is not None and 0 < v.ratio <= GATE_FACTOR for v in verdicts)


def test_the_worst_runs_with_the_extremes() -> None:
    """`run extremes` has the worst scenes of the search among its own."""
    assert set(KEPT) <= set(library.named(library.EXTREMES))
    assert library.named(library.WORST) == KEPT


def test_scene_file_says_why_it_is_there() -> None:
    """The text of the worst begins with its reason, and is the family's text besides."""
    text = worst_of("euler-thing", 3.25).scene_text
    assert text.startswith("# Why: of things")
    assert "3.25 in omega" in text
    assert text.endswith('title = "0.25"\n')


def test_page_is_made_from_stored_rows_alone(tmp_path: Path) -> None:
    """The worst family stands first; a ratio changed in worst.json is changed on the page."""
    rows = measure.study([worst_of("euler-a", 1.5), worst_of("euler-b", 2.5)], 60, 3)
    worst.WORST.write(tmp_path, rows)
    page = STUDY.pages(tmp_path)[STUDY.path]
    assert page.index("euler-b") < page.index("euler-a")
    assert "--runs 60 --seed 3" in page
    file = tmp_path / worst.WORST.name
    stored = json.loads(file.read_text(encoding="utf-8"))
    stored["families"][0]["ratio"] = 7.75
    file.write_text(json.dumps(stored), encoding="utf-8")
    changed = STUDY.pages(tmp_path)[STUDY.path]
    assert changed.index("euler-a") < changed.index("euler-b")
    assert "7.75" in changed or "7.8" in changed


def test_rows_that_are_none_are_refused(tmp_path: Path) -> None:
    """A file without families is a fault that names the file."""
    file = tmp_path / worst.WORST.name
    file.parent.mkdir()
    file.write_text("{}", encoding="utf-8")
    with pytest.raises(ValueError, match=r"worst\.json"):
        STUDY.pages(tmp_path)


def test_old_scenes_make_room(tmp_path: Path) -> None:
    """Scenes of an earlier search are removed when a new one has ended."""
    worst.store_scenes(tmp_path, {"one": "1\n", "two": "2\n"})
    worst.store_scenes(tmp_path, {"two": "3\n"})
    assert {p.name: p.read_text(encoding="utf-8") for p in tmp_path.iterdir()} == {
        "two.toml": "3\n"
    }


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["--runs", "0"], "expected a whole number of at least 10, got 0 @ --runs"),
        (
            ["--seconds", "5"],
            "expected a budget in runs, which can be repeated (--runs 400), got 5 s",
        ),
    ],
)
def test_a_wrong_budget_is_refused(
    capsys: pytest.CaptureFixture[str], words: list[str], sentence: str
) -> None:
    """No runs, and seconds, with which no search can be repeated, are wrong calls and change nothing."""
    assert main(["publish", "worst", *words]) == 2
    assert sentence in capsys.readouterr().err
