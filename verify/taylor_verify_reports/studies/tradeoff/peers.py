"""Section of the page that compares taylor with compiled integrators of other libraries."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from taylor_verify.words.cells import NOTHING, figure
from taylor_verify.words.markdown import bold, bullets, code, prose, table
from taylor_verify_reports.studies.tradeoff.trades import (
    UNTIL,
    TimedPoint,
    Trade,
    Trades,
    cheapest,
)

DIGITS: Final = (6, 9, 12)
OUTSIDE: Final = "outside "
TAYLOR: Final = "taylor f64"
OPTIMISED: Final = "taylor f64 optimised"
NOT_REACHED: Final = "not reached"
_NONE: Final = (
    "Not measured: `taylor-verify publish tradeoff --outside` does, and makes their environments."
)
_WHAT: Final = (
    "These integrators are compiled like heyoka's. They run on the scenes above, and on three of them "
    "for about a hundred periods. Each runs in a process of its own that stays, and takes its turn "
    "with all others in every round. All have the same equations, generated from one form, and the "
    "same samples, and are compared with the same exact motion. A cell is the processor's time of the "
    "cheapest tolerance, of all powers of ten from 1e-5 to 1e-15, that leaves this number of digits, "
    "over that of the yardstick. *ahead* is the fastest, with its lead: over the next peer "
    "if the fastest is taylor, else over taylor. They are *level* if the intervals of the two overlap."
)
# Headings of the columns by family; a family that is missing here has its own name as heading.
TITLES: Final = {
    OPTIMISED: "taylor, optimised code",
    "outside dop853": "DOP853 in numba",
    "outside cyrk-dop853": "CyRK DOP853",
    "outside cvode-adams": "SUNDIALS CVODE",
    "outside diffrax-dopri8": "diffrax Dopri8",
}
_HOW: Final = (
    "DOP853 in numba is ours: the method and the equations in one function, which numba compiles. A "
    "library has to call the equations.",
    "CyRK is C++, and calls equations that numba compiled.",
    "CVODE (Adams, by scikit-sundae) is C, and calls equations that numba compiled by way of Python, for "
    "want of another.",
    "diffrax is compiled as a whole by XLA (`jit`).",
    "The time of taylor includes its driver's work in Python around heyoka's compiled steps.",
    "Optimised code is `taylor?code=optimised`: it compiles for seconds.",
)
_SET_UP: Final = (
    "The times above exclude the set-up: the processor's seconds before the first solve of a process, "
    "mainly of compiling, the longest of all processes. taylor compiles once for each tolerance and "
    "form. The others "
    "compile once for a body, in every process anew."
)


def peer_sections(trades: Trades) -> list[str]:
    """Return the paragraphs and tables of the section; a sentence if no peer was measured."""
    if not any(_peers(trade) for trade in trades.trades):
        return [_NONE]
    return [_WHAT, _times(trades), bullets(_HOW), _SET_UP, _set_up(trades)]


def _peers(trade: Trade) -> list[str]:
    """Return the families of other libraries, including those that were not available."""
    return list(dict.fromkeys(p.family for p in trade.points if p.family.startswith(OUTSIDE)))


def _is_ours(row: TimedPoint) -> bool:
    return row.point.family in (TAYLOR, OPTIMISED)


def _families(trades: Trades) -> list[str]:
    """Return the families of the columns: taylor, those with a title in their order, and others."""
    points = [point for trade in trades.trades for point in trade.points]
    others = (OUTSIDE, OPTIMISED)
    asked = dict.fromkeys(p.family for p in points if p.family.startswith(others))
    known = [family for family in TITLES if family in asked]
    return [TAYLOR, *known, *(family for family in asked if family not in known)]


def _title(family: str) -> str:
    return TITLES.get(family, prose(family.removeprefix(OUTSIDE).removesuffix(" f64")))


def _of_family(trade: Trade, family: str) -> list[TimedPoint]:
    return [row for row in trade.sound if row.point.family == family]


# The times.


def _times(trades: Trades) -> str:
    families = _families(trades)
    rows = []
    for trade in trades.trades:
        for digits in DIGITS:
            best = {f: cheapest(_of_family(trade, f), digits) for f in families}
            ours, *others = (_cell(best[f], bool(_of_family(trade, f))) for f in families)
            name = code(trade.scene) if digits == DIGITS[0] else ""
            reached = sorted(
                (row for row in best.values() if row), key=lambda row: row.timing.ratio
            )
            times = [ours, _inner(best[TAYLOR]), *others]
            rows.append([name, str(digits), _ahead(reached), *times])
    times = ["taylor:", "of which heyoka:", *(f"{_title(f)}:" for f in families[1:])]
    return table(["scene", "digits:", "ahead", *times], rows)


def _cell(row: TimedPoint | None, is_there: bool) -> str:
    if row is None:
        return NOT_REACHED if is_there else NOTHING
    asked = f" @ {row.point.requested:.0e}" if row.point.requested else ""
    return f"{bold(figure(row.timing.ratio))}{asked}"


def _inner(row: TimedPoint | None) -> str:
    """Return the part of a time spent in heyoka's own compiled code, in the same unit."""
    if row is None or not row.timing.inner_seconds:
        return NOTHING
    return figure(row.timing.ratio * row.timing.inner_seconds / row.timing.seconds)


def _ahead(reached: Sequence[TimedPoint]) -> str:
    """Return the fastest family in words, with its lead over the next peer, or over taylor."""
    if not reached:
        return "nobody"
    first, name, other = reached[0], _title(reached[0].point.family), _next(reached)
    if other is None:
        is_alone = _is_ours(first) or len(reached) == 1
        return f"{name}, alone" if is_alone else f"{bold(name)}: taylor does not reach them"
    if _overlap(first, other):
        return f"level: {name} and {_title(other.point.family)}"
    lead = f"{other.timing.ratio / first.timing.ratio:.1f} times"
    return f"{name}, {lead}" if _is_ours(first) else f"{bold(name)}, {lead}"


def _next(reached: Sequence[TimedPoint]) -> TimedPoint | None:
    """Return the fastest of the other side than the first of all, taylor or a peer."""
    return next((row for row in reached if _is_ours(row) is not _is_ours(reached[0])), None)


def _overlap(first: TimedPoint, other: TimedPoint) -> bool:
    """Return True if the intervals of two times overlap; False without intervals."""
    high, low = first.timing.high, other.timing.low
    return high is not None and low is not None and low <= high


# The set-up.


def _set_up(trades: Trades) -> str:
    families = _families(trades)
    rows = []
    for scene in dict.fromkeys(_shipped(trade.scene) for trade in trades.trades):
        seconds = [_longest(trades, scene, family) for family in families]
        cells = [NOTHING if longest is None else f"{figure(longest)} s" for longest in seconds]
        rows.append([code(scene), *cells])
    return table(["scene", *(f"{_title(f)}:" for f in families)], rows)


def _longest(trades: Trades, scene: str, family: str) -> float | None:
    """Return the longest set-up of a family on a scene, which may be part of its short or long run."""
    seconds = [
        row.timing.setup_seconds
        for trade in trades.trades
        if _shipped(trade.scene) == _shipped(scene)
        for row in _of_family(trade, family)
        if row.timing.setup_seconds is not None
    ]
    return max(seconds, default=None)


def _shipped(scene: str) -> str:
    """Return the name of the shipped scene that one of this name follows beyond its end."""
    return scene.partition(UNTIL)[0]
