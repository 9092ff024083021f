"""Bodies under loads that the scene writes down, and with states of its own, in text and in numbers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np

from taylor_verify_reports.studies.causes.bodies import Acting, Floats, Sample, sample
from taylor_verify_reports.studies.causes.kind import Kind
from taylor_verify_reports.studies.causes.kinds_of_loads import without_lag
from taylor_verify_reports.studies.causes.loaded import GRID, lagging, numbers, on_grid, texts
from taylor_verify_reports.studies.causes.simulated import Rows, integrated, law, rotation
from taylor_verify_reports.studies.causes.stepping import Make

Draw = np.random.Generator
Loaded = Callable[[Sample, Draw], Sample]


def plain(sort: str, draw: Draw, loaded: Loaded | None = None) -> Sample:
    """Draw a body whose numbers are multiples of 1/64, with 11 to 16 rows."""
    drawn = sample(sort, draw)
    pace = max(float(np.linalg.norm(drawn.v0[-3:])), 0.4)
    step = max(float(on_grid(np.asarray(0.45 / pace))), 1 / GRID)
    mass = on_grid(drawn.mass)
    body = replace(
        drawn,
        mass=(mass + mass.T) / 2,
        load=on_grid(2 * drawn.load),
        rotor=on_grid(drawn.rotor),
        v0=on_grid(drawn.v0),
        q0=on_grid(drawn.q0),
        times=step * np.arange(int(draw.integers(11, 17)), dtype=np.float64),
        digits=int(draw.choice([9, 12])),
    )
    return loaded(body, draw) if loaded else body


def _moment(lines: list[str]) -> tuple[str, ...]:
    return (f"moment = {texts(lines)}",)


def timed(body: Sample, draw: Draw) -> Sample:
    """A moment that is a function of time."""
    size, rate = numbers(draw, 0.1, 0.5), numbers(draw, 0.5, 2)
    lines = [f"{a}*sin({b}*t)" for a, b in zip(size, rate, strict=True)]
    acting = Acting(load=lambda t, v, q, own: size * np.sin(rate * t))
    return replace(body, lines=_moment(lines), acting=acting)


def braked(body: Sample, draw: Draw) -> Sample:
    """A moment against the angular velocity and its cube."""
    linear, cubic = numbers(draw, 0.05, 0.3), numbers(draw, 0.05, 0.3)
    lines = [f"-{linear[i]}*w{i + 1} - {cubic[i]}*w{i + 1}^3" for i in range(3)]
    acting = Acting(load=lambda t, v, q, own: -linear * v - cubic * v**3)
    return replace(body, lines=_moment(lines), acting=acting)


def heavy(body: Sample, draw: Draw) -> Sample:
    """A weight at a point of the body, written as a moment."""
    arm = numbers(draw, -0.4, 0.4)
    a, b, c = (float(x) for x in arm)
    lines = [f"{b}*d3 - {c}*d2", f"{c}*d1 - {a}*d3", f"{a}*d2 - {b}*d1"]
    down = np.array([0.0, 0.0, -1.0])
    acting = Acting(load=lambda t, v, q, own: np.cross(arm, rotation(q).T @ down))
    return replace(body, lines=_moment(lines), tables=("[space]", "d = [0, 0, -1]"), acting=acting)


def feedback(body: Sample, draw: Draw) -> Sample:
    """A moment by the attitude and the angular velocity."""
    kp, kd = (float(x) for x in numbers(draw, 0.2, 0.8, 2))
    lines = [f"-{kp}*q{i}*q0 - {kd}*w{i}" for i in (1, 2, 3)]
    acting = Acting(load=lambda t, v, q, own: -kp * q[1:] * q[0] - kd * v)
    return replace(body, lines=_moment(lines), acting=acting)


def pulsed(body: Sample, draw: Draw) -> Sample:
    """A moment about each axis until it is switched off."""
    size = numbers(draw, 0.2, 0.6)
    off = float(body.times[len(body.times) // 2] + 1 / (2 * GRID))
    lines = [f"{a} if t < {off} else 0" for a in size]
    acting = Acting(load=lambda t, v, q, own: size * (t < off), switches=(off,))
    return replace(body, lines=_moment(lines), acting=acting)


def sampled(body: Sample, draw: Draw) -> Sample:
    """An own state: a controller that takes its moment some times in each row and keeps it."""
    kp, kd = (float(x) for x in numbers(draw, 0.3, 0.9, 2))
    every = float(body.times[1]) / int(draw.choice([1, 2]))
    lines = [f"-{kp}*q{i} - {kd}*w{i}" for i in (1, 2, 3)]
    tables = ("[states]", f'm = {{ every = "{every}", value = {texts(lines)} }}')
    acting = Acting(
        load=lambda t, v, q, own: own,
        start=np.zeros(3),
        taken=lambda t, v, q, own: -kp * q[1:] - kd * v,
        every=every,
    )
    return replace(body, lines=_moment(["m1", "m2", "m3"]), tables=tables, acting=acting)


def driven(body: Sample, draw: Draw) -> Sample:
    """A solid in a fluid with thrust and a drag on all velocities."""
    thrust, drag = float(numbers(draw, 0.1, 0.4, 1)[0]), numbers(draw, 0.05, 0.3, 6)
    names = ("u1", "u2", "u3", "w1", "w2", "w3")
    lines = [f"-{drag[i]}*{names[i]}" for i in range(6)]
    lines[0] += f" + {thrust}"
    push = np.array([thrust, 0, 0, 0, 0, 0])
    acting = Acting(load=lambda t, v, q, own: push - drag * v)
    both = (f"force = {texts(lines[:3])}", f"couple = {texts(lines[3:])}")
    return replace(body, lines=both, acting=acting)


WRITTEN: Final[dict[str, Loaded]] = {
    "timed": timed,
    "braked": braked,
    "heavy": heavy,
    "feedback": feedback,
    "pulsed": pulsed,
}
OWN_STATES: Final[dict[str, Loaded]] = {"lagging": lagging, "sampled": sampled}

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
