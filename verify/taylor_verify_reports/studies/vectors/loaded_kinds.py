"""Faults of written loads, of states of one's own and of files: what is changed, and the right words."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np

from taylor_verify_reports.studies.causes.bodies import Acting, Floats, Sample
from taylor_verify_reports.studies.causes.kind import Kind
from taylor_verify_reports.studies.causes.simulated import Rows, integrated, law, rotation
from taylor_verify_reports.studies.causes.stepping import Draw, Make
from taylor_verify_reports.studies.vectors.bodies_under_loads import WRITTEN

Columns = dict[str, list[Any]]
_LOADS: Final = ("moment", "load", "factor")
_TIMED: Final = ("timed", "pulsed")


def _acting(change: Callable[[Acting, Sample], Acting]) -> Make:
    """Return the maker of answers whose loads are changed."""

    def make(s: Sample, d: Draw, size: float) -> Rows:
        own = law(s)
        own.acting = change(s.acting, s)
        return integrated(s, own)

    return make


def _times(factor: float) -> Make:
    def changed(acting: Acting, s: Sample) -> Acting:
        load = acting.load
        return replace(acting, load=lambda t, v, q, own: factor * load(t, v, q, own))

    return _acting(changed)


def _in_space(acting: Acting, s: Sample) -> Acting:
    load = acting.load
    return replace(acting, load=lambda t, v, q, own: rotation(q).T @ load(t, v, q, own))


def _taken(s: Sample, late: bool) -> Rows:
    """Return a sampled controller whose values act a sample late, or without any hold."""
    own, take = law(s), s.acting.taken
    if late:
        after = replace(
            s.acting,
            start=np.zeros(6),
            taken=lambda t, v, q, m: np.concatenate([m[3:], take(t, v, q, m)]),
            load=lambda t, v, q, m: m[:3],
        )
    else:
        after = Acting(load=lambda t, v, q, m: take(t, v, q, m))
    own.acting = after
    return integrated(s, own)


def without_lag(s: Sample, d: Draw, size: float) -> Rows:
    """Return motors that follow at once: their states are those at which their rates are zero."""
    own, rate, load, none = law(s), s.acting.rate, s.acting.load, 0 * s.acting.start
    pace = float(-(rate(0.0, s.v0, s.q0, none + 1) - rate(0.0, s.v0, s.q0, none))[0])
    own.acting = replace(
        s.acting, load=lambda t, v, q, m: load(t, v, q, rate(t, v, q, none) / pace)
    )
    return integrated(s, own)


LOADED_KINDS: Final = (
    Kind("written load left out", _LOADS, _times(0.0), tuple(WRITTEN)),
    Kind("written load with the other sign", _LOADS, _times(-1.0), tuple(WRITTEN)),
    Kind("written load of another size", _LOADS, _times(1.06), tuple(WRITTEN)),
    Kind("written load in space axes", ("space axes",), _acting(_in_space), _TIMED),
    Kind("controller of another size", _LOADS, _times(1.06), ("lagging", "sampled")),
    Kind("controller with the other sign", _LOADS, _times(-1.0), ("lagging", "sampled")),
    Kind("controller left out", (*_LOADS, "stands still"), _times(0.0), ("lagging", "sampled")),
    Kind("controller a sample late", ("late",), lambda s, d, e: _taken(s, late=True), ("sampled",)),
    Kind(
        "controller without hold",
        ("continuous",),
        lambda s, d, e: _taken(s, late=False),
        ("sampled",),
    ),
    Kind("motor without lag", ("m ",), without_lag, ("lagging",)),
)
# Where nobody need know them.
NOT_KNOWN: Final = ("controller of another size", "controller a sample late", "motor without lag")


@dataclass(frozen=True)
class FileFault:
    """A fault of a right file: the change of its columns, and the verdict."""

    name: str
    verdict: str
    change: Callable[[Columns], Columns]
    words: tuple[str, ...] = ()


def _without(*names: str) -> Callable[[Columns], Columns]:
    return lambda columns: {k: list(v) for k, v in columns.items() if k not in names}


def _replaced(name: str, row: int, value: Any) -> Callable[[Columns], Columns]:
    def changed(columns: Columns) -> Columns:
        new = {k: list(v) for k, v in columns.items()}
        new[name][row] = value
        return new

    return changed


def _scaled(names: tuple[str, ...], factor: float) -> Callable[[Columns], Columns]:
    def changed(columns: Columns) -> Columns:
        new = {name: [float(f"{x * factor:.12g}") for x in columns[name]] for name in names}
        return {**columns, **new}

    return changed


def _exchanged(columns: Columns) -> Columns:
    return columns | {"w1": columns["w2"], "w2": columns["w1"]}


def _half(columns: Columns) -> Columns:
    return {k: v[: len(v) // 2] for k, v in columns.items()}


FILE_FAULTS: Final = (
    FileFault("half of the span", "undecided", _half),
    FileFault("no attitude", "undecided", _without("q0", "q1", "q2", "q3")),
    FileFault("no angular velocity", "undecided", _without("w1", "w2", "w3")),
    FileFault("not a number in a row", "fail", _replaced("w2", 4, "nan")),
    FileFault("infinity in a row", "fail", _replaced("w3", 5, "inf")),
    FileFault("no times", "refused", _without("t")),
    FileFault("a word for a number", "refused", _replaced("w1", 3, "fast")),
    FileFault("a column too short", "refused", lambda c: c | {"w1": c["w1"][:-1]}),
    FileFault("a time twice", "refused", lambda c: c | {"t": [*c["t"][:3], *c["t"][2:-1]]}),
    FileFault("one row alone", "undecided", lambda c: {k: v[:1] for k, v in c.items()}),
    FileFault("axes 1 and 2 exchanged", "fail", _exchanged, ("order", "axes", "axis")),
    FileFault("times in milliseconds", "fail", _scaled(("t",), 1000.0), ("ms", "clock", "milli")),
    FileFault("rates in degrees", "fail", _scaled(("w1", "w2", "w3"), 180 / np.pi), ("degrees",)),
)


def columns_of(rows: Rows, digits: int) -> Columns:
    """Return the columns of an answer, with numbers of so many digits."""
    names = ("w1", "w2", "w3") if rows.v.shape[1] == 3 else ("u1", "u2", "u3", "w1", "w2", "w3")
    values: Floats = np.hstack([rows.v, rows.q])
    columns = zip((*names, "q0", "q1", "q2", "q3"), values.T, strict=True)
    return {
        "t": [float(f"{t:.15g}") for t in rows.times],
        **{name: [float(f"{x:.{digits}g}") for x in column] for name, column in columns},
    }
