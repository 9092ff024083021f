"""The service of a script that stays running: it answers problems line by line, and times them again.

A request and its answer are one line of JSON each, on the standard input and output.

    {"problem": {...}, "settings": {...}}
        {"states": [[...], ...], "steps": 9, "evaluations": 99, "seconds": ..., "setup_seconds": ...}
    the same with "count": 100, which propagates so many times; seconds are those of one of them
    anything that fails
        {"fault": "a sentence"}

A problem has its equations as lines of + - * / with it: ``lines`` and the names of the results, ``rates``,
as solvers/straight_line.py of taylor-verify writes them, with ``constants``, ``parameters``, ``state`` and
``instants`` as hexadecimal floats. The instants begin with 0 and rise, and ``sign`` -1 asks for the motion
backwards in time. Seconds are those of the processor, in all threads of this process.
"""

from __future__ import annotations

import gc
import json
import os
import sys
import time
from collections.abc import Callable
from typing import Any

from question import Question, Settings, Solved, floats

Solve = Callable[[Question, Settings], Solved]


def stay(solve: Solve) -> None:
    """Answer the requests on the standard input until it ends."""
    # Output that a library prints would stand among the answers, so it goes to standard error.
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    propagations: dict[str, Callable[[], Any]] = {}
    for line in sys.stdin:
        try:
            answer = _answer(json.loads(line), solve, propagations)
        except (Exception, SystemExit) as error:  # a library's own: the caller hears of it
            answer = {"fault": f"{type(error).__name__}: {error}"}
        print(json.dumps(answer), file=answers, flush=True)


def _answer(
    request: Any, solve: Solve, propagations: dict[str, Callable[[], Any]]
) -> dict[str, Any]:
    count, asked = request.pop("count", 0), json.dumps(request)
    if count and asked in propagations:
        return {"seconds": _timed(propagations[asked], count)}
    began = time.process_time()
    solved = solve(_read(request["problem"]), Settings(**request["settings"]))
    spent = time.process_time() - began
    assert solved.again is not None
    propagations[asked] = solved.again
    seconds = _timed(solved.again, count or 1)
    return {
        "states": [[float(value).hex() for value in state] for state in solved.states],
        "steps": int(solved.steps),
        "evaluations": int(solved.evaluations),
        "seconds": seconds,
        # Beside compiling two propagations are in it.
        "setup_seconds": max(0.0, spent - 2 * seconds),
    }


def _timed(propagate: Callable[[], Any], count: int) -> float:
    """Return the processor's seconds of one propagation of so many."""
    enabled = gc.isenabled()
    gc.disable()
    try:
        began = time.process_time()
        for _ in range(count):
            propagate()
        return (time.process_time() - began) / count
    finally:
        if enabled:
            gc.enable()


def _read(problem: Any) -> Question:
    return Question(
        bits=53,
        columns=[],
        parameters=floats(problem["parameters"]),
        state=floats(problem["state"]),
        sign=problem["sign"],
        instants=floats(problem["instants"]),
        asks_start=True,
        times=[],
        code=_code(problem),
    )


def _code(problem: Any) -> str:
    """Return the text of ``rates(s, p)``, which returns a tuple."""
    constants = zip(problem["constants"], floats(list(problem["constants"].values())), strict=True)
    lines = [
        *(f"s{k} = s[{k}]" for k in range(len(problem["state"]))),
        *(f"p{k} = p[{k}]" for k in range(len(problem["parameters"]))),
        *(f"{name} = {value!r}" for name, value in constants),
        *problem["lines"],
        f"return ({', '.join(problem['rates'])},)",
    ]
    return "\n".join(["def rates(s, p):", *(f" {line}" for line in lines)])
