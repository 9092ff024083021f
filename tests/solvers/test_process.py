"""The process protocol: what a program is asked, what its answer is worth, and how it may fail."""

from __future__ import annotations

import json
import math
import re
import shlex
import sys
import time
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from builders.scenes import three_instants
from builders.turns import by_turns
from hypothesis import given
from hypothesis import strategies as st

from taylor_verify.models.problem import Problem, pose
from taylor_verify.numbers import tensors
from taylor_verify.numbers.precision import rung
from taylor_verify.records.status import Status
from taylor_verify.run import run
from taylor_verify.scenes.reading.reader import load
from taylor_verify.solvers.process import protocol
from taylor_verify.solvers.process.exact_text import exact_text
from taylor_verify.solvers.process.process import DEFAULT_LIMIT, LIMIT_VARIABLE, Process, named
from taylor_verify.solvers.trajectory import Outcome, Trajectory

OUTSIDE = Path(protocol.__file__).parents[1] / "outside"
SCENES = [
    "euler/generic",
    "euler/full-tensor",
    "euler/constant-moment",
    "euler/with-attitude",
    "euler/later-start",
    "kirchhoff/whole-motion",
    "kirchhoff/general-body",
    "kirchhoff/constant-loads",
    "euler/damped",
    "kirchhoff/damped",
]
# Those that one rounding made, so that text and hex are the same number.
ROUNDED_ONCE = {
    *("inverse_inertia", "moment", "angular_momentum", "attitude", "elapsed", "damping"),
    *("linear", "coupling", "angular", "force", "couple"),
    *("linear_impulse", "angular_impulse", "centre"),
}
ALSO_ROUNDED = {"inertia", "omega", "start", "times"}


# The question.


def numbers(document: dict[str, Any]) -> Iterator[tuple[str, list[Any], list[Any]]]:
    """Every number of a question: its key, its texts and its hexadecimal floats, flat."""
    for table in ("body", "initial", "time"):
        for key, value in document.get(table, {}).items():
            yield key, list(flat(value["text"])), list(flat(value["hex"]))


def flat(value: Any) -> Iterator[str]:
    if isinstance(value, str):
        yield value
    else:
        for entry in value:
            yield from flat(entry)


@pytest.mark.parametrize("on", ["f32", "f64", "mp237"])
@pytest.mark.parametrize("scene", SCENES)
def test_text_is_exact_and_hex_is_the_nearest_of_the_rung(scene: str, on: str) -> None:
    """hex is the text rounded to the rung's bits, and the same number where it was rounded once."""
    document = protocol.question(pose(load(scene), rung(on)))
    met = set()
    for key, texts, hexes in numbers(document):
        met.add(key)
        for text, hexadecimal in zip(texts, hexes, strict=True):
            exact, nearest = Fraction(text), from_hex(hexadecimal)
            assert abs(nearest - exact) <= rung(on).unit_roundoff * abs(exact)
            assert nearest.numerator.bit_length() <= rung(on).bits or nearest.denominator == 1
            assert key not in ROUNDED_ONCE or nearest == exact
    assert met <= ROUNDED_ONCE | ALSO_ROUNDED


def from_hex(text: str) -> Fraction:
    """Another reader of what C reads: sign, integer and power of two."""
    match = re.fullmatch(r"(-?)0x([0-9a-f]+)p([+-]\d+)", text)
    assert match
    return (-1 if match[1] else 1) * int(match[2], 16) * Fraction(2) ** int(match[3])


def test_the_tensor_and_its_inverse_are_one_body() -> None:
    """I K = 1 and omega = K H hold exactly between the texts, on a rung that had to round K."""
    document = protocol.question(pose(load("euler/full-tensor"), rung("f32")))
    body, initial = document["body"], document["initial"]
    identity = tensors.diagonal((Fraction(1),) * 3)
    K = matrix(body["inverse_inertia"]["text"])
    assert tensors.product(matrix(body["inertia"]["text"]), K) == identity
    momentum = tuple(map(Fraction, initial["angular_momentum"]["text"]))
    assert tensors.apply(K, momentum) == tuple(map(Fraction, initial["omega"]["text"]))


def matrix(rows: list[list[str]]) -> tuple[tuple[Fraction, ...], ...]:
    return tuple(tuple(map(Fraction, row)) for row in rows)


@given(st.fractions() | st.floats(allow_nan=False, allow_infinity=False).map(Fraction))
def test_an_exact_text_is_exact(value: Fraction) -> None:
    """The text of a rational reads back as the same rational, a decimal wherever one is finite."""
    text = exact_text(value)
    assert Fraction(text) == value
    assert ("/" in text) == (10**1100 % value.denominator != 0)


# The answer.


def answer(of: Problem, **changes: Any) -> bytes:
    """A sound answer in form, changed: the states are those of the start throughout."""
    omega = of.given.initial.omega  # type: ignore[union-attr]
    sound: dict[str, Any] = {"t": [float(t) for t in of.given.clock.instants]}
    for i, name in enumerate(("w1", "w2", "w3")):
        sound[name] = [float(omega[i]).hex()] * len(of.times)
    return json.dumps({**sound, **changes}).encode()


@pytest.mark.parametrize(
    ("on", "written", "exact"),
    [
        ("f64", "0.1", Fraction(0.1)),
        ("f32", "0.1", Fraction(0.1)),
        ("f80", "0.1", Fraction(1, 10)),
        ("f64", '"0.1"', Fraction(1, 10)),
        ("f64", '"1/3"', Fraction(1, 3)),
        ("f64", '"0x1.8p-3"', Fraction(3, 16)),
        ("f64", '"-0X.8P1"', Fraction(-1)),
        ("f64", '"0x18"', Fraction(24)),
        ("f64", "7", Fraction(7)),
        ("f64", "9007199254740993", Fraction(2**53)),
        ("mp237", "9007199254740993", Fraction(2**53 + 1)),
    ],
)
def test_a_number_is_taken_as_its_form_says(on: str, written: str, exact: Fraction) -> None:
    """A number in quotes is exact; a bare one is a double on f32 and f64, and exact on wider rungs."""
    asked = three_instants(on)
    text = answer(asked, w2=[0, 0, "HERE"]).replace(b'"HERE"', written.encode())
    assert protocol.read(text, asked).states[2][1] == exact


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_hexadecimal_and_shortest_decimal_of_a_double_are_the_double(value: float) -> None:
    """The double that a program held is judged, whether it prints %a or a decimal that is enough."""
    asked = three_instants()
    response = protocol.read(answer(asked, w1=[value.hex()] * 3, w3=[value] * 3), asked)
    assert response.states[0][0] == response.states[0][2] == value


MISANSWERS = [
    (b"", "got nothing"),
    (b"the end\n", "no JSON at line 1, column 1"),
    (b"[1, 2]", "got a list"),
    (b'{"t": [0, 1, 2', "where the answer ends"),
    (b'{"t": [0], "t": [0]}', "'t' twice"),
    (b"\xff\xfe{}", "expected one JSON object"),
    (b"[" * 100_000, "expected one JSON object"),
    (b'{"t": [0, 1, 2]}', "got no w1, w2, w3"),
    ({"w2": 0.5}, "expected a list of 3 numbers @ w2"),
    ({"t": [0, 1]}, "expected 3 rows, got 2, the last at t = 1 @ t"),
    ({"w3": [0, 0]}, "expected 3 rows, got 2 @ w3"),
    ({"w3": [0, 0, 0, 0]}, "expected 3 rows, got 4 @ w3"),
    ({"t": [0, 1, 1.9999999]}, "expected t = 2.0"),
    ({"t": [0, 2, 1]}, "@ t[1]"),
    ({"w1": [0, "fast", 0]}, "@ w1[1]"),
    ({"w1": [0, True, 0]}, "expected a number, got true @ w1[1]"),
    ({"w1": [0, [0], 0]}, "@ w1[1]"),
    ({"w1": [0, "1e999999999", 0]}, "@ w1[1]"),
    ({"w1": [0, "0x1p999999999", 0]}, "@ w1[1]"),
    ({"w1": [0, "0x", 0]}, "@ w1[1]"),
    ({"steps": -1}, "@ steps"),
    ({"steps": "many"}, "@ steps"),
    ({"evaluations": 1.5}, "@ evaluations"),
    ({"seconds": -0.5}, "@ seconds"),
    ({"seconds": "soon"}, "@ seconds"),
    ({"seconds": True}, "@ seconds"),
    ({"seconds": None}, "@ seconds"),
    ({"seconds": math.nan}, "@ seconds"),
    ({"seconds": 1e300}, "@ seconds"),
    ({"seconds": 0, "compile_seconds": -1}, "@ compile_seconds"),
    ({"compile_seconds": 1}, "expected seconds beside compile_seconds"),
    ({"remark": 1}, "expected a sentence, got 1 @ remark"),
    (b'{"unsuited": " "}', "expected a sentence that says why @ unsuited"),
]


@pytest.mark.parametrize(("given_back", "words"), MISANSWERS, ids=range(len(MISANSWERS)))
def test_a_wrong_answer_is_told_with_its_place(given_back: Any, words: str) -> None:
    """Whatever is not the answer asked for is refused, in words that say what and where."""
    asked = three_instants()
    text = answer(asked, **given_back) if isinstance(given_back, dict) else given_back
    with pytest.raises(protocol.Misanswer, match=re.escape(words)):
        protocol.read(text, asked)


@pytest.mark.parametrize("value", [math.nan, math.inf, None, "nan", "-Infinity", 10**400])
def test_what_is_not_finite_is_told_with_its_place(value: Any) -> None:
    """NaN, an infinity, null and what overflows a double are not finite, in every spelling."""
    asked = three_instants()
    with pytest.raises(protocol.NotFinite, match=re.escape("@ w2[1]")):
        protocol.read(answer(asked, w2=[0, value, 0]), asked)


def test_times_may_have_been_rounded_and_no_more() -> None:
    """t = start + k dt in doubles is the time asked for, and one part in 10^12 off is not."""
    asked = pose(load("euler/later-start"), rung("f64"))
    instants = [float(t) for t in asked.given.clock.instants]
    dt = (instants[-1] - instants[0]) / (len(instants) - 1)
    formed = [instants[0] + k * dt for k in range(len(instants))]
    assert formed != instants
    assert len(protocol.read(answer(asked, t=formed), asked).states) == len(instants)
    off = [t * (1 + 1e-12) for t in instants]
    with pytest.raises(protocol.Misanswer, match="roundings of f64"):
        protocol.read(answer(asked, t=off), asked)


# Programs. Each reads the question as `scene` and has a sound answer at hand as `found`.

SOUND = """\
import json, os, signal, subprocess, sys, time
scene = json.load(sys.stdin)
found = {"t": scene["time"]["times"]["hex"]}
for i, name in enumerate(("w1", "w2", "w3")):
    found[name] = [scene["initial"]["omega"]["hex"][i]] * len(found["t"])
"""
TELL = "json.dump(found, sys.stdout)\n"


def program(folder: Path, text: str) -> str:
    """The name of the solver that is this Python program."""
    file = folder / "a program.py"
    file.write_text(text)
    # Without site: it starts in half the time.
    return f"process:{shlex.join([sys.executable, '-S', str(file)])}"


def solve(folder: Path, text: str, limit: float = 60, samples: int = 3) -> Trajectory:
    return Process(program(folder, text), time_limit=limit).solve(three_instants(samples=samples))


def test_a_sound_program_is_heard(tmp_path: Path) -> None:
    """A program that answers is judged by its numbers, whatever it says on stderr."""
    program = f"{SOUND}print('working', file=sys.stderr)\nfound['steps'] = 7\n{TELL}"
    trajectory = solve(tmp_path, program)
    assert trajectory.outcome is Outcome.FINISHED
    assert (trajectory.steps, trajectory.detail) == (7, "")
    assert [float(v) for v in trajectory.quantities["omega"][2]] == [
        float(v)
        for v in three_instants().given.initial.omega  # type: ignore[union-attr]
    ]


def test_a_program_may_time_itself(tmp_path: Path) -> None:
    """The times of a trajectory are the seconds and compile_seconds that the program states."""
    program = f"{SOUND}found.update(seconds=2e-3, compile_seconds=1e-3)\n{TELL}"
    trajectory = solve(tmp_path, f"import time; time.sleep(3e-3)\n{program}")
    assert trajectory.outcome is Outcome.FINISHED
    assert (trajectory.seconds, trajectory.compile_seconds) == (2e-3, 1e-3)


def test_a_remark_of_a_program_is_the_detail_of_its_trajectory(tmp_path: Path) -> None:
    """A sentence on how an answer was had stays with it, without what is not for a terminal."""
    trajectory = solve(tmp_path, f"{SOUND}found.update(remark='in principal\\x1b axes'); {TELL}")
    assert (trajectory.outcome, trajectory.detail) == (Outcome.FINISHED, "in principal  axes")


def test_a_program_that_does_not_time_itself_is_timed_as_a_whole(tmp_path: Path) -> None:
    """Without seconds in the answer, they are those of the run, the start of the program included."""
    trajectory = solve(tmp_path, f"import time; time.sleep(0.2)\n{SOUND}{TELL}")
    assert trajectory.seconds >= 0.2
    assert trajectory.compile_seconds == 0


FAULTS = [
    ("import sys; sys.exit('no licence')", Outcome.CRASHED, "exit status 1; stderr: no licence"),
    (f"{SOUND}{TELL}sys.stdout.flush(); os.abort()", Outcome.CRASHED, "signal SIGABRT"),
    (f"{SOUND}{TELL}sys.exit(3)", Outcome.CRASHED, "exit status 3"),
    (f"{SOUND}1 // 0", Outcome.CRASHED, "ZeroDivisionError"),
    (f"{SOUND}for n in found: found[n].pop()\n{TELL}", Outcome.MISANSWERED, "got 2"),
    (f"{SOUND}print(json.dumps(found)[:-30])", Outcome.MISANSWERED, "no JSON"),
    (f"{SOUND}print('1e-3 done'); {TELL}", Outcome.MISANSWERED, "no JSON"),
    (f"{SOUND}found['w1'][1] = float('nan'); {TELL}", Outcome.NON_FINITE, "nan @ w1[1]"),
    (
        f"{SOUND}found['t'] = ['0x1p16000'] * 3; {TELL}",
        Outcome.MISANSWERED,
        "got 3.01947e+4816 @ t[0]",
    ),
    (f"{SOUND}found['steps'] = 10**15; {TELL}", Outcome.MISANSWERED, "steps in"),
    (f"{SOUND}found['seconds'] = 1000; {TELL}", Outcome.MISANSWERED, "got 1e+03 + 0 @ seconds"),
    (
        f"{SOUND}found.update(seconds=0, compile_seconds=1000); {TELL}",
        *(Outcome.MISANSWERED, "got 0 + 1e+03 @ seconds"),
    ),
    ("while True: print('x' * 65536)", Outcome.MISANSWERED, "bytes on standard output"),
    ("pass", Outcome.MISANSWERED, "got nothing"),
]


@pytest.mark.parametrize(("text", "outcome", "words"), FAULTS, ids=range(len(FAULTS)))
def test_a_program_that_fails_has_its_outcome(
    tmp_path: Path, text: str, outcome: Outcome, words: str
) -> None:
    """A crash, a claim of success without its rows, a torrent: each is told, and has no states."""
    trajectory = solve(tmp_path, text)
    assert trajectory.outcome is outcome
    assert words in trajectory.detail
    assert not trajectory.quantities


def test_a_program_that_is_not_there_is_told() -> None:
    """A command that cannot be started is an outcome of its own."""
    trajectory = Process("process:./no-such-simulator --fast").solve(three_instants())
    assert trajectory.outcome is Outcome.NOT_STARTED
    assert trajectory.detail == "./no-such-simulator: No such file or directory"


@pytest.mark.parametrize(
    "text",
    [
        "import time; time.sleep(600)",
        # Nothing more will come, and still it does not end.
        "import os, time; os.close(1); os.close(2); time.sleep(600)",
        "while True: pass",
        f"{SOUND}signal.signal(signal.SIGTERM, signal.SIG_IGN); time.sleep(600)",
    ],
    ids=["asleep", "silent", "busy", "stubborn"],
)
def test_a_program_that_does_not_end_is_ended(tmp_path: Path, text: str) -> None:
    """After its time limit a program is stopped, and the run says which limit that was."""
    began = time.monotonic()
    trajectory = solve(tmp_path, text, limit=1)
    # Half the time of the program.
    assert time.monotonic() - began < 300
    assert trajectory.outcome is Outcome.TIMED_OUT
    assert trajectory.detail == f"1 seconds, settable by {LIMIT_VARIABLE}"


def test_a_child_that_holds_the_pipes_is_not_waited_for(tmp_path: Path) -> None:
    """The answer is whole when the program ends, whatever it leaves in its session."""
    forks = "if not os.fork():\n    time.sleep(600)\n"
    began = time.monotonic()
    assert solve(tmp_path, SOUND + forks + TELL).outcome is Outcome.FINISHED
    assert time.monotonic() - began < 300


def test_neither_side_waits_for_the_other(tmp_path: Path) -> None:
    """A program may fill its output before it reads a question that fills the pipe as well."""
    talkative = "import sys\nsys.stderr.write('x' * 10**6)\nsys.stdout.write(' ' * 10**6)\n"
    trajectory = solve(tmp_path, f"{talkative}{SOUND}{TELL}", samples=3_000)
    assert trajectory.outcome is Outcome.FINISHED
    assert len(trajectory.quantities["omega"]) == 3_000


def test_a_question_need_not_be_read(tmp_path: Path) -> None:
    """A program that knows the answer is not made to read, and a broken pipe is no fault of it."""
    text = f"import sys; sys.stdin.close(); print({answer(three_instants(samples=3)).decode()!r})"
    assert solve(tmp_path, text).outcome is Outcome.FINISHED
    # Here the question is larger than the pipe.
    trajectory = solve(tmp_path, text, samples=3_000)
    assert trajectory.outcome is Outcome.MISANSWERED


def test_the_last_words_are_shown_without_their_colours(tmp_path: Path) -> None:
    """The last lines of a long stderr are told, and no escape sequence passes to the terminal."""
    text = "import sys\nfor i in range(9999): print(f'\\x1b[31mline {i}', file=sys.stderr)\nsys.exit(2)"
    detail = solve(tmp_path, text).detail
    assert "\x1b" not in detail
    assert detail.endswith("line 9998")
    assert "line 9994" in detail
    assert "line 9993" not in detail


# The name.


def test_a_command_is_split_as_a_shell_would() -> None:
    """Quotes hold a word together, and nothing is expanded."""
    solver = named("process:./my_simulator 'a b' $HOME")
    assert solver.command == ["./my_simulator", "a b", "$HOME"]
    assert solver.name == "process:./my_simulator 'a b' $HOME"


def test_the_time_limit_is_an_environment_variable(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its value is in seconds; what is no positive number is refused, not ignored."""
    monkeypatch.delenv(LIMIT_VARIABLE, raising=False)
    assert named("process:true").time_limit == DEFAULT_LIMIT
    monkeypatch.setenv(LIMIT_VARIABLE, "2.5")
    assert named("process:true").time_limit == 2.5
    for wrong in ("0", "-1", "nan", "inf", "soon"):
        monkeypatch.setenv(LIMIT_VARIABLE, wrong)
        with pytest.raises(ValueError, match=LIMIT_VARIABLE):
            named("process:true")


# The worked example.

RK4 = f"process:{shlex.join([sys.executable, '-S', str(OUTSIDE / 'rk4.py')])}"


@pytest.mark.parametrize(
    "scene", by_turns(["euler/with-attitude", "euler/generic", "kirchhoff/screw"])
)
def test_the_example_converges_with_order_four(scene: str) -> None:
    """Halving the step of rk4.py divides every state error by 16, far above and below no bound."""
    coarse = run(scene, f"{RK4} step=0.1").verdicts
    fine = run(scene, f"{RK4} step=0.05").verdicts
    assert fine[0].steps > coarse[0].steps > 0
    states = {"omega", "impulse", "attitude"}
    compared = [pair for pair in zip(coarse, fine, strict=True) if pair[0].quantity in states]
    assert compared
    for one, other in compared:
        assert one.verdict is other.verdict is Status.FAIL
        # Half an order leaves room for the next term of the error, and none for orders 3 and 5.
        assert 2**3.5 <= one.max / other.max <= 2**4.5
