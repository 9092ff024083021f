"""Reader of the question and writer of the answer: the JSON of the protocol, shared by all scripts.

A script has a function ``solve(question, settings)`` and ends with ``answer(solve)``. Its arguments are
the method, if it has several, and the settings that its metadata declares:

    uv run --script with_cvode.py method=bdf rtol=1e-9 atol=1e-12 < question.json > answer.json

With the one argument ``many`` it reads a question from each line, {"settings": ["method=bdf"], "question":
{...}}, and writes an answer to each, in a line of its own: libraries are loaded once. An error ends the
script, and what is not answered by then has to be asked again.

The keys of the JSON are explained in cases/README.md of taylor-verify. Numbers are the doubles that the
protocol hands over as ``hex``. An integration backwards in time is asked with ``sign`` -1: the rates are to
be multiplied by it, and the clock runs forwards for every library.
"""

from __future__ import annotations

import json
import math
import sys
import time
from collections.abc import Callable, Hashable, Iterable, Sequence
from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import Any, TextIO

from equations import Rates, rates

Row = Sequence[float]
# The argument that says that many questions follow, each in a line.
MANY = "many"
# The method and the settings by name, numbers as numbers; the library's own names of them are the
# script's affair.
Settings = SimpleNamespace


@dataclass(frozen=True)
class Question:
    """A problem; see equations.py for the order of ``state`` and ``parameters``.

    ``instants`` are the absolute times since the start that are asked for, from 0 on and strictly
    rising; ``columns`` the names that the answer needs besides t, and ``times`` is its column t.
    ``bits`` is the significand of the rung, 53 for float64. ``code`` is the text of ``rates(s, p)`` where
    the equations come with the question, and else empty: those of equations.py for the columns.
    """

    bits: int
    columns: list[str]
    parameters: list[float]
    state: list[float]
    sign: float
    instants: list[float]
    asks_start: bool
    times: list[str]
    code: str = ""

    @property
    def equations(self) -> Hashable:
        """The data that compiled equations depend on."""
        numbers = tuple(self.parameters), self.sign, len(self.state)
        return self.code, tuple(self.columns), *numbers

    @property
    def end(self) -> float:
        return self.instants[-1]


@dataclass(frozen=True)
class Solved:
    """The states at the instants of the question, and the work they took; times in seconds.

    A ``remark`` is a sentence on how they were had, such as the axes that an engine has worked in.
    ``again`` propagates once more, for a script that stays to be timed (service.py).
    """

    states: Sequence[Row]
    steps: int
    evaluations: int
    seconds: float
    compile_seconds: float
    remark: str = ""
    again: Callable[[], Any] | None = None


class Unsuited(SystemExit):
    """The question is not one for the library or its script; the text says why.

    The caller is told so, and the run is not a failure.
    """


def answer(solve: Callable[[Question, Settings], Solved]) -> None:
    """Read the question on stdin, solve it as the arguments say, write the answer on stdout.

    With the argument `serve` the script stays, and answers requests as service.py says.
    """
    if sys.argv[1:] == ["serve"]:
        from service import stay

        stay(solve)
        return

    def answered(scene: Any, settings: Settings) -> dict[str, Any]:
        question = read(scene)
        return _written(question, solve(question, settings))

    serve(answered, sys.stdout)


def serve(answered: Callable[[Any, Settings], dict[str, Any]], out: TextIO) -> None:
    """Write what is answered to the question on stdin, or to each of many, a line for each."""
    asked: Iterable[Any] = map(json.loads, sys.stdin)
    if sys.argv[1:] != [MANY]:
        asked = [{"question": json.load(sys.stdin), "settings": sys.argv[1:]}]
    for each in asked:
        try:
            settings = Settings(**dict(map(_setting, each["settings"])))
            written = answered(each["question"], settings)
        except Unsuited as reason:
            written = {"unsuited": str(reason.code)}
        print(json.dumps(written), file=out, flush=True)


def _setting(argument: str) -> tuple[str, str | float]:
    name, _, value = argument.partition("=")
    try:
        return name, float(value)
    except ValueError:
        return name, value


def twice(propagate: Callable[[], Any]) -> tuple[Any, float, float]:
    """Return the result of a propagation, its seconds, and how many more the first one took to compile.

    It is done twice: the first may compile, load and allocate, the second one propagates alone.
    """
    _, first = timed(propagate)
    result, second = timed(propagate)
    return result, second, max(0.0, first - second)


def timed(propagate: Callable[[], Any]) -> tuple[Any, float]:
    """Return a result and its seconds of the processor, which other programs do not make longer.

    They are at most those on the wall: threads side by side do not count twice.
    """
    began, used = time.perf_counter(), time.process_time()
    result = propagate()
    return result, min(time.perf_counter() - began, time.process_time() - used)


def once_for_equations(make: Callable[[Question], Any]) -> Callable[[Question], Any]:
    """Return the function with a memory: what it makes of the same equations is made once."""
    known: dict[Hashable, Any] = {}

    def made(question: Question) -> Any:
        if question.equations not in known:
            known[question.equations] = make(question)
        return known[question.equations]

    return made


def equations_of(question: Question, jit: Any = None) -> Rates:
    """Return ``rates(s, p)`` of a question, a tuple; ``jit`` compiles each function of it."""
    compiled = jit or (lambda function: function)
    if not question.code:
        return rates(question.columns, compiled)
    made: dict[str, Any] = {}
    exec(question.code, made)
    equations: Rates = compiled(made["rates"])
    return equations


@once_for_equations
def compiled_rates(question: Question) -> Any:
    """Return ``fill(state, out)``, the rates compiled by numba; the body's numbers are constants of it."""
    import numpy
    from numba import njit

    # Equations that come with the question are compiled as C and heyoka's are: a product and a sum in one
    # rounding, and no look whether a divisor is zero.
    jit = njit(fastmath={"contract"}, error_model="numpy") if question.code else njit
    equations = equations_of(question, jit)
    parameters = numpy.array(question.parameters)
    sign, n = question.sign, len(question.state)

    def fill(state: Any, out: Any) -> None:
        f = equations(state, parameters)
        for i in range(n):
            out[i] = sign * f[i]

    return jit(fill)


# Reading.


def floats(number: Any) -> Any:
    """Return the doubles of a number, vector or matrix: each is there as `text` and as `hex`."""
    if isinstance(number, dict):
        return floats(number["hex"])
    if isinstance(number, list):
        return [floats(entry) for entry in number]
    return float.fromhex(number)


# The columns of each model's answer that the equations lead to, in the order of the state.
COLUMNS = {
    "euler": "w1 w2 w3 q0 q1 q2 q3",
    "kirchhoff": "x1 x2 x3 y1 y2 y3 q0 q1 q2 q3 c1 c2 c3",
}


def read(scene: Any, takes_loads: bool = False) -> Question:
    """Return the question in a document; raises Unsuited if it asks for what is not computed.

    Loads and states that a scene writes down are left to whoever takes them (acting.py).
    """
    body, initial, clock = scene["body"], scene["initial"], scene["time"]
    if "loads" in scene and not takes_loads:
        raise Unsuited("expected constant loads, got some that the scene writes down")
    columns = scene["columns"][1:]
    own = [state["name"] for state in scene.get("states", [])]
    if scene["model"] not in COLUMNS:
        raise Unsuited(f"expected the model {' or '.join(COLUMNS)}, got {scene['model']}")
    known = COLUMNS[scene["model"]]
    if unknown := [name for name in columns if name not in (*known.split(), *own)]:
        raise Unsuited(f"expected columns among {known}, got {' '.join(unknown)} @ columns")
    if scene["model"] == "euler":
        wheels = floats(body["rotor"]) if "rotor" in body else [0.0, 0.0, 0.0]
        parameters = _flat(body["inverse_inertia"]) + floats(body["moment"]) + wheels
        state = floats(initial["angular_momentum"])
    else:
        parameters = [v for key in ("linear", "coupling", "angular") for v in _flat(body[key])]
        parameters += floats(body["force"]) + floats(body["couple"])
        state = floats(initial["linear_impulse"]) + floats(initial["angular_impulse"])
    parameters.append(floats(body["damping"]) if "damping" in body else 0.0)
    if "q0" in columns:
        state += unit(floats(initial["attitude"]))
    if "c1" in columns:
        state += floats(initial["centre"])
    elapsed = floats(clock["elapsed"])
    asks_start = elapsed[0] == 0
    return Question(
        bits=scene["bits"],
        columns=columns,
        parameters=parameters,
        state=state,
        sign=math.copysign(1.0, elapsed[-1]),
        instants=[0.0] * (not asks_start) + [abs(t) for t in elapsed],
        asks_start=asks_start,
        times=clock["times"]["hex"],
    )


def _flat(matrix: Any) -> list[float]:
    return [entry for row in floats(matrix) for entry in row]


def unit(q: Row) -> list[float]:
    """Return the unit quaternion: the protocol gives one of any length."""
    length = math.sqrt(sum(entry * entry for entry in q))
    return [entry / length for entry in q]


# Writing.


def _written(question: Question, solved: Solved) -> dict[str, Any]:
    if "w1" in question.columns:
        states = [_with_omega(question.parameters, state) for state in solved.states]
        solved = replace(solved, states=states)
    return document(question, solved)


def document(question: Question, solved: Solved) -> dict[str, Any]:
    """Return the answer, whose states are rows of the columns that the question asks for."""
    states = solved.states if question.asks_start else solved.states[1:]
    columns = zip(*states, strict=True)
    return {
        "t": question.times,
        "steps": int(solved.steps),
        "evaluations": int(solved.evaluations),
        "seconds": solved.seconds,
        "compile_seconds": solved.compile_seconds,
        **({"remark": solved.remark} if solved.remark else {}),
        # Hexadecimal floats are exact.
        **{
            name: [float(value).hex() for value in column]
            for name, column in zip(question.columns, columns, strict=True)
        },
    }


def _with_omega(p: Row, state: Row) -> Row:
    """Return the state with omega = K H in place of H."""
    state = [float(value) for value in state]
    H = state[:3]
    return [sum(p[3 * i + j] * H[j] for j in range(3)) for i in range(3)] + state[3:]
