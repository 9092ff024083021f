"""The ratios of `make bench`: taken in turns, kept, and set beside what they were and what is wanted."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from io import StringIO
from pathlib import Path

import pytest
from benches import __main__ as bench
from benches import history
from benches.history import Row, has_moved, keep, last
from benches.judging import FAILING, PASSING, chunks
from benches.propagation import plain
from benches.ratio import Action, Ratio, Side, Target
from benches.suite import Costs, Measured, in_turns, summary
from benches.table import remarks, table
from rich.console import Console

from taylor_verify.batch.sweeps.chunk import judge
from taylor_verify.judge.provenance import processor
from taylor_verify.models.problem import pose
from taylor_verify.numbers.precision import rung
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.taylor.driver import Taylor
from taylor_verify.solvers.trajectory import Postponed

PROCESSOR, COMMIT = "some processor", "1234567"
ENOUGH = Target(2.5, "half as much again may be added")


class Time:
    """A clock that goes on only where an action says so."""

    def __init__(self) -> None:
        self.now, self.order = 0.0, ""

    def __call__(self) -> float:
        return self.now

    def action(self, letter: str, seconds: float, units: int = 1) -> Action:
        """Return an action that takes so many seconds."""

        def run(_: None) -> None:
            self.now += seconds
            self.order += letter

        return Action(run, units=units, clock=self)


def invented(slower: float = 1, rounds: int | None = None) -> Ratio:
    """Return a ratio of two, whose action may be slower by a factor."""

    def pair() -> tuple[Side, Side]:
        time = Time()
        return time.action("a", 0.5 * slower), time.action("y", 0.25)

    return Ratio("invented/twice", "twice the work over the work", pair, ENOUGH, rounds=rounds)


def measured(ratio: Ratio) -> Measured:
    """Return a ratio that two processes have taken."""
    return summary(ratio, [in_turns(ratio), in_turns(ratio)])


def printed(measured: list[Measured], before: dict[str, Row]) -> str:
    page = Console(file=StringIO(), width=200)
    page.print(table(measured, before))
    for line in remarks(measured, before):
        page.print(line)
    return page.file.getvalue()  # type: ignore[attr-defined]


# Taking


def test_both_sides_have_a_turn_in_each_round() -> None:
    """The first cost of each is after a call that is not timed."""
    time = Time()
    pair = time.action("a", 1.0), time.action("y", 2.0)
    costs = in_turns(Ratio("x", "x", lambda: pair, rounds=4))
    assert {time.order[:4]} <= {"aayy", "yyaa"}
    assert all({*time.order[k : k + 2]} == {"a", "y"} for k in (4, 6, 8))
    assert costs == Costs((1.0,) * 4, (2.0,) * 4)


def test_a_ratio_is_the_median_of_quotients_of_single_rounds() -> None:
    """A machine that grows slower in the meantime changes costs, and not the ratio."""
    every = [Costs((2.0, 4.0, 8.0), (1.0, 2.0, 4.0)), Costs((30.0, 20.0), (10.0, 10.0))]
    one = summary(invented(), every)
    assert (one.value, one.spread, one.cost) == (2.0, 0.0, 8.0)


# What is named


def test_a_slower_twin_is_named(tmp_path: Path) -> None:
    """Half as slow again misses its target and is worse than what was kept; the sound one is neither."""
    sound, slower = (measured(invented(factor)) for factor in (1, 1.5))
    keep([sound], tmp_path / "history.csv", PROCESSOR, COMMIT)
    before = last(tmp_path / "history.csv", PROCESSOR)
    assert before["invented/twice"].ratio == 2.0
    assert not sound.misses
    assert "worse" not in printed([sound], before)
    page = printed([slower], before)
    assert slower.misses
    assert f"missed ({ENOUGH.because}): invented/twice" in page
    assert f"worse: invented/twice is 3 ±0, was 2 ±0 at {COMMIT}" in page
    assert "better: " in printed(
        [sound], {"invented/twice": replace(before["invented/twice"], ratio=3)}
    )


@pytest.mark.parametrize(
    ("value", "spread", "moved"),
    [
        (2.0, 0.0, False),
        (2.05, 0.0, True),
        (2.03, 0.0, False),
        (2.2, 0.15, False),
        (2.3, 0.15, True),
    ],
)
@pytest.mark.parametrize("sign", [1, -1])
def test_a_ratio_has_moved_beyond_both_spreads_and_the_resolution(
    value: float, spread: float, moved: bool, sign: int
) -> None:
    """Upwards and downwards alike."""
    row = Row(
        "2026-01-01", COMMIT, "1", PROCESSOR, "invented/twice", 2.0, 0.1 if spread else 0.0, 1.0
    )
    assert has_moved(Measured(invented(), 2 + sign * (value - 2), spread, 1.0), row) is moved


def test_a_cost_beyond_its_own_target_misses() -> None:
    """The ratio may be as good as it likes."""
    ratio = replace(invented(), limit=Target(0.5, "half a second"))
    assert not Measured(ratio, 2.0, 0.0, 0.5).misses
    assert Measured(ratio, 2.0, 0.0, 0.6).misses


# The history


def test_the_history_answers_with_the_latest_row_of_the_same_processor(tmp_path: Path) -> None:
    """Rows are appended, and another machine's ratios are no yardstick."""
    file = tmp_path / "history.csv"
    assert last(file, PROCESSOR) == {}
    for value, chip in ((1.0, PROCESSOR), (1.5, PROCESSOR), (9.0, "another, older")):
        keep([Measured(invented(), value, 0.1, 1e-3)], file, chip, COMMIT)
    assert last(file, PROCESSOR)["invented/twice"].ratio == 1.5
    assert last(file, "another, older")["invented/twice"].ratio == 9.0
    assert file.read_text().count("date,commit") == 1
    assert len(file.read_text().splitlines()) == 4


# The command


@pytest.fixture
def shipped(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Put one invented ratio in the place of all others, and an empty history; yield the history."""
    monkeypatch.setattr(bench, "RATIOS", (invented(1.5, rounds=2),))
    monkeypatch.setattr(history, "FILE", tmp_path / "history.csv")
    return tmp_path / "history.csv"


def test_a_missed_target_fails_only_where_that_is_asked_for(
    shipped: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """It is named all the same, and nothing is kept unasked."""
    assert bench.main([]) == 0
    assert "missed" in capsys.readouterr().out
    assert not shipped.exists()
    assert bench.main(["--strict", "--keep"]) == 1
    assert last(shipped, processor())["invented/twice"].ratio == 3.0


# The ratios


@pytest.mark.parametrize(("tolerance", "status"), [(PASSING, "pass"), (FAILING, "fail")])
def test_satellites_of_the_two_tolerances_pass_and_fail(tolerance: float, status: str) -> None:
    """Every body of a chunk has the status that its ratio names."""
    columns = judge(next(chunks(tolerance))).columns
    of_omega = zip(columns["quantity"], columns["verdict"], strict=True)
    assert {verdict for quantity, verdict in of_omega if quantity == "omega"} == {status}


@pytest.mark.parametrize("name", ["euler/with-attitude", "kirchhoff/general-body"])
def test_heyokas_own_call_solves_what_the_driver_solves(name: str) -> None:
    """The yardstick does the same work: its states are the driver's, to roundings."""
    problem = pose(load(name), rung("f64"))
    rows = Postponed(problem, plain(problem)()[5], Fraction)
    for quantity, states in Taylor().solve(problem).quantities.items():
        assert abs(rows[quantity] - states).max() <= 1e-12 * abs(states).max()
