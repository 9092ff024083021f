"""Speed against accuracy: the front, the target, and what a time or an error may not do to them."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import pairwise
from math import inf, nan
from pathlib import Path

import pytest
from builders.scenes import asked_at, scene_file
from hypothesis import example, given
from hypothesis import strategies as st
from mpmath import mp

import taylor_verify
from taylor_verify.cli import main
from taylor_verify.cli.tradeoff import tradeoff_text
from taylor_verify.models.problem import Problem, pose
from taylor_verify.numbers.precision import rung
from taylor_verify.records.standing import Standing
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.taylor.driver import Taylor
from taylor_verify.solvers.taylor.settings import named
from taylor_verify.solvers.trajectory import Outcome, Trajectory
from taylor_verify.tradeoff.accuracy import Accuracy, Truth
from taylor_verify.tradeoff.attainability import least_error
from taylor_verify.tradeoff.point import Point, point
from taylor_verify.tradeoff.random_starts import STARTS, nearby
from taylor_verify.tradeoff.recommendation import MARGIN, OutOfReach, recommend, recommended
from taylor_verify.tradeoff.setting import Setting, settings
from taylor_verify.tradeoff.solves import Timed
from taylor_verify.tradeoff.trade_off import front, trade_off

F64 = rung("f64")


@dataclass(frozen=True)
class Scripted(Solver):
    """The driver's answers, with times and outcomes that are made up."""

    name: str
    seconds: float
    tolerance: str = ""
    outcome: Outcome = Outcome.FINISHED
    factor: float = 1.0
    setting: str = ""

    def solve(self, problem: Problem) -> Trajectory:
        if self.outcome is not Outcome.FINISHED:
            return Trajectory(self.outcome, seconds=self.seconds)
        solver = named(f"taylor?tol={self.tolerance}") if self.tolerance else Taylor()
        made, times = solver.solve(problem), mp.mpf(self.factor)
        return replace(
            made,
            quantities={name: values * times for name, values in made.quantities.items()},
            seconds=self.seconds,
            compile_seconds=0.0,
            inner_seconds=None,
        )


def setting_of(solver: Solver, family: str = "") -> Setting:
    return Setting(solver, F64, 1e-9, "tolerance", family or solver.name)


def made_up(error: float, seconds: float, outcome: Outcome = Outcome.FINISHED) -> Point:
    setting = setting_of(Scripted("made up", seconds))
    run = Timed(setting, Trajectory(outcome, seconds=seconds), 0.0, (seconds,))
    return point(run, Accuracy({"omega": error}, {"omega": error}))


@pytest.fixture(scope="module")
def scene() -> Scene:
    whole = load("euler/generic")
    return replace(whole, clock=replace(whole.clock, instants=whole.clock.instants[:6]))


MADE = st.builds(
    made_up,
    st.one_of(st.floats(0, 10), st.sampled_from([nan, inf, 1e-9, 1e-3])),
    st.sampled_from([0.1, 0.2, 0.3, 0.5, 1.0]) | st.floats(1e-6, 10),
    st.sampled_from([Outcome.FINISHED] * 4 + [Outcome.STEP_LIMIT, Outcome.NON_FINITE]),
)


def dominates(one: Point, other: Point) -> bool:
    """No slower and no less accurate, and better in one of them."""
    no_worse = one.seconds <= other.seconds and one.error <= other.error
    return no_worse and (one.seconds < other.seconds or one.error < other.error)


@given(st.lists(MADE, max_size=12))
@example([made_up(1e-3, 1.0), made_up(1e-3, 1.0)])
def test_the_front_is_what_nothing_sound_beats(points: list[Point]) -> None:
    """No point of the front is dominated, every sound point off it is, and all on it are sound.

    Along it times do not fall, and errors do not rise.
    """
    fastest = front(points)
    for before, after in pairwise(fastest):
        assert before.seconds <= after.seconds
        assert before.error >= after.error
    sound = [p for p in points if p.standing is Standing.SOUND]
    for p in fastest:
        assert p.standing is Standing.SOUND
        assert p.timed.trajectory.outcome is Outcome.FINISHED
        assert p.error < 1
        assert not any(dominates(other, p) for other in sound)
    on = {id(p) for p in fastest}
    for p in sound:
        assert id(p) in on or any(dominates(other, p) for other in fastest)
    assert bool(fastest) == bool(sound)


@pytest.mark.parametrize("error", [nan, inf, 1.0, 2.0])
def test_an_error_of_the_motions_size_is_a_false_success(error: float) -> None:
    """A finished run whose error is no number, or as large as the motion, is told as such."""
    p = made_up(error, 1e-9)
    assert p.standing is Standing.FALSE
    assert front([p, made_up(1e-3, 1.0)])[0].error == 1e-3
    assert json.loads(json.dumps(p.row(), allow_nan=False))["standing"] == "false success"


def test_nan_in_one_quantity_is_the_worst() -> None:
    """An error of the attitude that is no number is not lost beside a small one of omega."""
    accuracy = Accuracy({"omega": 1e-9, "attitude": nan})
    assert not accuracy.worst < 1
    accuracy = Accuracy({"attitude": nan, "omega": 1e-9})
    assert not accuracy.worst < 1


def test_a_lost_or_failed_run_is_never_on_the_front(scene: Scene) -> None:
    """The fastest runs of all are one of NaN, one that stopped and one twice too large: none wins."""
    asked = [
        setting_of(Scripted("lost", 1e-9, factor=nan)),
        setting_of(Scripted("stopped", 1e-9, outcome=Outcome.STEP_LIMIT)),
        setting_of(Scripted("tripled", 1e-9, factor=3)),
        setting_of(Scripted("slow", 1.0)),
    ]
    trade = trade_off(scene, asked, repeats=1)
    standing = {p.timed.setting.solver.name: p.standing for p in trade.points}
    assert standing == {
        "lost": Standing.FALSE,
        "stopped": Standing.FAILED,
        "tripled": Standing.FALSE,
        "slow": Standing.SOUND,
    }
    assert [p.timed.setting.solver.name for p in trade.front] == ["slow"]
    assert recommended(trade, 1e-6).solver.name == "slow"


def test_a_trade_says_what_rounding_alone_leaves(scene: Scene) -> None:
    """The floor of the judge, one rounding a sample, is told for each rung, finer on the wider one."""
    asked = [
        setting_of(Scripted("coarse", 1.0)),
        replace(setting_of(Scripted("fine", 1.0)), rung=rung("f32")),
    ]
    document = trade_off(scene, asked, repeats=1).document()
    floors = document["attainable"]
    assert floors == {r.name: least_error(scene, r) for r in (F64, rung("f32"))}
    assert floors["f64"] * 2**28 <= floors["f32"] <= floors["f64"] * 2**30
    assert f"f64 {floors['f64']:.2g}" in " ".join(tradeoff_text([document]).split())


def test_a_family_is_not_set_finer_than_patience_has_it(scene: Scene) -> None:
    """Settings finer than one that takes too long are not run, with the reason."""
    slow, finer, other = (
        Scripted(n, s) for n, s in (("slow", 1e3), ("finer", 1e3), ("other", 1.0))
    )
    asked = [setting_of(slow, "one"), setting_of(finer, "one"), setting_of(other, "two")]
    trade = trade_off(scene, asked, repeats=2)
    assert [p.standing for p in trade.points] == [
        Standing.SOUND,
        Standing.NOT_RUN,
        Standing.SOUND,
    ]
    assert "coarser" in trade.points[1].because
    assert len(trade.points[0].timed.seconds) == 1


@pytest.mark.parametrize(
    ("name", "states"),
    [("euler/generic", {"omega"}), ("euler/with-attitude", {"omega", "attitude"})],
)
def test_errors_are_the_judges(name: str, states: set[str]) -> None:
    """The achieved error and drift of a point are those that the judge finds, each quantity apart."""
    scene, solver = asked_at(name, 0, 1, 2, 3), named("taylor?tol=1e-6")
    (p,) = trade_off(scene, [setting_of(solver)], repeats=1).points
    verdicts = {v.quantity: v for v in taylor_verify.run(scene, solver, "f64").verdicts}
    assert set(p.accuracy.max) == states
    assert p.error == max(p.accuracy.max.values())
    # The point adds the width of the truth: a thousandth of a unit of roundoff of 1e-6.
    for state in states:
        assert p.accuracy.max[state] == pytest.approx(verdicts[state].max, rel=1e-9)
        assert p.accuracy.final[state] == pytest.approx(verdicts[state].final, rel=1e-9)
    assert p.accuracy.drift == max(
        verdict.max for quantity, verdict in verdicts.items() if quantity not in {*states, "start"}
    )


@pytest.mark.parametrize("target", [1e-5, 1e-10])
def test_the_recommended_setting_meets_the_target(scene: Scene, target: float) -> None:
    """Run again, the setting stays below the target with its margin, here and on every near start."""
    asked = [s for s in settings(scene, ["f64"]) if isinstance(s.solver, Taylor)]
    recommendation = recommend(scene, target, asked)
    assert isinstance(recommendation.solver, Solver)
    for start in (scene, *nearby(scene, recommendation.seed)):
        problem = pose(start, recommendation.rung)
        assert (
            MARGIN * Truth(problem).accuracy(recommendation.solver.solve(problem)).worst <= target
        )
    (_, omega, *_) = taylor_verify.run(scene, recommendation.solver, recommendation.rung).verdicts
    assert omega.max is not None
    assert omega.max <= target


@dataclass(frozen=True)
class Fitted(Solver):
    """Accurate from one start and no other, as a step tuned to one orbit is."""

    own: Scene
    name: str = "fitted"
    setting: str = ""

    def solve(self, problem: Problem) -> Trajectory:
        at_home = problem.scene.initial == self.own.initial
        solver = Taylor() if at_home else named("taylor?tol=1e-2")
        return replace(solver.solve(problem), seconds=1e-6)


def test_a_setting_that_fails_from_a_near_start_is_passed_over(scene: Scene) -> None:
    """The fastest setting reaches the target from the scene's own start alone, and is not taken."""
    asked = [setting_of(Fitted(scene)), setting_of(Scripted("steady", 1.0))]
    trade = trade_off(scene, asked, repeats=1)
    assert next(p.timed.setting.solver.name for p in trade.front) == "fitted"
    recommendation = recommended(trade, 1e-10)
    assert recommendation.solver.name == "steady"
    assert recommendation.starts == 1 + STARTS


def test_a_target_below_roundoff_is_out_of_reach(scene: Scene) -> None:
    """A target that no setting reaches is said, with the setting that comes nearest."""
    asked = [setting_of(Scripted("slow", 1.0))]
    with pytest.raises(OutOfReach, match=r"1e-40.*most accurate, slow"):
        recommended(trade_off(scene, asked, repeats=1), 1e-40)
    # Before it is measured, it is known from the rounding alone.
    with pytest.raises(OutOfReach, match=r"1e-40.*on f64 rounding alone leaves.*is mp\d+"):
        recommend(scene, 1e-40, asked)


def test_starts_are_near_and_drawn_from_the_seed(scene: Scene) -> None:
    """Starts of one seed are equal; each component is within one per cent, and zero stays."""
    flat = replace(
        scene, initial=replace(scene.initial, omega=(Fraction(1), Fraction(0), Fraction(2)))
    )
    starts = nearby(flat, 3)
    assert starts == nearby(flat, 3)
    assert starts != nearby(flat, 4)
    assert len({s.initial for s in starts}) == STARTS
    for start in starts:
        for moved, own in zip(start.initial.omega, flat.initial.omega, strict=True):
            assert abs(moved - own) <= abs(own) / 100


# The command


@pytest.fixture
def short(tmp_path: Path) -> str:
    return str(scene_file(tmp_path))


def test_the_verb_tells_all_of_it(short: str, capsys: pytest.CaptureFixture[str]) -> None:
    """The document has points with what was asked and achieved, the front, the machine, the setting."""
    call = ["tradeoff", short, "--rung", "f32", "--repeats", "2", "--target", "1e-3", "--json"]
    assert main(call) == 0
    (trade,) = json.loads(capsys.readouterr().out)["scenes"]
    assert {row["rung"] for row in trade["points"]} == {"f32"}
    assert trade["front"]
    assert trade["provenance"]["processor"]
    assert trade["timing"]["seed"] == 1
    chosen = trade["recommendation"]
    assert chosen["margin"] * chosen["error"] <= 1e-3
    for row in trade["points"]:
        assert row["seconds"] is None or row["repeats"] == 2


def test_the_verb_says_that_nothing_reaches_the_target(
    short: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """Exit status 3, and the reason on stderr; the table is printed all the same."""
    call = ["tradeoff", short, "--rung", "f32", "--repeats", "1", "--target", "1e-20"]
    assert main(call) == 3
    out, err = capsys.readouterr()
    assert "no setting stays below 1e-20" in err
    assert "The front" in out


@pytest.mark.parametrize(
    ("call", "message"),
    [
        ([], "expected a scene"),
        (["euler/generic", "--target", "0"], "positive error"),
        (["euler/generic", "--target", "nan"], "positive error"),
        (["euler/generic", "--repeats", "0"], "--repeats"),
        (["euler/generic", "--rung", "f63"], "--rung"),
        (["euler/generic", "--solver", "taylor?tol=none"], "@ --solver"),
        (["euler/nowhere"], "nowhere"),
    ],
)
def test_a_wrong_call_is_refused(
    call: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """Exit status 2, and what was expected."""
    assert main(["tradeoff", *call]) == 2
    assert message in capsys.readouterr().err


def test_the_pictures_and_their_numbers_are_written_on_request(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """--out DIR holds the document that --json prints, and each picture for page and print."""
    place = tmp_path / "out"
    arguments = ["tradeoff", "euler/generic", "--solver", "geometric:splitting?step=0.1"]
    assert main([*arguments, "--rung", "f64", "--repeats", "1", "--json", "--out", str(place)]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert json.loads((place / "tradeoff.json").read_text()) == printed
    names = {file.name for file in place.iterdir()}
    expected = {
        f"euler-generic-{what}.{end}" for what in ("time", "evaluations") for end in ("svg", "pdf")
    }
    assert expected < names


def test_a_folder_that_cannot_be_made_is_refused_before_measuring(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Minutes of measuring do not end in a refusal to write."""
    (tmp_path / "file").write_text("")
    assert main(["tradeoff", "euler/generic", "--out", str(tmp_path / "file" / "out")]) == 2
    assert "expected a folder that can be written" in capsys.readouterr().err
