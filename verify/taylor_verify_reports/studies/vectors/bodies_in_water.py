"""Solids in a fluid as vehicles have them: added mass, drag, thrust, righting moment, current, motors."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Final

import numpy as np

from taylor_verify_reports.studies.causes.bodies import Acting, Floats, Sample
from taylor_verify_reports.studies.causes.kind import Kind, of
from taylor_verify_reports.studies.causes.kinds_of_loads import (
    centre_in_one,
    of_added,
    slower_motor,
    without_lag,
)
from taylor_verify_reports.studies.causes.loaded import numbers, solid_of, texts
from taylor_verify_reports.studies.causes.simulated import Rows, integrated, law, rotation
from taylor_verify_reports.studies.causes.stepping import Make
from taylor_verify_reports.studies.vectors.bodies_under_loads import Draw, Loaded

_PLAIN: Final = ("vehicle", "current")
_SOLIDS: Final = (*_PLAIN, "steered")
_MASS: Final = ("added mass", "M_", "mass")
_CORIOLIS: Final = ("added mass", "Coriolis", "C_", "M_")


def _scaled(part: Callable[[Floats, Floats], Floats], factor: float) -> Make:
    """Return the maker of answers in which a part of the load has a factor.

    The part is made of the whole load and of that at rest.
    """

    def make(s: Sample, d: Draw, size: float) -> Rows:
        own, load = law(s), s.acting.load

        def changed(t: float, v: Floats, q: Floats, m: Floats) -> Floats:
            whole, at_rest = load(t, v, q, m), load(t, 0 * v, q, m)
            return whole + (factor - 1) * part(whole, at_rest)

        own.acting = replace(s.acting, load=changed)
        return integrated(s, own)

    return make


def _drag(whole: Floats, at_rest: Floats) -> Floats:
    return whole - at_rest


def _thrust(whole: Floats, at_rest: Floats) -> Floats:
    return at_rest * (np.arange(6) < 3)


def _righting(whole: Floats, at_rest: Floats) -> Floats:
    return at_rest * (np.arange(6) > 2)


def _over_ground(s: Sample, d: Draw, size: float) -> Rows:
    rows = integrated(s, law(s))
    ground = np.array([rotation(q).T @ s.current for q in rows.q])
    v = rows.v.copy()
    v[:, :3] += ground
    return rows._replace(v=v)


def _drag_over_ground(s: Sample, d: Draw, size: float) -> Rows:
    own, load = law(s), s.acting.load

    def changed(t: float, v: Floats, q: Floats, m: Floats) -> Floats:
        ground = np.concatenate([rotation(q).T @ s.current, np.zeros(3)])
        return load(t, v + ground, q, m)

    own.acting = replace(s.acting, load=changed)
    return integrated(s, own)


def _of_energy(change: Callable[[Floats, float], Floats]) -> Make:
    """Return the maker of answers by another energy of the impulses."""

    def make(s: Sample, d: Draw, size: float) -> Rows:
        own = law(s)
        own.mass = np.asarray(np.linalg.inv(change(np.asarray(np.linalg.inv(s.mass)), size)))
        own.coriolis, own.munk = own.mass.copy(), own.mass[:3].copy()
        return integrated(s, own)

    return make


_coefficient: Final = _of_energy(
    lambda form, size: form * (1 + size / 4 * np.diag([1, 1, 0, 0, 0, 0]))
)
_without_coupling: Final = _of_energy(lambda form, size: form * np.kron(np.eye(2), np.ones((3, 3))))


_PUSH: Final = ("force", "load", "thrust")
_MOMENT: Final = ("weight", "moment", "load", "couple")
_DRAG: Final = ("drag", "load", "force", "factor")
WATER_KINDS: Final = (
    Kind("added mass left out", _MASS, of_added(0.0, in_inertia=True), _PLAIN),
    Kind("added mass twice", _MASS, of_added(2.0, in_inertia=True), _PLAIN),
    Kind("C_A left out", _CORIOLIS, of_added(0.0), _SOLIDS),
    Kind("C_A twice", _CORIOLIS, of_added(2.0), _SOLIDS),
    Kind("C_A with the other sign", _CORIOLIS, of_added(-1.0), _SOLIDS),
    Kind("centre of mass left out of C", ("coupling", *_CORIOLIS), of(centre_in_one), _SOLIDS),
    Kind("drag left out", _DRAG, _scaled(_drag, 0.0), _SOLIDS),
    Kind("drag of another size", _DRAG, _scaled(_drag, 1.06), _SOLIDS),
    Kind("thrust left out", _PUSH, _scaled(_thrust, 0.0), _PLAIN),
    Kind("thrust with the other sign", _PUSH, _scaled(_thrust, -1.0), _PLAIN),
    Kind("righting moment left out", _MOMENT, _scaled(_righting, 0.0), ("vehicle",)),
    Kind("righting moment upside down", (*_MOMENT, "sign"), _scaled(_righting, -1.0), ("vehicle",)),
    Kind("velocity over ground", ("over ground", "moving frame"), _over_ground, ("current",)),
    Kind("drag by the velocity over ground", _DRAG, _drag_over_ground, ("current",)),
    Kind("motor without lag", ("m ", "lag"), without_lag, ("steered",)),
    Kind("slower motor", ("m ", "rate"), slower_motor, ("steered",)),
    Kind("coefficient p of another size", ("a_", "M_", "p "), _coefficient, ("clebsch",)),
    Kind("coupling left out", ("coupling", "b_", "M_", "q"), _without_coupling, ("clebsch",)),
)
# Where nobody need know them: their forms are those of one scene.
NOT_KNOWN_IN_WATER: Final = (
    *("drag left out", "drag of another size", "thrust left out", "thrust with the other sign"),
    *(
        "righting moment left out",
        "righting moment upside down",
        "drag by the velocity over ground",
    ),
    *("slower motor", "coefficient p of another size", "coupling left out"),
)

_NAMES: Final = ("u1", "u2", "u3", "w1", "w2", "w3")


def _solid(body: Sample, draw: Draw) -> Sample:
    """A rigid body with an added mass; its origin is not its centre of mass."""
    mass, inertia = float(numbers(draw, 2, 4, 1)[0]), numbers(draw, 0.8, 2)
    centre, added = numbers(draw, -0.15, 0.15), numbers(draw, 0.3, 2, 6)
    return solid_of(body, mass, inertia, centre, added)


def _both(lines: list[str]) -> tuple[str, str]:
    return f"force = {texts(lines[:3])}", f"couple = {texts(lines[3:])}"


def _driven(body: Sample, draw: Draw, lines: tuple[str, ...] = ()) -> Sample:
    """A thrust along the first axis, and a drag that is linear and quadratic."""
    push = float(numbers(draw, 0.2, 0.6, 1)[0]) * np.eye(6)[0]
    linear, quadratic = numbers(draw, 0.1, 0.4, 6), numbers(draw, 0.1, 0.4, 6)
    drag = zip(linear, _NAMES, quadratic, _NAMES, _NAMES, strict=True)
    written = [f"-{a}*{u} - {b}*abs({v})*{w}" for a, u, b, v, w in drag]
    written[0] += f" + {push[0]}"
    acting = Acting(load=lambda t, v, q, own: push - linear * v - quadratic * np.abs(v) * v)
    return replace(body, lines=(*_both(written), *lines), acting=acting)


def vehicle(body: Sample, draw: Draw) -> Sample:
    """A neutral vehicle with thrust and drag, whose weight acts at its centre of mass."""
    driven = _driven(_solid(body, draw), draw)
    weight, at = float(numbers(draw, 1, 3, 1)[0]), driven.solid["centre_of_mass"]
    down = np.array([0, 0, -weight])
    load = driven.acting.load

    def acting(t: float, v: Floats, q: Floats, own: Floats) -> Floats:
        righting = np.cross(at, rotation(q).T @ down)
        return np.asarray(load(t, v, q, own) + np.array([0, 0, 0, *righting]))

    place = f"[{', '.join(map(str, at))}]"
    hydrostatic = (
        f"weight = {{ force = [0, 0, {-weight}], at = {place} }}",
        f"buoyancy = {{ force = [0, 0, {weight}] }}",
    )
    return replace(driven, lines=(*driven.lines, *hydrostatic), acting=Acting(load=acting))


def in_current(body: Sample, draw: Draw) -> Sample:
    """A vehicle in a current: its velocities are relative to the fluid."""
    current = numbers(draw, 0.2, 0.6)
    driven = _driven(_solid(body, draw), draw, (f"current = {current.tolist()}",))
    return replace(driven, current=current)


def clebsch(body: Sample, draw: Draw) -> Sample:
    """A solid of revolution of Kirchhoff and Clebsch, by the energy of its impulses."""
    p, p_prime, r, r_prime = numbers(draw, 0.5, 1.5, 4)
    q, q_prime = numbers(draw, -0.2, 0.2, 2)
    coupling = np.diag([q, q, q_prime])
    energy = np.block([[np.diag([p, p, p_prime]), coupling], [coupling, np.diag([r, r, r_prime])]])
    names = ("p", "p_prime", "q", "q_prime", "r", "r_prime")
    six = dict(zip(names, (p, p_prime, q, q_prime, r, r_prime), strict=True))
    return replace(body, mass=np.linalg.inv(energy), solid={"clebsch": six})


def steered(body: Sample, draw: Draw) -> Sample:
    """Own states: a propeller and a rudder follow their commands with a lag."""
    solid = _solid(body, draw)
    push, gain, pace = (float(x) for x in numbers(draw, 0.3, 0.9))
    drag = numbers(draw, 0.1, 0.4, 6)
    lines = [f"-{a}*{name}" for a, name in zip(drag, _NAMES, strict=True)]
    lines[0], lines[5] = f"{lines[0]} + m1", f"{lines[5]} + m2"
    rates = [f"{pace}*({push} - m1)", f"{pace}*(-{gain}*q3 - m2)"]
    tables = ("[states]", f"m = {{ start = [0, 0], rate = {texts(rates)} }}")
    acting = Acting(
        load=lambda t, v, q, own: np.array([own[0], 0, 0, 0, 0, own[1]]) - drag * v,
        start=np.zeros(2),
        rate=lambda t, v, q, own: pace * (np.array([push, -gain * q[3]]) - own),
    )
    return replace(solid, lines=_both(lines), tables=tables, acting=acting)


IN_WATER: Final[dict[str, Loaded]] = {
    "vehicle": vehicle,
    "current": in_current,
    "clebsch": clebsch,
    "steered": steered,
}
