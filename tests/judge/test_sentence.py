"""The sentence of a verdict: the digits that are right, the kind of error that is left, and since when."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable
from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pytest
from builders.integrators import step
from builders.numbers import cross
from builders.trajectories import Columns, columns_at, write_csv
from builders.turns import by_turns
from builders.verdicts import far_off as row

import taylor_verify
from taylor_verify.cli import main
from taylor_verify.judge.diagnosis import diagnosed, is_bounded, is_constant, power_of_time
from taylor_verify.records.error_kind import ErrorKind
from taylor_verify.records.json_text import converted
from taylor_verify.records.quantities import COMPLETE, CONSERVED, INITIAL, STATES
from taylor_verify.records.reason import Cause, stated
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.reading.reader import load
from taylor_verify.words.next_steps import coarser_tolerance

pytestmark = pytest.mark.usefixtures("without_causes")
Captured = pytest.CaptureFixture[str]

SCENE = "euler/generic"
OMEGA = ("w1", "w2", "w3")
TIMES = [Fraction(k) for k in range(101)]
SEED = 20


# Synthetic files, each with one kind of error.


@cache
def motion(times: tuple[Fraction, ...]) -> Columns:
    return columns_at(load(SCENE), times)


def exact(times: Iterable[Fraction] = TIMES) -> Columns:
    """The exact motion at given times, under the time stamps 0, 1, ..., 100."""
    return {**motion(tuple(times)), "t": [float(t) for t in TIMES]}


def changed(change: Callable[[Any, Any], Any]) -> Columns:
    """The exact motion with ``change(omega, t)`` in place of its omega."""
    columns = exact()
    rows = change(np.array([columns[name] for name in OMEGA]).T, np.array(columns["t"])[:, None])
    return {**columns, **{name: rows[:, i].tolist() for i, name in enumerate(OMEGA)}}


def rounded_at_random(omega: Any, t: Any) -> Any:
    return omega * (1 + np.random.default_rng(SEED).uniform(-1, 1, omega.shape) * 2.0**-53)


def noisy(omega: Any, t: Any) -> Any:
    return omega + 1e-7 * np.random.default_rng(SEED).normal(size=omega.shape)


@cache
def runge_kutta_4() -> Columns:
    """The classical Runge-Kutta method with a step of 1/200."""
    inertia = np.array([1.0, 2.0, 3.0])

    def rate(_: float, w: Any) -> Any:
        return -cross(w, inertia * w) / inertia

    w, h, rows = np.array([float(v) for v in load(SCENE).initial.omega]), 1 / 200, []
    for _ in TIMES:
        rows.append(w)
        for _ in range(200):
            w = step(rate, 0.0, w, h)
    return {
        "t": [float(t) for t in TIMES],
        **dict(zip(OMEGA, np.array(rows).T.tolist(), strict=True)),
    }


def printed_with(digits: int) -> Callable[[float], str]:
    return lambda value: f"{value:.{digits}g}"


FILES: dict[str, tuple[Callable[[], Columns], Callable[[float], str], ErrorKind, str]] = {
    "sound": (exact, repr, ErrorKind.ROUNDOFF, "what is left is roundoff"),
    "random rounding": (
        lambda: changed(rounded_at_random), repr, ErrorKind.ROUNDOFF, "what is left is roundoff",
    ),
    "delayed": (
        lambda: exact([t - Fraction(1, 1000) for t in TIMES]),
        repr, ErrorKind.TIME_SHIFT, "the error is a time shift: the answer is late by 0.001, and ",
    ),
    "slow clock": (
        lambda: exact([t * (1 - Fraction(1, 10**6)) for t in TIMES]),
        repr, ErrorKind.PHASE_DRIFT,
        "the error is a drift of phase: the clock runs slow by 1e-06 per unit of time, and ",
    ),
    "RK4": (
        runge_kutta_4, repr, ErrorKind.PHASE_DRIFT,
        "the error is a drift of phase: the clock runs slow by 6.15e-13 per unit of time, and ",
    ),
    "offset": (
        lambda: changed(lambda omega, t: omega + np.array([1e-5, -1e-5, 2e-5])),
        repr, ErrorKind.OFFSET, "the error has one size at all samples",
    ),
    "noise": (lambda: changed(noisy), repr, ErrorKind.BOUNDED, "it hardly grows with time"),
    "loss": (
        lambda: changed(lambda omega, t: omega * (1 - 1e-9 * t)),
        repr, ErrorKind.GROWTH, "it grows in proportion to t",
    ),
    "square of time": (
        lambda: changed(lambda omega, t: omega * (1 - 1e-10 * t**2)),
        repr, ErrorKind.GROWTH, "it grows as t^2",
    ),
    "six digits": (exact, printed_with(6), ErrorKind.PRINTED, "the file's own printed digits"),
    "float32": (
        exact, lambda value: repr(float(np.float32(value))), ErrorKind.SINGLE, "to float32",
    ),
    "degrees": (
        lambda: changed(lambda omega, t: np.degrees(omega)),
        repr, ErrorKind.CONVENTION, "the file has another convention than the scene",
    ),
    "lost": (
        lambda: changed(lambda omega, t: np.where((t == 3) & (omega == omega), np.nan, omega)),
        repr, ErrorKind.NOT_FINITE, "not a finite number, first at t = 3; w1 is nan in row 4, t = 3",
    ),
}  # fmt: skip


def test_a_quaternion_of_length_zero_is_no_attitude(tmp_path: Path) -> None:
    """A file with q0 q1 q2 q3 all 0 has finite numbers: its rows are named, and none is called lost."""
    scene = load("euler/with-attitude")
    columns = dict(columns_at(scene, scene.clock.instants[:4]))
    columns |= {f"q{i}": [*columns[f"q{i}"][:2], 0.0, *columns[f"q{i}"][3:]] for i in range(4)}
    file = write_csv(tmp_path / "mine.csv", columns, repr)
    verdict = taylor_verify.check(scene, file)["attitude"]
    where = f"t = {float(scene.clock.instants[2]):g}"
    assert verdict.sentence.endswith(
        f"no attitude, first at {where}; q0 q1 q2 q3 are 0 in row 3, {where}"
    )
    assert verdict.reason.remarks[0].cause is Cause.NO_ATTITUDE


@cache
def judged(name: str) -> dict[str, Verdict]:
    """The verdicts on a file, by quantity."""
    columns, form, *_ = FILES[name]
    with TemporaryDirectory() as folder:
        file = write_csv(Path(folder) / f"{name}.csv", columns(), form)
        verdicts = taylor_verify.check(SCENE, file).verdicts
    return {verdict.quantity: verdict for verdict in verdicts}


@pytest.mark.parametrize("name", by_turns(FILES, len(FILES), lambda name: FILES[name][2]))
def test_each_file_says_its_kind_and_no_other(name: str) -> None:
    """The kind of the error of omega is that which was made, and the sentence says it in words."""
    _, _, kind, words = FILES[name]
    omega = judged(name)["omega"]
    assert omega.error_kind is kind
    assert words in omega.sentence
    others = {phrase for _, _, other, phrase in FILES.values() if other is not kind}
    assert not any(phrase in omega.sentence for phrase in others)


def test_a_loss_of_energy_is_told_from_a_gain(tmp_path: Path) -> None:
    """T of an omega that shrinks in proportion to t is lost steadily; of one that grows it is gained."""
    lost = judged("loss")["T"]
    assert lost.sentence.startswith("T: 6 digits are kept up to t = 100 (largest error 2e-07); ")
    assert "it grows in proportion to t: a steady loss; larger than f64 rounding" in lost.sentence
    assert lost.change == pytest.approx(-2e-7, rel=0.01)
    assert lost.exponent == pytest.approx(1, abs=0.05)
    file = write_csv(tmp_path / "gain.csv", changed(lambda omega, t: omega * (1 + 1e-9 * t)))
    (gained,) = (v for v in taylor_verify.check(SCENE, file).verdicts if v.quantity == "T")
    assert "a steady gain" in gained.sentence


def test_a_printed_start_is_no_wrong_start() -> None:
    """A first row that is wrong by the digits of the file alone is no wrong start."""
    start = judged("float32")[INITIAL]
    assert start.error_kind is ErrorKind.SINGLE
    assert "is not the scene's initial state" not in start.sentence
    assert "is not the scene's initial state" in judged("offset")[INITIAL].sentence


# Since when.


def test_since_is_the_first_sample_above_its_bound() -> None:
    """Only a failed row has a first sample above its bound; a tolerance replaces what arithmetic leaves."""
    times, attainable = np.arange(5.0) + 7, np.full(5, 1e-3)
    errors = np.array([0.0, 2e-2, 0.0, 3e-2, 1e-2])
    verdict = diagnosed(row(Status.FAIL), times, 7.0, errors, attainable)
    assert (verdict.since, verdict.until) == (8.0, 11.0)
    assert diagnosed(row(Status.PASS), times, 7.0, errors / 9, attainable).since is None
    tolerant = row(Status.FAIL, tolerance=2.5e-2)
    verdict = diagnosed(tolerant, times, 7.0, errors, attainable)
    assert verdict.since == 10.0
    assert "above the tolerance of 0.025 (rounding in f64 explains " in verdict.sentence
    passed = replace(verdict, verdict=Status.PASS, since=None)
    assert "within the tolerance of 0.025" in passed.sentence


def test_a_truth_that_is_too_wide_has_no_digits() -> None:
    """An undecided row says why, and nothing of digits or of the kind of an error."""
    errors, wide = np.array([0.0, 1e-3, 2e-3]), stated(Cause.WIDE_TRUTH, "the truth is wide")
    undecided = row(Status.UNDECIDED, reason=wide)
    verdict = diagnosed(undecided, np.arange(3.0), 0.0, errors, np.ones(3))
    assert (verdict.digits, verdict.error_kind, verdict.exponent) == (None, None, None)
    assert verdict.sentence == "omega: undecided, the truth is wide"


# The course of an error in time.


@pytest.mark.parametrize("power", [0.5, 1.0, 1.5, 2.0, 3.0])
@pytest.mark.parametrize("scale", [1e-300, 1e-12, 1.0])
def test_a_power_of_time_is_read_from_the_errors(power: float, scale: float) -> None:
    """The power is read at any size, through a factor that swings twofold; noise and a jump have none."""
    elapsed = np.linspace(0, 200, 401)
    swing = 1 + np.abs(np.sin(3.3 * elapsed))
    fitted = power_of_time(elapsed, scale * swing * elapsed**power)
    assert fitted == pytest.approx(power, abs=0.1)
    # A number of Python: those of NumPy cannot be stored between processes.
    assert type(fitted) is float
    assert not is_bounded(elapsed, scale * swing * elapsed**power)
    assert power_of_time(elapsed, scale * swing) is None
    assert power_of_time(elapsed, scale * np.where(elapsed < 100, 1.0, 1e4)) is None


def test_few_samples_show_no_course() -> None:
    """Three rows are no power of time, no constant and no bound."""
    elapsed, errors = np.array([0.0, 1.0, 2.0]), np.array([1.0, 1.0, 1.0])
    assert power_of_time(elapsed, elapsed) is None
    assert not is_constant(errors)
    assert not is_bounded(elapsed, errors)
    assert power_of_time(np.zeros(3), errors) is None


# The words.


@pytest.mark.parametrize("status", Status)
@pytest.mark.parametrize("quantity", [INITIAL, COMPLETE, *STATES, *CONSERVED])
def test_every_quantity_of_every_status_has_a_sentence(quantity: str, status: Status) -> None:
    """Every kind of error, compared or not, with numbers and without, is told without a hole."""
    kinds = [None, *ErrorKind]
    rows = [row(status, quantity=quantity, error_kind=kind) for kind in kinds]
    rows += [replace(v, max=None, bound=None, ratio=None) for v in rows]
    rows += [replace(v, since=2.0, until=9.0, exponent=1.0, change=-3e-12) for v in rows]
    rows += [replace(v, reason=stated(Cause.NOT_POSED, "")) for v in rows]
    rows += [
        row(status, quantity=quantity, max=None, at=None, reason=stated(Cause.NOT_POSED, "why"))
    ]
    for verdict in rows:
        text = verdict.sentence
        assert text.startswith(f"{quantity}: ")
        assert text.removeprefix(f"{quantity}: ").strip()
        assert not re.search(r"None|\bnan\b|; ;|;$|  ", text)


@pytest.mark.parametrize(
    ("size", "digits", "words"),
    [
        (3.3e-12, 11, "11 digits are right (largest error 3.3e-12)"),
        (0.03, 1, "1 digit is right (largest error 0.03)"),
        (0.3, 0, "no digit is right at t = 7 (error 0.3)"),
        (55.0, 0, "no digit is right at t = 7 (error 55)"),
        (1e-30, 15, "15 digits are right (largest error 1e-30)"),
        (0.0, 15, "exact"),
        (float("nan"), None, "not a finite number"),
        (float("inf"), None, "not a finite number"),
    ],
)
def test_digits_are_counted_down_to_none(size: float, digits: int | None, words: str) -> None:
    """Never more than the rung has, never less than none; what is not finite has no count."""
    verdict = row(Status.FAIL, max=size, reason=stated(Cause.NOT_POSED, ""))
    assert verdict.digits == digits
    assert verdict.sentence.startswith(f"omega: {words};")


def test_the_row_of_a_verdict_has_its_sentence() -> None:
    """JSON holds what the sentence is made of, and the sentence; a row is read back without loss."""
    verdict = row(Status.FAIL, since=1.0, until=9.0, error_kind=ErrorKind.GROWTH, exponent=1.02)
    written = json.loads(json.dumps(verdict.row()))
    assert (written["digits"], written["since"], written["error_kind"]) == (11, 1.0, "growth")
    assert written["sentence"] == verdict.sentence
    assert converted(written, Verdict) == verdict


def test_a_coarser_tolerance_is_named_only_for_accuracy() -> None:
    """A power of ten that all failed rows are within; never to hide a convention or a wrong start."""
    drift = row(Status.FAIL, error_kind=ErrorKind.PHASE_DRIFT)
    assert coarser_tolerance([drift, row()]) == pytest.approx(1e-11)
    assert coarser_tolerance([row()]) is None
    for kind in (None, ErrorKind.CONVENTION, ErrorKind.TIME_SHIFT, ErrorKind.OFFSET):
        assert coarser_tolerance([drift, replace(drift, error_kind=kind)]) is None
    assert coarser_tolerance([replace(drift, max=0.5)]) is None


# The commands.


def sentences_of(text: str) -> list[str]:
    return [line for line in text.splitlines() if re.match(r"(initial state|omega|T|H2): ", line)]


@pytest.mark.parametrize("verb", by_turns(["check", "run"], 2))
def test_the_answer_comes_first_and_the_arithmetic_on_request(
    verb: str, tmp_path: Path, capsys: Captured
) -> None:
    """A sentence for every quantity, then the numbers, the counts and the next step."""
    file = write_csv(tmp_path / "rk4.csv", runge_kutta_4())
    solver = ["--solver", "geometric:implicit-midpoint?step=0.01"]
    call = ["check", file, "--scene", SCENE] if verb == "check" else ["run", SCENE, *solver]
    assert main(call) == 1
    plain = capsys.readouterr().out
    assert len(sentences_of(plain)) == 4
    assert plain.index("the error is a drift of phase") < plain.index("verdict")
    assert "attainable" not in plain
    assert "(exit status 1)" in plain
    assert "--tolerance 1e-" in plain
    assert "--explain shows" in plain
    assert main([*call, "--explain"]) == 1
    explained = capsys.readouterr().out
    assert sentences_of(explained)[:4] == sentences_of(plain)
    assert "omega allowed: " in explained
    assert "attainable = u sqrt(N) x growth" in explained
    assert "--explain" not in explained
