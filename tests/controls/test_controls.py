"""Every gate has a broken solver that it catches, and the published table says what the rows say."""

import json
from dataclasses import replace
from functools import lru_cache
from math import nextafter
from pathlib import Path

import numpy as np
import pytest
from builders.studies.stored import publish_document

from taylor_verify.exact.invariants import invariants
from taylor_verify.models.problem import pose
from taylor_verify.numbers.precision import rung
from taylor_verify.records.quantities import INITIAL, UNIT_QUATERNION
from taylor_verify.records.status import Status
from taylor_verify.scenes.reading.reader import load
from taylor_verify_reports.controls.broken_answers import ANSWERS
from taylor_verify_reports.controls.defect import Defect
from taylor_verify_reports.controls.defects import DEFECTS
from taylor_verify_reports.studies.controls import controls_page as controls
from taylor_verify_reports.studies.controls import proof
from taylor_verify_reports.studies.controls.broken_runs import RUNG, Twins, sights, study
from taylor_verify_reports.studies.controls.controls_page import STUDY
from taylor_verify_reports.studies.controls.sight import CONTROLS, ControlsStudy, Sight

NAMED = {defect.name: defect for defect in DEFECTS}
TWINS: Twins = {}
# They take longest, and each gate that one of them fails sees another defect too.
LONG = {
    *("damping-of-omega", "damping-of-one-impulse", "munk-moment-sign"),
    *("one-sample-late", "one-sample-late-impulse"),
}
COMPARED = [
    pytest.param(d, id=d.name, marks=pytest.mark.slow if d.name in LONG else ())
    for d in DEFECTS
    if not d.honest
]


@lru_cache
def sight_of(name: str) -> Sight:
    """One run of a defect and its twin, shared by the tests."""
    (sight,) = sights([NAMED[name]], twins=TWINS)
    return sight


@pytest.fixture(
    scope="module",
    params=[False, pytest.param(True, marks=pytest.mark.slow)],
    ids=["most", "every"],
)
def document(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> ControlsStudy:
    """Most defects, or all, as they are read back by way of a file."""
    folder = tmp_path_factory.mktemp("controls")
    names = [defect.name for defect in DEFECTS if request.param or defect.name not in LONG]
    CONTROLS.write(folder, study(map(sight_of, names)))
    return CONTROLS.load(folder)


@pytest.fixture
def rows(document: ControlsStudy) -> tuple[Sight, ...]:
    return document.sights


# The defects.


@pytest.mark.parametrize("defect", COMPARED)
def test_defect_is_seen_by_the_gates_that_physics_says_and_by_no_other(defect: Defect) -> None:
    """Quantities that a defect conserves pass, all others fail, the gate named for it among them."""
    verdicts = sight_of(defect.name).verdicts
    start = set() if defect.wrong_start else {INITIAL}
    assert {
        v.quantity for v in verdicts.values() if v.verdict is Status.PASS
    } == defect.passes | start
    assert {v.verdict for v in verdicts.values()} <= {Status.PASS, Status.FAIL}
    assert verdicts[defect.gate].verdict is Status.FAIL


@pytest.mark.parametrize("defect", COMPARED)
def test_defect_is_off_by_more_than_any_rounding(defect: Defect) -> None:
    """The named gate fails by a thousand floors, so that no choice of its factor could hide it."""
    caught = sight_of(defect.name).verdicts[defect.gate]
    if defect.name == "one-ulp-over":
        # This one is as close as it can be.
        assert caught.max == pytest.approx(caught.bound, rel=1e-15)
    elif defect.name == "one-nan":
        assert caught.ratio is None or np.isnan(caught.ratio)
    else:
        assert caught.ratio is not None
        assert caught.ratio >= 1000


@pytest.mark.parametrize("defect", COMPARED)
def test_sound_twin_passes_every_gate(defect: Defect) -> None:
    """The defect fails, not the scene and not the step: the twin passes all gates there."""
    sight = sight_of(defect.name)
    assert {v.verdict for v in sight.sound.values()} == {Status.PASS}
    # A quaternion has a row of its own only where it is no unit quaternion.
    assert set(sight.sound) == set(sight.verdicts) - {UNIT_QUATERNION}


def test_honest_failure_is_scored_as_its_outcome() -> None:
    """A solver that says it stopped has one failed row, its outcome, and no error in numbers."""
    (verdict,) = sight_of("stopped-and-said-so").verdicts.values()
    assert (verdict.verdict, verdict.max, verdict.at) == (Status.FAIL, None, None)
    assert verdict.outcome.startswith("stopped")
    assert [defect.name for defect in DEFECTS if defect.honest] == ["stopped-and-said-so"]


def test_every_gate_catches_a_defect(rows: tuple[Sight, ...]) -> None:
    """No gate on any scene used here is only for show."""
    asked = {name for row in rows for name in row.quantities}
    assert INITIAL in asked
    caught = {name for row in rows for name in row.seen_by}
    assert asked == caught
    assert asked >= {"omega", "impulse", "attitude", "centre", "T", "H2", "F2", "FG", "y3"}
    assert asked >= {"H_space", "x_space", "y_space"}


@pytest.mark.parametrize(
    ("name", "sign"), [("explicit-gyroscopic-update", 1), ("implicit-gyroscopic-update", -1)]
)
def test_energy_rises_or_falls_in_every_step(name: str, sign: int) -> None:
    """The explicit update gains energy from sample to sample, its implicit mirror loses it."""
    scene = load(NAMED[name].scene)
    problem = pose(scene, rung(RUNG))
    motion = NAMED[name].solve(problem).motion(100)
    (energy,) = (i for i in invariants(problem.given) if i.name == "T")
    assert np.all(sign * np.diff(energy.value(motion)) > 0)


def test_shift_is_found_with_its_size_and_sign() -> None:
    """States half a millisecond early are found to be so, to what the gates would let pass."""
    verdict = sight_of("half-a-millisecond-early").verdicts["omega"]
    assert verdict.shift == "constant"
    assert verdict.time_shift is not None
    assert verdict.residual is not None
    assert verdict.bound is not None
    assert verdict.max is not None
    # An error of the bound is as much time as the bound is of this error.
    assert abs(verdict.time_shift + 0.0005) <= 0.0005 * verdict.bound / verdict.max
    assert verdict.residual <= verdict.bound


def test_one_ulp_decides() -> None:
    """The least double above the bound fails and the greatest below it passes, at one sample."""
    sight = sight_of("one-ulp-over")
    over, within = sight.verdicts["omega"], sight.sound["omega"]
    assert over.bound == within.bound
    assert over.bound is not None
    assert (over.verdict, within.verdict) == (Status.FAIL, Status.PASS)
    # The error is an mpf, rounded once more to be shown.
    assert over.max in {over.bound, nextafter(over.bound, 1)}
    assert within.max in {over.bound, nextafter(over.bound, 0)}


def test_defects_of_an_answer_change_nothing_where_they_say_nothing() -> None:
    """A quantity whose numbers a defect leaves alone keeps them bit by bit: T of a conjugate, say."""
    spoilt = sight_of("conjugate-quaternion").verdicts
    twin = sight_of("conjugate-quaternion").sound
    assert all(spoilt[q].max == twin[q].max for q in NAMED["conjugate-quaternion"].passes)
    assert NAMED["conjugate-quaternion"] in ANSWERS


# What the table says.


def test_energy_alone_misses_what_it_is_said_to_miss(rows: tuple[Sight, ...]) -> None:
    """Every defect that conserves T by its physics is one that the page says the energy misses."""
    (sentence,) = (s for s in proof.proven(rows) if "gate of the energy" in s)
    named = sentence.partition(": ")[2].partition(".")[0].replace(" and ", ", ").split(", ")
    finished = [row for row in rows if row.is_finished]
    blind = [row for row in finished if "T" in NAMED[row.defect.name].passes]
    assert f"{len(blind)} of {len(finished)} defects" in sentence
    assert sorted(named) == sorted(proof.title(row) for row in blind)


def test_conservation_altogether_misses_a_wrong_motion(rows: tuple[Sight, ...]) -> None:
    """Late, early and frozen bodies pass every conserved quantity, and fail the state."""
    names = {row.defect.name for row in rows}
    defects = [NAMED[name] for name in names]
    expected = {d.name for d in defects if not d.honest and set(d.passes) >= conserved_by(d)}
    missed = {row.defect.name for row in proof.conserving(rows)}
    assert missed == expected
    late = {"half-a-millisecond-early", "success-after-failure", "one-sample-late"}
    assert missed >= late & names


def conserved_by(defect: Defect) -> set[str]:
    return {v.quantity for v in sight_of(defect.name).sound.values() if v.is_conserved}


def test_faulty_twin_takes_the_gate_out_of_the_count(rows: tuple[Sight, ...]) -> None:
    """A gate that fails the sound twin too has not seen the defect, and the page says so."""
    row = next(row for row in rows if row.defect.name == "angular-damping")
    assert row.is_seen_by("T")
    failed = replace(row.sound["T"], verdict=Status.FAIL)
    faulty = replace(row, sound={**row.sound, "T": failed})
    assert not faulty.is_seen_by("T")
    assert any("sound twin fails" in sentence for sentence in proof.proven([faulty]))


def test_table_is_made_from_stored_rows_alone(tmp_path: Path) -> None:
    """A number changed in controls.json is changed in the tables, and no solver runs for it."""
    publish_document(tmp_path, STUDY, CONTROLS, study([sight_of("energy-restored")]))
    file = tmp_path / "data" / "controls.json"
    content = json.loads(file.read_text(encoding="utf-8"))
    for row in content["verdicts"]:
        if row["solver"] == "energy-restored" and row["quantity"] == "omega":
            row["ratio"] = 1.25e7 * content["factor"]
    file.write_text(json.dumps(content), encoding="utf-8")
    changed = CONTROLS.load(tmp_path)
    assert "**1.2e7**" in controls.page(changed)
    assert ",12500000.0," in controls.sheet(changed)
