"""Pictures of errors: over time for one scene, and over what is attainable for all of them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import log10
from typing import Any, Final

from taylor_verify.publish.cells import figure
from taylor_verify.records.quantities import GATE_FACTOR, STATES
from taylor_verify.records.runs import Run
from taylor_verify.records.verdict import Verdict
from taylor_verify.studies.controls.document import Sight
from taylor_verify.studies.site.figure import (
    WIDE,
    Drawing,
    Figure,
    Layout,
    Trace,
    decades,
    log_axis,
    on_log,
    short,
)
from taylor_verify.studies.site.looks import Palette, line_of, marker_of, rungs_upwards

Record = Mapping[str, Any]

_TAYLOR: Final = "taylor"
# The state, and of what is conserved the energy alone: the others have their numbers in the table.
_DRAWN: Final = (*STATES, "T")
_LINE: Final = {"width": 1.2}


def against_time(records: Mapping[str, Record], palette: Palette) -> Figure | None:
    """Every sample's error on every rung, and what is attainable as a line of the same colour.

    ``records`` are those of one scene by rung.
    """
    found = {gate["quantity"] for record in records.values() for gate in record["gates"]}
    quantities = [name for name in _DRAWN if name in found]
    drawings = [_over_time(name, records) for name in quantities]
    drawings = [one for one in drawings if one.traces]
    if not drawings:
        return None
    return Figure(
        name="error",
        title="Error against time",
        caption="Points are the errors at the samples, lines what perfect rounding of every step "
        "would leave on this orbit: Brouwer's law, carried on by the orbit. Both axes are "
        f"logarithmic; an error of zero has no place there. A gate allows {GATE_FACTOR} times the line. In "
        "units of u, the roundoff of its rung, every rung is at one height.",
        alt="Error of every sample against time for each rung, both logarithmic, with what is "
        "attainable as a line. The largest errors are in the table of this page.",
        drawings=drawings,
        columns={**_times(records), **_bases(records, palette)},
        units={rung: record["unit_roundoff"] for rung, record in records.items()},
        asks="quantity",
    )


def _times(records: Mapping[str, Record]) -> dict[str, list[float | None]]:
    """By rung, since the start: forwards for a motion that runs back as well."""
    return {
        rung: on_log([abs(t - record["times"][0]) for t in record["times"]], 4)
        for rung, record in records.items()
    }


def _over_time(name: str, records: Mapping[str, Record]) -> Drawing:
    traces: list[Trace] = []
    unit = ""
    for rung, record in records.items():
        gate = next((one for one in record["gates"] if one["quantity"] == name), None)
        if gate is None or not gate["errors"]:
            continue
        unit = gate["unit"]
        later = [t != record["times"][0] for t in record["times"]]
        for base, values in (("line", gate["attainable"]), ("points", gate["errors"])):
            traces.append({"base": f"@{base} {rung}", "y": decades(_where(later, values))})
    axes = {
        "xaxis": log_axis("time since the start"),
        "yaxis": log_axis(f"error of {name}, in {unit}" if unit else f"error of {name}"),
    }
    return Drawing(name, traces, axes)


def _where(later: Sequence[bool], values: Sequence[float]) -> list[float | None]:
    """The start has no place on the axis of time, and what was found there none on the other."""
    return [value if seen else None for seen, value in zip(later, values, strict=True)]


def _bases(records: Mapping[str, Record], palette: Palette) -> dict[str, Trace]:
    """What the traces of a rung have in common, whatever the quantity."""
    found: dict[str, Trace] = {}
    for rung in records:
        colour = palette.rung(rung)
        found[f"points {rung}"] = {
            **{"type": "scatter", "mode": "markers", "name": rung, "legendgroup": rung},
            "x": f"@{rung}",
            "marker": {**marker_of(_TAYLOR, rung), "color": colour, "size": 5},
            "hovertemplate": f"{rung}<br>t %{{x:.4g}}<br>error %{{y:.2g}}<extra></extra>",
        }
        found[f"line {rung}"] = {
            **{"type": "scatter", "mode": "lines", "showlegend": False, "legendgroup": rung},
            "x": f"@{rung}",
            "line": {**line_of(_TAYLOR, rung), "color": colour, "width": 1.2},
            "hovertemplate": f"{rung}, attainable<br>t %{{x:.4g}}<br>%{{y:.2g}}<extra></extra>",
        }
    return found


# All scenes together.


# Of attainable: below this an error is as good as none, and stands at the edge of the picture.
_EDGE: Final = 1e-2
_SPREAD: Final = 0.8


def over_attainable(
    runs: Iterable[Run], sights: Iterable[Sight], factor: float, palette: Palette
) -> Figure:
    """The largest state error of every run over what is attainable, beside the broken solvers.

    ``factor`` is what a gate allows over attainable: it parts the picture in two.
    """
    points: dict[str, list[Verdict]] = {}
    for run in runs:
        for verdict in run.state:
            if verdict.is_compared and verdict.ratio and verdict.attainable:
                points.setdefault(run.rung, []).append(verdict)
    rungs = rungs_upwards(points)
    traces = [_rung_points(n, rung, points[rung], palette) for n, rung in enumerate(rungs)]
    broken = [one for sight in sights for one in _failures(sight)]
    if broken:
        traces.append(_broken_points(len(rungs), broken))
    names = [*rungs, *(["broken"] if broken else [])]
    return Figure(
        name="attainable",
        title="Every error over what is attainable",
        caption="A point for each state quantity of each run: its largest error over what perfect "
        "rounding of every step would have left, in each column from the easiest orbit on the left to "
        f"the hardest. A gate allows {factor:g}. The crosses are solvers that were broken on purpose, "
        "one thing in each; the two halves have scales of their own.",
        alt=_told({rung: points[rung] for rung in rungs}, broken, factor),
        drawings=[Drawing("all", traces, _halves(names, factor))],
        shape=WIDE,
    )


def _rung_points(place: int, rung: str, found: Sequence[Verdict], palette: Palette) -> Trace:
    ordered = sorted(found, key=lambda one: (one.attainable or 0.0, one.scene, one.quantity))
    return {
        **{"type": "scatter", "mode": "markers", "name": rung, "showlegend": False},
        "x": _spread(place, len(ordered)),
        "y": on_log(max(one.ratio or 0.0, _EDGE) for one in ordered),
        "text": [f"{one.quantity} of {one.scene}, {rung}: {figure(one.ratio)}" for one in ordered],
        "marker": {**marker_of(_TAYLOR, rung), "color": palette.rung(rung), "size": 5},
        "hovertemplate": "%{text}<extra></extra>",
    }


def _broken_points(place: int, found: Sequence[tuple[str, Verdict]]) -> Trace:
    ordered = sorted(found, key=lambda one: one[1].ratio or 0.0)
    return {
        **{"type": "scatter", "mode": "markers", "name": "broken", "showlegend": False},
        **{"x": _spread(place, len(ordered)), "yaxis": "y2", "cliponaxis": False},
        "y": on_log(verdict.ratio for _, verdict in ordered),
        "text": [f"{name}, {one.quantity}: {figure(one.ratio)}" for name, one in ordered],
        "marker": {"symbol": "x-thin", "size": 7, "line": {"width": 1.6, "color": "$alarm"}},
        "hovertemplate": "%{text}<extra></extra>",
    }


def _spread(place: int, number: int) -> list[float]:
    """Side by side within the column of a place."""
    return [round(place + _SPREAD * ((k + 0.5) / number - 0.5), 3) for k in range(number)]


def _failures(sight: Sight) -> list[tuple[str, Verdict]]:
    return [
        (sight.defect.name.replace("-", " "), sight.verdicts[name])
        for name in sight.seen_by
        if name in STATES and sight.verdicts[name].ratio
    ]


def _halves(names: Sequence[str], factor: float) -> Layout:
    """Below the gate two thirds of the height, above it one."""
    gate, edge = log10(factor), log10(_EDGE)
    column = {"tickvals": list(range(len(names))), "ticktext": list(names)}
    line = {"type": "line", "xref": "paper", "x0": 0, "x1": 1}
    words = {"xref": "paper", "x": 0.005, "xanchor": "left", "showarrow": False}
    return {
        "margin": {"l": 64, "r": 8, "t": 12, "b": 32},
        "xaxis": {**column, "showgrid": False, "range": [-0.5, len(names) - 0.5], "anchor": "y"},
        "yaxis": {
            **log_axis("error over attainable"),
            **{"domain": [0, 0.64], "range": [edge - 0.15, gate], "dtick": 1},
        },
        "yaxis2": {**log_axis(""), "domain": [0.64, 1], "range": [gate, 16.5], "dtick": 3},
        "shapes": [
            {**line, "y0": 1, "y1": 1, "line": {"color": "$quiet", "width": 1.2, "dash": "dot"}},
            {**line, "y0": factor, "y1": factor, "line": {"color": "$alarm", "width": 1.6}},
        ],
        "annotations": [
            # Plotly puts an annotation at the logarithm.
            {**words, "y": 0.0, "yanchor": "bottom", "text": "perfect rounding"},
            {**words, "y": short(gate), "yanchor": "top", "text": "the gate"},
        ],
    }


def _told(
    points: Mapping[str, Sequence[Verdict]], broken: Sequence[tuple[str, Verdict]], factor: float
) -> str:
    each = ", ".join(
        f"{rung} {figure(max((one.ratio or 0.0 for one in found), default=None))}"
        for rung, found in points.items()
    )
    ratios = [verdict.ratio or 0.0 for _, verdict in broken]
    lowest = f" Solvers broken on purpose lie from {figure(min(ratios))} upwards." if ratios else ""
    return f"Largest error over attainable by rung: {each}; a gate allows {factor:g}.{lowest}"


# What a verdict calls an error of which a shift of time leaves a tenth at most.
_SHIFTED: Final = ("constant", "drifting", "wandering")


def shifts(sights: Iterable[Sight], fallback: str | None = None) -> Figure | None:
    """Of every broken solver whose error is for most a shift of time: the error, and what is left."""
    found = [
        (sight.defect.name.replace("-", " "), name, verdict)
        for sight in sights
        for name, verdict in sight.verdicts.items()
        if name in STATES and verdict.shift in _SHIFTED and verdict.residual and verdict.max
    ]
    if not found:
        return None
    names = [f"{name}: {quantity}" for name, quantity, _ in found]
    errors = on_log(verdict.max for _, _, verdict in found)
    left = on_log(verdict.residual for _, _, verdict in found)
    told = [f"shift {figure(verdict.time_shift)}, {verdict.shift}" for _, _, verdict in found]
    bars = [
        {
            **{"type": "scatter", "mode": "lines", "x": [error, rest], "y": [name, name]},
            **{"showlegend": False, "hoverinfo": "skip", "line": {"color": "$quiet", **_LINE}},
        }
        for name, error, rest in zip(names, errors, left, strict=True)
    ]
    ends = [
        _ends("error", errors, names, told, "$alarm", "circle"),
        _ends("what the best shift of time leaves", left, names, told, "$accent", "diamond"),
    ]
    return Figure(
        name="shift",
        title="Error, and what a shift of time leaves of it",
        caption="An answer that is right but late has an error that no conserved quantity sees. The "
        "judge finds the shift of time that explains most of it: where the second point is far to the "
        "left, lateness is all that is wrong.",
        alt="; ".join(
            f"{name}: error {figure(verdict.max)}, {figure(verdict.residual)} left after a shift of "
            f"{figure(verdict.time_shift)}"
            for name, (_, _, verdict) in zip(names, found, strict=True)
        ),
        drawings=[
            Drawing(
                "shift",
                [*bars, *ends],
                {
                    "xaxis": log_axis("largest error"),
                    "yaxis": {"autorange": "reversed", "type": "category", "dtick": 1},
                },
            )
        ],
        lines=len(names),
        fallback=fallback,
    )


def _ends(
    name: str, x: Sequence[Any], y: Sequence[str], told: Sequence[str], colour: str, symbol: str
) -> Trace:
    return {
        **{"type": "scatter", "mode": "markers", "name": name, "x": list(x), "y": list(y)},
        "text": list(told),
        "marker": {"color": colour, "symbol": symbol, "size": 9},
        "hovertemplate": "%{y}<br>%{x:.3g}<br>%{text}<extra></extra>",
    }
