"""Verdict rows and a record as runs leave them, changed where a test says so, and their schema."""

from __future__ import annotations

import math
from typing import Any

from jsonschema import Draft202012Validator

from taylor_verify.records.reason import Cause, stated
from taylor_verify.records.record import GateRecord, Record
from taylor_verify.records.schema import schema
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict

ATTAINABLE = 1e-14
VERSIONS = {"python": "3.12.1", "taylor-verify": "0.1.0", "heyoka": "7.13.0"}
PROVENANCE = {"versions": VERSIONS, "processor": "A chip", "command": "taylor-verify run"}
UNIT = {"f32": 2.0**-24, "f64": 2.0**-53, "mp237": 2.0**-237}


def row(errors: float = 0.5, **changed: Any) -> Verdict:
    """A row that passes, of euler/generic on f64; its errors are so many times what is attainable."""
    numbers: dict[str, Any] = {
        "scene": "euler/generic",
        "solver": "taylor",
        "rung": "f64",
        "setting": "",
        "quantity": "omega",
        "verdict": Status.PASS,
        "outcome": "reached the last sample",
        **dict.fromkeys(("max", "mean", "final"), errors * ATTAINABLE),
        "at": 7.0,
        "unit": "max|omega|",
        "bound": 10 * ATTAINABLE,
        "reason": stated(Cause.NOT_POSED, "10 x attainable; a reason"),
        "attainable": ATTAINABLE,
        "ratio": errors,
        "ratio_at": 7.0,
        "roundoff": 2.0**-53,
        "steps": 100,
        "evaluations": 2000,
        "provenance": {"scene": "digest"},
    }
    return Verdict(**numbers | changed)


def far_off(status: Status = Status.PASS, **changed: Any) -> Verdict:
    """A row with an error of 3.3e-12 at t = 7, where 2e-13 is allowed."""
    numbers: dict[str, Any] = {
        "max": 3.3e-12,
        "mean": 2e-12,
        "final": 1e-12,
        "bound": 2e-13,
        "reason": stated(Cause.NOT_POSED, "10 x attainable; one rounding a step"),
        "attainable": 2e-14,
        "ratio": 165.0,
        "ratio_at": 6.5,
        "evaluations": 0,
        "seconds": 0.25,
        "provenance": {"scene": "digest", "versions": {"python": "3.12.1"}},
    }
    return row(verdict=status, **numbers | changed)


def passed(scene: str, rung: str, quantity: str, **changed: Any) -> Verdict:
    """A row with an error of 3 u at t = 7, a mean of 2 u, and 6 u attainable."""
    u = UNIT[rung]
    numbers: dict[str, Any] = {
        "max": 3 * u,
        "mean": 2 * u,
        "final": u,
        "bound": 60 * u,
        "attainable": 6 * u,
        "roundoff": u,
        "steps": 41,
        "evaluations": 410,
        "seconds": 0.25,
        "provenance": {**PROVENANCE, "scene": f"digest of {scene}"},
    }
    return row(scene=scene, rung=rung, quantity=quantity, **numbers | changed)


def unscored(scene: str, rung: str, quantity: str, status: Status, outcome: str) -> Verdict:
    """A row without a number, and the reason for it."""
    because = f"the reason why {scene} has no number"
    return Verdict(
        *(scene, "taylor", rung, "", quantity, status, outcome),
        reason=stated(Cause.NOT_POSED, because),
        provenance={**PROVENANCE, "scene": f"digest of {scene}"},
    )


NAN = {"max": math.nan, "mean": math.nan, "final": math.nan, "ratio": math.nan}


STOPPED = "stopped: a state or derivative was not finite"


MIXED = [
    *(passed("kirchhoff/screw", "f64", quantity) for quantity in ("impulse", "T", "F2", "y3")),
    *(passed("euler/generic", rung, q) for rung in ("mp237", "f64") for q in ("omega", "T")),
    unscored("euler/generic", "f80", "omega", Status.UNAVAILABLE, "not started"),
    unscored("euler/broken", "f64", "omega", Status.FAIL, STOPPED),
    passed("euler/lost", "f64", "omega", verdict=Status.FAIL, **NAN),
    passed("euler/lost", "f64", "T", verdict=Status.FAIL, **NAN),
    unscored("euler/vast", "f32", "omega", Status.REFUSED, "not started: out of range"),
    passed("euler/long", "f64", "omega", verdict=Status.VACUOUS, bound=3.0),
    passed("euler/long", "f64", "T", verdict=Status.FAIL, ratio=50.0, ratio_at=5.0),
]


RECORD = Record(
    scene="euler/generic",
    title="Free asymmetric body",
    solver="taylor",
    rung="f64",
    track=("omega",),
    equations=("H1' = H2 * w3",),
    parameters={"K11": "1.0"},
    units={"time": "1"},
    regime="max",
    route="arb",
    truth_digits=19,
    outcome="reached the last sample",
    steps=41,
    unit_roundoff=2.0**-53,
    times=(0.0, 0.1),
    gates=(GateRecord("omega", "max|omega|", (0.0, math.nan), (1e-300, math.inf), 5e-324),),
)


def by_quantity(judged: Any) -> dict[str, Verdict]:
    """The verdicts of a judgement by their quantities."""
    return {verdict.quantity: verdict for verdict in judged.verdicts}


# The published schema

SCHEMA = schema()


def violations(document: Any) -> list[str]:
    """The places where a document is not of the schema."""
    errors = Draft202012Validator(SCHEMA).iter_errors(document)
    return [f"{error.message} @ {error.json_path}" for error in errors]
