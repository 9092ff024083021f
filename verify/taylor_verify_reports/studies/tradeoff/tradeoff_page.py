"""The study of speed against accuracy: every setting on some scenes, timed in fresh processes."""

from __future__ import annotations

from collections.abc import Iterable
from math import isclose, log10
from pathlib import Path
from typing import Final

from taylor_verify.plotting.picture import Picture
from taylor_verify.records.precisions import place_of_rung
from taylor_verify.records.standing import Standing
from taylor_verify.tradeoff import work_precision
from taylor_verify.tradeoff.document import TradePoint
from taylor_verify.words.cells import NOTHING, figure
from taylor_verify.words.csv_sheet import sheet as csv_sheet
from taylor_verify.words.markdown import bold, bullets, code, prose, table
from taylor_verify.words.page_parts import whole
from taylor_verify_reports.studies import figures
from taylor_verify_reports.studies.study import Measured, Option, Progress, Study
from taylor_verify_reports.studies.tradeoff.peers import DIGITS, NOT_REACHED, TAYLOR, peer_sections
from taylor_verify_reports.studies.tradeoff.timing_method import (
    how_it_was_timed,
    remake,
    what_is_timed,
)
from taylor_verify_reports.studies.tradeoff.trades import (
    TimedPoint,
    Trade,
    Trades,
    cheapest,
    load,
    write,
)

_RIVALS: Final = ("scipy DOP853", "scipy LSODA", "scipy RK45", "scipy Radau", "scipy BDF")
_GEOMETRIC: Final = "geometric "
_ASKED: Final = (1e-3, 1e-6, 1e-9, 1e-12)

_WHAT: Final = (
    "This page compares all solvers on the same four scenes, at many settings, and each answer with "
    "the exact motion. A time is given as a multiple of that of the *yardstick*, the Taylor "
    "integrator of heyoka in float64 at its own tolerance, in the same minute on the same machine; "
    "the error is the largest of everything that the scene tracks, at all its samples."
)


def page(trades: Trades, folder: Path) -> str:
    """Return the whole page, with the pictures that are in ``folder``/figures."""
    return whole(
        "Speed against accuracy",
        _WHAT,
        "## What so many digits cost",
        "The cheapest measured setting whose error leaves at least this number of digits: its time "
        f"over that of the yardstick, the interval in brackets, and the tolerance. *{NOT_REACHED}* "
        "means that no measured setting leaves so many. A ratio below 1 is faster than the yardstick, "
        "whose digits are in the first line of each scene. If the intervals of neighbouring "
        "tolerances overlap, chance decides which one is the cheapest.",
        _by_digits(trades),
        "## Beside compiled integrators of other libraries",
        *peer_sections(trades),
        "## What a wider number costs",
        "Taylor at each rung's own tolerance: time over that in float64, and the digits that are "
        "left. *attainable* are the digits that would be left by rounding the state once for each "
        "sample.",
        _by_rung(trades),
        "## Asked for and achieved",
        "A tolerance bounds the solver's estimate of the error of one step, and not the error of the "
        "answer. The table has the digits that were left at each tolerance:",
        _by_request(trades),
        "## In pictures",
        "The thin line is the *front*: the settings that no other beats in both time and error.",
        *(figures.shown(folder, _of_trade(trade)) for trade in trades.short),
        "## Geometric integrators",
        "Fixed steps, in the scene's unit of time. They conserve their quantities to the last bits: "
        "all of them the momentum in space, the midpoint and Moser and Veselov's the energy too. With "
        "splitting the energy oscillates, with lie-rk4 it drifts. Conservation is no accuracy. "
        "*drift* is the largest of all conserved quantities, with its name.",
        _geometric(trades),
        "## What failed, and what was not run",
        "None of these is on a front, and none has a number above.",
        _failures(trades),
        "## What is timed",
        what_is_timed(),
        "## How it was timed, and where",
        bullets(how_it_was_timed(trades)),
        "## To remake this",
        remake(trades),
    )


def pictures(trades: Trades) -> list[Picture]:
    """Return the pictures of every short scene."""
    return [picture for trade in trades.short for picture in _of_trade(trade)]


def _of_trade(trade: Trade) -> list[Picture]:
    """Return the picture of error against time of one scene; none if no setting is sound.

    The other one, against evaluations, says the same of one machine: `tradeoff SCENE --out` draws it.
    """
    return work_precision.pictures(trade.document())[:1] if trade.sound else []


# The cost of digits.


def _by_digits(trades: Trades) -> str:
    columns = ["scene", "solver", *(f"{digits} digits:" for digits in DIGITS)]
    rows = []
    for trade in trades.short:
        yardstick = _yardstick(trade, trades.numbers.yardstick)
        rows.append([code(trade.scene), yardstick, *[""] * len(DIGITS)])
        ran = {p.family for p in trade.points if p.standing is not Standing.NOT_RUN}
        for family in (TAYLOR, *_RIVALS):
            if family in ran:
                own = [row for row in trade.sound if row.point.family == family]
                rows.append(["", _family(family), *(_cheapest(own, digits) for digits in DIGITS)])
    return table(columns, rows)


def _yardstick(trade: Trade, name: str) -> str:
    """Return the error of the yardstick on this scene, and its share in heyoka's compiled code."""
    row = next((row for row in trade.sound if row.point.label == name), None)
    if row is None:
        return f"*{prose(name)}*: no sound answer"
    inner, seconds = row.timing.inner_seconds, row.timing.seconds
    part = f", {inner / seconds:.0%} of its time in heyoka itself" if inner else ""
    return f"*{prose(name)} = 1*: {_digits(row.point)}{part}"


def _digits(point: TradePoint) -> str:
    """Return the digits that were left, or the word for all."""
    return "exact" if point.achieved_digits is None else f"{point.achieved_digits:.1f} digits"


def _cheapest(rows: Iterable[TimedPoint], digits: int) -> str:
    """Return ratio, interval and tolerance of the fastest setting that leaves these digits."""
    best = cheapest(rows, digits)
    if best is None:
        return NOT_REACHED
    is_tolerance = best.point.asked == "tolerance" and best.point.requested
    return f"{_ratio(best)}{f' @ {best.point.requested:.0e}' if is_tolerance else ''}"


def _ratio(row: TimedPoint) -> str:
    timing = row.timing
    interval = f" [{figure(timing.low)}, {figure(timing.high)}]" if timing.low is not None else ""
    return f"{bold(figure(timing.ratio))}{interval}"


# Rungs and requests.


def _by_rung(trades: Trades) -> str:
    rungs = {p.rung for p in trades.numbers.points if _is_own_tolerance(p)}
    ladder = sorted(rungs, key=place_of_rung)
    rows = []
    for trade in trades.short:
        own = {row.point.rung: row for row in trade.sound if _is_own_tolerance(row.point)}
        cells = [
            f"{_ratio(own[rung])}, {_digits(own[rung].point)}" if rung in own else NOTHING
            for rung in ladder
        ]
        rows.append([code(trade.scene), *cells])
        if floors := trade.about.attainable:
            least = [floors.get(rung) for rung in ladder]
            cells = [f"{-log10(e):.1f} digits" if e and e < 1 else NOTHING for e in least]
            rows.append(["*attainable*", *cells])
    return table(["scene", *(f"{rung}:" for rung in ladder)], rows)


def _is_own_tolerance(point: TradePoint) -> bool:
    """Return True for taylor at the tolerance of the rung."""
    return point.solver == "taylor" and not point.setting


def _by_request(trades: Trades) -> str:
    columns = ["scene", "solver", *(f"{-log10(asked):.0f} asked for:" for asked in _ASKED)]
    rows = []
    for trade in trades.short:
        for family in dict.fromkeys(p.family for p in trade.points if p.asked == "tolerance"):
            own = [p for p in trade.points if p.family == family]
            cells = [_achieved(own, asked) for asked in _ASKED]
            if any(cell != NOTHING for cell in cells):
                rows.append([code(trade.scene), _family(family), *cells])
    return table(columns, rows)


def _achieved(points: Iterable[TradePoint], asked: float) -> str:
    """Return the digits that were left, or a word for an answer that is not sound."""
    for p in points:
        if p.requested is not None and isclose(p.requested, asked):
            if p.standing is not Standing.SOUND:
                return p.standing.value
            return NOTHING if p.achieved_digits is None else f"{p.achieved_digits:.1f}"
    return NOTHING


# The geometric integrators, the failures.


def _geometric(trades: Trades) -> str:
    columns = ["scene", "integrator", "step:", "time:", "largest error:", "drift:", "of"]
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
        for trade in trades.trades
        for row in trade.sound
        if row.point.family.startswith(_GEOMETRIC)
    ]
    return table(columns, rows)


def _failures(trades: Trades) -> str:
    """Return a table of the points that are not sound, or were not timed in every process."""
    rows = []
    for trade in trades.trades:
        compared = [row.point for row in trade.sound]
        for p in trade.points:
            if p not in compared:
                is_sound = p.standing is Standing.SOUND
                standing = "sound, and not timed" if is_sound else prose(p.standing.value)
                rows.append([code(trade.scene), code(p.label), standing, prose(p.because)])
    columns = ["scene", "setting", "what it is", "because"]
    return table(columns, rows) if rows else "Nothing."


def _family(family: str) -> str:
    return prose(family.removesuffix(" f64").replace("scipy ", "SciPy "))


# The sheet.


_FIELDS: Final = (
    "scene",
    "solver",
    "setting",
    "rung",
    "family",
    "asked",
    "requested",
    "achieved_digits",
    "error",
    "drift",
    "drifting",
    "steps",
    "evaluations",
    "seconds",
    "inner_seconds",
    "ratio",
    "low",
    "high",
    "processes",
    "standing",
    "outcome",
    "because",
)


def sheet(trades: Trades) -> str:
    """Return a CSV row for every scene and setting, with every digit."""
    return csv_sheet(_FIELDS, (row for trade in trades.trades for row in trade.rows))


# The study.


def _measure(folder: Path, progress: Progress, outside: bool = False) -> Measured:
    from taylor_verify_reports.studies.tradeoff.measurement import measurement

    numbers, times = measurement(with_outside=outside, finished=progress.say)
    return Measured(write(folder, numbers, times))


STUDY: Final = Study(
    name="tradeoff",
    title="speed against accuracy, every solver, measured once",
    duration="minutes, a quiet machine; with --outside twenty",
    measure=_measure,
    find=load,
    page=page,
    sheet=sheet,
    draw=pictures,
    options=(
        Option(
            "outside",
            "also measure compiled integrators of other libraries, in turns with all others; each is "
            "downloaded first",
        ),
    ),
)
