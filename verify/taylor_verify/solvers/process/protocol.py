"""The protocol of user programs: a question in JSON on standard input, an answer in JSON on its output.

`cases/README.md`, *A program as a solver*, has every key of both. Every key of the question but ``text``
and ``hex`` occurs once in it and has one meaning, whatever its table, so that a reader may search the text
for ``"elapsed":`` and go on from there. None of them is a key of the answer.

Every number, vector or matrix of the question is an object of two: ``text``, the exact value, and ``hex``,
the hexadecimal float of the rung, as C's strtod reads it. K and H are rounded once, and I = K^-1 and
omega = K H follow from them exactly; so whoever integrates H' = H x K H + M has exact data. An engine whose
script says ``data = "tensor"`` is asked the other way round.

An entry of the answer in quotes is taken exactly. A bare JSON number is on f32 and f64 the double nearest
to it, because that is what the program held and printed, and on wider rungs the exact decimal.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from typing import Any, Final

from taylor_verify.models.problem import Problem
from taylor_verify.models.registry import mechanics
from taylor_verify.numbers.precision import double_text
from taylor_verify.scenes.bodies import Body
from taylor_verify.scenes.named_numbers import Value
from taylor_verify.solvers.process.exact_text import exact_number
from taylor_verify.solvers.process.loads import states, written_loads
from taylor_verify.solvers.values import exact, named_once

# The version of a question, and those of what acts besides constant loads: a program can refuse them.
VERSION: Final = 1
VERSIONS: Final = {"rotor": 3, "damping": 4, "loads": 5}

# A time is read from a decimal, formed as start + k dt and printed again: three roundings, plus one.
_TIME_ROUNDINGS = 4
_DOUBLE_BITS = 53
_LONGEST_REMARK = 300
# Seconds, of the order of a century: a double holds it, and no program was waited for so long.
_LONGEST = 10**10


class Misanswer(Exception):
    """The error for an answer that does not follow the protocol; the text says how."""


class NotFinite(Exception):
    """The error for an answer with a number that is not finite; the text says where."""


class Unsuited(Exception):
    """The error for a program that is not made for the question; the text is its reason."""


@dataclass(frozen=True)
class Answer:
    """States in the order of ``columns``, held exactly, and the work that the program claims.

    ``seconds`` is None where the program did not time itself.
    """

    states: list[list[Fraction | float]]
    steps: int
    evaluations: int
    seconds: float | None = None
    compile_seconds: float = 0.0
    remark: str = ""


# The question.


def question(problem: Problem) -> dict[str, Any]:
    """Return the document that a program is asked with."""
    scene = problem.scene
    return {
        "protocol": _version(scene.body),
        "scene": scene.name,
        "title": scene.title,
        "model": scene.model,
        "track": sorted(scene.track | scene.states),
        "rung": problem.rung.name,
        "bits": problem.rung.bits,
        "columns": column_names(problem),
        **_data(problem),
        **({} if scene.body.loads is None else {"loads": written_loads(problem)}),
        **states(problem),
    }


def _version(body: Body) -> int:
    """Return the version that a program has to know for this body; one that no program knows for others."""
    unknown = max(VERSIONS.values()) + 1
    acting = set(body.acting) - set(body.load_names())
    return max((VERSIONS.get(name, unknown) for name in acting), default=VERSION)


def column_names(problem: Problem) -> list[str]:
    """Return the columns of an answer: t, and those of everything the scene tracks."""
    return ["t", *(name for group in problem.scene.groups for name in group.columns)]


def _data(problem: Problem) -> dict[str, Any]:
    given, rung = problem.given, problem.rung
    body, initial, clock = given.body, given.initial, given.clock
    derived = mechanics(body).derived(body, initial)
    numbers: dict[str, dict[str, Any]] = {
        "body": {
            **_merged(body.parts(), derived.get("body", {})),
            **problem.scene.body.description,
        },
        "initial": _merged(initial.parts(), derived.get("initial", {})),
    }
    # Each is rounded once: start + elapsed, of which both are rounded, may be another number.
    numbers["time"] = {
        "start": clock.start,
        "elapsed": clock.elapsed,
        "times": problem.scene.clock.instants,
    }
    return {
        table: {key: exact_number(value, rung) for key, value in entries.items()}
        for table, entries in numbers.items()
    }


def _merged(parts: Mapping[str, Value], derived: Mapping[str, Value]) -> dict[str, Value]:
    """Return the parts, and behind the first of them what follows from it."""
    first = next(iter(parts))
    return {first: parts[first], **derived, **parts}


# The answer.

# So many characters of an output that is no answer are shown.
_SHOWN: Final = 60


def longest_answer(problem: Problem) -> int:
    """Return the bytes that an answer to this problem may have: room for every number's every bit."""
    numbers = len(problem.times) * len(column_names(problem))
    return 2**20 + numbers * (200 + 2 * problem.rung.bits)


def read(text: bytes, problem: Problem) -> Answer:
    """Return the states in an answer; raise Misanswer or NotFinite, whose text says what and where.

    Raises Unsuited for an answer that says so.
    """
    document = _parsed(text)
    if "unsuited" in document:
        if more := [name for name in document if name != "unsuited"]:
            raise Misanswer(f"expected unsuited alone, or columns, got {more[0]} beside it")
        if why := _sentence(document, "unsuited").strip():
            raise Unsuited(why)
        raise Misanswer("expected a sentence that says why @ unsuited, got an empty one")
    names = column_names(problem)
    if missing := [name for name in names if name not in document]:
        raise Misanswer(f"expected the columns {', '.join(names)}, got no {', '.join(missing)}")
    for name in names:
        _check_length(document, name, len(problem.times))
    as_double = problem.rung.bits <= _DOUBLE_BITS
    times, *states = (
        [_number(value, as_double, f"{name}[{row}]") for row, value in enumerate(document[name])]
        for name in names
    )
    _check_times(times, problem)
    rows = [list(row) for row in zip(*states, strict=True)]
    work = _count(document, "steps"), _count(document, "evaluations")
    return Answer(rows, *work, *_durations(document), _sentence(document, "remark"))


def _parsed(text: bytes) -> Mapping[str, Any]:
    if not text.strip():
        raise Misanswer("expected a JSON object on standard output, got nothing")
    try:
        document = json.loads(text, parse_float=Decimal, object_pairs_hook=named_once)
    except json.JSONDecodeError as error:
        where = f"line {error.lineno}, column {error.colno}"
        cut = " (where the answer ends)" if error.pos >= len(text.rstrip()) - 1 else ""
        begins = text.decode("utf-8", "replace").strip()[:_SHOWN]
        raise Misanswer(
            f"expected one JSON object on standard output and nothing else, got no JSON at {where}{cut}: "
            f"{error.msg}; the output begins {begins!r}"
        ) from error
    except (ValueError, RecursionError) as error:
        raise Misanswer(f"expected one JSON object, got {error}") from error
    if not isinstance(document, dict):
        raise Misanswer(f"expected a JSON object of columns, got a {type(document).__name__}")
    return document


def _check_length(document: Mapping[str, Any], name: str, samples: int) -> None:
    entries = document[name]
    if not isinstance(entries, list):
        raise Misanswer(f"expected a list of {samples} numbers @ {name}")
    if len(entries) != samples:
        last = f", the last at t = {document['t'][-1]}" if name == "t" and entries else ""
        raise Misanswer(f"expected {samples} rows, got {len(entries)}{last} @ {name}")


def _check_times(times: Sequence[Fraction | float], problem: Problem) -> None:
    clock = problem.given.clock
    size = abs(clock.start) + max(abs(elapsed) for elapsed in clock.elapsed)
    allowed = _TIME_ROUNDINGS * problem.rung.unit_roundoff * size
    for row, (asked, got) in enumerate(zip(clock.instants, times, strict=True)):
        if not abs(Fraction(got) - asked) <= allowed:
            raise Misanswer(
                f"expected t = {double_text(asked)} (within {_TIME_ROUNDINGS} roundings of "
                f"{problem.rung.name}), got {double_text(got)} @ t[{row}]"
            )


def _count(document: Mapping[str, Any], name: str) -> int:
    count = document.get(name, 0)
    if not isinstance(count, int) or isinstance(count, bool) or count < 0:
        raise Misanswer(f"expected a whole number, got {count!s:.40} @ {name}")
    return count


def _durations(document: Mapping[str, Any]) -> tuple[float | None, float]:
    """Return the program's own seconds, None where it states none, and those of compiling."""
    stated: dict[str, float] = {}
    for name in ("seconds", "compile_seconds"):
        if name in document:
            value = document[name]
            is_number = isinstance(value, int | Decimal) and not isinstance(value, bool)
            if not (is_number and 0 <= value <= _LONGEST):
                expected = "a number of seconds, not negative"
                raise Misanswer(f"expected {expected}, got {_json(value)} @ {name}")
            stated[name] = float(value)
    if stated and "seconds" not in stated:
        raise Misanswer("expected seconds beside compile_seconds, got none @ seconds")
    return stated.get("seconds"), stated.get("compile_seconds", 0.0)


def _sentence(document: Mapping[str, Any], name: str) -> str:
    """Return a sentence of a program, in printable characters: it is shown to people."""
    sentence = document.get(name, "")
    if not isinstance(sentence, str):
        raise Misanswer(f"expected a sentence, got {_json(sentence)} @ {name}")
    return "".join(c if c.isprintable() else " " for c in sentence[:_LONGEST_REMARK])


def _number(value: Any, as_double: bool, place: str) -> Fraction | float:
    """Return a number of an answer, held exactly."""
    if value is None or (isinstance(value, float) and not math.isfinite(value)):
        raise NotFinite(f"{'null' if value is None else value} @ {place}")
    if isinstance(value, bool) or not isinstance(value, str | int | Decimal):
        raise Misanswer(f"expected a number, got {_json(value)} @ {place}")
    if as_double and not isinstance(value, str):
        try:
            double = float(value)
        except OverflowError:
            double = math.inf
        if not math.isfinite(double):
            raise NotFinite(f"beyond the range of doubles @ {place}")
        return double
    try:
        number = exact(value)
    except ValueError as error:
        raise Misanswer(f"expected {error}, got {value!s:.40} @ {place}") from None
    if not isinstance(number, Fraction):
        raise NotFinite(f"{value} @ {place}")
    return number


def _json(value: Any) -> str:
    return f"{json.dumps(value, default=str):.40}"
