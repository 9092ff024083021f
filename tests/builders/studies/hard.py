"""A stored study of hard scenes: a verdict of each kind, two worst scenes, and one family on two rungs."""

from __future__ import annotations

from decimal import Decimal

from builders.verdicts import NAN, VERSIONS, passed
from taylor_verify.records.answers import LeftOut
from taylor_verify.records.provenance import Machine, Provenance
from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.families.distributions import Draw
from taylor_verify.scenes.families.family import Family, Variable
from taylor_verify_reports.studies.hard.hard_scenes import (
    Expected,
    HardStudy,
    ReachFamily,
    ReachRow,
    Search,
    Titled,
)
from taylor_verify_reports.studies.hard.search import Candidate, Found

WHY = "one roundoff grows to the size of the motion"
VACUOUS = passed("extremes/long", "f64", "omega", verdict=Status.VACUOUS, bound=3.0)
SOUND = passed("extremes/near", "f64", "omega")
DRIFT = passed("extremes/near", "f64", "T", ratio=0.75)
LOST = passed("extremes/vast", "f64", "impulse", verdict=Status.FAIL, **dict.fromkeys(NAN))
ALL = (VACUOUS, SOUND, DRIFT, LOST)

FORESEEN = (
    Expected("extremes/long", "f64", "omega", Status.VACUOUS, WHY),
    Expected("extremes/vast", "f64", "impulse", Status.REFUSED, "out of range"),
)

MISMATCH = "expected refused (out of range), got fail @ extremes/vast f64 impulse"
KNOWN = {name: version for name, version in VERSIONS.items() if name != "python"}
MACHINE = Machine(python="3.12.1", processor="A chip", command="taylor-verify run")

VALUES = ("1e-1", "1e-2", "1e-3")
AXIS = ReachFamily("axis", "a body beside something", "d", VALUES, {"f32": 100, "f64": 100})


def row(value: str, name: str, *errors: float | None, why: str = "") -> ReachRow:
    """A stored row; the floor is a tenth of the error."""
    floors = tuple(None if error is None else error / 10 for error in errors)
    return ReachRow("axis", value, name, (1, 10, 100), errors, floors, 9, why)


REACH = (
    row("1e-1", "f32", 1e-6, 1e-4, 1e-2),
    row("1e-2", "f32", 1e-3, 0.5, None, why="the run stopped: too many steps"),
    row("1e-3", "f32", why="rounded to f32, it is another orbit"),
    row("1e-1", "f64", 1e-14, 1e-13, 1e-12),
    row("1e-2", "f64", 1e-13, 1e-11, 1e-9),
    row("1e-3", "f64", 1e-12, 1e-8, 0.0),
)


def verdict(ratio: float | None, status: Status = Status.PASS) -> Verdict:
    return Verdict("here", "taylor", "f64", "", "omega", status, "reached", ratio=ratio)


def searched_family(name: str, free: int = 1) -> Family:
    """A family of so many free numbers."""
    variables = tuple(
        Variable(f"x{k}", Draw("uniform", (Decimal(0), Decimal(1)), 6)) for k in range(free)
    )
    return Family(name, "things", ('title = "', 0, '"\n'), variables)


def worst_of(name: str, ratio: float) -> Found:
    return Found(searched_family(name), "things", 7, Candidate((0.25,), verdict(ratio)))


def study(
    verdicts: tuple[Verdict, ...] = ALL, mismatches: tuple[str, ...] = (MISMATCH,)
) -> HardStudy:
    scenes = dict.fromkeys(verdict.scene for verdict in verdicts)
    return HardStudy(
        versions=KNOWN,
        machine=MACHINE,
        scenes=tuple(Titled(scene, f"Title of {scene}") for scene in scenes),
        left_out=(LeftOut("extremes/endless", "mp237", "it takes a week"),),
        expected=FORESEEN,
        mismatches=mismatches,
        families=(AXIS,),
        reach=REACH,
        verdicts=verdicts,
        search=Search("f64", 60, 3, Provenance()),
        worst=tuple(worst_of(f"euler-{name}", r).row() for name, r in (("a", 1.5), ("b", 2.5))),
    )
