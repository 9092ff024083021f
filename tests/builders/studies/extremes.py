"""A stored study of extremes: a verdict of each kind, one of them not as expected."""

from __future__ import annotations

from builders.verdicts import NAN, VERSIONS, passed
from taylor_verify.records.answers import LeftOut
from taylor_verify.records.provenance import Machine
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify_reports.studies.extremes.document import (
    Expected,
    ExtremesStudy,
    ExtremeVerdict,
    Titled,
)

WHY = "one roundoff grows to the size of the motion"
VACUOUS = passed("extremes/long", "f64", "omega", verdict=Status.VACUOUS, bound=3.0)
SOUND = passed("extremes/near", "f64", "omega")
DRIFT = passed("extremes/near", "f64", "T", ratio=0.75)
LOST = passed("extremes/vast", "f64", "impulse", verdict=Status.FAIL, **dict.fromkeys(NAN))
ALL = (VACUOUS, SOUND, DRIFT, LOST)

FORESEEN = {
    ("extremes/long", "f64", "omega"): Expected(Status.VACUOUS, WHY),
    ("extremes/near", "f64", "omega"): Expected(Status.PASS, ""),
    ("extremes/near", "f64", "T"): Expected(Status.PASS, ""),
    ("extremes/vast", "f64", "impulse"): Expected(Status.REFUSED, "out of range"),
}

MISMATCH = "expected refused (out of range), got fail @ extremes/vast f64 impulse"
KNOWN = {name: version for name, version in VERSIONS.items() if name != "python"}
MACHINE = Machine(python="3.12.1", processor="A chip", command="taylor-verify run")


def study(
    verdicts: tuple[Verdict, ...] = ALL, mismatches: tuple[str, ...] = (MISMATCH,)
) -> ExtremesStudy:
    scenes = dict.fromkeys(verdict.scene for verdict in verdicts)
    return ExtremesStudy(
        versions=KNOWN,
        machine=MACHINE,
        scenes=tuple(Titled(scene, f"Title of {scene}") for scene in scenes),
        left_out=(LeftOut("extremes/endless", "mp237", "it takes a week"),),
        mismatches=mismatches,
        verdicts=tuple(
            ExtremeVerdict.of(v, FORESEEN.get((v.scene, v.rung, v.quantity))) for v in verdicts
        ),
    )
