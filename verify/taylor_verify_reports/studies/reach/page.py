"""Page of the reach of each precision, made from the stored measurement."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product, takewhile, zip_longest
from pathlib import Path
from typing import Any, Final

from taylor_verify.plotting.picture import Picture
from taylor_verify.words.cells import NOTHING, figure
from taylor_verify.words.markdown import bullets, prose, table
from taylor_verify.words.page import made_on, whole
from taylor_verify.words.sheet import sheet as csv_sheet
from taylor_verify_reports.studies import figures
from taylor_verify_reports.studies.reach import picture as digits_map
from taylor_verify_reports.studies.reach.document import ReachFamily, ReachRow, ReachStudy
from taylor_verify_reports.studies.reach.picture import ACHIEVED, ATTAINABLE, numbers_of
from taylor_verify_reports.studies.stored import Stored

REACH: Final = Stored(ReachStudy, "reach")
DIGITS: Final = (3, 6, 12)

# The numbers of periods that have a line in the tables.
_AFTER: Final = (1, 10, 100, 1000)
# Mark after the last value that was tried, beyond which the reach may extend.
_LAST: Final = " \N{RIGHTWARDS ARROW}"
_NOT_HELD, _NOT_RUN = "not held", "not run"
# The first word of a reason why a rung cannot represent an orbit.
_ROUNDED: Final = "rounded"

_WHAT: Final = (
    "This page shows how far each precision keeps 3, 6 or 12 digits: for long motions, near a "
    "separatrix, and for unlike moments of inertia. The Taylor integrator runs at the rung's own "
    "tolerance; the digits left after N periods are those of the largest error up to then, compared "
    "with the exact motion of the same rounded data. Beside them are the digits that perfect rounding "
    "would leave on the same orbit."
)
_LEGEND: Final = (
    "*3, 6, 12 digits* are the last values at which this number of digits is left, as at all easier "
    f"values; {_LAST.strip()} marks the last value that was tried: the reach may be longer. {NOTHING} "
    "means that there is no value.",
    "*attainable* has the same values for the judge's floor: the effect on the orbit of one rounding "
    "of every component in every step. It is a model of random roundings, and no bound.",
    f"*{_NOT_HELD}*: the numbers rounded to the rung belong to another orbit, whose period differs by "
    "more than a tenth or does not exist. The requested orbit is then out of reach of the rung. "
    f"*{_NOT_RUN}*: the machine does not have the rung, or its numbers cannot represent the scene.",
    "Periods are those of omega or of the impulses, and the instants are their quarters. Only omega "
    "or the impulses are compared, except in the family that names the attitude.",
)


def pictures(study: ReachStudy) -> list[Picture]:
    """Return a map of digits for every family that leads to a separatrix."""
    return [
        picture for family in study.families for picture in _maps(family, _rows_of(study, family))
    ]


def _maps(family: ReachFamily, rows: Sequence[ReachRow]) -> list[Picture]:
    return [digits_map.picture(family, rows)] if family.symbol == "d" else []


def page(study: ReachStudy, folder: Path) -> str:
    """Return the whole page, with the pictures that are in ``folder``/figures."""
    return whole(
        "How far each precision carries",
        _WHAT,
        bullets(_LEGEND),
        *(block for family in study.families for block in _section(study, family, folder)),
        "## How it was measured",
        bullets(_method(study)),
        "## To remake this",
        "`taylor-verify publish reach` repeats the measurement in some minutes, and writes "
        f"[reach.json](../{REACH.name}), this page and its pictures.",
    )


def _section(study: ReachStudy, family: ReachFamily, folder: Path) -> list[str]:
    rows = _rows_of(study, family)
    towards = f"; {family.symbol} leads to {family.extreme}" if family.symbol else ""
    blocks = [f"## {family.name}", prose(f"{family.title[0].upper()}{family.title[1:]}{towards}.")]
    if len(family.values) > 1:
        blocks += [figures.shown(folder, _maps(family, rows)), _by_value(family, rows)]
        blocks.append("Periods at which so many digits are left:")
    return [*blocks, _by_periods(family, rows)]


def _rows_of(study: ReachStudy, family: ReachFamily) -> list[ReachRow]:
    return [row for row in study.rows if row.family == family.name]


# The two questions.


def last_value(
    rows: Sequence[ReachRow], after: int, digits: int, key: str = ACHIEVED
) -> str | None:
    """Return the last value up to which ``digits`` are left after ``after`` periods; None if there is none.

    ``rows`` are those of one family on one rung, the easiest value first. ``key`` is ACHIEVED or
    ATTAINABLE.
    """
    precise = list(takewhile(lambda row: _keeps(row, after, digits, key), rows))
    return precise[-1].value if precise else None


def most_periods(row: ReachRow, digits: int, key: str = ACHIEVED) -> int | None:
    """Return the most periods after which ``digits`` are left; None if the fewest periods leave fewer."""
    precise = list(takewhile(lambda count: _keeps(row, count, digits, key), row.periods))
    return precise[-1] if precise else None


def _keeps(row: ReachRow, after: int, digits: int, key: str) -> bool:
    """Return True if the error after so many periods is a number and leaves so many digits."""
    error = dict(zip(row.periods, numbers_of(row, key), strict=False)).get(after)
    return error is not None and error <= 10.0**-digits


def _headings(what: str) -> list[str]:
    achieved = [f"{what}{n} digits:" for n in DIGITS]
    return [*achieved, *(f"attainable, {n}:" for n in DIGITS)]


def _by_value(family: ReachFamily, rows: Sequence[ReachRow]) -> str:
    lines = []
    for rung in family.rungs:
        own = [row for row in rows if row.rung == rung]
        for after in _AFTER:
            if any(after in row.periods for row in own):
                blocks = product((ACHIEVED, ATTAINABLE), DIGITS)
                values = (last_value(own, after, n, key) for key, n in blocks)
                lines.append([rung, str(after), *(cell(v, family.values[-1]) for v in values)])
    return table(["rung", "periods:", *_headings(f"{family.symbol}, ")], lines)


def cell(value: str | int | None, last: str | int) -> str:
    """Return the value as a cell, with a mark if it is the ``last`` that was tried."""
    if value is None:
        return NOTHING
    return f"{value}{_LAST}" if value == last else str(value)


def _by_periods(family: ReachFamily, rows: Sequence[ReachRow]) -> str:
    """Return a table of periods: a line for each value, or for each rung of a family of one value."""
    by_place = {(row.value, row.rung): row for row in rows}
    lines = []
    if len(family.values) == 1:
        for rung in family.rungs:
            row = by_place[family.values[0], rung]
            lines.append([rung, *_periods(row, ACHIEVED), *_periods(row, ATTAINABLE)])
        return table(["rung", *_headings("")], lines)
    for value in family.values:
        own = [by_place[value, rung] for rung in family.rungs]
        cells = [_periods(row, ACHIEVED) if row.errors else [_nothing(row)] for row in own]
        lines.append([value, *map(", ".join, cells)])
    return table([f"{family.symbol}:", *(f"{r}: 3, 6, 12:" for r in family.rungs)], lines)


def _periods(row: ReachRow, key: str) -> list[str]:
    """Return the most periods for each number of digits."""
    if not numbers_of(row, key):
        return [_nothing(row)] * len(DIGITS)
    return [cell(most_periods(row, n, key), row.periods[-1]) for n in DIGITS]


def _nothing(row: ReachRow) -> str:
    """Return the reason why there is no number."""
    return _NOT_HELD if row.why.startswith(_ROUNDED) else _NOT_RUN


def _over_attainable(rows: Sequence[ReachRow]) -> str:
    """Return the errors over the floors that leave a digit, in words."""
    ratios = sorted(
        error / least
        for row in rows
        for error, least in zip(row.errors, row.floors, strict=False)
        if error is not None and least and least <= 0.1
    )
    if not ratios:
        return "No error was compared with a floor."
    return (
        f"Error over attainable, if the attainable error leaves a digit: {figure(ratios[-1])} at most, "
        f"with a median of {figure(ratios[len(ratios) // 2])} over {len(ratios)} errors."
    )


def _method(study: ReachStudy) -> list[str]:
    rows = study.rows
    lost = sum(bool(row.errors) and row.errors[-1] is None for row in rows)
    blurred = sum(row.why.startswith(_ROUNDED) for row in rows)
    # A run that ended early has no number, like one that was lost.
    stopped = [row for row in rows if row.errors and row.why]
    return [
        f"{len(rows)} runs: one for each value of a family and each rung. An error of {study.lost:g} "
        "is the size of the motion. A run that reaches this error within its first period is not "
        f"continued, and the steps for its floor are extrapolated in proportion. {lost} runs were "
        f"lost; in {blurred} runs the rung could not represent the value.",
        "Wider rungs are run for fewer periods, because a period takes hundreds of times as long on "
        "f128 as on f64.",
        _over_attainable(rows),
        *(f"{r.family} {r.value}, {r.rung}: {prose(r.why)}. It counts as lost." for r in stopped),
        made_on(study.provenance),
    ]


# The sheet.


_SHEET: Final = (
    "family",
    "value",
    "rung",
    "periods",
    "error",
    "attainable",
    "lost",
    "steps",
    "why",
)


def sheet(study: ReachStudy) -> str:
    """Return a row for every number of periods, or one row with the reason if nothing was run."""
    return csv_sheet(_SHEET, (line for row in study.rows for line in _reached(row)))


def _reached(row: ReachRow) -> Iterator[dict[str, Any]]:
    """Yield the rows of a run. A missing error means that the motion was lost."""
    own = {name: getattr(row, name) for name in ("family", "value", "rung", "steps", "why")}
    if not row.errors:
        yield own
        return
    for periods, error, floor in zip_longest(row.periods, row.errors, row.floors):
        lost = "yes" if error is None else "no"
        yield {**own, "periods": periods, "error": error, "attainable": floor, "lost": lost}
