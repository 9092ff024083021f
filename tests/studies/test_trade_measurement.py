"""The published measurement: medians and their intervals, rounds and their yardstick, what is stored."""

from __future__ import annotations

import gc
import json
from dataclasses import dataclass, fields, replace
from functools import partial
from math import comb, isclose
from pathlib import Path
from statistics import median

import pytest
from hypothesis import given
from hypothesis import strategies as st

from taylor_verify.cli import main
from taylor_verify.models.problem import Problem
from taylor_verify.numbers.precision import rung
from taylor_verify.records.standing import Standing
from taylor_verify.scenes.reading.reader import load
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.solver import Solver
from taylor_verify.solvers.trajectory import Outcome, Trajectory
from taylor_verify.tradeoff.document import TradePoint
from taylor_verify.tradeoff.setting import setting as real_setting
from taylor_verify.tradeoff.timing import in_rounds
from taylor_verify_reports.studies.tradeoff import measurement, rounds
from taylor_verify_reports.studies.tradeoff.measurement import (
    SCENES,
    published_settings,
    scene_named,
)
from taylor_verify_reports.studies.tradeoff.medians import CONFIDENCE, coverage, estimate, place
from taylor_verify_reports.studies.tradeoff.rounds import YARDSTICK, measured

F64 = rung("f64")

# The median and its interval.


@given(st.lists(st.floats(-1e6, 1e6), min_size=1, max_size=30))
def test_the_interval_is_made_of_the_values_and_holds_the_median(values: list[float]) -> None:
    """The ends of the interval are two of the values, with symmetric ranks."""
    estimated = estimate(values)
    assert estimated.median == median(values)
    if estimated.low is not None and estimated.high is not None:
        assert estimated.low <= estimated.median <= estimated.high
        rank, ranked = place(len(values), CONFIDENCE), sorted(values)
        assert (estimated.low, estimated.high) == (ranked[rank - 1], ranked[::-1][rank - 1])


@pytest.mark.parametrize("count", range(1, 40))
def test_the_rank_is_the_largest_that_has_the_confidence(count: int) -> None:
    """The next rank has less than the confidence, by the binomial distribution."""
    rank = place(count, CONFIDENCE)
    if rank:
        assert coverage(count, rank) >= CONFIDENCE
    assert not coverage(count, rank + 1) >= CONFIDENCE
    between = sum(comb(count, below) for below in range(rank, count - rank + 1)) / 2**count
    assert isclose(between, coverage(count, rank), abs_tol=1e-12)


# The rounds of a process.


def test_each_round_has_every_turn_in_an_order_of_its_own() -> None:
    """Answers stand by turn and round, the order is random, and garbage is not collected meanwhile."""
    called: list[int] = []

    def turn(number: int) -> tuple[int, bool]:
        called.append(number)
        return len(called), gc.isenabled()

    answers = in_rounds([partial(turn, k) for k in range(8)], 3, seed=2)
    rounds = [called[k : k + 8] for k in range(0, 24, 8)]
    assert all(sorted(each) == [*range(8)] for each in rounds)
    assert len(set(map(tuple, rounds))) == 3
    assert answers[5] == [(8 * k + each.index(5) + 1, False) for k, each in enumerate(rounds)]
    assert gc.isenabled()


class Machine:
    """A machine whose speed drifts: each solve takes longer than the last by one per cent."""

    def __init__(self) -> None:
        self.slowness = 1.0
        self.solved: list[str] = []
        self.now = 0.0

    def take(self, name: str, seconds: float) -> float:
        self.slowness *= 1.01
        self.solved.append(name)
        self.now += seconds * self.slowness
        return seconds * self.slowness

    def clock(self) -> float:
        """The seconds of the processor."""
        return self.now


@dataclass(frozen=True)
class Paced(Solver):
    """Takes what it is told to, on a machine that drifts."""

    machine: Machine
    name: str
    seconds: float
    outcome: Outcome = Outcome.FINISHED
    setting: str = ""

    def solve(self, problem: Problem) -> Trajectory:
        seconds = self.machine.take(self.name, self.seconds)
        return Trajectory(self.outcome, seconds=seconds, inner_seconds=seconds / 2)


@pytest.fixture
def machine(monkeypatch: pytest.MonkeyPatch) -> Machine:
    """Settings are made up; each name says how long a solve takes, or that it fails."""
    made = Machine()

    def made_up(name: str, on: object) -> object:
        if name == YARDSTICK[0]:
            return replace(real_setting("taylor", F64), solver=Paced(made, name, 0.02))
        word, _, seconds = name.partition(":")
        outcome = Outcome.NON_FINITE if word == "broken" else Outcome.FINISHED
        solver = Paced(made, name, float(seconds), outcome)
        return replace(real_setting("taylor", F64), solver=solver)

    monkeypatch.setattr(rounds, "setting", made_up)
    return made


@pytest.fixture(scope="module")
def scene() -> Scene:
    return load("euler/generic")


def names(*words: str) -> list[tuple[str, str]]:
    return [(word, "f64") for word in words]


def test_a_ratio_is_formed_within_its_round(machine: Machine, scene: Scene) -> None:
    """A machine that slows down tenfold over a run shifts no ratio by more than one round does."""
    asked = names(*(f"a{k}:0.04" for k in range(12)))
    ratios = measured(scene, asked, seed=3, rounds=18, resolution=1e-9, clock=machine.clock)
    assert machine.slowness > 10
    # A round has 13 solves or so, each a per cent slower than the one before.
    for one in ratios.values():
        assert 2 / 1.01**14 <= one.ratio <= 2 * 1.01**14
        assert one.inner == pytest.approx(one.seconds / 2)


def test_a_short_solve_is_repeated_until_the_clock_resolves_it(
    machine: Machine, scene: Scene
) -> None:
    """A measurement lasts at least a hundred times the clock's resolution."""
    asked = names("quick:0.001")
    measured(scene, asked, seed=1, rounds=1, resolution=1e-3, clock=machine.clock)
    # 0.1 s in solves of a thousandth; the first solve of all is not among them.
    assert machine.solved.count("quick:0.001") - 1 >= 0.1 / 0.001 / machine.slowness


def test_what_fails_is_left_out(machine: Machine, scene: Scene) -> None:
    """A setting that does not finish has no time, and the others do."""
    ratios = measured(scene, names("broken:0.01", "sound:0.01"), 1, 2, 1e-9, machine.clock)
    assert set(ratios) == {("sound:0.01", "f64")}
    assert machine.solved.count("broken:0.01") == 1


# What is measured, and what is stored of it.


@pytest.mark.parametrize("name", SCENES)
def test_every_published_setting_can_be_named_again(name: str) -> None:
    """A worker process gets names alone: each leads to the same solver, once."""
    asked = tuple(published_settings(scene_named(name), with_outside=True))
    names_and_rungs = [(one.solver.name, one.rung.name) for one in asked]
    assert len(set(names_and_rungs)) == len(names_and_rungs)
    assert YARDSTICK in names_and_rungs
    for one in asked:
        again = real_setting(one.solver.name, one.rung)
        assert again.solver == one.solver
        assert again.family == one.family


def test_a_scene_beyond_its_end_has_the_solvers_of_the_columns_alone() -> None:
    """Taylor on f64 and the peers follow it; the scene is the shipped one until the later time."""
    name = "kirchhoff/whole-motion until t = 1600"
    scene, shipped = scene_named(name), load("kirchhoff/whole-motion")
    assert (scene.name, scene.body, scene.initial) == (name, shipped.body, shipped.initial)
    assert (scene.clock.instants[0], scene.clock.instants[-1]) == (0, 1600)
    families = {one.family for one in published_settings(scene, with_outside=True)}
    ours = {"taylor f64", "taylor f64 optimised"}
    assert families == ours | {f"outside {peer}" for peer in measurement.PEERS}


def test_numbers_and_times_are_apart(monkeypatch: pytest.MonkeyPatch, scene: Scene) -> None:
    """No time stands among the numbers, and every setting that is sound has one among the times."""
    few = [
        replace(real_setting(name, F64), withheld=reason)
        for name, reason in (("taylor", ""), ("taylor?tol=1e-6", ""), ("scipy:DOP853", "too slow"))
    ]
    monkeypatch.setattr(measurement, "published_settings", lambda scene, outside: few)
    monkeypatch.setattr(measurement, "run_all", lambda work, asked, workers: [work(*asked)])
    finished: list[str] = []
    numbers, times = measurement.measurement(["euler/generic"], 2, 1, finished=finished.append)
    (one,) = numbers.scenes
    assert {p.scene for p in numbers.points} == {one.scene}
    assert not {"seconds", "spread", "repeats"} & {f.name for f in fields(TradePoint)}
    sound, not_run = Standing.SOUND, Standing.NOT_RUN
    assert [p.standing for p in numbers.points] == [sound, sound, not_run]
    timed = {(row.solver, row.rung): row for row in times.timings}
    assert set(timed) == {("taylor", "f64"), ("taylor?tol=1e-6", "f64")}
    assert timed[YARDSTICK].ratio == 1
    assert timed[YARDSTICK].processes == 2
    # Two processes are too few for an interval, and none is claimed.
    assert timed[YARDSTICK].low is None
    assert len(finished) == 3


def test_the_verb_writes_data_and_page(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """`publish tradeoff` measures, and writes both documents, the page, its sheet and its pictures."""
    few = (real_setting("taylor", F64),)
    whole = measurement.measurement
    monkeypatch.setattr(measurement, "published_settings", lambda scene, outside: few)
    monkeypatch.setattr(measurement, "run_all", lambda work, asked, workers: [work(*asked)])
    monkeypatch.setattr(
        measurement,
        "measurement",
        lambda with_outside, finished: whole(["euler/generic"], 1, 1, with_outside, 1, finished),
    )
    assert main(["publish", "tradeoff", "--from", str(tmp_path), "--json"]) == 0
    written = json.loads(capsys.readouterr().out)["written"]
    pictures = {name for name in written if Path(name).parent.name == "figures"}
    assert {Path(name).suffix for name in pictures} == {".svg", ".pdf"}
    assert {Path(name).name for name in set(written) - pictures} == {
        "tradeoff.json",
        "tradeoff-timings.json",
        "tradeoff.md",
        "tradeoff.csv",
    }
