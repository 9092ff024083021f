"""Kinds of faults of loads that a scene writes as texts, and of the Coriolis terms of an added mass."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any, Final

import numpy as np

from taylor_verify_reports.studies.causes.bodies import Acting, Floats, Sample
from taylor_verify_reports.studies.causes.kind import Kind, of
from taylor_verify_reports.studies.causes.loaded import held
from taylor_verify_reports.studies.causes.simulated import (
    Law,
    Rows,
    cross,
    integrated,
    law,
    rotation,
    skew,
)
from taylor_verify_reports.studies.causes.stepping import Draw, Make

_LOWER: Final = ((4, 0), (4, 2), (5, 0), (5, 1))


def _added_coriolis(s: Sample, v: Floats) -> Floats:
    """Return C_A(v) of Fossen (Handbook of Marine Craft Hydrodynamics, 2nd ed., 6.3.1)."""
    p, turning = np.split((s.mass - s.dry) @ v, 2)
    return np.block([[np.zeros((3, 3)), -skew(p)], [-skew(p), -skew(turning)]])


def _entries(places: Callable[[Draw], Any], factor: float) -> Make:
    """Return the maker of a motion with some entries of C_A times a factor."""

    def change(own: Law, s: Sample, d: Draw, size: float) -> None:
        mask = np.zeros((6, 6))
        mask[tuple(np.transpose(places(d)))] = factor - 1
        own.loads_of = lambda t, v: -(mask * _added_coriolis(s, v)) @ v

    return of(change)


def _any_entry(d: Draw) -> Any:
    i, k = int(d.integers(6)), int(d.integers(2))
    block = 3 if i < 3 or d.integers(2) else 0
    return [(i, block + (i % 3 + 1 + k) % 3)]


def of_added(factor: float, *, in_inertia: bool = False) -> Make:
    """Return the maker of motions whose added mass has a factor in the Coriolis terms, or everywhere."""

    def change(own: Law, s: Sample, d: Draw, size: float) -> None:
        own.coriolis = s.dry + factor * (s.mass - s.dry)
        own.munk = own.coriolis[:3].copy()
        if in_inertia:
            own.mass = own.coriolis.copy()

    return of(change)


def centre_in_one(own: Law, s: Sample, d: Draw, size: float) -> None:
    """Leave the coupling by the centre of mass out of the Coriolis terms."""
    matrix = s.mass.copy()
    matrix[:3, 3:] = matrix[3:, :3] = 0
    own.coriolis, own.munk = matrix, matrix[:3].copy()


def _with(**changes: Any) -> Make:
    """Return the maker of a motion with another source of loads; a value may be made of the old source."""

    def make(s: Sample, d: Draw, size: float) -> Rows:
        values = {n: x(s.source, s, size) if callable(x) else x for n, x in changes.items()}
        other = replace(s.source, **values)
        acting = getattr(other, "acting", None)
        if acting is None:
            edges = getattr(other, "times", (getattr(other, "until", np.inf),))
            acting = Acting(other.load, switches=tuple(edges))
        return integrated(s, _acting(s, acting))

    return make


def _acting(s: Sample, acting: Acting) -> Law:
    own = law(s)
    own.acting = acting
    return own


def _over_ground(*terms: str) -> Make:
    """Return the maker of a motion with the terms of the added mass, rate or C_A, over ground."""

    def load(s: Sample, t: float, v: Floats, q: Floats, own: Floats) -> Floats:
        current, none = rotation(q).T @ s.current, np.zeros(3)
        rate = np.r_[cross(current, v[3:]), none]
        more = -("rate" in terms) * (s.mass - s.dry) @ rate
        if "C_A" in terms:
            over_ground = v + np.r_[current, none]
            more += _added_coriolis(s, v) @ v - _added_coriolis(s, over_ground) @ over_ground
        return np.asarray(s.source.load(t, v, q, own) + more)

    def make(s: Sample, d: Draw, size: float) -> Rows:
        acting = Acting(partial(load, s), switches=(s.source.until,))
        return integrated(s, _acting(s, acting))

    return make


def _held(s: Sample, d: Draw, size: float) -> Rows:
    return integrated(s, _acting(s, held(s.source.load, s)))


def _continuous(s: Sample, d: Draw, size: float) -> Rows:
    return integrated(s, _acting(s, Acting(lambda t, v, q, own: -s.source.gain * v)))


def _half_drag(v: Any, s: Any, size: float) -> Any:
    return (1 + size) * v.drag


def _one_drag_less(v: Any, s: Any, size: float) -> Any:
    return v.drag * np.array([1, 0, 1, 1, 1, 1])


_V: Final = ("vehicle",)
_S: Final = ("sampled",)
_U: Final = ("surge",)
_SURGE: Final = ("the number ", "in force 1", "quadratic drag")
_DRAG: Final = ("terms with velocities", "all quadratic drag")
_THRUST: Final = ("in force 1", "terms of force without", "from t =", "right up to", "switch at")
_PULSES: Final = ("loads late",)
OF_LOADS: Final = (
    Kind(
        "added mass missing in C",
        ("lack the added mass", "added mass left out in"),
        of_added(0),
        ("solid",),
    ),
    Kind("added mass twice in C", ("added mass twice",), of_added(2), ("solid",)),
    Kind(
        "added mass of the other sign in C",
        ("added mass with the other",),
        of_added(-1),
        ("solid",),
    ),
    Kind("added mass missing", ("added mass left out",), of_added(0, in_inertia=True), ("solid",)),
    Kind("entry of C_A zeroed", ("C_",), _entries(_any_entry, 0.0), ("solid",)),
    Kind("entry of C_A of the other sign", ("C_",), _entries(_any_entry, -1.0), ("solid",)),
    Kind(
        "entries of C_A as simulators zero them",
        ("C_",),
        _entries(lambda d: _LOWER, 0.0),
        ("solid",),
    ),
    Kind(
        "centre of mass in M alone",
        ("centre of mass", "coupling left out in", "m r_"),
        of(centre_in_one),
        ("solid",),
    ),
    Kind("drag of another size", _DRAG, _with(drag=_half_drag), _V),
    Kind(
        "drag left out on an axis",
        ("in force 2", "force 2 left out"),
        _with(drag=_one_drag_less),
        _V,
    ),
    Kind("thrust left out", _THRUST, _with(thrust=0.0), _V),
    Kind("thrust of the other sign", _THRUST, _with(thrust=lambda v, s, e: -v.thrust), _V),
    Kind("switch missed", _THRUST, _with(until=np.inf), _V),
    Kind(
        "switch late by a step",
        _THRUST,
        _with(until=lambda v, s, e: v.until + float(s.times[1])),
        _V,
    ),
    Kind(
        "couple of weight and buoyancy left out",
        ("weight at", "weight and buoyancy", "couple r x R^T e3", "component 3 of the point"),
        _with(arm=np.zeros(3)),
        _V,
    ),
    Kind("drag over ground", ("ground",), _with(wind=lambda v, s, e: s.current), _V),
    # A pulse that is held is a pulse that begins and ends later.
    Kind(
        "loads held over a step",
        ("held in between", "loads late"),
        _held,
        (*_V, "pulse", "gradient"),
    ),
    Kind("load turned the wrong way", ("wrong way",), _with(is_back=True), ("gradient",)),
    Kind(
        "products left out of the gravity gradient",
        ("no products of inertia",),
        _with(inertia=lambda g, s, e: np.diag(np.diag(g.inertia))),
        ("gradient",),
    ),
    Kind(
        "pulses late by a step",
        _PULSES,
        _with(times=lambda p, s, e: tuple(t + float(s.times[1]) for t in p.times)),
        ("pulse",),
    ),
    Kind(
        "pulses left out",
        ("moment left out", "the number ", "from t ="),
        _with(size=0.0),
        ("pulse",),
    ),
    Kind(
        "controller at another rate",
        ("taken every", "every ="),
        _with(every=lambda c, s, e: 2 * c.every),
        _S,
    ),
    Kind("controller one sample late", ("one sample late",), _with(delay=3), _S),
    Kind("controller without its delay", ("without its delay",), _with(delay=0), _S),
    Kind("controller continuous", ("continuous",), _continuous, _S),
    Kind(
        "controller of another gain",
        ("the number ",),
        _with(gain=lambda c, s, e: (1 + e) * c.gain),
        _S,
    ),
)


def without_lag(s: Sample, d: Draw, size: float) -> Rows:
    """Return motors that follow at once: their states are those at which their rates are zero."""
    own, rate, load, none = law(s), s.acting.rate, s.acting.load, 0 * s.acting.start
    pace = float(-(rate(0.0, s.v0, s.q0, none + 1) - rate(0.0, s.v0, s.q0, none))[0])
    own.acting = replace(
        s.acting, load=lambda t, v, q, m: load(t, v, q, rate(t, v, q, none) / pace)
    )
    return integrated(s, own)


def slower_motor(s: Sample, d: Draw, size: float) -> Rows:
    """Return motors whose states follow in a longer time."""
    own, rate = law(s), s.acting.rate
    own.acting = replace(s.acting, rate=lambda t, v, q, m: rate(t, v, q, m) / (1 + size))
    return integrated(s, own)


# Kinds that came later stand last of all.
LATER_OF_LOADS: Final = (
    Kind("rate of the current left out", ("rate of the current",), _over_ground("rate"), _V),
    Kind("C_A over ground", ("take the velocity over ground",), _over_ground("C_A"), _V),
    Kind("added mass over ground", ("moves over ground",), _over_ground("rate", "C_A"), _V),
    Kind("weight turned by R", ("turned the wrong way",), _with(hangs_back=True), _V),
    Kind("drag along space axes", ("along space axes",), _with(is_drag_in_space=True), _V),
    Kind("lag left out", ("without its lag",), without_lag, ("lag",)),
    Kind(
        "lag of another time constant",
        ("the number ",),
        slower_motor,
        ("lag",),
    ),
    Kind("drag of another size in surge", _SURGE, _with(drag=lambda a, s, e: 1.5 * a.drag), _U),
    Kind(
        "thrust of another size in surge", _SURGE, _with(thrust=lambda a, s, e: 1.5 * a.thrust), _U
    ),
)
