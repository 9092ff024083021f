"""A result of the search for the worst scene, of any ratio."""

from __future__ import annotations

from decimal import Decimal

from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.scenes.families.draw import Draw
from taylor_verify.scenes.families.family import Family, Variable
from taylor_verify_reports.studies.worst.measure import Candidate, FamilyResult, SearchedFamily


def verdict(ratio: float | None, status: Status = Status.PASS) -> Verdict:
    return Verdict("here", "taylor", "f64", "", "omega", status, "reached", ratio=ratio)


def searched_family(name: str, free: int = 1) -> SearchedFamily:
    """A family of so many free numbers."""
    variables = tuple(
        Variable(f"x{k}", Draw("uniform", (Decimal(0), Decimal(1)), 6)) for k in range(free)
    )
    return SearchedFamily(Family(name, "things", ('title = "', 0, '"\n'), variables), "things")


def worst_of(name: str, ratio: float) -> FamilyResult:
    return FamilyResult(searched_family(name), 7, Candidate((0.25,), verdict(ratio)))
