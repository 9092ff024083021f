"""The page of attainable and reached errors: every error in its cell, every failure in words."""

from __future__ import annotations

import csv

import pytest
from builders.verdicts import MIXED, NAN, STOPPED, UNIT, passed, unscored

from taylor_verify.records.status import Status
from taylor_verify.records.verdict import Verdict
from taylor_verify.report import csv_tables as sheets
from taylor_verify.report.attainable import attainable

u = UNIT["f64"]
# As a NaN is stored.
LOST = dict.fromkeys(NAN)


def rows(text: str) -> dict[str, list[str]]:
    """The lines of all tables by their first cell."""
    lines = (line for line in text.splitlines() if line.startswith("| "))
    cells = ([cell.strip() for cell in line.strip("|").split(" | ")] for line in lines)
    return {row[0].strip("`"): row for row in cells}


def test_a_cell_has_both_errors_and_where_they_are_nearest() -> None:
    """A cell has the reached error, the attainable one at its time, and the largest ratio with its time."""
    verdict = passed("euler/a", "f64", "omega", max=3 * u, attainable=6 * u, ratio=0.75, ratio_at=2)
    text = attainable([verdict])
    assert rows(text)["euler/a"] == ["`euler/a`", "`omega`", "3.33e-16, 6.66e-16, 0.750 @ 2"]


@pytest.mark.parametrize(
    ("verdict", "cell"),
    [
        (passed("a", "f64", "omega", max=0.0, ratio=0.0), "0, 6.66e-16"),
        (passed("a", "f64", "omega", verdict=Status.FAIL, **LOST), "**fail**"),
        (unscored("a", "f64", "omega", Status.FAIL, STOPPED), f"**{STOPPED}**"),
        (unscored("a", "f64", "omega", Status.UNAVAILABLE, "not started"), "**unavailable**"),
        (
            passed("a", "f64", "omega", verdict=Status.FAIL, max=90 * u, ratio=15.0, ratio_at=4),
            "9.99e-15, 6.66e-16, 15.0 @ 4 **fail**",
        ),
        (
            passed("a", "f64", "omega", verdict=Status.FAIL, attainable=0.0, ratio=None),
            "3.33e-16, 0, ∞ @ 7 **fail**",
        ),
    ],
)
def test_a_failure_is_printed_in_its_cell(verdict: Verdict, cell: str) -> None:
    """A run that failed, stopped, was lost or never began has a word in its cell, and no number."""
    assert rows(attainable([verdict]))["a"][-1] == cell


def test_a_rung_has_a_column_and_a_line() -> None:
    """Each scene has a cell for each rung, empty where it has no run; each rung its worst, named."""
    text = attainable(
        [
            *(passed(f"euler/{n}", "f64", "omega", ratio=r) for n, r in (("a", 0.5), ("b", 3.0))),
            passed("euler/a", "mp237", "omega", ratio=1.0),
            passed("euler/a", "mp237", "T", ratio=9.0),
        ]
    )
    cells = rows(text)
    assert cells["f64"] == [
        "f64",
        "1.11e-16",
        "2",
        "1.75",
        "1 of 2",
        "3.00",
        "`omega` of `euler/b` at t = 7",
    ]
    # The drift of a conserved quantity is no error of the state.
    assert cells["mp237"][2:6] == ["1", "1.00", "1 of 1", "1.00"]
    assert cells["euler/b"][2:] == ["3.33e-16, 6.66e-16, 3.00 @ 7", "–"]  # noqa: RUF001


def test_an_error_that_is_no_number_is_the_worst_of_its_rung() -> None:
    """NaN counts as larger than every number, so that the median may be infinite."""
    lost = passed("euler/lost", "f64", "omega", verdict=Status.FAIL, **LOST)
    cells = rows(attainable([lost, passed("euler/a", "f64", "omega", ratio=0.5)]))
    assert cells["f64"][3:] == ["**∞**", "1 of 2", "**fail**", "`omega` of `euler/lost` at t = 7"]


def test_the_sheet_has_every_digit() -> None:
    """The sheet has a row for every state quantity, and attainable times ratio bounds the error."""
    text = sheets.attainable(MIXED)
    lines = list(csv.DictReader(text.splitlines()))
    assert len(lines) == sum(v.quantity in ("omega", "impulse") for v in MIXED)
    generic = next(r for r in lines if (r["scene"], r["rung"]) == ("euler/generic", "f64"))
    assert (float(generic["max"]), float(generic["attainable"])) == (3 * u, 6 * u)
    assert (generic["max_u"], generic["attainable_u"]) == ("3.0", "6.0")
