"""A stored study of reach: one family of three values on two rungs."""

from __future__ import annotations

from taylor_verify.records.provenance import SceneProvenance
from taylor_verify_reports.studies.reach import page as page
from taylor_verify_reports.studies.reach.document import ReachFamily, ReachRow, ReachStudy


def row(value: str, name: str, *errors: float | None, why: str = "") -> ReachRow:
    """A stored row; the floor is a tenth of the error."""
    floors = tuple(None if error is None else error / 10 for error in errors)
    return ReachRow("axis", value, name, (1, 10, 100), errors, floors, 9, why)


VALUES = ("1e-1", "1e-2", "1e-3")

AXIS = ReachFamily(
    "axis", "a body beside something", "d", "something", VALUES, {"f32": 100, "f64": 100}
)


def study() -> ReachStudy:
    """One family of three values on two rungs, with everything that a table has to tell."""
    rows = (
        row("1e-1", "f32", 1e-6, 1e-4, 1e-2),
        row("1e-2", "f32", 1e-3, 0.5, None, why="the run stopped: too many steps"),
        row("1e-3", "f32", why="rounded to f32, it is another orbit"),
        row("1e-1", "f64", 1e-14, 1e-13, 1e-12),
        row("1e-2", "f64", 1e-13, 1e-11, 1e-9),
        row("1e-3", "f64", 1e-12, 1e-8, 0.0),
    )
    return ReachStudy((AXIS,), rows, 1.0, SceneProvenance({"heyoka": "7"}, "some", "publish"))
