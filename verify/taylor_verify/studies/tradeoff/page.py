"""The page of speed against accuracy, from the stored measurement alone."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import log10
from pathlib import Path
from typing import Final

from taylor_verify.publish.cells import NOTHING, figure
from taylor_verify.publish.markdown import bold, bullets, code, prose, table
from taylor_verify.publish.page import whole
from taylor_verify.publish.pictures.picture import Picture
from taylor_verify.publish.pictures.ratio import Ratio
from taylor_verify.publish.sheet import sheet as csv_sheet
from taylor_verify.records.standing import Standing
from taylor_verify.studies import figures
from taylor_verify.studies.tradeoff.document import TradePoint
from taylor_verify.studies.tradeoff.doubles_table import doubles_table
from taylor_verify.studies.tradeoff.pictures import time_by_rung
from taylor_verify.studies.tradeoff.pictures import trade as of_one_scene
from taylor_verify.studies.tradeoff.stored import TimedPoint, Trade, Trades
from taylor_verify.studies.tradeoff.timing_method import how_it_was_timed, remake, what_is_timed

DIGITS: Final = (6, 9, 12)
_NOT_REACHED: Final = "not reached"
_TAYLOR: Final = "taylor f64"
_RIVALS: Final = ("scipy DOP853", "scipy LSODA", "scipy RK45", "scipy Radau", "scipy BDF")
_OUTSIDE: Final = "outside"
_GEOMETRIC: Final = "geometric "
_CLOSED_FORM: Final = "closed-form ellipj"
_ASKED: Final = (1e-3, 1e-6, 1e-9, 1e-12)

_WHAT: Final = (
    "Every solver on the same four scenes, each at many settings, each answer compared with the exact "
    "motion. A time is given as a multiple of that of the *yardstick*, the Taylor integrator of "
    "heyoka in float64 at its own tolerance, in the same minute on the same machine; the error is "
    "the largest of everything that the scene tracks, at all its samples."
)


def page(found: Trades, folder: Path) -> str:
    """The whole page, with the pictures that are in ``folder``/figures."""
    return whole(
        "Speed against accuracy",
        _WHAT,
        "## What so many digits cost",
        "The cheapest measured setting whose error leaves at least so many digits: its time over that "
        f"of the yardstick, the interval for it in brackets, and the tolerance. *{_NOT_REACHED}* is "
        "said where no measured setting leaves so many. Below 1 is faster than the yardstick, which "
        "leaves the digits that the first line of each scene says. Where the intervals of neighbouring "
        "tolerances overlap, which of them is the cheapest is chance.",
        _by_digits(found),
        "## What a wider number costs",
        "Taylor at each rung's own tolerance: time over that in float64, and the digits that are left. "
        "*attainable* are those that rounding the state once a sample, and nothing else, would leave.",
        _by_rung(found),
        figures.shown(folder, _of_rungs(found.trades)),
        "## Asked for and achieved",
        "A tolerance bounds the error of one step, or what the solver takes for it, and promises "
        "nothing of the answer. The digits that were left at each:",
        _by_request(found),
        "## In pictures",
        *(figures.shown(folder, _of_trade(one)) for one in found.trades),
        "## The front",
        "The settings in float64 that no other beats in both time and error, the fastest first.",
        *(_front(trade) for trade in found.trades),
        "## Geometric integrators",
        "Fixed steps, in the scene's unit of time. They keep what they promise, to the last bits: all of "
        "them the momentum in space, the midpoint and Moser and Veselov's the energy too, which "
        "splitting lets swing and lie-rk4 drift. That is no accuracy. *drift* is the largest of all "
        "conserved quantities, with its name.",
        _geometric(found),
        "## What failed, and what was not run",
        "None of these is on a front, and none has a number above.",
        _failures(found),
        "## The closed form in plain doubles",
        doubles_table(found.numbers.plain_doubles),
        "## What is timed",
        what_is_timed(),
        "## How it was timed, and where",
        bullets(how_it_was_timed(found)),
        "## To remake this",
        remake(found),
    )


def pictures(found: Trades) -> list[Picture]:
    """Return the pictures of every scene, and that of all rungs."""
    return [*(one for trade in found.trades for one in _of_trade(trade)), *_of_rungs(found.trades)]


def _of_trade(found: Trade) -> list[Picture]:
    """Error against time, evaluations and steps, and the digits asked for and left, of one scene."""
    return of_one_scene.pictures(found.document()) if found.sound else []


def _of_rungs(found: Sequence[Trade]) -> list[Picture]:
    """Taylor's time at each rung's own tolerance, a line for each scene."""
    rows = [
        Ratio(one.scene, row.point.rung, row.timing.ratio, row.timing.low, row.timing.high)
        for one in found
        for row in one.sound
        if row.point.solver == "taylor"
    ]
    return [time_by_rung.picture("published", rows)] if rows else []


# What so many digits cost.


def _by_digits(found: Trades) -> str:
    columns = ["scene", "solver", *(f"{digits} digits:" for digits in DIGITS)]
    rows = []
    for trade in found.trades:
        rows.append(
            [code(trade.scene), _yardstick(trade, found.numbers.yardstick), *[""] * len(DIGITS)]
        )
        for family in (_TAYLOR, *_RIVALS, _CLOSED_FORM):
            own = [row for row in trade.sound if row.point.family == family]
            if any(p.family == family and _ran(p) for p in trade.points):
                cells = [_cheapest(own, digits) for digits in DIGITS]
                rows.append(["", _family(family), *cells])
        rows.append(["", *_outside(trade)])
    return table(columns, rows)


def _yardstick(trade: Trade, name: str) -> str:
    """Return what the yardstick leaves on this scene, and its own part in heyoka's compiled code."""
    for row in trade.sound:
        if row.point.label == name:
            inner, seconds = row.timing.inner_seconds, row.timing.seconds
            part = f", {inner / seconds:.0%} of its time in heyoka itself" if inner else ""
            achieved = row.point.achieved_digits
            digits = f"{achieved:.1f} digits" if achieved else "exact"
            return f"*{prose(name)} = 1*: {digits}{part}"
    return f"*{prose(name)}*: no sound answer"


def _cheapest(rows: Iterable[TimedPoint], digits: int, named: bool = False) -> str:
    """Return ratio, interval and tolerance of the fastest that leaves so many digits."""
    reached = [row for row in rows if row.error <= 10.0**-digits]
    if not reached:
        return _NOT_REACHED
    best = min(reached, key=lambda row: row.timing.ratio)
    who = f"{_family(best.point.family)}, " if named else ""
    return f"{who}{_ratio(best)}{_at(best)}"


def _ratio(row: TimedPoint) -> str:
    timing = row.timing
    interval = f" [{figure(timing.low)}, {figure(timing.high)}]" if timing.low is not None else ""
    return f"{bold(figure(timing.ratio))}{interval}"


def _at(row: TimedPoint) -> str:
    asked = row.point.requested
    return f" @ {asked:.0e}" if row.point.asked == "tolerance" and asked else ""


def _outside(trade: Trade) -> list[str]:
    own = [row for row in trade.sound if row.point.family.startswith(_OUTSIDE)]
    if not own:
        return ["fastest compiled other library", *["not measured"] * len(DIGITS)]
    return [
        "fastest compiled other library",
        *(_cheapest(own, digits, named=True) for digits in DIGITS),
    ]


# Rungs and requests.


def _by_rung(found: Trades) -> str:
    rungs = dict.fromkeys(
        p.rung for trade in found.trades for p in trade.points if _is_own_tolerance(p)
    )
    ladder = sorted(rungs, key=lambda rung: (rung.startswith("mp"), int(rung.lstrip("fmp"))))
    columns = ["scene", *(f"{rung}:" for rung in ladder)]
    rows = []
    for trade in found.trades:
        own = {row.point.rung: row for row in trade.sound if _is_own_tolerance(row.point)}
        cells = [_rung_cell(own[rung]) if rung in own else NOTHING for rung in ladder]
        rows.append([code(trade.scene), *cells])
        if floors := trade.about.attainable:
            rows.append(["*attainable*", *(_floor_cell(floors.get(rung)) for rung in ladder)])
    return table(columns, rows)


def _floor_cell(least: float | None) -> str:
    """Return the digits that one rounding a sample leaves."""
    return f"{-log10(least):.1f} digits" if least and least < 1 else NOTHING


def _is_own_tolerance(point: TradePoint) -> bool:
    return point.solver == "taylor" and not point.setting


def _rung_cell(row: TimedPoint) -> str:
    digits = row.point.achieved_digits
    return f"{_ratio(row)}, {'exact' if digits is None else f'{digits:.1f} digits'}"


def _by_request(found: Trades) -> str:
    columns = ["scene", "solver", *(f"{-log10(asked):.0f} asked for:" for asked in _ASKED)]
    rows = []
    for trade in found.trades:
        families = dict.fromkeys(p.family for p in trade.points if p.asked == "tolerance")
        for family in families:
            own = [p for p in trade.points if p.family == family]
            cells = [_achieved(own, asked) for asked in _ASKED]
            if any(cell != NOTHING for cell in cells):
                rows.append([code(trade.scene), _family(family), *cells])
    return table(columns, rows)


def _achieved(points: Iterable[TradePoint], asked: float) -> str:
    """Return the digits that were left; a word where the answer is not sound."""
    for p in points:
        if p.requested is not None and abs(p.requested / asked - 1) <= 1e-9:
            if p.standing is not Standing.SOUND:
                return p.standing.value
            return NOTHING if p.achieved_digits is None else f"{p.achieved_digits:.1f}"
    return NOTHING


# The front, the geometric integrators, the failures.


def front(rows: Iterable[TimedPoint]) -> list[TimedPoint]:
    """Return what no other beats in both ratio and error, the fastest first."""
    found: list[TimedPoint] = []
    for row in sorted(rows, key=lambda row: (row.timing.ratio, row.error)):
        if not found or row.error < found[-1].error:
            found.append(row)
    return found


def _front(trade: Trade) -> str:
    doubles = [row for row in trade.sound if row.point.rung == "f64"]
    integrators = [row for row in doubles if row.point.family != _CLOSED_FORM]
    said = [_front_line(row) for row in front(doubles)]
    parts = [f"{code(trade.scene)}:", bullets(said)]
    if len(integrators) != len(doubles):
        parts += ["And of the integrators alone:", bullets(map(_front_line, front(integrators)))]
    return "\n\n".join(parts)


def _front_line(row: TimedPoint) -> str:
    digits = row.point.achieved_digits
    left = "every digit" if digits is None else f"{digits:.1f} digits"
    name = code(row.point.label.removesuffix(f" {row.point.rung}"))
    return f"{left}: {name}, {_ratio(row)} times the yardstick"


def _geometric(found: Trades) -> str:
    numbers = ("step:", "time:", "largest error:", "drift:")
    columns = ["scene", "integrator", *numbers, "of"]
    rows = [
        [
            code(trade.scene),
            row.point.family.removeprefix(_GEOMETRIC),
            figure(row.point.requested),
            _ratio(row),
            figure(row.point.error),
            figure(row.point.drift),
            code(row.point.drifting),
        ]
        for trade in found.trades
        for row in trade.sound
        if row.point.family.startswith(_GEOMETRIC)
    ]
    return table(columns, rows)


def _failures(found: Trades) -> str:
    columns = ["scene", "setting", "what it is", "because"]
    rows = [
        [code(trade.scene), code(p.label), prose(_standing(p)), prose(p.because)]
        for trade in found.trades
        for p in trade.uncompared
    ]
    return table(columns, rows) if rows else "Nothing."


def _standing(point: TradePoint) -> str:
    is_sound = point.standing is Standing.SOUND
    return "sound, and not timed" if is_sound else point.standing.value


def _ran(point: TradePoint) -> bool:
    return point.standing is not Standing.NOT_RUN


def _family(family: str) -> str:
    return prose(family.removesuffix(" f64").replace("scipy ", "SciPy "))


# The sheet.


_FIELDS: Final = (
    *("scene", "solver", "setting", "rung", "family", "asked", "requested", "achieved_digits"),
    *("error", "drift", "drifting", "steps", "evaluations", "seconds", "inner_seconds"),
    *("ratio", "low", "high", "processes", "standing", "outcome", "because"),
)


def sheet(found: Trades) -> str:
    """A row for every scene and setting, with every digit."""
    return csv_sheet(_FIELDS, (row for trade in found.trades for row in trade.rows))
