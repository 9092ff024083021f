"""A hundred drawn questions, in numbers that are doubles and short decimals at once."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import chain
from typing import Any, Final

import numpy as np

from taylor_verify.exact.printed import document
from taylor_verify.exact.route import solution
from taylor_verify.models.problem import pose_as_stored
from taylor_verify.numbers.precision import rung
from taylor_verify.records.quantities import COLUMNS
from taylor_verify.scenes.reading.reader import read
from taylor_verify.scenes.scene import Scene
from taylor_verify.solvers.process.protocol import question
from taylor_verify_reports.studies.causes.bodies import Floats, Sample
from taylor_verify_reports.studies.causes.loaded import on_grid
from taylor_verify_reports.studies.reference.exact_table import columns
from taylor_verify_reports.studies.vectors.bodies_in_water import IN_WATER
from taylor_verify_reports.studies.vectors.bodies_under_loads import (
    OWN_STATES,
    WRITTEN,
    Draw,
    Loaded,
    driven,
    plain,
)

DIGITS: Final = 17
_ZEROS: Final = re.compile(r"\.?0*p")
_LOADED: Final[dict[str, Loaded]] = {**WRITTEN, **OWN_STATES, "driven": driven, **IN_WATER}
_SORTS: Final = {"free": "free", "wheels": "wheels", "moment": "moment", "fluid": "fluid"}
_MANUFACTURED: Final = ("tones", "impulses")
_NAMES: Final = {**COLUMNS, "attitude": ("q0", "q1", "q2", "q3")}
COUNTS: Final = {
    "free": 22,
    "wheels": 12,
    "moment": 10,
    **dict.fromkeys(WRITTEN, 4),
    **dict.fromkeys(OWN_STATES, 5),
    "fluid": 6,
    "driven": 4,
    "tones": 2,
    "impulses": 2,
    "vehicle": 4,
    "current": 3,
    "clebsch": 2,
    "steered": 3,
}


@dataclass(frozen=True)
class Question:
    """A question: its name, what it asks, the text of its scene, and its body, start and times."""

    name: str
    kind: str
    text: str
    body: Sample


def questions(seed: int) -> list[Question]:
    """Return the questions of a seed, those of a kind together."""
    return [*chain.from_iterable(_of_kind(kind, count, seed) for kind, count in COUNTS.items())]


def _of_kind(kind: str, count: int, seed: int) -> Iterator[Question]:
    for number in range(count):
        draw = np.random.default_rng([seed, list(COUNTS).index(kind), number])
        name = f"{kind}-{number + 1}"
        if kind in _MANUFACTURED:
            body = plain("free" if kind == "tones" else "fluid", draw)
            yield Question(name, kind, _manufactured(kind, body, draw), body)
            continue
        sort = _SORTS.get(kind, "fluid" if kind in ("driven", *IN_WATER) else "free")
        body = plain(sort, draw, _LOADED.get(kind))
        yield Question(name, kind, body.text.replace("Sample", name), body)


def _manufactured(kind: str, body: Sample, draw: Draw) -> str:
    """Return a scene whose motion is a sum of waves; the load that makes it is no key of the scene."""
    model, named = ("euler", "inertia") if kind == "tones" else ("kirchhoff", "mass_matrix")
    waves = {"omega": _waves(draw)} if kind == "tones" else _impulses(draw)
    lines = [
        f'title = "{kind}"',
        f'model = "{model}"',
        "[body]",
        f"{named} = {body.mass.tolist()}",
        "[manufactured]",
        *(f"{name} = {text}" for name, text in waves.items()),
        "[time]",
        f"end = {float(body.times[-1])}",
        f"samples = {len(body.times)}",
    ]
    return "\n".join(lines) + "\n"


def _impulses(draw: Draw) -> dict[str, str]:
    return {name: _waves(draw) for name in ("linear_impulse", "angular_impulse")}


def _waves(draw: Draw) -> str:
    waves = [
        f"{{ frequency = {float(rate)}, cosine = {_vector(draw)}, sine = {_vector(draw)} }}"
        for rate in np.cumsum(on_grid(draw.uniform(0.2, 0.9, 2)))
    ]
    return f"[{', '.join(waves)}]"


def _vector(draw: Draw) -> list[float]:
    return [float(x) for x in on_grid(draw.uniform(-1, 1, 3))]


def answered(asked: Question) -> dict[str, Any]:
    """Return a question with its numbers as text and hexadecimal, and its right answer with the radius."""
    scene = read(asked.text, asked.name)
    instants = scene.clock.instants
    times = [(repr(float(instant)), instant) for instant in instants]
    printed = document(scene, solution(scene), times, DIGITS, "quaternion")
    return {
        "name": asked.name,
        "kind": asked.kind,
        "scene": asked.text,
        "question": {"model": scene.model, **_numbers(asked), **_further(scene)},
        "truth": {
            "route": printed["route"],
            "evidence": printed["evidence"],
            "columns": {
                **columns(printed["rows"], _NAMES),
                "radius": [row["radius"] for row in printed["rows"]],
            },
        },
    }


def _numbers(asked: Question) -> dict[str, Any]:
    """Return the numbers of a body, its start and its times, under the keys of a scene.

    A manufactured motion has its start in its waves.
    """
    body = asked.body
    start = {"omega": body.v0, "attitude": body.q0}
    numbers = {"inertia": body.mass, "moment": body.load, "rotor": body.rotor}
    if body.n == 6:
        start = {
            "linear_velocity": body.v0[:3],
            "angular_velocity": body.v0[3:],
            "attitude": body.q0,
        }
        numbers = dict(body.solid) or {"mass_matrix": body.mass}
    if asked.kind in _MANUFACTURED:
        start = {}
    return {
        "body": {name: both(value) for name, value in numbers.items()},
        "initial": {name: both(value) for name, value in start.items()},
        "time": {"times": both(body.times)},
    }


def _further(scene: Scene) -> dict[str, Any]:
    """Return what the protocol says of written loads, own states and a manufactured motion."""
    given = question(pose_as_stored(scene, rung("f64")))
    return {key: given[key] for key in ("loads", "states", "manufactured") if key in given}


def both(values: Any) -> dict[str, Any]:
    """Return numbers as exact text and as hexadecimal: they are doubles and short decimals."""
    values = np.atleast_1d([*values.values()] if isinstance(values, dict) else values)
    return {"text": _nested(values, repr), "hex": _nested(values, _hexadecimal)}


def _hexadecimal(value: float) -> str:
    return _ZEROS.sub("p", value.hex())


def _nested(values: Floats, written: Callable[[float], str]) -> Any:
    if np.ndim(values) > 1:
        return [_nested(row, written) for row in values]
    return [written(float(x)) for x in values]
