"""The loads that a scene writes down, in the question: their texts, and their elementary steps.

``steps`` are lists: ["input", name], ["number", text, hex], ["power", place, text, hex], and [operation,
place, ...] for the rest, where a place counts the steps from 0. The input t is the time since the start.
``from`` and ``to`` are such times, and null where a piece has no end.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import Any

from taylor_verify.models.problem import Problem
from taylor_verify.numbers.precision import Rung, hexadecimal
from taylor_verify.scenes.loads.loads import VECTORS, Entry, Loads, Piece
from taylor_verify.scenes.loads.steps import Step
from taylor_verify.solvers.process.numbers import exact_text


def written_loads(problem: Problem) -> dict[str, Any]:
    """Return the texts of a problem's loads, the names that they read, and the steps of each piece."""
    loads = problem.given.body.loads
    assert loads is not None
    bits = Rung(problem.rung.name, problem.rung.bits)
    return {
        "text": {name: [_text(entry) for entry in entries] for name, entries in loads.vectors},
        "define": {name: _text(entry) for name, entry in loads.definitions},
        "space": {name: [_text(entry) for entry in entries] for name, entries in loads.space},
        "inputs": sorted(loads.inputs),
        "pieces": [_piece(piece, loads, bits) for piece in _pieces(loads)],
    }


def _pieces(loads: Loads) -> Iterator[Piece]:
    switches = loads.switches
    if switches:
        yield loads.piece(switches[0], is_later=False)
    for switch in switches or (Fraction(0),):
        yield loads.piece(switch)


def _piece(piece: Piece, loads: Loads, rung: Rung) -> dict[str, Any]:
    outputs = {
        name: list(piece.outputs[3 * k : 3 * k + 3]) for k, name in enumerate(VECTORS[loads.model])
    }
    return {
        "from": None if piece.begin is None else exact_text(piece.begin),
        "to": None if piece.end is None else exact_text(piece.end),
        "steps": [_step(step, rung) for step in piece.steps],
        **outputs,
    }


def _step(step: Step, rung: Rung) -> list[Any]:
    listed: list[Any] = [step.operation, *step.operands]
    if step.operation == "input":
        listed.append(step.name)
    if step.number is not None:
        listed += [exact_text(step.number), hexadecimal(rung.round(step.number))]
    return listed


def _text(entry: Entry) -> str:
    return entry if isinstance(entry, str) else exact_text(entry)
