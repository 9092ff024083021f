"""Tables of the paper: as many columns and rows as fit a page, each with a caption."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

from taylor_verify.records import store
from taylor_verify.records.standing import Standing
from taylor_verify.report.index_page import BY_RUNG, by_rung
from taylor_verify.words.cells import NOTHING, figure
from taylor_verify.words.csv_sheet import sheet
from taylor_verify.words.markdown import code, plain, prose, table
from taylor_verify_reports.studies.accuracy import quoted
from taylor_verify_reports.studies.controls import controls_page
from taylor_verify_reports.studies.controls.sight import CONTROLS
from taylor_verify_reports.studies.engines import document as engines
from taylor_verify_reports.studies.engines import page as engines_page
from taylor_verify_reports.studies.hard import hard_page, picture
from taylor_verify_reports.studies.hard.hard_scenes import HARD
from taylor_verify_reports.studies.paper.paper_findings import REACHED
from taylor_verify_reports.studies.paper.sources import Sources
from taylor_verify_reports.studies.tradeoff import trades as tradeoff
from taylor_verify_reports.studies.tradeoff.peers import (
    DIGITS,
    NOT_REACHED,
    OUTSIDE,
    TAYLOR,
    TITLES,
)
from taylor_verify_reports.studies.tradeoff.trades import Trade, cheapest

VERDICTS: Final = (f"{store.FOLDER}/{store.VERDICTS}",)
ENGINES: Final = (engines.ENGINES.name, engines.TIMINGS.name)
TRADEOFF: Final = (tradeoff.NUMBERS.name, tradeoff.TIMINGS.name)


@dataclass(frozen=True)
class Caption:
    """A sentence in Markdown on the subject, the files of data, and the processor."""

    words: str
    data: tuple[str, ...]
    machine: str

    @property
    def markdown(self) -> str:
        """The whole caption."""
        files = ", ".join(map(code, self.data))
        return f"{self.words} Data: {files}. Machine: {prose(self.machine) or 'unknown'}."


_RIVALS: Final = ("scipy DOP853", "scipy LSODA", "scipy RK45", "scipy Radau")


@dataclass(frozen=True)
class Table:
    """Headings and rows in Markdown; the heading of a column of numbers ends with a colon."""

    name: str
    headings: Sequence[str]
    rows: Sequence[Sequence[str]]
    caption: Caption

    @property
    def markdown(self) -> str:
        """The table with its caption."""
        return f"{table(self.headings, self.rows)}\n\n: {self.caption.markdown}\n"

    @property
    def csv(self) -> str:
        """The cells as CSV."""
        names = [heading.removesuffix(":") for heading in self.headings]
        rows = (dict(zip(names, map(plain, row), strict=True)) for row in self.rows)
        return sheet(names, rows)


def tables(sources: Sources) -> list[Table]:
    """Return all tables, in the order of the paper."""
    return [make(sources) for make in (_controls, _precisions, _scenes, _engines, _reach, _trade)]


def _controls(sources: Sources) -> Table:
    study = sources.controls
    words = (
        "Solvers that were broken on purpose, one thing in each, as three kinds of gates see them: the "
        "largest error over its bound, or *not seen* where the gate passes the defect."
    )
    caption = Caption(words, (CONTROLS.name,), study.machine.processor)
    return Table("controls", controls_page.SHORT, controls_page.short_rows(study), caption)


def _precisions(sources: Sources) -> Table:
    words = (
        "The Taylor integrator on the standard set in each number format: unit roundoff $u$, runs, runs "
        "all of whose comparisons pass, median and largest error of the state in units of $u$, and the "
        "largest error over the floor."
    )
    headings = ["format", *BY_RUNG[1:-2], "over floor:"]
    rows = [row[:-1] for row in by_rung(sources.runs)]
    return Table("precisions", headings, rows, Caption(words, VERDICTS, sources.processors))


def _scenes(sources: Sources) -> Table:
    words = (
        "Largest error over all samples of some scenes, in units of the format's roundoff $u$, and in "
        "brackets over the floor. The flip of the tennis racket costs as much in every format: that is the "
        "orbit, not the solver."
    )
    headings, rows = quoted.chosen(sources.verdicts)
    bare = [[cell.replace(" u (", " (") for cell in row] for row in rows]
    headings = [headings[0], "quantity", *headings[2:]]
    return Table("scenes", headings, bare, Caption(words, VERDICTS, sources.processors))


def _engines(sources: Sources) -> Table:
    words = (
        f"Free rotation from an oblique attitude ({code(sources.engine_scene)}): each engine, and in "
        "italics plain solvers, with the best of their settings. *omega* is relative, *attitude* an angle "
        "in radians, *energy* the relative drift, each the largest of all samples; *order* is observed, of "
        "omega and attitude; *time* is that of a second of the motion."
    )
    board, rows = sources.board, []
    for best in sources.best:
        title = sources.title_of(best)
        cells = engines_page.cells(board, best.setting, best.row)
        rows.append([f"*{title}*" if sources.is_plain(best) else title, *cells])
    caption = Caption(words, ENGINES, board.timings.machine.processor)
    return Table("engines", [*engines_page.COLUMNS[:-1], "time, µs:"], rows, caption)


def _reach(sources: Sources) -> Table:
    words = (
        f"The last value of each family at which the Taylor integrator leaves {REACHED} digits: the "
        "number of periods, or the parameter that leads to the extreme, after one period. An arrow "
        f"stands behind the last value that was tried, {NOTHING} where there is no value."
    )
    lines = picture.lines(sources.hard)
    rungs = list(dict.fromkeys(line.rung for line in lines))
    far = {(line.family.name, line.rung): hard_page.far(line, REACHED) for line in lines}
    rows = [
        [
            prose(family.title.replace("^2", "²")),
            family.symbol or "periods",
            *(far.get((family.name, rung), NOTHING) for rung in rungs),
        ]
        for family in sources.hard.families
    ]
    headings = ["motion", "varied", *(f"{rung}:" for rung in rungs)]
    return Table(
        "reach", headings, rows, Caption(words, (HARD.name,), sources.hard.machine.processor)
    )


def _trade(sources: Sources) -> Table:
    words = (
        "Time of the cheapest setting that leaves so many digits, over that of the Taylor integrator in "
        "float64 at its own tolerance on the same scene; in brackets the interval for the median over "
        "processes. SciPy calls the equations in Python, heyoka compiles them. *not reached* stands where "
        "no measured setting leaves so many."
    )
    trades = sources.trades
    rows = [row for trade in trades.short for row in _solvers(trade)]
    headings = ["scene", "solver", *(f"{digits} digits:" for digits in DIGITS)]
    return Table(
        "tradeoff", headings, rows, Caption(words, TRADEOFF, trades.times.machine.processor)
    )


def _solvers(trade: Trade) -> Iterator[list[str]]:
    """Yield a row for each solver that ran on a scene; only the first row names the scene."""
    ran = {point.family for point in trade.points if point.standing is not Standing.NOT_RUN}
    compiled = sorted(family for family in ran if family.startswith(OUTSIDE))
    name = code(trade.scene)
    for family in (TAYLOR, *_RIVALS, *compiled):
        if family in ran:
            title = TITLES.get(family, family.removesuffix(" f64").replace("scipy ", "SciPy "))
            yield [name, prose(title), *(_cost(trade, family, digits) for digits in DIGITS)]
            name = ""


def _cost(trade: Trade, family: str, digits: int) -> str:
    """Return the time of the cheapest setting of a family that leaves so many digits, with its interval."""
    best = cheapest((row for row in trade.sound if row.point.family == family), digits)
    if best is None:
        return NOT_REACHED
    low, high = best.timing.low, best.timing.high
    interval = f" ({figure(low)} to {figure(high)})" if low is not None else ""
    return f"{figure(best.timing.ratio)}{interval}"
