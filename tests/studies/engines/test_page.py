"""The page of the board: computed advice, and all measurements."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest
from builders.studies.engines import (
    ENTRIES,
    PLAIN,
    SCENE,
    SPINNER,
    WOBBLER,
    answers,
    board,
    board_with,
    made_up,
)

from taylor_verify.plotting.picture import content
from taylor_verify_reports.studies.engines import page
from taylor_verify_reports.studies.engines.advice import advice, at_length
from taylor_verify_reports.studies.engines.board_studies import STUDY
from taylor_verify_reports.studies.engines.document import EngineRow, Standing, find, write
from taylor_verify_reports.studies.engines.engine_page import pages
from taylor_verify_reports.studies.engines.entry import Entry, EntryList, entry_list
from taylor_verify_reports.studies.engines.pictures import energy, sweeps, work

REPORTS = Path(__file__).resolve().parents[3] / "reports"


@pytest.fixture(autouse=True)
def _small_list(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(page, "entry_list", lambda board: ENTRIES)


def advised(*rows: EngineRow, entries: EntryList = ENTRIES, **seconds: float) -> list[str]:
    return advice(board_with(*rows, seconds=seconds or None), entries)


def with_errors(entry: Entry, *errors: float) -> list[EngineRow]:
    """Rows of an entry, each with an error of its own."""
    rows = made_up(entry, {"omega": 1.0, "attitude": 1e-9, "T": 1e-7})
    return [
        replace(row, errors={**row.errors, "omega": error})
        for row, error in zip(rows, errors, strict=True)
    ]


# The advice.


def test_the_best_setting_is_advised() -> None:
    """The advised engine and step have the smallest error on the scenes; a plain solver is no engine."""
    rows = with_errors(SPINNER, 1e-2, 1e-6, 1e-4), with_errors(WOBBLER, 1e-3, 1e-5, 1e-7)
    first, *_ = advised(*rows[0], *rows[1], *with_errors(PLAIN, 1e-12))
    assert first.startswith(
        "For free rotation take **Wobbler** with splitting and a step of 0.025:"
    )
    assert "are right to 1.00e-7 on all of `engines/oblique`" in first
    first, *_ = advised(*rows[0], *with_errors(WOBBLER, 1.0, 1.0, 1.0))
    assert first.startswith("For free rotation take **Spinner** with lie-rk4 and a step of 0.05:")


def test_a_tie_has_no_winner() -> None:
    """Engines whose errors, or times, are within a small factor are named together, and as a tie."""
    equal = advised(*with_errors(SPINNER, 1e-2, 1e-4, 1.2e-7), *with_errors(WOBBLER, 1, 1, 1e-7))
    both = "take **Wobbler** with splitting and a step of 0.025 or **Spinner** with lie-rk4"
    assert both in equal[0]
    assert "a tie: their errors differ by less than a factor 1.5." in equal[0]
    assert "among the cheapest" in equal[1]
    assert "within a factor 3 of it, a tie, **" in equal[1]


def test_the_cheapest_of_the_sufficient_is_advised() -> None:
    """The time decides among those whose error is small enough."""
    rows = [*with_errors(SPINNER, 1e-2, 1e-4, 1e-6), *with_errors(WOBBLER, 1e-4, 1e-5, 1e-9)]
    seconds = dict(zip((row.key for row in rows), (1e-3, 0.9, 2.0, 0.2, 0.6, 5.0), strict=True))
    sentences = advised(*rows, **seconds)
    assert (
        "**Wobbler** with splitting and a step of 0.1 is the cheapest: 1.00e4 micro" in sentences[1]
    )


def test_a_method_that_loses_the_motion_is_warned_of() -> None:
    """The warning has the least error of the method and the better method of the same engine."""
    other = replace(WOBBLER, name="spinner", title="Spinner")
    entries = replace(ENTRIES, entry=(SPINNER, other))
    rows = [*with_errors(SPINNER, 1e-2, 1e-4, 1e-6), *with_errors(other, 0.9, 0.8, 0.7)]
    sentences = advised(*rows, entries=entries)
    assert (
        "Never **Spinner** with splitting (least error 0.700; lie-rk4 has 1.00e-6)."
    ) in sentences


def test_what_is_shipped_is_warned_of() -> None:
    """A warning is given if the shipped settings are far worse than the board's at the same step."""
    row = replace(SPINNER, shipped={"defaults": "shipped"}, warning="its damping switched off")
    entries = replace(ENTRIES, entry=(row,))
    usual = with_errors(SPINNER, 1e-3, 1e-4, 1e-5)
    bare = [replace(one, shipped=True, variant=f"{one.variant}, shipped") for one in usual]
    assert not any("shipped" in sentences for sentences in advised(*usual, *bare, entries=entries))
    bare[1] = replace(bare[1], errors={"omega": 0.2, "attitude": 0.05})
    sentences = advised(*usual, *bare, entries=entries)
    assert (
        "Not as shipped: **Spinner** needs its damping switched off (0.200 becomes 1.00e-4)."
    ) in sentences


def test_steps_that_make_it_worse_are_warned_of() -> None:
    """The warning names the step below which errors grow again."""
    sentences = advised(*with_errors(SPINNER, 1e-3, 1e-5, 1e-4))
    assert (
        "No smaller step than 0.05 in **Spinner** (1.00e-5 becomes 1.00e-4 with 0.025)."
        in sentences[-1]
    )


def under(load: str, entry: Entry, *errors: float) -> list[EngineRow]:
    return [replace(row, load=load) for row in with_errors(entry, *errors)]


def test_a_way_of_giving_a_load_is_warned_of() -> None:
    """The line of a job has the best setting with its way, and the least error of a far worse way."""
    each_step = under("held over each step", WOBBLER, 1e-2, 5e-3, 1e-3)
    rows = [*under("asked for in each stage", SPINNER, 1e-3, 1e-6, 1e-9), *each_step]
    short, *_ = advised(*rows)
    assert "a step of 0.025 (the load asked for in each stage): right to 1.00e-9." in short
    assert "Never with the load held over each step (1.00e-3 at best)." in short
    first, *_, last = at_length(board_with(*rows), ENTRIES, ENTRIES.scene[0].job)
    assert "a step of 0.025 (the load asked for in each stage): omega and attitude" in first
    worse = "Never with the load held over each step (**Wobbler** with splitting and a step of 0.025 has"
    assert f"{worse} 1.00e-3)" in last
    near = under("held over each step", WOBBLER, 1e-2, 5e-3, 1e-10)
    assert "Never with" not in advised(*under("asked", SPINNER, 1e-3, 1e-6, 1e-12), *near)[0]


def test_a_step_over_a_switch_is_warned_of() -> None:
    """The warning has a longer step that ends on every switch, and a shorter one that does not."""
    rows = under("asked for in each stage", SPINNER, 1e-9, 1e-3, 1e-10)
    switched = replace(ENTRIES, scene=(replace(ENTRIES.scene[0], switches=True),))
    assert "goes over a switch" not in advised(*rows)[0]
    assert "Never a step that goes over a switch." in advised(*rows, entries=switched)[0]
    *_, sentence = at_length(board_with(*rows), switched, switched.scene[0].job)
    assert (
        "has 1.00e-9 with a step of 0.1, which ends on every switch, and 1.00e-3 with 0.05"
        in sentence
    )


def test_an_engine_that_loses_a_loaded_motion_is_named() -> None:
    """Its least error at any step is beside its name."""
    rows = under("asked", SPINNER, 1e-3, 1e-6, 1e-9), under("asked", WOBBLER, 0.9, 0.8, 0.7)
    assert (
        "Not for free rotation, with the least error at any step: **Wobbler** (0.700)."
        in (advised(*rows[0], *rows[1])[0])
    )


# The pages.


def test_the_page_has_what_was_measured(tmp_path: Path) -> None:
    """The page has every engine with its best step, orders and errors, and the sheet has all rows."""
    document = board()
    write(tmp_path, document)
    made = {path.name for path in STUDY.publish(tmp_path).written}
    assert {"engines.md", "engines.csv", "engines-time.svg", "engines-step.svg"} <= made
    assert "engines-energy.svg" in made
    assert {f"engines-{name}.md" for name in ("spinner", "wobbler", "scipy")} <= made
    text = (tmp_path / "tables/engines.md").read_text(encoding="utf-8")
    assert re.search(r"\[Spinner\]\(engines-spinner\.md\) +\| lie-rk4 +\| +0\.025 \|", text)
    assert re.search(r"\| splitting .* 2\.0, 2\.0 \|", text)
    assert "](../figures/engines-time.svg)" in text
    sheet = (tmp_path / "tables/engines.csv").read_text(encoding="utf-8").splitlines()
    assert len(sheet) == 1 + len(answers())
    assert STUDY.pages(tmp_path)["tables/engines.md"] == text


def test_an_error_that_changes_is_changed_on_the_page(tmp_path: Path) -> None:
    """No number of the page is typed."""
    rows = with_errors(SPINNER, 1e-3, 1e-4, 1.23e-5)
    before = page.page(board_with(*rows), tmp_path)
    after = page.page(
        board_with(*rows[:2], replace(rows[2], errors={"omega": 4.56e-5, "attitude": 1e-9})),
        tmp_path,
    )
    assert "1.23e-5" in before
    assert "1.23e-5" not in after
    assert "4.56e-5" in after


def test_an_engine_that_the_list_lacks_is_named(tmp_path: Path) -> None:
    """The error names the engine, and says how to remove its rows."""
    other = replace(SPINNER, name="of-yesterday")
    stale = board_with(*made_up(SPINNER, {"omega": 1e-3}), *made_up(other, {"omega": 1e-3}))
    for make in (lambda: page.page(stale, tmp_path), lambda: page.pictures(stale)):
        with pytest.raises(ValueError, match=r"got of-yesterday: .* @ data/engines\.json"):
            make()


def test_what_has_no_number_is_told_with_its_reason(tmp_path: Path) -> None:
    """Both pages list unavailable and failed runs with their reasons, and without numbers."""
    lost = made_up(SPINNER, {}, standing=Standing.UNAVAILABLE, detail="no such package", floors={})
    document = board_with(*lost, *with_errors(WOBBLER, 1e-3, 1e-4, 1e-5))
    text = page.page(document, tmp_path)
    assert "unavailable, no such package" in text
    assert "[Spinner]" not in text
    own = pages(document, ENTRIES)["tables/engines-spinner.md"]
    assert "unavailable: no such package" in own


def test_the_page_of_an_engine_has_its_commands() -> None:
    """The page has a command for each setting, with all its steps and scenes."""
    own = pages(board(), ENTRIES)["tables/engines-spinner.md"]
    assert "# step 0.1 0.05 0.025; engines/oblique\n" in own
    assert f'taylor-verify run {SCENE} --solver "geometric:lie-rk4?step=0.1"\n' in own
    other = pages(board(), ENTRIES)["tables/engines-wobbler.md"]
    assert re.search(r"splitting\. omega: order (1\.9|2\.0)", other)


# The pictures.


def test_a_picture_has_a_line_for_each_engine() -> None:
    """The points of a line are the rows of the best setting; plain solvers have no step."""
    document = board()
    (panel,) = work.panels(document, ENTRIES, SCENE, document.pace, 1e6)
    assert [line.name for line in panel.lines] == ["Spinner", "Wobbler", "SciPy"]
    assert [y for _, y in panel.lines[0].points] == [
        row.worst for row in document.study.rows if row.engine == "spinner"
    ]
    (steps,) = work.panels(document, ENTRIES, SCENE, work._step, 1.0)
    assert [x for x, _ in steps.lines[0].points] == [0.1, 0.05, 0.025]
    assert [line.name for line in steps.lines] == ["Spinner", "Wobbler"]


def test_no_colour_stands_for_two_engines() -> None:
    """The best two and the worst of each precision have a colour of their own, all others are grey."""
    published = find(REPORTS)
    assert published is not None
    drawn = work.panels(published, entry_list(), SCENE, published.pace, 1e6)
    styles = [line.look for panel in drawn for line in panel.lines if not line.look.dashes]
    coloured = [look.colour for look in styles if look.width > work._OTHERS.width]
    assert len(coloured) == len(set(coloured)) == 3 * len(drawn) < len(styles)


def test_energy_stands_beside_the_motion() -> None:
    """The picture has each engine at its best; the text names one with good energy and a wrong motion."""
    rows = [
        *with_errors(SPINNER, 1e-3, 1e-5, 1e-4),
        *with_errors(WOBBLER, 1.5, 1.4, 1.39),
        *with_errors(PLAIN, 1e-12),
    ]
    document = board_with(*rows)
    drawn = energy.lines(document, ENTRIES, SCENE)
    assert [(line.name, line.motion) for line in drawn] == [("Spinner", 1e-5), ("Wobbler", 1.39)]
    (picture,) = energy.pictures(document, ENTRIES)
    assert "Wobbler keeps the energy to 1.0e-5 %, and its angular velocity is 139 %" in picture.alt
    assert "139 %" in content(picture, "svg").decode()
    lost = board_with(*made_up(SPINNER, {"omega": 0.1, "attitude": 0.1}))
    assert energy.pictures(lost, ENTRIES) == []


def test_a_sweep_shows_what_a_version_changed() -> None:
    """Versions stand in their order, a version without a number leaves a gap, and the text says most."""
    rows = [
        replace(row, version=version, solver=f"{version}{row.value}")
        for version, error in (("3.10", 1e-3), ("3.9", 1e-6), ("3.8", 1e-6))
        for row in with_errors(SPINNER, error, error, error)
    ]
    (sweep,) = sweeps.sweeps(board_with(*rows), ENTRIES)
    assert sweep.versions == ("3.8", "3.9", "3.10")
    assert sweep.lines == {"lie-rk4": (1e-6, 1e-6, 1e-3)}
    (picture,) = sweeps.pictures(board_with(*rows), ENTRIES)
    assert "the largest change is that of lie-rk4 in 3.10, 1e-06 to 0.001." in picture.alt
    assert content(picture, "svg") == content(picture, "svg")
    assert sweeps.pictures(board_with(*rows[:6]), ENTRIES) == []
