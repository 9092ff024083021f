"""Rows of a file on the start and on instants of held states, however their times are written."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from pathlib import Path

import pytest
from builders.trajectories import write_csv
from builders.turns import by_turns
from hypothesis import assume, given
from hypothesis import strategies as st

from taylor_verify import check
from taylor_verify.cli import main
from taylor_verify.judge.files.meant_times import meant_times
from taylor_verify.numbers.precision import floor_log2, rung
from taylor_verify.scenes.reading.reader import read
from taylor_verify.scenes.scene import Scene

pytestmark = pytest.mark.usefixtures("without_causes")
COUNTER = """
title = "A body that a counter spins up"
model = "euler"
track = ["k"]
[body]
inertia = [1, 1, 1]
moment = ["k/100", 0, 0]
[states]
k = {{ every = "{every}", start = 0, value = "k + 1" }}
[initial]
omega = [0, 0, 1]
[time]
start = "{start}"
end = "{end}"
samples = {samples}
"""
TENTH = Fraction(1, 10)


def counter(start: Fraction, every: Fraction = TENTH, count: int = 31) -> Scene:
    """A scene whose samples are its instants: k counts those that are over, and turns w1."""
    end = start + (count - 1) * every
    text = COUNTER.format(start=start, every=every, end=end, samples=count)
    return read(text, "counter")


def written(path: Path, times: list[str]) -> str:
    """Rows on all instants, each read after it: w1' = k/100 with k = 1, 2, 3, ... for a tenth each."""
    w1 = [float(Fraction(n * (n + 1), 2000)) for n in range(len(times))]
    counts = range(1, len(times) + 1)
    columns = {"t": times, "w1": [*map(repr, w1)], "k": [*map(str, counts)]}
    still = {"w2": ["0"] * len(times), "w3": ["1"] * len(times)}
    return write_csv(path, columns | still, str)


def nearest(start: Fraction, n: int) -> str:
    return repr(float(start + n * TENTH))


def summed(start: Fraction, n: int) -> str:
    return repr(float(start) + float(n * TENTH))


@pytest.mark.parametrize(
    ("start", "form"),
    by_turns(
        (start, form)
        for start in ("-1", "1/3", "1/10", "0", "1000000", "-1/7")
        for form in (nearest, summed)
    ),
)
def test_rows_on_instants_are_read_after_them_at_any_start(
    start: str, form: Callable[[Fraction, int], str], tmp_path: Path
) -> None:
    """-1 + 8/10 is no sum of doubles; a text, the nearest double and the sum all mean the instant."""
    begin = Fraction(start)
    times = [form(begin, n) for n in range(31)]
    judged = check(counter(begin), written(tmp_path / "run.csv", times))
    assert judged.passed, str(judged)
    assert judged["k"].max == 0


@pytest.mark.parametrize("start", by_turns(["-1", "1/3", "0"], 2))
def test_the_last_instant_counts_if_the_last_row_is_on_it(start: str, tmp_path: Path) -> None:
    """0.3 is a little less than the double nearest to it is; both are the end of three tenths."""
    begin = Fraction(start)
    times = [nearest(begin, n) for n in range(4)]
    judged = check(counter(begin, count=4), written(tmp_path / "run.csv", times))
    assert judged.passed, str(judged)


@given(
    start=st.fractions(-1000, 1000, max_denominator=1000),
    every=st.fractions(Fraction(1, 1000), 10, max_denominator=1000),
    n=st.integers(0, 40),
    name=st.sampled_from(["f32", "f64", "mp100"]),
)
def test_a_row_one_step_before_an_instant_is_before_it(
    start: Fraction, every: Fraction, n: int, name: str
) -> None:
    """Text, nearest number and sum of rounded numbers are the instant in the truth; a step less is not."""
    on = rung(name)
    exactly = start + n * every
    read_as = on.round(exactly)
    assume(read_as and every > 64 * on.unit_roundoff * (abs(start) + n * every + 1))
    scene = counter(start, every, n + 2)
    total = on.round(on.round(start) + on.round(n * every))
    other = on.round(start + on.round(n * every))
    instant = start + on.round(n * every)
    last = start + (n + 1) * every
    rows = (exactly, read_as, total, other)
    assert set(meant_times((*rows, last), scene, on)[:-1]) == {instant}
    step = Fraction(2) ** (floor_log2(read_as) - on.bits + 1)
    before = read_as - step
    assume(before not in (total, other))
    meant, _ = meant_times((before, last), scene, on)
    assert meant < instant
    assert instant - meant <= abs(exactly - before) + abs(exactly - instant)


def test_a_row_at_the_rounded_start_is_the_start(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A single row at the start is no trajectory, which `complete` says, and is compared with the start."""
    scene, file = tmp_path / "scene.toml", tmp_path / "run.csv"
    third = Fraction(1, 3)
    end = third + 3
    scene.write_text(COUNTER.format(start=third, every=TENTH, end=end, samples=31))
    written(file, [nearest(third, 0)])
    assert main(["check", str(file), "--scene", str(scene)]) == 3
    text = " ".join(capsys.readouterr().out.split())
    assert "complete: not judged" in text
    assert "--partial" in text
    assert "question" in text
    assert "--csv" in text
    assert main(["check", str(file), "--scene", str(scene), "--partial"]) == 0


def test_the_printed_times_are_those_of_the_scene_rounded_once(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The double nearest to -1 + 7/10 is -0.3, and no sum of doubles."""
    scene = tmp_path / "scene.toml"
    scene.write_text(COUNTER.format(start=-1, every=TENTH, end=2, samples=31))
    assert main(["question", str(scene), "--csv"]) == 0
    _, *rows = capsys.readouterr().out.split()
    assert [row.partition(",")[0] for row in rows][6:9] == ["-0.4", "-0.3", "-0.2"]
