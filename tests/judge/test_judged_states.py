"""Answers with states of a scene's own: right ones pass, and each fault fails the gate that names it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from builders.integrators import step
from builders.scenes import read_scene, scene_text
from builders.trajectories import QUATERNION, VECTORS, write_csv
from builders.turns import by_turns
from builders.written_loads import End, Evaluated, end_of
from hypothesis import assume, given
from hypothesis import strategies as st
from mpmath import mp, mpf

from taylor_verify import check, explain, solve
from taylor_verify.cli import main
from taylor_verify.exact.conditioning.condition import transition
from taylor_verify.exact.conditioning.path_times import times_of_run
from taylor_verify.exact.route import solution
from taylor_verify.judge.files.meant_times import meant_times
from taylor_verify.judge.tolerances import tolerances
from taylor_verify.numbers.precision import floor_log2, rung
from taylor_verify.records.status import Status
from taylor_verify.scenes.motion import Clock
from taylor_verify.scenes.reading.reader import read
from taylor_verify.scenes.scene import Scene

pytestmark = pytest.mark.usefixtures("without_causes")
OMEGA = VECTORS["omega"]
SAMPLED = 'moment = ["m1 - i1/16", "m2", "-w3/8"]'
INTEGRAL = 'i = { start = [0, 0], rate = ["q1 - i1/64", "q2 - i2/64"] }'
LAW = '["-0.75*q1 - w1/2", "clip(-0.75*q2 - w2/2, -0.125, 0.125)"]'
TOLERANCE = 1e-6
# Each on an instant of a value that is taken every quarter, and on one of those every half.
ROWS = tuple(Fraction(k, 2) for k in range(3))


def satellite(states: str, body: str = SAMPLED, track: Sequence[str] = ("m", "i")) -> Scene:
    """The satellite with rows at ROWS."""
    scene = read_scene(
        f"inertia = [1.25, 0.875, 1.5]\n{body}",
        "omega = [0.25, -0.5, 0.375]\nattitude = [0.5, 0.625, -0.375, 0.5]",
        f"[states]\n{states}",
        top=f"track = {['attitude', *track]}",
    )
    return replace(scene, clock=Clock(Fraction(0), ROWS))


def states(every: str, value: str = LAW, more: str = "") -> str:
    return f'm = {{ every = "{every}", start = [0, 0], value = {value} }}\n{INTEGRAL}\n{more}'


RIGHT = satellite(states("1/4"))
LATE = states("1/4", '["l1", "l2"]', f'l = {{ every = "1/4", start = [0, 0], value = {LAW} }}')
# By the fault: the scene that the faulty program follows, what fails, and what passes all the same.
TWINS: Mapping[str, tuple[Scene, set[str], set[str]]] = {
    "sampled at another rate": (
        satellite(states("1/8")), {"omega", "attitude", "m", "i", "T", "H_space"}, {"m law"},
    ),
    "one sample late": (satellite(LATE), {"omega", "m", "i", "m law"}, set()),
    "another law": (
        satellite(states("1/4", LAW.replace("w1/2", "w1/3"))), {"omega", "m", "m law"}, set(),
    ),
    "an integral that does not leak": (
        satellite(states("1/4").replace(" - i1/64", "")), {"omega", "i"}, {"m law"},
    ),
}  # fmt: skip


SPUN_UP = 'h = { start = [0, 0, 0], rate = ["q1/2 + w1/4", "q2/2 + w2/4", "q3/2 + w3/4"] }'
WHEELS = satellite(SPUN_UP, 'rotor = ["h1", "h2", "h3"]', ("h",))
# The gyroscopic term of the wheels, without the reaction of their motors.
UNMOVED = satellite(SPUN_UP, 'moment = ["h2*w3 - h3*w2", "h3*w1 - h1*w3", "h1*w2 - h2*w1"]', ("h",))


def written(path: Path, scene: Scene, ends: Sequence[End], names: Sequence[str]) -> Path:
    """A file of these states, with the columns of some of the scene's own states."""
    columns = {s.name: s.components for s in scene.body.loads.states}
    header = ["t", *OMEGA, *QUATERNION, *(column for name in names for column in columns[name])]
    rows = [
        map(float, (time, *end.state[:7], *(v for name in names for v in end.own[name])))
        for time, end in zip(ROWS, ends, strict=True)
    ]
    return Path(write_csv(path, dict(zip(header, zip(*rows, strict=True), strict=True))))


@pytest.mark.parametrize("form", by_turns([repr, "{:.17g}".format]), ids=["shortest", "17 digits"])
def test_a_row_on_an_instant_is_one_however_its_time_is_written(
    form: Callable[[float], str], tmp_path: Path
) -> None:
    """0.1 in a text is a little earlier than the double at which a value was taken, and means it."""
    tenths = tuple(Fraction(k, 10) for k in range(8))
    scene = replace(satellite(states("1/10")), clock=Clock(Fraction(0), tenths))
    answer = solve(scene)
    rows = np.hstack([answer[name] for name in ("omega", "quaternion", "m", "i")]).astype(float)
    names = (*OMEGA, *QUATERNION, "m1", "m2", "i1", "i2")
    columns = {
        name: [*map(repr, column)] for name, column in zip(names, rows.T.tolist(), strict=True)
    }
    times = {"t": [form(float(t)) for t in tenths]}
    judgement = check(scene, write_csv(tmp_path / "run.csv", times | columns, str))
    assert judgement.passed, str(judgement)


@cache
def answers(scene: Scene) -> list[End]:
    """The states at ROWS, by an integrator that reads the texts by itself."""
    with mp.workdps(40):
        return [end_of(scene, time, 18, 2, columns=10) for time in ROWS]


def judged(tmp_path: Path, scene: Scene, names: Sequence[str] = ("m", "i"), **options: Any) -> Any:
    """The judgement of a file that follows a scene, by the right one."""
    return check(RIGHT, written(tmp_path / "run.csv", scene, answers(scene), names), **options)


def test_a_right_file_passes_by_the_arithmetic_alone(tmp_path: Path) -> None:
    """States, own states, energy and the law of the held one, all to the rounding of the file."""
    answer = judged(tmp_path, RIGHT, partial=True)
    assert answer.passed, str(answer)
    names = {v.quantity for v in answer.verdicts}
    assert {"initial state", "omega", "attitude", "m", "i", "m law", "T", "H2", "H_space"} <= names
    assert all((v.bound or 1.0) < 1e-13 for v in answer.verdicts if v.is_compared)


@pytest.mark.parametrize("twin", by_turns([*TWINS]))
def test_a_fault_of_a_controller_fails_the_gate_that_names_it(twin: str, tmp_path: Path) -> None:
    """A wrong rate, a late sample and a wrong law differ in which of the rows they fail."""
    scene, failing, passing = TWINS[twin]
    answer = judged(tmp_path, scene, partial=True, tolerance=TOLERANCE)
    failed = {v.quantity for v in answer.verdicts if v.verdict is Status.FAIL}
    passed = {v.quantity for v in answer.verdicts if v.verdict is Status.PASS}
    assert failing <= failed
    assert passing <= passed


def test_the_momentum_of_body_and_wheels_is_conserved(tmp_path: Path) -> None:
    """H = I omega + h stays as it is in space; a program that forgets the reaction of a motor fails it."""
    right, wrong = (
        check(WHEELS, written(tmp_path / "run.csv", scene, answers(scene), ("h",)), partial=True)
        for scene in (WHEELS, UNMOVED)
    )
    assert right.passed, str(right)
    of_right, of_wrong = ({v.quantity: v for v in each.verdicts} for each in (right, wrong))
    for name in ("H2", "H_space"):
        assert "polynomial zero" in str(of_right[name].reason)
        assert of_wrong[name].verdict is Status.FAIL


def by_steps(scene: Scene, steps: int) -> list[End]:
    """The states at ROWS by the classical Runge-Kutta method; values are taken where a step ends."""
    with mp.workdps(17):
        equations, ends, h = Evaluated(scene), list[End](), mpf(1) / steps
        y, due = equations.start(), 0
        for k in range(steps + 1):
            while Fraction(due, 4) <= Fraction(k, steps):
                equations.take(k * h, Fraction(due, 4), y)
                due += 1
            if Fraction(k, steps) in ROWS:
                ends.append(End(list(y), mpf(0), False, equations.own(y)))
            y = step(equations.rates, k * h, y, h)
        return ends


@pytest.mark.parametrize(("counts", "order"), [((10, 18, 26), 1), ((8, 12, 16), 4)])
def test_steps_over_the_instants_are_of_order_one(
    counts: Sequence[int], order: int, tmp_path: Path
) -> None:
    """Steps that end at every instant have their own order; others have 1, and the judge says why."""
    files = [
        written(tmp_path / f"run_{n}.csv", RIGHT, by_steps(RIGHT, n), ("m", "i")) for n in counts
    ]
    answer = check(RIGHT, files, partial=True, steps=[1 / n for n in counts])
    (attitude,) = (each for each in answer.order if each.quantity == "attitude")
    assert attitude.order == pytest.approx(order, abs=0.5)
    over = [note for note in answer.notes if "steps end at the instants of held states" in note]
    assert bool(over) is (order == 1)


def test_a_law_has_a_tolerance_of_its_own() -> None:
    """The quantities of a scene, for which a caller may ask a tolerance, name states and laws."""
    asked = tolerances({"m law": 1e-3, "i": 1e-4, "omega": 1e-5}, [RIGHT])
    assert asked.of("m law") == 1e-3
    with pytest.raises(
        ValueError, match=r"expected some of omega, attitude, i, m, m law, .*got i law"
    ):
        tolerances({"i law": 1e-3}, [RIGHT])


def test_a_state_that_the_file_lacks_is_said(tmp_path: Path) -> None:
    """A tracked own state without its columns makes the answer incomplete."""
    answer = judged(tmp_path, RIGHT, ["i"])
    assert not answer.passed
    assert any("state m is not judged: the file has no m1 m2" in note for note in answer.remarks)
    assert {"m", "m law"}.isdisjoint(v.quantity for v in answer.verdicts)


@pytest.mark.slow
def test_an_untracked_state_is_computed_and_not_gated(tmp_path: Path) -> None:
    """The same motion without tracked own states passes without their columns."""
    scene = replace(RIGHT, states=frozenset())
    file = written(tmp_path / "run.csv", RIGHT, answers(RIGHT), [])
    answer = check(scene, file, partial=True)
    assert answer.passed, str(answer)
    assert {v.quantity for v in answer.verdicts}.isdisjoint(("m", "i", "m law"))


def test_the_derivative_goes_through_instants() -> None:
    """An error of an own state at the start becomes what a motion from another start has."""
    small, end = Fraction(1, 10**9), ROWS[-1]
    path = transition(RIGHT, [Fraction(0), end])
    with mp.workdps(40):
        here = solution(RIGHT).motion([end], 30)
        for k in range(2):
            start = ", ".join(str(float(small)) if j == k else "0" for j in range(2))
            other = satellite(
                states("1/4").replace("i = { start = [0, 0]", f"i = {{ start = [{start}]")
            )
            there = solution(other).motion([end], 30)
            unit = float(path.units["i"])
            column = path.carried.steps[0][:, path.places[path.span("i")][k]] / unit
            for name in ("m", "i"):
                apart = (there[name][0] - here[name][0]) / mp.convert(small)
                rows = column[path.places[path.span(name)]] * float(path.units[name])
                assert np.allclose(apart.astype(float), rows, rtol=1e-6, atol=1e-9)


def test_a_run_meets_every_instant() -> None:
    """The times of a run are samples, instants and times between, from the start on."""
    times = times_of_run(RIGHT)
    assert times[0] == 0
    assert {*ROWS, Fraction(1, 4), Fraction(3, 4)} <= set(times)
    assert times == sorted(times)


def test_own_states_are_explained() -> None:
    """The terms that read own states have their work, and nothing is found to be conserved."""
    document = explain(RIGHT)
    assert document["track"] == ["attitude", "i", "m", "omega"]
    texts = [term["text"] for term in document["loads"]["terms"]]
    assert texts == ["m1", "-i1/16", "m2", "-w3/8"]
    assert document["loads"]["terms"][-1]["work"] < 0


# Rows of a file on the start and on instants of held states, however their times are written.


TENTH = Fraction(1, 10)


def counting(start: Fraction | int, every: Fraction = TENTH, count: int = 31) -> str:
    """A scene whose samples are its instants: k counts those that are over, and turns w1."""
    return scene_text(
        'inertia = [1, 1, 1]\nmoment = ["k/100", 0, 0]',
        "omega = [0, 0, 1]",
        f'[states]\nk = {{ every = "{every}", start = 0, value = "k + 1" }}',
        f'start = "{start}"\nend = "{start + (count - 1) * every}"\nsamples = {count}',
        'track = ["k"]',
    )


def counter(*given: Any, **more: Any) -> Scene:
    return read(counting(*given, **more), "counter")


def write_counts(path: Path, times: list[str]) -> str:
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
    judged = check(counter(begin), write_counts(tmp_path / "run.csv", times))
    assert judged.passed, str(judged)
    assert judged["k"].max == 0


@pytest.mark.parametrize("start", by_turns(["-1", "1/3", "0"], 2))
def test_the_last_instant_counts_if_the_last_row_is_on_it(start: str, tmp_path: Path) -> None:
    """0.3 is a little less than the double nearest to it is; both are the end of three tenths."""
    begin = Fraction(start)
    times = [nearest(begin, n) for n in range(4)]
    judged = check(counter(begin, count=4), write_counts(tmp_path / "run.csv", times))
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
    scene.write_text(counting(third))
    write_counts(file, [nearest(third, 0)])
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
    scene.write_text(counting(-1))
    assert main(["question", str(scene), "--csv"]) == 0
    _, *rows = capsys.readouterr().out.split()
    assert [row.partition(",")[0] for row in rows][6:9] == ["-0.4", "-0.3", "-0.2"]
