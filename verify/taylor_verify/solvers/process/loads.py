"""The loads and states that a scene writes down, in the question: texts, and their elementary steps.

``steps`` are lists: ["input", name], ["number", text, hex], ["power", place, text, hex], and [operation,
place, ...] for the rest, where a place counts the steps from 0. The input t is the time since the start.
``from`` and ``to`` are such times, and null where a piece has no end.
The pieces end with the stairs of floor where these end. Of a piece ``rates`` are the places
of the rates of all states with a rate, ``values`` those of the values of all held ones, both in the order
of ``states``, and ``rotor`` those of the momentum of wheels; each is there where the scene writes it.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from taylor_verify.models.problem import Problem
from taylor_verify.numbers.precision import Rung
from taylor_verify.scenes.loads.loads import VECTORS, Entry, Loads, Piece
from taylor_verify.scenes.loads.states import Held, State
from taylor_verify.scenes.loads.steps import Step
from taylor_verify.solvers.process.exact_text import exact_number, exact_text


def written_loads(problem: Problem) -> dict[str, Any]:
    """Return the texts of a problem's loads, the names that they read, and the steps of each piece."""
    loads = problem.given.body.loads
    assert loads is not None
    rung = problem.rung
    return {
        "text": {name: [_text(entry) for entry in entries] for name, entries in loads.vectors},
        "define": {name: _text(entry) for name, entry in loads.definitions},
        "space": {name: [_text(entry) for entry in entries] for name, entries in loads.space},
        **({"current": exact_number(loads.current, rung)} if any(loads.current) else {}),
        "inputs": sorted(loads.inputs),
        "pieces": [_piece(piece, loads, rung) for piece in loads.known_pieces()],
    }


def states(problem: Problem) -> dict[str, Any]:
    """Return the components of the scene's own states, and the instants at which some are taken.

    An instant is a list: the elapsed time, and the names of the components that are taken there.
    """
    loads = problem.given.body.loads
    if loads is None or not loads.states:
        return {}
    rung = problem.rung
    listed = [entry for state in loads.states for entry in _components(state, rung)]
    instants = [
        [exact_number(instant.time, rung), [loads.held_values[place] for place in instant.places]]
        for instant in problem.takings
    ]
    return {"states": listed, **({"instants": instants} if instants else {})}


def _components(state: State, rung: Rung) -> Iterator[dict[str, Any]]:
    for k, (name, entry) in enumerate(zip(state.components, state.entries, strict=True)):
        start = None if state.start is None else exact_number(state.start[k], rung)
        if isinstance(state, Held):
            times = {"every": exact_text(state.every), "offset": exact_text(state.offset)}
            yield {"name": name, "start": start, **times, "value": _text(entry)}
        else:
            yield {"name": name, "start": start, "rate": _text(entry)}


def _piece(piece: Piece, loads: Loads, rung: Rung) -> dict[str, Any]:
    outputs = {
        name: list(piece.outputs[3 * k : 3 * k + 3]) for k, name in enumerate(VECTORS[loads.model])
    }
    return {
        "from": None if piece.begin is None else exact_text(piece.begin),
        "to": None if piece.end is None else exact_text(piece.end),
        "steps": [_step(step, rung) for step in piece.steps],
        **outputs,
        **{
            name: list(places)
            for name in ("rates", "values", "rotor")
            if (places := getattr(piece, name))
        },
    }


def _step(step: Step, rung: Rung) -> list[Any]:
    listed: list[Any] = [step.operation, *step.operands]
    if step.operation == "input":
        listed.append(step.name)
    if step.number is not None:
        listed += exact_number(step.number, rung).values()
    return listed


def _text(entry: Entry) -> str:
    return entry if isinstance(entry, str) else exact_text(entry)
