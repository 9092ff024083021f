"""A catch of the hunt for the worst, of any ratio."""

from __future__ import annotations

from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.studies.worst.measure import Catch, Family, FamilyResult


def verdict(ratio: float | None, status: Status = Status.PASS) -> Verdict:
    return Verdict("here", "taylor", "f64", "", "omega", status, "reached", ratio=ratio)


def worst_of(name: str, ratio: float) -> FamilyResult:
    family = Family(name, "things", 1, lambda place: f'title = "{place[0]}"\n')
    return FamilyResult(family, 7, Catch((0.25,), verdict(ratio)))
