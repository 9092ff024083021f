"""The verb `question`: a scene as any solver gets it, or the empty trajectory file that answers it."""

from __future__ import annotations

import argparse
from functools import partial

from taylor_verify.cli.answer import PASS, Answer, CallParts, WrongCall
from taylor_verify.cli.inputs import known_rungs, read_scene
from taylor_verify.cli.streams import as_json_text
from taylor_verify.models.problem import NotRepresentable, Problem, pose
from taylor_verify.numbers.precision import rung, shortest_decimal
from taylor_verify.solvers.process.protocol import column_names, question


def answer(options: argparse.Namespace) -> Answer:
    """Print the question as JSON, or the header and the times of a trajectory file as CSV."""
    parts = CallParts()
    if options.csv and options.json:
        parts.faults.append("expected one of --csv and --json, got both @ question")
    rungs, scene = parts.read(known_rungs, [options.rung]), parts.read(read_scene, options.scene)
    parts.end()
    (name,) = rungs
    try:
        problem = pose(scene, rung(name))
    except NotRepresentable as reason:
        raise WrongCall(f"expected a scene that {name} can hold, got {reason} @ --rung") from reason
    document = question(problem)
    if not options.csv:
        return Answer(PASS, document, partial(as_json_text, document))
    return Answer(PASS, document, partial(_csv, problem))


def _csv(problem: Problem) -> str:
    """Return a header, and for each sample its time and a cell for every other column."""
    names, bits = column_names(problem), problem.rung.bits
    cells = "," * (len(names) - 1)
    times = [shortest_decimal(time, bits) for time in problem.scene.clock.instants]
    return "\n".join([",".join(names), *(f"{time}{cells}" for time in times)])
