"""Pictures of measurements: speed against accuracy, digits left of the extremes, growth over decades."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from math import floor, log10
from typing import Final

from taylor_verify.publish.cells import figure
from taylor_verify.publish.pictures.style import place
from taylor_verify.studies.growth.document import Ensemble
from taylor_verify.studies.reach.document import ReachFamily, ReachRow
from taylor_verify.studies.reach.picture import ACHIEVED, ATTAINABLE, numbers_of
from taylor_verify.studies.site.figure import WIDE, Drawing, Figure, Layout, Trace, log_axis, on_log
from taylor_verify.studies.site.looks import Palette, line_of, marker_of
from taylor_verify.studies.tradeoff.document import TradePoint
from taylor_verify.studies.tradeoff.stored import TimedPoint, Trade

_WORK: Final = {
    "seconds": "time of a solve (s)",
    "evaluations": "evaluations of the equations of motion",
    "steps": "steps",
}
# From so many digits on, as the published maps have it.
_CLASSES: Final = (0, 1, 3, 6, 12, 24)
_MAP: Final = "coloraxis"


def precision(trade: Trade, palette: Palette, fallback: str | None = None) -> Figure:
    """Error against time, evaluations and steps, of every sound setting."""
    drawings = [
        Drawing(
            {"seconds": "time"}.get(key, key),
            _families(trade, key, palette),
            {"xaxis": log_axis(title), "yaxis": log_axis("largest error of the state")},
        )
        for key, title in _WORK.items()
    ]
    best = min(trade.sound, key=lambda row: row.error, default=None)
    told = f" The least error is {figure(best.error)}, of {best.point.solver}." if best else ""
    return Figure(
        name=f"work-{trade.scene.replace('/', '-')}",
        title=f"Work and precision: {trade.scene}",
        caption=f"{trade.about.title}: every setting that gave a sound answer, a line for each family of "
        "solvers. Further left is faster, further down more accurate.",
        alt=f"Largest error against work on {trade.scene}, both logarithmic, for "
        f"{len({row.point.family for row in trade.sound})} families of solvers.{told}",
        drawings=[one for one in drawings if one.traces],
        shape=WIDE,
        asks="work as",
        fallback=fallback,
    )


def _families(trade: Trade, key: str, palette: Palette) -> list[Trace]:
    rows = [row for row in trade.sound if _work(row, key) and row.error]
    rows.sort(key=lambda row: (*place(*_family(row.point)), row.point.rung, _work(row, key)))
    return [
        _series(family, rung, list(found), key, palette)
        for (family, rung), found in groupby(rows, key=lambda row: _family(row.point))
    ]


def _work(row: TimedPoint, key: str) -> float:
    counted = {"evaluations": row.point.evaluations, "steps": row.point.steps}
    return row.timing.seconds if key == "seconds" else counted[key]


def _family(point: TradePoint) -> tuple[str, str]:
    return point.family, point.rung


def _series(
    family: str, rung: str, rows: Sequence[TimedPoint], key: str, palette: Palette
) -> Trace:
    colour = palette.family(family, rung)
    return {
        **{"type": "scatter", "mode": "lines+markers", "name": family},
        **{"x": on_log(_work(row, key) for row in rows), "y": on_log(row.error for row in rows)},
        "text": [f"{row.point.solver} {rung}" for row in rows],
        "marker": {**marker_of(family, rung), "color": colour},
        "line": {**line_of(family, rung), "color": colour},
        "hovertemplate": "%{text}<br>%{x:.3g}<br>error %{y:.3g}<extra></extra>",
    }


# The extremes.


def digits_map(
    family: ReachFamily, rows: Sequence[ReachRow], fallback: str | None = None
) -> Figure | None:
    """Return digits left over the family's number and the periods, achieved and attainable, by rung."""
    drawings = [_maps(family, [row for row in rows if row.rung == r], r) for r in family.rungs]
    drawings = [one for one in drawings if one.traces]
    if not drawings:
        return None
    towards = f"; {family.symbol} leads to {family.extreme}" if family.symbol else ""
    return Figure(
        name=f"reach-{family.name}",
        title=f"Digits left: {family.name}",
        caption=f"{family.title[0].upper()}{family.title[1:]}{towards}. The number in a cell is "
        "the whole decimal digits that are left after so many periods; an empty cell was not run, or "
        "the rung cannot hold the scene.",
        alt=f"Decimal digits left of {family.title}, over {family.symbol or 'its number'} and "
        "the periods, for each rung; the table of the same family has the numbers.",
        drawings=drawings,
        layout={_MAP: _colours()},
        shape=WIDE,
        asks="rung",
        first=min(1, len(drawings) - 1),
        fallback=fallback,
    )


def _maps(family: ReachFamily, rows: Sequence[ReachRow], rung: str) -> Drawing:
    run = [row for row in rows if row.errors]
    if not run:
        return Drawing(rung, [])
    periods = max((row.periods for row in run), key=len)
    traces = [
        _map(family.values, periods, run, key, n)
        for n, key in enumerate((ACHIEVED, ATTAINABLE), start=1)
    ]
    heading = {"showarrow": False, "yref": "paper", "y": 1.02, "yanchor": "bottom"}
    layout: Layout = {
        "grid": {"rows": 1, "columns": 2, "pattern": "independent", "xgap": 0.08},
        "annotations": [
            {**heading, "text": text, "xref": f"x{n} domain", "x": 0.5}
            for n, text in ((1, "achieved"), (2, "attainable"))
        ],
        "yaxis": _categories(family.symbol or "value"),
        "yaxis2": {**_categories(""), "showticklabels": False},
        "xaxis": _categories("periods"),
        "xaxis2": _categories("periods"),
    }
    return Drawing(rung, traces, layout)


def _categories(title: str) -> Layout:
    # Values such as 1e-3 are names of lines here; as numbers they would be drawn to scale.
    return {"type": "category", "title": {"text": title}, "showgrid": False, "automargin": True}


def _map(
    values: Sequence[str], periods: Sequence[int], rows: Sequence[ReachRow], key: str, number: int
) -> Trace:
    found = {
        (row.value, count): digits_left(error)
        for row in rows
        for count, error in zip(row.periods, numbers_of(row, key), strict=False)
    }
    cells = [[found.get((value, count)) for count in periods] for value in values]
    suffix = "" if number == 1 else str(number)
    return {
        **{"type": "heatmap", "x": [str(count) for count in periods], "y": list(values)},
        "z": [[None if n is None else _class_of(n) for n in line] for line in cells],
        "text": [["" if n is None else str(n) for n in line] for line in cells],
        **{"texttemplate": "%{text}", "xgap": 1, "ygap": 1, "coloraxis": _MAP},
        **{"xaxis": f"x{suffix}", "yaxis": f"y{suffix}"},
        "hovertemplate": "%{y}, %{x} periods: %{text} digits<extra></extra>",
    }


def digits_left(error: float | None) -> int | None:
    """Whole decimal digits; an error of one or more leaves none, one of zero all that count here."""
    if error is None:
        return None
    return max(0, floor(-log10(error))) if error > 0 else _CLASSES[-1]


def _class_of(digits: int) -> int:
    return sum(digits >= low for low in _CLASSES) - 1


def _colours() -> Layout:
    """A colour for each class, without steps between."""
    last = len(_CLASSES)
    edges = [(n / last, f"$class{low}", (n + 1) / last) for n, low in enumerate(_CLASSES)]
    names = [f"{low}+" if low else "0" for low in _CLASSES]
    return {
        "colorscale": [[at, colour] for low, colour, high in edges for at in (low, high)],
        **{"cmin": -0.5, "cmax": last - 0.5},
        "colorbar": {
            **{"title": {"text": "digits"}, "tickvals": list(range(last)), "ticktext": names},
            **{"thickness": 12, "len": 0.8, "outlinewidth": 0},
        },
    }


# Growth.


def growth(
    runs: Sequence[Ensemble], palette: Palette, fallback: str | None = None
) -> Figure | None:
    """Return the root mean square of each quantity over an ensemble, against the periods."""
    drawings = [_growing(run, palette) for run in runs]
    drawings = [one for one in drawings if one.traces]
    if not drawings:
        return None
    return Figure(
        name="growth",
        title="Growth over decades of time",
        caption="Root mean square over an ensemble of starts. A conserved quantity under random "
        "roundings grows with the square root of time, a phase with its power 3/2; a bias would show "
        "as the powers 1 and 2.",
        alt="; ".join(
            f"{run.scene} on {run.rung}: "
            + ", ".join(f"{q.quantity} {figure(q.exponent)}" for q in run.quantities)
            for run in runs
        ),
        drawings=drawings,
        shape=WIDE,
        asks="ensemble",
        fallback=fallback,
    )


def _growing(run: Ensemble, palette: Palette) -> Drawing:
    traces = [
        {
            **{"type": "scatter", "mode": "lines+markers", "x": on_log(run.counts)},
            **{"y": on_log(one.rms), "name": f"{one.quantity}: {figure(one.exponent)}"},
            **{"line": {"color": palette.line(n), "width": 1.4}, "marker": {"size": 6}},
            "hovertemplate": "%{x:.3g} periods<br>rms %{y:.3g}<extra></extra>",
        }
        for n, one in enumerate(run.quantities)
    ]
    axes = {
        "xaxis": log_axis("periods"),
        "yaxis": log_axis("root mean square"),
        "legend": {"title": {"text": "exponent of growth"}},
    }
    return Drawing(f"{run.scene}, {run.rung}, {run.solver}", traces, axes)
